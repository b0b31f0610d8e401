"""Worlds of the three tasks: field, discs, where robots start, and what counts as done.

Sizes, weights and speeds did not survive in the paper; those here are ours (one unit is 1 m).
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.versatile_pushing.pushing import friction_force
from mjmr.disc import let_discs_sleep
from mjmr.group import Group
from mjmr.randomness import Streams
from mjmr.robots.round_pusher import RoundPusher
from mjmr.sensors.beacon import Beacon
from mjmr.sensors.camera import Camera
from mjmr.sensors.compass import Compass
from mjmr.sensors.lidar import Lidar
from mjmr.sensors.turret import Turret
from mjmr.sensors.visual_arc import VisualArc
from mjmr.world import World

Array = NDArray[np.float64]

HALF = 5.0  # m, of the field
WALL_HEIGHT = 0.3
SMALL, LARGE = 0.1, 1.0  # m, radii of discs
DISC_HEIGHT = 0.17  # m: what is as low as this the obstacle ring looks over
SMALL_SHARE = 0.15  # friction force of a small disc, as a share of one robot's push
HOME = 0.5  # m, half a side of the home zone of foraging
NEST = 3.0  # m from home: where discs are far enough in construction
GOAL = 1.0  # m from home: where the large disc's centre is to be in transport
LARGE_AT = (-2.0, 2.5)
RANGE = 3.0  # m, of the turret's camera
PERIOD = 0.1  # s, of control, vision and every other sensor
RING_HEIGHT, RING_RANGE, RING_BEAMS = 0.215, 0.8, 48
ARC_HEIGHT, ARC_COLUMNS = 0.1, 128
ARC_NOISE = 0.02  # of a range
WIDTH, HEIGHT = 160, 120  # px
TEAM = "blue"
PAINT = (0.42, 0.58, 0.46, 1.0)  # of zones: too pale to be taken for a thing
ORANGE = (0.95, 0.45, 0.05)
_WALL_GAP, _CLEARANCE = 0.5, 0.02  # m
# where robots stand round the large disc, as seen from its centre [degrees], 0 away from home: the
# paper's Figure 5 is lost, all of them see the disc
BEARINGS = (150.0, -150.0, 60.0, -60.0)
_STAND = 0.6  # m, from the robots' centres to the disc's surface


@dataclass(frozen=True, kw_only=True)
class Task:
    """What a task's world has, apart from the map.

    Attributes:
        disc_radius: [m].
        zone: ``square``: done inside |x|, |y| < size; ``disc``: done within size of home;
            ``outside``: done at size from home or more.
        size: [m].
    """

    disc_radius: float
    zone: str
    size: float

    def done(self, places: Array) -> NDArray[np.bool_]:
        """Which discs are where they shall be, from places (k, 2) relative to home [m]."""
        return zone_holds(places, self.zone, self.size)


def zone_holds(places: Array, zone: str, size: float) -> NDArray[np.bool_]:
    """Which places (..., 2) relative to home are in a zone; see :class:`Task`."""
    if zone == "square":
        return np.abs(places).max(axis=-1) < size
    distance = np.hypot(places[..., 0], places[..., 1])
    return distance < size if zone == "disc" else distance >= size


TASKS = {
    "foraging": Task(disc_radius=SMALL, zone="square", size=HOME),
    "transport": Task(disc_radius=LARGE, zone="disc", size=GOAL),
    "construction": Task(disc_radius=SMALL, zone="outside", size=NEST),
}


def build(
    task: str,
    *,
    robots: int,
    weight: int = 0,
    map_seed: int = 0,
    vision: str = "arcs",
    jitter: int = 0,
) -> tuple[World, Group]:
    """The world of a task, and its robots with all their sensors.

    Args:
        task: One of ``TASKS``.
        robots: How many, 1 to 4.
        weight: Of the large disc.
        map_seed: Of the small discs' places.
        vision: ``arcs``, ``camera`` or ``both``.
        jitter: Seed of small changes of where robots start.
    """
    world = World(bounds=[-HALF, -HALF, HALF, HALF], wall_height=WALL_HEIGHT, floor="concrete")
    if task == "transport":
        add_disc(world, LARGE_AT, LARGE, friction_force(weight))
        poses = around(LARGE_AT, robots, Streams(jitter).generator("starts"))
    else:
        force = SMALL_SHARE * RoundPusher.push_force
        for place in places(task, map_seed):
            add_disc(world, place, SMALL, force)
        world.edit(let_discs_sleep)  # most lie still: half the time of the physics
        poses = at_home(robots)
    paint_home(world, task)
    group = world.add_group(RoundPusher, poses, name="pusher", team=TEAM)
    mount(group, vision)
    return world, group


def add_disc(world: World, at: Any, radius: float, force: float) -> None:
    """Lay a disc in the colour that robots look for."""
    world.add_disc(
        float(at[0]), float(at[1]), radius, force, height=DISC_HEIGHT, rgba=(*ORANGE, 1.0)
    )


def paint_home(world: World, task: str) -> None:
    """Paint the zone on the floor: for films and those who look on, robots do not use it."""
    kind = TASKS[task]
    if kind.zone == "square":
        world.add_mark(0.0, 0.0, length=2 * kind.size, width=2 * kind.size, rgba=PAINT)
    else:
        world.add_mark(0.0, 0.0, radius=kind.size, rgba=PAINT)


def mount(group: Group, vision: str) -> None:
    """Give robots their eyes, the obstacle ring, compass and beacon."""
    group.mount(Turret(rate=1 / PERIOD))
    if vision in ("arcs", "both"):
        group.mount(
            VisualArc(
                site="turret",
                height=ARC_HEIGHT,
                columns=ARC_COLUMNS,
                max_range=RANGE,
                rate=1 / PERIOD,
                proportional_noise=ARC_NOISE,
                noise=0.01,
            ),
            "arc",
        )
    if vision in ("camera", "both"):
        group.mount(
            Camera(at="camera", width=WIDTH, height=HEIGHT, rate=1 / PERIOD, noise=3.0), "eye"
        )
    group.mount(
        Lidar(
            beams=RING_BEAMS,
            field_of_view=2 * np.pi,
            max_range=RING_RANGE,
            rate=1 / PERIOD,
            noise=0.01,
            position=(0.0, 0.0, RING_HEIGHT),
        ),
        "ring",
    )
    group.mount(Compass(rate=1 / PERIOD, noise=np.radians(0.5)))
    group.mount(Beacon(rate=1 / PERIOD, bearing_noise=np.radians(0.5), distance_noise=0.02))


def places(task: str, map_seed: int) -> Array:
    """Where the small discs of a map lie (k, 2) [m]; drawn from the map's number alone."""
    rng = Streams(map_seed).generator(f"map/{task}")
    count = 10 if task == "foraging" else 30
    found = np.empty((0, 2))
    while len(found) < count:
        spot = rng.uniform(-HALF, HALF, 2)
        if task == "foraging":
            reject = np.abs(spot).max() > HALF - _WALL_GAP or np.abs(spot).max() < HOME
        else:
            reject = not 1.0 <= np.hypot(*spot) <= NEST
        apart = np.hypot(*(found - spot).T) >= 2 * SMALL + _CLEARANCE
        start = np.hypot(*(at_home(4)[:, :2] - spot).T) >= RoundPusher.radius + SMALL + _CLEARANCE
        if not reject and apart.all() and start.all():
            found = np.vstack([found, spot])
    return found


def at_home(robots: int) -> Array:
    """Poses (n, 3) on the edges of the home zone, facing outwards."""
    angles = np.array([0.0, np.pi, np.pi / 2, -np.pi / 2])[:robots]
    return np.column_stack([HOME * np.cos(angles), HOME * np.sin(angles), angles])


def around(disc: Any, robots: int, rng: np.random.Generator) -> Array:
    """Poses (n, 3) round the large disc, facing it, up to 5 degrees and 0.1 m off."""
    away = np.arctan2(disc[1], disc[0])
    turn, shift = rng.uniform(-1.0, 1.0, (2, len(BEARINGS)))[:, :robots]
    angles = away + np.radians(np.array(BEARINGS[:robots]) + 5.0 * turn)
    distance = LARGE + _STAND + 0.1 * shift
    x, y = disc[0] + distance * np.cos(angles), disc[1] + distance * np.sin(angles)
    return np.column_stack([x, y, angles + np.pi])
