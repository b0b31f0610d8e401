"""What a truck carries, how it gets onto its bus, and what its controller reads from there."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.perimeter.percepts import (
    SPOKEN,
    Percepts,
    foot_of_edge,
    nearest_of_kind,
    room_to_turn,
)
from controllers.perimeter.vision import inside
from experiments.perimeter.worlds import Scene
from mjmr.bus import Bus
from mjmr.loop import TickedSimulation
from mjmr.radio import Radio
from mjmr.sensors.camera import Camera
from mjmr.sensors.localizer import Localizer
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
IDENTIFIERS = {INSIDE: 0x100, EDGE: 0x110, BODY: 0x120, POSE: 0x130}
SIZES = {INSIDE: 1, EDGE: 12, BODY: 8, POSE: 12}  # bytes
TURN, NOSE = 0.67, np.array([0.4, 0.2])  # m: sharpest turn at 0.3 rad/s, and what it must not touch
STALE = 0.5  # s: what is older counts as missing


def mount(scene: Scene, condition: Mapping[str, Any]) -> None:
    """Mount the sensors of a condition on the trucks."""
    trucks = scene.trucks
    trucks.mount(Localizer(rate=RATE, position_noise=0.02, yaw_noise=0.01), "localizer")
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
        arc, localizer = trucks.arc, trucks.localizer
        site = simulation.rays.sites(trucks.prefixes[:1], ["lidar"])[0]
        at = simulation.rays.mounts(site)[0]

        def edge() -> Array:
            looks = arc.read()
            foot = foot_of_edge(looks, arc.angles, PILLAR, at, SENSE)
            room = room_to_turn(looks, arc.angles, PILLAR, at, TURN, NOSE)
            return np.column_stack([foot, room])

        def body() -> Array:
            return nearest_of_kind(arc.read(), arc.angles, ROBOT, at, SEE)

        if condition["sensing"] == "camera":
            eye = trucks.eye
            self._attach(INSIDE, lambda: inside(eye.read()), lambda: eye.sampled_at)
        else:
            self._attach(INSIDE, trucks.spot.read, lambda: trucks.spot.sampled_at)
        self._attach(EDGE, edge, lambda: arc.sampled_at)
        self._attach(BODY, body, lambda: arc.sampled_at)
        self._attach(POSE, localizer.read, lambda: localizer.sampled_at)

    def _attach(self, name: str, read: Any, sampled_at: Any) -> None:
        self.bus.attach(name, IDENTIFIERS[name], read, sampled_at, size=SIZES[name])

    def look(self, time: float, on: NDArray[np.bool_]) -> Percepts | None:
        """What the trucks know now; None before anything has come.

        Args:
            time: [s].
            on: Who is switched on (n,).
        """
        bus, n = self.bus, self.n
        bus.step()
        if not all((bus.age(name) < np.inf).any() for name in IDENTIFIERS):
            return None
        read = {}
        for name in IDENTIFIERS:
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
        return Percepts(
            time=time, pose=read[POSE], edge=read[EDGE][:, :2], inside=read[INSIDE],
            room=read[EDGE][:, 2], body=read[BODY], heard=heard, sent=sent,
        )  # fmt: skip
