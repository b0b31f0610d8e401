"""The physical maze: walls, blocks, painted nest and goal, and the yard beside it."""

import numpy as np
from numpy.typing import NDArray

from experiments.scout_workers.mazes import REACH, ROBOT, WALL_HEIGHT
from mjmr.world import World

Array = NDArray[np.float64]
PITCH = 0.2  # m, between robots in the yard
_WALL = 0.04  # m, between yard and maze
_NEST, _GOAL = (0.25, 0.45, 0.85, 1.0), (0.30, 0.75, 0.30, 1.0)


def build_arena(size: float, blocks: Array, nest: Array, goal: Array, n: int) -> World:
    """The maze at the origin, and to its west a yard with room for n robots.

    Args:
        size: Side of the maze [m].
        blocks: Corners (k, 4) [m].
        nest: (2,) [m].
        goal: (2,) [m].
        n: Robots.
    """
    yard = yard_slots(size, n)
    west = float(yard[:, 0].min()) - PITCH / 2 - 0.01
    world = World(bounds=[west, 0.0, size, size], wall_height=WALL_HEIGHT, floor="concrete")
    world.add_box(-_WALL / 2, size / 2, _WALL, size, height=WALL_HEIGHT)
    for x0, y0, x1, y1 in blocks:
        world.add_box((x0 + x1) / 2, (y0 + y1) / 2, x1 - x0, y1 - y0, height=WALL_HEIGHT)
    world.add_mark(*nest, radius=REACH, rgba=_NEST)
    world.add_mark(*goal, radius=REACH, rgba=_GOAL)
    return world


def yard_slots(size: float, n: int) -> Array:
    """Where robots wait that are not in the maze (n, 3): rows beside it, out of everybody's way."""
    assert PITCH > 2 * ROBOT
    rows = int((size - PITCH) / PITCH)
    k = np.arange(n)
    slots = np.zeros((n, 3))
    slots[:, 0] = -_WALL - PITCH / 2 - 0.01 - PITCH * (k // rows)
    slots[:, 1] = size - PITCH / 2 - 0.01 - PITCH * (k % rows)
    return slots
