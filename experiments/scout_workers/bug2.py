"""Bug2 with perfect senses: what a worker's way is compared with, beyond the paper.

A point robot in the free space of a TJ Pro's middle drives along the line from nest to goal; where
that is blocked it follows the boundary, always to the same hand, back to the line, nearer to the
goal than where it left it. Source: V. Lumelsky and A. Stepanov, Path-planning strategies for a
point mobile automaton, Algorithmica 2, 1987.
"""

import functools
from typing import Any

import numpy as np
import shapely
from shapely.ops import substring

from experiments.scout_workers.mazes import REACH, maze

_NEAR = 1e-6


def bug2(free: Any, nest: np.ndarray, goal: np.ndarray, hand: int) -> float:
    """Length of the way until the goal is seen [m]; infinite if it comes round to where it was.

    Args:
        free: Where its middle can be: a shapely polygon.
        nest: (2,) [m].
        goal: (2,) [m].
        hand: 1 keeps what is solid on its left, -1 on its right.
    """
    end = shapely.Point(goal)
    line = shapely.LineString([nest, goal])
    # what is solid lies on the left of every ring: inside of blocks, outside of the arena
    rings = [
        r if shapely.is_ccw(r) != outer else shapely.reverse(r)
        for outer, r in ((True, free.exterior), *((False, r) for r in free.interiors))
    ]
    place, way = shapely.Point(nest), 0.0
    while True:
        ahead = shapely.LineString([place, end])
        hits = [
            (place.distance(p), p, ring)
            for ring in rings
            for p in _points(ahead.intersection(ring))
            if place.distance(p) > _NEAR
        ]
        if not hits:
            return way + place.distance(end) - REACH
        _, hit, ring = min(hits, key=lambda h: h[0])
        way += place.distance(hit)
        leaving = _leave(free, ring, line, hit, end, hand)
        if leaving is None:
            return float("inf")
        around, place = leaving
        way += around


def _leave(free: Any, ring: Any, line: Any, hit: Any, end: Any, hand: int) -> Any:
    """How far to follow a ring, and the point on the line where it is left; None if nowhere."""
    length, at = ring.length, ring.project(hit)
    found = []
    for p in _points(line.intersection(ring)):
        if p.distance(end) > hit.distance(end) - _NEAR:
            continue
        step = substring(shapely.LineString([p, end]), 0, 1e-4)
        if free.buffer(1e-9).covers(step):
            found.append(((hand * (ring.project(p) - at)) % length, p))
    return min(found, key=lambda f: f[0]) if found else None


def _points(shape: Any) -> list[Any]:
    """Points of an intersection; a stretch counts with both of its ends."""
    found = []
    for part in shapely.get_parts(shape):
        if part.geom_type == "Point":
            found.append(part)
        elif not part.is_empty:
            found += [shapely.Point(part.coords[0]), shapely.Point(part.coords[-1])]
    return found


@functools.cache
def of_maze(name: str) -> tuple[float, float]:
    """Ways with blocks on its left and on its right, in one of the study's mazes [m]."""
    m = maze(name)
    free = m.free_space()
    parts = [p for p in shapely.get_parts(free) if p.covers(shapely.Point(m.nest))]
    left, right = (bug2(parts[0], m.nest, m.goal, hand) for hand in (1, -1))
    return left, right
