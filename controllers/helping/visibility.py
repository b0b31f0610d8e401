"""What a point sees, and how it moves, in a plane of straight walls.

Walls are the edges of a polygon of free space, inflated by the robot's radius, shape (m, 4) as
``x0, y0, x1, y1`` [m], each with the free space on its left: the order shapely's ``orient`` gives.
Everything is compiled and goes through all edges: an office has about a hundred.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mjmr.jit import njit

RAYS = np.arange(32) * (2 * np.pi / 32)
_GAP = 1e-6  # m kept from an edge, so that rounding never puts a robot outside


class Walls(NamedTuple):
    """What hides and what stops.

    Args:
        sight: Edges that hide (m, 4) [m].
        kept: Edges that hide a goal that was in sight a step ago (j, 4) [m]; walls are thinner for
            these, so that a goal glimpsed past two corners is not lost in going round the first.
        motion: Edges that stop (k, 4) [m]; nearer to the robot than those that hide, so that it is
            never on the very edge of what it sees by.
        path: Edges that are followed along walls (k, 4) [m]; a little nearer still.
        after: Index of the path edge after each (k,).
        before: Index of the path edge before each (k,).
    """

    sight: NDArray[np.float64]
    kept: NDArray[np.float64]
    motion: NDArray[np.float64]
    path: NDArray[np.float64]
    after: NDArray[np.int64]
    before: NDArray[np.int64]


@njit
def clear(px, py, qx, qy, edges):
    """Whether the segment from p to q crosses no edge.

    Args:
        px: Start [m].
        py: Start [m].
        qx: End [m].
        qy: End [m].
        edges: Shape (m, 4) [m].
    """
    dx, dy = qx - px, qy - py
    for k in range(edges.shape[0]):
        ax, ay = edges[k, 0] - px, edges[k, 1] - py
        bx, by = edges[k, 2] - px, edges[k, 3] - py
        side_a = dx * ay - dy * ax
        side_b = dx * by - dy * bx
        if (side_a >= 0.0) != (side_b >= 0.0):
            # where the line of pq meets the edge: p and q on different sides of it?
            turn = ax * by - ay * bx  # twice the area p, a, b
            ex, ey = bx - ax, by - ay
            other = turn - (dx * ey - dy * ex)
            if (turn >= 0.0) != (other >= 0.0):
                return False
    return True


@njit
def sees(px, py, qx, qy, radius, edges):
    """Whether p sees q: nearer than ``radius`` [m] and :func:`clear`."""
    dx, dy = qx - px, qy - py
    if dx * dx + dy * dy > radius * radius:
        return False
    return clear(px, py, qx, qy, edges)


@njit
def cast(px, py, angles, reach, edges, ranges):
    """Ranges from p to the walls, written into ``ranges``.

    Args:
        px: Where the rays start [m].
        py: Where the rays start [m].
        angles: Directions (k,) [rad].
        reach: Largest range [m]; what is farther reads ``reach``.
        edges: Shape (m, 4) [m].
        ranges: Shape (k,) [m], overwritten.
    """
    near = np.empty(edges.shape[0], dtype=np.int64)
    count = 0
    for k in range(edges.shape[0]):
        x0, x1 = min(edges[k, 0], edges[k, 2]), max(edges[k, 0], edges[k, 2])
        y0, y1 = min(edges[k, 1], edges[k, 3]), max(edges[k, 1], edges[k, 3])
        if x0 - reach <= px <= x1 + reach and y0 - reach <= py <= y1 + reach:
            near[count] = k
            count += 1
    for i in range(angles.shape[0]):
        dx, dy = np.cos(angles[i]), np.sin(angles[i])
        best = reach
        for c in range(count):
            k = near[c]
            ax, ay = edges[k, 0] - px, edges[k, 1] - py
            ex, ey = edges[k, 2] - edges[k, 0], edges[k, 3] - edges[k, 1]
            across = dx * ey - dy * ex
            if across == 0.0:
                continue
            along = (ax * ey - ay * ex) / across
            at = (ax * dy - ay * dx) / across
            if 0.0 <= at <= 1.0 and 0.0 <= along < best:
                best = along
        ranges[i] = best


@njit
def _first_contact(x, y, dx, dy, length, edges):
    """Way until a wall and the wall, or ``length`` and -1."""
    hit, way = -1, length
    for k in range(edges.shape[0]):
        ex, ey = edges[k, 2] - edges[k, 0], edges[k, 3] - edges[k, 1]
        into = dx * ey - dy * ex  # towards the right of the edge: out of the free space
        if into <= 0.0:
            continue
        ax, ay = x - edges[k, 0], y - edges[k, 1]
        t = (ex * ay - ey * ax) / into
        size = np.hypot(ex, ey)
        # negative: beyond this edge's line already, unless by rounding
        if t * into / size < -10.0 * _GAP or t >= way + _GAP * size / into:
            continue
        at = ((ax + t * dx) * ex + (ay + t * dy) * ey) / (size * size)
        if 0.0 <= at <= 1.0:
            t = max(0.0, t - _GAP * size / into)
            if t < way:
                hit, way = k, t
    return way, hit


@njit
def move(x, y, dx, dy, length, edges, to_nearest_end):
    """Where a robot is after ``length`` [m] along (dx, dy), sliding along walls it meets.

    Args:
        x: Start [m].
        y: Start [m].
        dx: Unit vector of the way.
        dy: Unit vector of the way.
        length: Of the way [m]; sliding uses up the rest of it.
        edges: Shape (m, 4) [m].
        to_nearest_end: A robot that drives at what it sees clips no more than the corner of a
            wall: met squarely, it slides to the wall's nearer end. Otherwise it stops there.
    """
    # a corner can hand the robot from wall to wall, hence the limit
    for _ in range(4):
        way, hit = _first_contact(x, y, dx, dy, length, edges)
        x, y = x + way * dx, y + way * dy
        length -= way
        if hit < 0 or length <= _GAP:
            break
        ex, ey = edges[hit, 2] - edges[hit, 0], edges[hit, 3] - edges[hit, 1]
        size = np.hypot(ex, ey)
        ex, ey = ex / size, ey / size
        along = dx * ex + dy * ey
        at = (x - edges[hit, 0]) * ex + (y - edges[hit, 1]) * ey
        if to_nearest_end and abs(along) < 0.2:
            along = 1.0 if 2.0 * at > size else -1.0
        elif abs(along) < 1e-3:
            break
        sign = 1.0 if along > 0.0 else -1.0
        # no farther than the wall's end: from there the old direction may be free again
        slide = min(length, (size - at if sign > 0.0 else at) + 10.0 * _GAP)
        way, hit = _first_contact(x, y, sign * ex, sign * ey, slide, edges)
        x, y = x + way * sign * ex, y + way * sign * ey
        length -= way
        if hit >= 0 and way < _GAP:
            break
    return x, y


@njit
def inside(x, y, edges):
    """Whether a point is in the free space; even-odd rule."""
    odd = False
    for k in range(edges.shape[0]):
        y0, y1 = edges[k, 1], edges[k, 3]
        if (y0 > y) != (y1 > y):
            at = edges[k, 0] + (y - y0) / (y1 - y0) * (edges[k, 2] - edges[k, 0])
            if x < at:
                odd = not odd
    return odd
