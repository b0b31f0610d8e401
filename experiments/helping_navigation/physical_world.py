"""An office in MuJoCo: walls that block sight, Pioneers with masts, lidar and four cameras."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from mjmr.robots.pioneer2dx import Pioneer2DX
from mjmr.sensors.camera import Camera
from mjmr.sensors.lidar import Lidar
from mjmr.world import World

if TYPE_CHECKING:
    import mujoco

    from mjmr.group import Group

WALL_HEIGHT, WALL_THICKNESS = 0.8, 0.08  # m: higher than the cameras, as thick as a partition
LIDAR_HEIGHT = 0.27  # m: above the hulls, which are 0.22 m high; it sees walls, not robots
MARKER_HEIGHT, MARKER_RADIUS, MARKER_LENGTH = 0.40, 0.07, 0.20  # m: its middle, upright cylinder
CAMERA_HEIGHT, CAMERA_OFFSET = 0.60, 0.08  # m: above the marker, and out from the mast's axis
CAMERA_WIDTH, CAMERA_PIXELS = math.radians(100.0), (640, 288)  # they overlap by 10 degrees
CAMERAS = ("front", "left", "back", "right")
# hues a hall's floor, walls and the robots' own paint do not have
MARKER_COLOURS = (
    (0.05, 0.80, 0.10),
    (0.05, 0.15, 0.95),
    (0.90, 0.05, 0.85),
    (0.05, 0.80, 0.85),
)


def office_world(size: ArrayLike, walls: ArrayLike) -> World:
    """World of an office.

    Args:
        size: Length and width (2,) [m]; a corner is the origin.
        walls: Segments (k, 4): x0, y0, x1, y1 [m]; they become boxes ``WALL_THICKNESS`` thick whose
            ends are the segments' ends, so that doors are as wide as drawn. Those on the rim are
            the world's own wall.
    """
    length, width = np.asarray(size, dtype=np.float64)
    world = World(bounds=[0.0, 0.0, length, width], wall_height=WALL_HEIGHT, floor="concrete")
    for x0, y0, x1, y1 in np.asarray(walls, dtype=np.float64).reshape(-1, 4):
        rim = (x0 == x1 and x0 in (0.0, length)) or (y0 == y1 and y0 in (0.0, width))
        if not rim:
            world.add_wall((x0, y0), (x1, y1), thickness=WALL_THICKNESS, height=WALL_HEIGHT)
    return world


def add_team(world: World, poses: ArrayLike, *, lidar_rate: float = 10.0) -> "Group":
    """Pioneers with a mast each: encoders, a lidar all round, a marker of a colour of their own.

    Args:
        world: Gets them.
        poses: Starts (n, 3) [m, m, rad], world frame, n at most 4.
        lidar_rate: Scans, and encoder readings, a second [Hz].
    """
    from mjmr.sensors.encoders import WheelEncoders

    robots = world.add_group(Pioneer2DX, poses)
    robots.mount(WheelEncoders(rate=lidar_rate))
    robots.mount(
        Lidar(
            beams=360,
            field_of_view=2 * math.pi,
            max_range=8.0,
            rate=lidar_rate,
            position=(0.0, 0.0, LIDAR_HEIGHT),
        )
    )
    add_masts(world, robots.prefixes)
    return robots


def add_masts(world: World, prefixes: Sequence[str], first: int = 0) -> None:
    """Put a mast with a marker on robots; it is drawn, and neither touched nor met by rays.

    Args:
        world: That the robots are in.
        prefixes: MJCF name prefixes of the robots.
        first: Index of the first robot's colour in ``MARKER_COLOURS``.
    """

    def build(spec: "mujoco.MjSpec") -> None:
        for i, prefix in enumerate(prefixes):
            _mast(spec.body(f"{prefix}base"), MARKER_COLOURS[first + i])

    world.edit(build)


def _mast(base: Any, colour: Sequence[float]) -> None:
    import mujoco

    drawn = {"contype": 0, "conaffinity": 0, "group": 1, "mass": 0.0}
    cylinder = mujoco.mjtGeom.mjGEOM_CYLINDER
    pole = CAMERA_HEIGHT / 2 - 0.11
    base.add_geom(
        type=cylinder, size=[0.012, pole, 0], pos=[0, 0, 0.22 + pole], rgba=[0.1, 0.1, 0.1, 1],
        **drawn,
    )  # fmt: skip
    base.add_geom(
        type=cylinder,
        size=[MARKER_RADIUS, MARKER_LENGTH / 2, 0],
        pos=[0, 0, MARKER_HEIGHT],
        rgba=[*colour, 1],
        **drawn,
    )
    base.add_geom(
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=[0.05, 0.05, 0.02],
        pos=[0, 0, CAMERA_HEIGHT],
        rgba=[0.1, 0.1, 0.12, 1],
        **drawn,
    )


def mount_cameras(robots: "Group", *, rate: float, noise: float = 2.0) -> list[Camera]:
    """Four cameras on the mast that together look all round, in the order of ``CAMERAS``.

    Args:
        robots: Which get them.
        rate: Images a second [Hz].
        noise: Of a pixel [grey levels].
    """
    width, height = CAMERA_PIXELS
    fovy = 2 * math.atan(math.tan(CAMERA_WIDTH / 2) * height / width)
    cameras = []
    for k, name in enumerate(CAMERAS):
        way = np.array([math.cos(k * math.pi / 2), math.sin(k * math.pi / 2), 0.0])
        place = np.array([0.0, 0.0, CAMERA_HEIGHT]) + CAMERA_OFFSET * way
        camera = Camera(
            width=width, height=height, fovy=fovy, rate=rate, noise=noise,
            position=place, look_at=place + way,
        )  # fmt: skip
        cameras.append(robots.mount(camera, name))
    return cameras
