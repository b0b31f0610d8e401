"""Patrol: supporters go round a closed route of waypoints, out of phase with each other.

Source: the paper's supporters patrol corridors; routes and phases are ours.
"""

import numpy as np
from numpy.typing import NDArray

from mjmr.jit import njit


def length(route: NDArray[np.float64]) -> float:
    """Length [m] of the closed way over waypoints (k, 2) [m]."""
    return float(np.linalg.norm(np.roll(route, -1, axis=0) - route, axis=1).sum())


@njit
def place(route, along):
    """Point [m] and next waypoint's index, ``along`` [m] from the first waypoint.

    Args:
        route: Waypoints (k, 2) [m] of a closed way.
        along: Length gone [m], from 0 to the route's length.
    """
    n = route.shape[0]
    for k in range(n):
        ex = route[(k + 1) % n, 0] - route[k, 0]
        ey = route[(k + 1) % n, 1] - route[k, 1]
        size = np.hypot(ex, ey)
        if along <= size or k == n - 1:
            part = min(1.0, along / size) if size > 0.0 else 0.0
            return route[k, 0] + part * ex, route[k, 1] + part * ey, (k + 1) % n
        along -= size
    return route[0, 0], route[0, 1], 0


@njit
def advance(x, y, following, route, way):
    """Where a robot at (x, y) [m] is ``way`` [m] later, and its next waypoint.

    Args:
        x: Position [m].
        y: Position [m].
        following: Index of the waypoint it goes to.
        route: Waypoints (k, 2) [m] of a closed way.
        way: Length to go [m].
    """
    for _ in range(route.shape[0]):
        ex, ey = route[following, 0] - x, route[following, 1] - y
        far = np.hypot(ex, ey)
        if far > way:
            return x + way * ex / far, y + way * ey / far, following
        x, y, way = route[following, 0], route[following, 1], way - far
        following = (following + 1) % route.shape[0]
    return x, y, following
