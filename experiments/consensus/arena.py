"""Four-wheelers with masts at their hands, in a hall; and how they see each other."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.perception.markers import Marker, MarkerFinder
from mjmr.robots.four_wheeler import FourWheeler
from mjmr.sensors.camera import Camera
from mjmr.sensors.cone_sight import ConeSight
from mjmr.world import World

if TYPE_CHECKING:
    import mujoco

    from mjmr.group import Group

Array = NDArray[np.float64]
HAND = 0.2
"""L, of the hand point ahead of the middle of the wheels [m]."""
RANGE = 6.0
"""Of sight [m]."""
LOOKS = 10.0
"""Of cameras and of rays in their place [Hz]."""
EYE = (0.30, 0.0, 0.45)
"""Of the camera, in front of the mast [m], robot frame."""
MARK = (HAND, 0.0, 0.45)
"""Middle of the marker: the mast stands at the hand, so that who sees it sees the hand."""
_LENGTH, _RADIUS = 0.40, 0.07
_PIXELS = (480, 120)
_NOISE = 2.0  # grey levels of a pixel
COLOURS = ((0.90, 0.05, 0.05), (0.05, 0.75, 0.10), (0.10, 0.20, 0.95))
_MARKER = Marker(length=_LENGTH, radius=_RADIUS, colours=COLOURS)


def hall(bounds: ArrayLike) -> World:
    """An empty hall with a concrete floor (xmin, ymin, xmax, ymax) [m]."""
    return World(bounds=bounds, wall_height=0.5, floor="concrete")


def add_team(
    world: World, poses: Array, *, calibrated: bool, masts: bool, virtual: bool = False
) -> "Group":
    """Robots at poses (n, 3).

    Args:
        world: To put them into.
        poses: (n, 3).
        calibrated: Whether servos reckon with the scrub of the tyres.
        masts: Whether they carry them: three that are to see each other.
        virtual: Whether they pass through each other; floor and walls carry and stop them still.
    """
    platform = FourWheeler(acceleration=2.0, turn_acceleration=10.0, calibrated=calibrated)
    robots = world.add_group(platform, poses, name="rover")
    if masts:

        def build(spec: "mujoco.MjSpec") -> None:
            for prefix, colour in zip(robots.prefixes, COLOURS, strict=True):
                _mast(spec.body(f"{prefix}base"), colour)

        world.edit(build)
    if virtual:
        world.edit(lambda spec: _pass_through(spec, robots.prefixes))
    return robots


def _pass_through(spec: "mujoco.MjSpec", prefixes: Any) -> None:
    for prefix in prefixes:
        for geom in spec.body(f"{prefix}base").find_all("geom"):
            # what is touched by others; what it touches itself, contype, is floor and walls then
            geom.conaffinity = 0


def _mast(base: Any, colour: tuple[float, ...]) -> None:
    import mujoco

    cylinder = mujoco.mjtGeom.mjGEOM_CYLINDER
    # touched and met by rays, as what is seen should be; its mass is the base's
    base.add_geom(
        type=cylinder, size=[_RADIUS, _LENGTH / 2, 0], pos=MARK, rgba=[*colour, 1],
        group=0, mass=0.0,
    )  # fmt: skip
    base.add_geom(
        type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.012, 0.02, 0.015],
        pos=[EYE[0] - 0.015, 0, EYE[2]], rgba=[0.1, 0.1, 0.12, 1],
        contype=0, conaffinity=0, group=1, mass=0.0,
    )  # fmt: skip


def mount_rays(world: World, cone: float) -> ConeSight:
    """Rays in place of cameras with this cone [rad]."""
    return world.mount(ConeSight(cone=cone, range=RANGE, eye=EYE, mark=MARK, rate=LOOKS))


class Eyes:
    """One rendered camera a robot, and what OpenCV finds in its pictures."""

    def __init__(self, robots: "Group", cone: float):
        """Args: robots: Three of them. cone: Whole horizontal angle [rad], below pi."""
        width, height = _PIXELS
        ahead = (EYE[0] + 1.0, EYE[1], EYE[2])
        fovy = 2 * math.atan(math.tan(cone / 2) * height / width)
        self._camera: Camera = robots.mount(
            Camera(
                width=width, height=height, fovy=fovy, rate=LOOKS, noise=_NOISE, position=EYE,
                look_at=ahead,
            )
        )  # fmt: skip
        self._finder = MarkerFinder(_MARKER, [self._camera.calibration], complete=True)
        self._n = robots.n

    def read(self) -> Array:
        """As :meth:`mjmr.sensors.cone_sight.ConeSight.read`, from pictures."""
        found = np.full((self._n, self._n, 2), np.nan)
        if not np.any(self._camera.fresh):
            return found
        for i, image in enumerate(self._camera.read()):
            found[i] = self._finder.find([image])
        found[np.eye(self._n, dtype=bool)] = np.nan
        found[~(found[..., 0] <= RANGE)] = np.nan
        return found

    @property
    def sampled_at(self) -> float:
        """Instant of the pictures [s]."""
        return self._camera.sampled_at
