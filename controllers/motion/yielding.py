"""Yielding: who is in the way of a robot that goes first gets out of it."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.motion.steering import free_way, near_points
from mjmr.jit import njit

Array = NDArray[np.float64]
_HEADINGS = 24


@dataclass(frozen=True, kw_only=True)
class YieldingConfig:
    """When and how robots yield.

    Attributes:
        reach: A robot that goes first makes way to be cleared this far ahead of it [m].
        width: Half of the lane that it needs [m].
        radius: Kept from walls while yielding [m].
        robot_radius: Of other robots' discs [m].
        step: Length of the moves that are weighed [m].
    """

    reach: float = 1.5
    width: float = 0.66
    radius: float = 0.32
    robot_radius: float = 0.30
    step: float = 0.5


def give_way(
    others: ArrayLike,
    travel: ArrayLike,
    first: ArrayLike,
    ranges: Array,
    angles: Array,
    config: YieldingConfig | None = None,
) -> Array:
    """Directions in which robots get out of the way of those that go first.

    A robot is in the way if it is in the lane ahead of one that goes first. It takes the direction
    that brings it furthest out of that lane, or, where walls forbid that (a doorway), further
    ahead of the other.

    Args:
        others: Other robots seen (n, k, 2) [m], body frame; NaN where there is none.
        travel: Directions in which those go (n, k) [rad], body frame of the one that sees; NaN
            where one does not go or has not told.
        first: Whether they go first (n, k).
        ranges: Of each robot's scan (n, b) [m].
        angles: Of its beams (b,) [rad], body frame.
        config: When and how.

    Returns:
        (n,) [rad], body frame; NaN for who is in nobody's way.
    """
    c = config or YieldingConfig()
    return _give_way(
        np.ascontiguousarray(others, dtype=np.float64),
        np.ascontiguousarray(travel, dtype=np.float64),
        np.ascontiguousarray(first, dtype=np.bool_),
        np.ascontiguousarray(ranges),
        np.cos(angles),
        np.sin(angles),
        (c.reach, c.width, c.radius, c.robot_radius, c.step),
    )


@njit
def _give_way(others, travel, first, ranges, cos, sin, config):
    reach, width, radius, robot_radius, step = config
    n, known = others.shape[0], others.shape[1]
    way = np.full(n, np.nan)
    most = ranges.shape[1] + known
    points, radii = np.empty((most, 3)), np.empty(most)
    for i in range(n):
        nearest, chosen = math.inf, -1
        for k in range(known):
            if not first[i, k] or not math.isfinite(travel[i, k]):
                continue
            x, y = -others[i, k, 0], -others[i, k, 1]  # from the other to me
            c, s = math.cos(travel[i, k]), math.sin(travel[i, k])
            along, across = c * x + s * y, c * y - s * x
            # also beside it, where it is about to pass
            if -0.2 < along < reach and abs(across) < width and math.hypot(x, y) < nearest:
                nearest, chosen = math.hypot(x, y), k
        if chosen < 0:
            continue
        x, y = -others[i, chosen, 0], -others[i, chosen, 1]
        c, s = math.cos(travel[i, chosen]), math.sin(travel[i, chosen])
        count = near_points(
            ranges[i], cos, sin, others[i], radius, robot_radius, step + 1.0, points, radii
        )
        best = -math.inf
        for h in range(_HEADINGS):
            angle = 2.0 * math.pi * (h - _HEADINGS // 2 + 1) / _HEADINGS
            dx, dy = math.cos(angle), math.sin(angle)
            free = free_way(dx, dy, points, radii, count, step)
            along = c * (x + free * dx) + s * (y + free * dy)
            across = abs(c * (y + free * dy) - s * (x + free * dx))
            # a way blocked at once leads nowhere: small preference for what can be driven
            value = min(across, width + 0.05) + 0.4 * min(along, reach) + 0.05 * free
            if value > best + 1e-9:
                best, way[i] = value, angle
    return way
