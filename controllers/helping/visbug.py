"""VisBug-21: Bug2's path, with shortcuts as far as the eye reaches.

Bug2 goes along the straight line from start to goal (the M-line), follows a wall it meets, kept on
the left, until it is on the M-line again, nearer to the goal and free to go on, and so on. That
path is computed exactly, as a polyline, from the crossings of the M-line with the walls; what is
used of it at a step is what the robot sees: the target moves ahead along the path while it is in
sight, and the robot goes straight to it.

Source: Lumelsky and Skewis (1990). The first part of the path out of sight stops the target, as in
VisBug-21; looking for parts that come into sight again beyond would be VisBug-22.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from controllers.helping.visibility import sees
from mjmr.jit import njit

_AHEAD = 0.1  # m: how far the target moves on at a time
_OFF = 1e-3  # m: how far from a wall a path may start


class Bug(NamedTuple):
    """The path of one robot to its target.

    Args:
        path: Vertices (k, 2) [m]; ``at[0]`` of them are valid.
        at: Integers (3,): number of vertices, the one behind the target, and 1 if Bug2 found the
            goal to be out of reach.
        offset: Of the target from that vertex (1,) [m].
    """

    path: NDArray[np.float64]
    at: NDArray[np.int64]
    offset: NDArray[np.float64]


def bug(vertices: int = 4096) -> Bug:
    """No path yet, room for ``vertices``."""
    return Bug(np.zeros((vertices, 2)), np.zeros(3, dtype=np.int64), np.zeros(1))


@njit
def forget_path(bug2):
    """A new M-line is due: at a new goal, or where the robot did something else in between."""
    bug2.at[:] = 0


@njit
def has_path(bug2):
    """Whether an M-line was drawn."""
    return bug2.at[0] > 0


@njit
def _pushed_off(x, y, edges):
    """The point, at least ``_OFF`` from every wall."""
    for _ in range(2):
        for k in range(edges.shape[0]):
            ex, ey = edges[k, 2] - edges[k, 0], edges[k, 3] - edges[k, 1]
            size = np.hypot(ex, ey)
            ax, ay = x - edges[k, 0], y - edges[k, 1]
            at = (ax * ex + ay * ey) / size
            off = (ex * ay - ey * ax) / size
            if -_OFF <= at <= size + _OFF and abs(off) < _OFF:
                x -= (_OFF - off) * ey / size
                y += (_OFF - off) * ex / size
    return x, y


@njit
def plan(bug2, x, y, gx, gy, edges, after, before, left):
    """Bug2's path from (x, y) to (gx, gy) [m].

    Args:
        bug2: Overwritten.
        x: Start [m].
        y: Start [m].
        gx: Goal [m].
        gy: Goal [m].
        edges: Walls (m, 4) [m], free space on the left of each.
        after: Index of the edge after each (m,).
        before: Index of the edge before each (m,).
        left: Keep the wall on the left; else on the right.
    """
    m = edges.shape[0]
    path, most = bug2.path, bug2.path.shape[0]
    path[0, 0], path[0, 1] = x, y
    x, y = _pushed_off(x, y, edges)
    path[1, 0], path[1, 1] = x, y
    count = 2
    dx, dy = gx - x, gy - y
    # where the M-line crosses each edge: part of the way, nan if it does not. A vertex on the
    # line counts as on its left, for both of its edges, so that crossings alternate.
    along = np.full(m, np.nan)
    leaves = np.zeros(m, dtype=np.bool_)
    for k in range(m):
        ax, ay = edges[k, 0] - x, edges[k, 1] - y
        bx, by = edges[k, 2] - x, edges[k, 3] - y
        a, b = dx * ay - dy * ax, dx * by - dy * bx
        if (a >= 0.0) == (b >= 0.0):
            continue
        at = a / (a - b)
        qx, qy = ax + at * (bx - ax), ay + at * (by - ay)
        along[k] = (qx * dx + qy * dy) / (dx * dx + dy * dy)
        leaves[k] = a > b  # the edge turns to the right of the line: free space ahead
    here, found = 0.0, True
    while count < most:
        hit = -1
        for k in range(m):
            ahead = here < along[k] < 1.0 and not leaves[k]
            if ahead and (hit < 0 or along[k] < along[hit]):
                hit = k
        if hit < 0:
            break
        path[count, 0], path[count, 1] = x + along[hit] * dx, y + along[hit] * dy
        count += 1
        k, found = hit, False
        while count < most - 1:
            corner = k if left else after[k]
            path[count, 0], path[count, 1] = edges[corner, 0], edges[corner, 1]
            count += 1
            k = before[k] if left else after[k]
            if k == hit:
                break
            if leaves[k] and along[hit] < along[k] < 1.0:
                found = True
                path[count, 0], path[count, 1] = x + along[k] * dx, y + along[k] * dy
                count += 1
                here = along[k]
                break
        if not found:
            break
    if found:
        path[count, 0], path[count, 1] = gx, gy
        count += 1
    bug2.at[0], bug2.at[1], bug2.at[2] = count, 0, 0 if found else 1
    bug2.offset[0] = 0.0


@njit
def target(bug2, x, y, vision, edges):
    """Move the target ahead while it is in sight of (x, y) [m]; returns it [m].

    Args:
        bug2: Its target is changed in place.
        x: Own position [m].
        y: Own position [m].
        vision: How far this planner sees [m].
        edges: Walls that hide (m, 4) [m].
    """
    path, last = bug2.path, bug2.at[0] - 1
    k, offset = bug2.at[1], bug2.offset[0]
    px, py = path[k, 0], path[k, 1]
    first = True
    while True:
        # the point now
        if k >= last:
            px, py = path[last, 0], path[last, 1]
            break
        ex, ey = path[k + 1, 0] - path[k, 0], path[k + 1, 1] - path[k, 1]
        size = np.hypot(ex, ey)
        if first:
            part = offset / size if size > 0.0 else 0.0
            px, py = path[k, 0] + part * ex, path[k, 1] + part * ey
            first = False
        # the next one, no farther than the next vertex
        ahead = min(offset + _AHEAD, size)
        part = ahead / size if size > 0.0 else 1.0
        qx, qy = path[k, 0] + part * ex, path[k, 1] + part * ey
        stands_on_it = np.hypot(px - x, py - y) < 1e-3
        if not stands_on_it and not sees(x, y, qx, qy, vision, edges):
            break
        px, py = qx, qy
        if ahead >= size:
            k, offset = k + 1, 0.0
        else:
            offset = ahead
    bug2.at[1], bug2.offset[0] = k, offset
    return px, py
