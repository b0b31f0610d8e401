"""The hall, the spill and the trucks of a condition."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.perimeter.config import tracked_radius
from experiments.perimeter.checks import (
    BUNCH,
    CLEAR,
    HALF,
    OFF,
    SPREAD,
    check,
    largest_radius,
    limit_of,
)
from mjmr.pillar import radii_at
from mjmr.randomness import Streams
from mjmr.robots.tamiya_txt1 import TamiyaTXT1
from mjmr.world import World

Array = NDArray[np.float64]
WALL = 0.6  # m, high
SPILL_HEIGHT = 0.4  # m
PARKED = (HALF - 6.0, -HALF + 6.0)  # where robots stand that are switched off


@dataclass(frozen=True, kw_only=True)
class Scene:
    """What a trial knows of its world, for metrics.

    Attributes:
        world: With the trucks.
        trucks: Their group.
        lobes: Centres and first radii of the discs that make the spill (k, 3) [m].
        growth: Of every radius [m/s].
        limit: Radius at which it ends [m].
        start: Poses (n, 3).
    """

    world: World
    trucks: Any
    lobes: Array
    growth: float
    limit: float
    start: Array

    def radii(self, time: float) -> Array:
        """Radii of the discs (k,) at ``time`` [s], in m."""
        return radii_at(self.lobes[:, 2], self.growth, self.limit, time)

    def depth(self, points: Array, time: float) -> Array:
        """How far points (..., 2) are inside the spill [m], negative outside."""
        way = points[..., None, :] - self.lobes[:, :2]
        return (self.radii(time) - np.hypot(way[..., 0], way[..., 1])).max(axis=-1)


def world(condition: Mapping[str, Any]) -> World:
    """World of a condition, as seed 0 has it."""
    return build(condition, 0).world


def build(condition: Mapping[str, Any], seed: int) -> Scene:
    """Build the scene of a condition.

    Raises:
        InvalidInputError: What :func:`experiments.perimeter.checks.check` refuses.
    """
    check(condition)
    rng = Streams(seed).generator("scene")
    radius, growth, limit = condition["radius"], condition["growth"], limit_of(condition)
    spread = min(SPREAD, HALF - 2.0 * CLEAR - largest_radius(condition))
    centre = rng.uniform(-spread, spread, 2)
    hall = World.rectangle(2 * HALF, 2 * HALF, wall_height=WALL, floor="concrete")
    lobes = _lobes(condition["edge"], centre, radius)
    for x, y, r in lobes:
        hall.add_pillar(
            x, y, r, growth=growth, limit=limit if growth else None, height=SPILL_HEIGHT
        )
    start = _starts(condition, lobes, rng)
    trucks = hall.add_group(TamiyaTXT1, start)
    return Scene(world=hall, trucks=trucks, lobes=lobes, growth=growth, limit=limit, start=start)


def _lobes(edge: str, centre: Array, radius: float) -> Array:
    """A disc, or three of which none is inside another: an edge with bays."""
    if edge == "disc":
        return np.array([[*centre, radius]])
    shifts = 0.6 * radius * np.array([[1.0, 0.0], [-0.5, 0.8], [-0.4, -0.9]])
    return np.column_stack([centre + shifts, radius * np.array([0.75, 0.65, 0.7])])


def _starts(condition: Mapping[str, Any], lobes: Array, rng: np.random.Generator) -> Array:
    if condition["start"] != "scattered":
        return _on_perimeter(condition, lobes[0], rng)
    n = condition["robots"]
    poses = np.empty((n, 3))
    # it ends: checks.py lets no more trucks come here than are soon put down
    for i in range(n):
        while True:
            at = rng.uniform(-HALF + CLEAR, HALF - CLEAR, 2)
            off = np.hypot(*(at - lobes[:, :2]).T) - lobes[:, 2]
            apart = np.hypot(*(at - poses[:i, :2]).T)
            if off.min() > CLEAR and (i == 0 or apart.min() > CLEAR):
                break
        poses[i] = *at, rng.uniform(-np.pi, np.pi)
    return poses


def _on_perimeter(condition: Mapping[str, Any], disc: Array, rng: np.random.Generator) -> Array:
    """On the edge, heading anticlockwise: in a bunch 3.6 to 4.5 m apart, or evenly."""
    n, late = condition["robots"], condition["failure"] == "added"
    there = n - late
    way = tracked_radius(disc[2])
    gaps = rng.uniform(*BUNCH, there) / way
    if condition["start"] == "even":
        gaps = np.full(there, 2.0 * np.pi / there)
    turn = rng.uniform(-np.pi, np.pi) + np.cumsum(gaps)
    poses = np.column_stack(
        [disc[0] + way * np.cos(turn), disc[1] + way * np.sin(turn), turn + np.pi / 2]
    )
    # who is first has no say in who is ahead
    poses = poses[rng.permutation(there)]
    if late:
        out = rng.uniform(-np.pi, np.pi)
        far = way + OFF
        spot = [disc[0] + far * np.cos(out), disc[1] + far * np.sin(out), out + np.pi]
        poses = np.vstack([poses, spot])
    return poses
