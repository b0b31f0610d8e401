"""What a truck carries, how it gets onto its bus, and what its controller reads from there."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.perimeter.config import PerimeterConfig
from controllers.perimeter.echoes import kind_in_cones, nearest_unexplained, wall_ranges
from controllers.perimeter.percepts import (
    SPOKEN,
    Percepts,
    foot_of_edge,
    nearest_of_kind,
    room_to_turn,
)
from controllers.perimeter.vision import inside
from experiments.perimeter.reckoning import Reckoning
from experiments.perimeter.worlds import HALF, Scene
from mjmr.bus import Bus
from mjmr.loop import TickedSimulation
from mjmr.radio import Radio
from mjmr.sensors.camera import Camera
from mjmr.sensors.compass import Compass
from mjmr.sensors.localizer import Localizer
from mjmr.sensors.rangers import Sonar
from mjmr.sensors.spot import Spot
from mjmr.sensors.visual_arc import PILLAR, ROBOT, VisualArc

Array = NDArray[np.float64]
EYE = (0.1, 0.1, 0.42)  # m, frame of the truck: where the camera is
AIM = (0.5, 0.6, 0.0)  # m: the spot on the floor it is aimed at, down and to the left
WIDTH, HEIGHT, CAMERA_RATE = 160, 120, 5.0
RATE = 10.0  # Hz, of everything else
SENSE = 3.0  # m, D_sen
SEE = 5.0  # m, at which trucks see each other
COLUMNS = 72
FAN_HEIGHT = 0.2  # m, above the floor: what it sees is the spill's side and other trucks
POSE, EDGE, BODY, INSIDE = "pose", "edge", "body", "inside"
RED, SONAR, ODOMETER, COMPASS = "red", "sonar", "odometer", "compass"
IDENTIFIERS = {
    INSIDE: 0x100, EDGE: 0x110, RED: 0x118, BODY: 0x120, SONAR: 0x128, POSE: 0x130,
    ODOMETER: 0x138, COMPASS: 0x13C,
}  # fmt: skip
SIZES = {
    INSIDE: 1, EDGE: 12, RED: 16, BODY: 8, SONAR: 16, POSE: 12, ODOMETER: 8, COMPASS: 2,
}  # fmt: skip
"""Bytes."""
# m: radius of a truck's sharpest turn; its front left corner, with room for a tyre that is steered
TURN, NOSE = PerimeterConfig.least_speed / PerimeterConfig.top_turn, np.array([0.4, 0.2])
STALE = 0.5  # s: what is older counts as missing
SONAR_RATE = 5.0  # Hz: 5 m and back take 29 ms, and of eight two fire at once
BEAM = np.radians(15.0)  # full angle of a cone
NEAREST, FARTHEST = 0.2, 5.0  # m, of the sonars
FANS = 4  # of rays a cone: a flat one at 0.19 m passes over the tyres of other trucks
MARGIN = 0.5  # m, by which an echo must be nearer than what is known to be in its cone
SLACK = np.radians(12.0)  # of a cone, for what a truck turns between two samples and errs in yaw
ACCOUNTED = 2.75  # m from the fan, up to which echoes count; the camera knows red up to 3 m
HEADING_NOISE = 0.02  # rad, of the compass; ours


def mount(scene: Scene, condition: Mapping[str, Any]) -> None:
    """Mount the sensors of a condition on the trucks."""
    trucks = scene.trucks
    if condition["localization"] == "localizer":
        trucks.mount(Localizer(rate=RATE, position_noise=0.02, yaw_noise=0.01), "localizer")
    elif condition["localization"] == "odometry-compass":
        trucks.mount(Compass(rate=RATE, noise=HEADING_NOISE), "compass")
    if condition["obstacles"] == "sonars":
        trucks.mount(
            Sonar(
                beam_width=BEAM, min_range=NEAREST, max_range=FARTHEST, rate=SONAR_RATE,
                proportional_noise=0.01, fans=FANS,
            ),
            "sonar",
        )  # fmt: skip
    trucks.mount(
        VisualArc(
            site="lidar", height=FAN_HEIGHT, columns=COLUMNS, field_of_view=2 * np.pi,
            max_range=SEE, rate=RATE, noise=0.01,
        ),
        "arc",
    )  # fmt: skip
    trucks.mount(trucks.platform.default_sensors()["encoders"], "encoders")
    both = condition["sensing"] == "both"
    # a camera whose pictures nobody reads costs nothing; films look through it
    eye = Camera(width=WIDTH, height=HEIGHT, rate=CAMERA_RATE, position=EYE, look_at=AIM)
    trucks.mount(eye, "eye")
    if condition["sensing"] != "camera":
        trucks.mount(
            Spot(
                position=EYE, target=AIM, rate=CAMERA_RATE if both else RATE,
                wrong=condition["wrong"],
            ),
            "spot",
        )  # fmt: skip


class Senses:
    """The trucks' buses and their radio.

    Attributes:
        bus: With the devices.
        radio: Within D_com.
    """

    def __init__(self, simulation: TickedSimulation, scene: Scene, condition: Mapping[str, Any]):
        """Attach the sensors; the simulation has them already."""
        trucks = scene.trucks
        self.n = trucks.n
        self.radio = Radio(simulation, range=condition["d_com"])
        self.bus = Bus(simulation, self.n)
        self._devices: list[str] = []
        arc = trucks.arc
        site = simulation.rays.sites(trucks.prefixes[:1], ["lidar"])[0]
        at = self._at = simulation.rays.mounts(site)[0]

        def edge() -> Array:
            looks = arc.read()
            foot = foot_of_edge(looks, arc.angles, PILLAR, at, SENSE)
            room = room_to_turn(looks, arc.angles, PILLAR, at, TURN, NOSE)
            return np.column_stack([foot, room])

        if condition["sensing"] == "camera":
            eye = trucks.eye
            self._attach(INSIDE, lambda: inside(eye.read()), lambda: eye.sampled_at)
        else:
            self._attach(INSIDE, trucks.spot.read, lambda: trucks.spot.sampled_at)
        self._attach(EDGE, edge, lambda: arc.sampled_at)
        self._others(condition["obstacles"], trucks)
        self._reckoning = None
        self._whereabouts(condition["localization"], scene)

    def _others(self, obstacles: str, trucks: Any) -> None:
        """Devices that find whoever is near: the fan, or sonars beside a camera that knows red."""
        arc, at = trucks.arc, self._at
        if obstacles == "fan":

            def body() -> Array:
                return nearest_of_kind(arc.read(), arc.angles, ROBOT, at, SEE)

            self._attach(BODY, body, lambda: arc.sampled_at)
            return
        sonar = trucks.sonar
        mounts = self._mounts = sonar.mounts

        def red() -> Array:
            return kind_in_cones(arc.read(), arc.angles, PILLAR, at, mounts, BEAM + SLACK, SENSE)

        self._attach(RED, red, lambda: arc.sampled_at)
        self._attach(SONAR, sonar.read, lambda: sonar.sampled_at)

    def _whereabouts(self, localization: str, scene: Scene) -> None:
        """Devices that tell where a truck is, or how far it went."""
        trucks = scene.trucks
        if localization == "localizer":
            self._attach(POSE, trucks.localizer.read, lambda: trucks.localizer.sampled_at)
            return
        self._reckoning = Reckoning(scene)
        self._attach(ODOMETER, trucks.encoders.read, lambda: trucks.encoders.sampled_at)
        if localization == "odometry-compass":
            self._attach(COMPASS, trucks.compass.read, lambda: trucks.compass.sampled_at)

    def _attach(self, name: str, read: Any, sampled_at: Any) -> None:
        self.bus.attach(name, IDENTIFIERS[name], read, sampled_at, size=SIZES[name])
        self._devices.append(name)

    def look(self, time: float, on: NDArray[np.bool_]) -> Percepts | None:
        """What the trucks know now; None before anything has come.

        Args:
            time: [s].
            on: Who is switched on (n,).
        """
        bus, n = self.bus, self.n
        bus.step()
        if not all((bus.age(name) < np.inf).any() for name in self._devices):
            return None
        read = {}
        for name in self._devices:
            value = bus.read(name)
            fresh = (bus.age(name) <= STALE) & on
            # a device that its manager reports gone is not asked
            fresh &= bus.present(name)
            value[~fresh] = np.nan
            read[name] = value
        heard, sent = np.full((n, n, len(SPOKEN)), np.nan), np.full((n, n), np.nan)
        if self.radio.messages_sent.any():
            heard, sent = self.radio.latest()
            # the clock is behind the newest there can be
            sent[~on] = np.nan
        pose = read[POSE] if self._reckoning is None else self._reckon(read)
        body = read[BODY] if BODY in read else self._echo(read, pose)
        return Percepts(
            time=time, pose=pose, edge=read[EDGE][:, :2], inside=read[INSIDE],
            room=read[EDGE][:, 2], body=body, heard=heard, sent=sent,
        )  # fmt: skip

    def _reckon(self, read: Mapping[str, Array]) -> Array:
        """Poses (n, 3) by dead reckoning; NaN where a device of it is missing."""
        assert self._reckoning is not None
        counts, heading = read[ODOMETER], read.get(COMPASS)
        pose = self._reckoning.step(counts, heading)
        pose[~np.isfinite(counts).all(axis=1)] = np.nan
        if heading is not None:
            pose[~np.isfinite(heading)] = np.nan
        return pose

    def _echo(self, read: Mapping[str, Array], pose: Array) -> Array:
        """Who is ahead by the sonars (n, 2): what neither walls nor the spill explain.

        Without a pose or a camera nothing explains an echo, so that it counts.
        """
        walls = wall_ranges(pose, self._mounts, BEAM + SLACK, (-HALF, -HALF, HALF, HALF))
        known = np.fmin(walls, read[RED])
        return nearest_unexplained(
            read[SONAR], known, self._mounts, margin=MARGIN, at=self._at[:2], reach=ACCOUNTED
        )
