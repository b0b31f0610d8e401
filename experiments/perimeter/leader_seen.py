"""Followers that see their leader and hear nothing: two coloured poles, a camera, odometry.

A picture is delivered a period after it was taken, as everything is on the trucks' bus.
"""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from controllers.consensus.leader_track import LeaderTrack
from controllers.estimation.odometry import Odometry
from controllers.perception.markers import Marker, MarkerFinder
from mjmr.sensors.camera import Camera
from mjmr.world import World

if TYPE_CHECKING:
    import mujoco

    from mjmr.group import Group

Array = NDArray[np.float64]
PERIOD = 0.1  # s, of control; the cameras take a picture in each
EYE = (0.32, 0.0, 0.45)  # m, frame of the truck: of the camera that looks ahead
REAR, FRONT = -0.05, 0.30  # m ahead of the rear axle: where the leader's poles stand
_HEIGHT = 0.64  # m, of their middles: above the head of the leader's own camera, which hid one
_STALK = 0.20  # m, by which they stand off the truck
_POLE = Marker(length=0.30, radius=0.05, colours=((0.90, 0.05, 0.85), (0.05, 0.75, 0.10)))
_PIXELS = (480, 160)
_CONE = math.radians(100.0)  # horizontally
_NOISE = 2.0  # grey levels of a pixel


def add_poles(world: World, trucks: "Group") -> None:
    """Put a pole over the leader's payload and one over its bonnet."""

    def build(spec: "mujoco.MjSpec") -> None:
        import mujoco

        base = spec.body(f"{trucks.prefixes[0]}base")
        kind, low = mujoco.mjtGeom.mjGEOM_CYLINDER, _HEIGHT - (_POLE.length + _STALK) / 2
        shown: dict[str, Any] = {
            "type": kind, "contype": 0, "conaffinity": 0, "group": 1, "mass": 0
        }  # fmt: skip
        for x, colour in zip((REAR, FRONT), _POLE.colours, strict=True):
            size = [_POLE.radius, _POLE.length / 2, 0]
            base.add_geom(**shown, size=size, pos=[x, 0, _HEIGHT], rgba=[*colour, 1])
            base.add_geom(
                **shown,
                size=[0.006, _STALK / 2, 0],
                pos=[x, 0, low],
                rgba=[0.1, 0.1, 0.1, 1],
            )

    world.edit(build)


class LeaderSeen:
    """What every follower makes of its pictures and its own wheels' counts."""

    def __init__(self, world: World, trucks: "Group", condition: Mapping[str, Any]):
        """Put up the poles and mount the cameras; the first of the trucks is the leader."""
        del condition
        add_poles(world, trucks)
        width, height = _PIXELS
        fovy = 2.0 * math.atan(math.tan(_CONE / 2.0) * height / width)
        ahead = (EYE[0] + 1.0, EYE[1], EYE[2])
        self._camera: Camera = trucks.mount(
            Camera(
                width=width, height=height, fovy=fovy, rate=1.0 / PERIOD, latency=PERIOD,
                noise=_NOISE, position=EYE, look_at=ahead,
            ),
            "front",
        )  # fmt: skip
        self._trucks = trucks
        n = trucks.n - 1
        self._track = LeaderTrack(n, behind=REAR, ahead=FRONT, period=PERIOD)
        platform: Any = trucks.platform
        # a frame of its own for each: where it starts
        self._odometry = Odometry(
            np.zeros((n, 3)), radius=platform.rolling_radius, track=platform.track,
            counts_per_turn=trucks.encoders.counts_per_turn,
        )  # fmt: skip
        self._looked_at = -1.0
        self._then = self._odometry.poses

    def start(self, simulation: Any) -> None:
        """Find out how the cameras project."""
        del simulation
        self._finder = MarkerFinder(_POLE, [self._camera.calibration], complete=True)

    def step(self, now: float, leads: Array) -> tuple[Array, Array]:
        """As :meth:`LeaderHeard.step <experiments.perimeter.leader_heard.LeaderHeard.step>`.

        Neither argument is used: nobody speaks.
        """
        del now, leads
        then, own = self._then, self._odometry.step(self._trucks.encoders.read()[1:])
        self._then = own
        marks = np.full((len(own), 2, 2), np.nan)
        if np.any(self._camera.fresh) and self._camera.sampled_at != self._looked_at:
            self._looked_at = self._camera.sampled_at
            for i, image in enumerate(self._camera.read()[1:]):
                marks[i] = self._finder.find([image])
        return self._track.step(marks, then, own)
