"""Objects in a visual arc: round things made out of the nearest surface of every column.

What the columns come from does not matter: rays, or the colours of a picture's columns
(:mod:`controllers.perception.floor_columns`).
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError
from mjmr.jit import njit

Array = NDArray[np.float64]
NOTHING, FIXED, ROBOT, MOVER = 0, 1, 2, 3  # kinds of surfaces, as VisualArc tells them


@dataclass(frozen=True, kw_only=True)
class Objects:
    """Up to k objects that each of n robots sees, nearest first.

    Attributes:
        kind: Index into the kinds of surfaces (n, k); 0 where there is no object.
        centre: In the arc's frame, x ahead (n, k, 2) [m]; of fixed things the nearest point.
        gap: From the arc's origin to the nearest surface (n, k) [m]; infinite where none.
        whole: Whether neither edge is hidden or out of view (n, k).
    """

    kind: NDArray[np.int64]
    centre: Array
    gap: Array
    whole: NDArray[np.bool_]


class ArcObjects:
    """Makes objects of columns: runs of one kind without jumps, each of a known radius.

    A run ends where the kind changes, where the range jumps, and at a ridge between two valleys,
    which round things that touch each other leave. Bearing is that of the middle between both
    edges; where one edge is hidden it follows from the other and the radius; where both are, from
    a circle of that radius through the points. Two pieces of one thing, seen on both sides of
    what hides its middle, become one.
    """

    def __init__(
        self,
        *,
        robot_radius: float,
        mover_radius: float,
        max_range: float,
        most: int = 16,
        resolution: float = 0.0,
        least_columns: int = 2,
    ):
        """Say what there is to be seen.

        Args:
            robot_radius: Of robots [m].
            mover_radius: Of the things to be pushed [m].
            max_range: Objects further away than this are left out [m].
            most: Objects kept of each arc, the nearest ones.
            resolution: Error of a range at 1 m [m]; it grows with the square of the range, as that
                of a row in a picture does.
            least_columns: Runs of fewer columns are specks.

        Raises:
            InvalidInputError: Radii, a range or counts that are not positive.
        """
        if not min(robot_radius, mover_radius, max_range, most, least_columns) > 0:
            raise InvalidInputError(
                f"radii, range and counts must be positive; got {robot_radius}, {mover_radius}, "
                f"{max_range} m, {most} and {least_columns}"
            )
        self._radii = np.array([0.0, 0.0, robot_radius, mover_radius])
        self._max_range, self._most = float(max_range), int(most)
        self._resolution, self._least = float(resolution), int(least_columns)

    def find(self, bearings: Array, ranges: Array, kinds: Array) -> Objects:
        """Objects of n arcs.

        Args:
            bearings: Of the columns (n, c) or (c,) [rad], anticlockwise, increasing.
            ranges: Of the nearest surfaces (n, c) [m]; infinite where there is none.
            kinds: Of the surfaces (n, c).
        """
        n, c = ranges.shape
        angles = np.ascontiguousarray(np.broadcast_to(bearings, (n, c)))
        found = _find(
            angles, np.ascontiguousarray(ranges), np.ascontiguousarray(kinds), self._radii,
            self._max_range, self._most, self._resolution, self._least,
        )  # fmt: skip
        return Objects(kind=found[0], centre=found[1], gap=found[2], whole=found[3])


@njit
def _find(bearings, ranges, kinds, radii, max_range, most, resolution, least):
    n, c = ranges.shape
    kind = np.zeros((n, most), dtype=np.int64)
    centre = np.full((n, most, 2), np.nan)
    gap = np.full((n, most), np.inf)
    whole = np.zeros((n, most), dtype=np.bool_)
    # of one robot, before the nearest are kept
    row = np.empty((c, 6))  # kind, x, y, gap, whole, columns
    for i in range(n):
        count = 0
        start = 0
        while start < c:
            label = int(kinds[i, start])
            if label == 0:
                start += 1
                continue
            stop = _run_end(bearings[i], ranges[i], kinds[i], start, radii[label], resolution)
            pieces = _pieces(bearings[i], ranges[i], start, stop, radii[label])
            for piece in range(pieces):
                first = start + (stop - start) * piece // pieces
                last = start + (stop - start) * (piece + 1) // pieces
                if last - first < least:
                    continue
                # two abreast hide nothing of each other
                low = piece > 0 or _edge_free(ranges[i], kinds[i], start, -1)
                high = piece < pieces - 1 or _edge_free(ranges[i], kinds[i], stop - 1, 1)
                x, y, near, both = _estimate(
                    bearings[i], ranges[i], first, last, radii[label], low, high
                )
                if near <= max_range:
                    row[count, 0], row[count, 1], row[count, 2] = label, x, y
                    row[count, 3], row[count, 4], row[count, 5] = near, both, last - first
                    count = _join(row, count, radii)
            start = stop
        order = np.argsort(row[:count, 3])
        for k in range(min(count, most)):
            j = order[k]
            kind[i, k] = int(row[j, 0])
            centre[i, k, 0], centre[i, k, 1] = row[j, 1], row[j, 2]
            gap[i, k], whole[i, k] = row[j, 3], row[j, 4] > 0.5
    return kind, centre, gap, whole


@njit
def _run_end(bearings, ranges, kinds, start, radius, resolution):
    """Column after the last one of the run that begins at ``start``."""
    c = ranges.shape[0]
    label = kinds[start]
    valley = peak = ranges[start]
    peak_at = start
    for j in range(start + 1, c):
        if kinds[j] != label:
            return j
        r = ranges[j]
        if radius == 0.0:  # a wall: flat, met at any slant
            continue
        blur = resolution * r * r
        if abs(r - ranges[j - 1]) > max(radius, 0.08) + 1.3 * blur:
            return j
        rise = max(0.4 * radius, 0.04) + 1.3 * blur
        if peak - valley > rise and peak - r > rise:
            return peak_at
        if r < valley and peak - valley <= rise:
            valley = peak = r
            peak_at = j
        elif r > peak:
            peak, peak_at = r, j
    return c


@njit
def _pieces(bearings, ranges, start, stop, radius):
    """How many things of a radius side by side a run is as wide as."""
    if radius == 0.0 or stop - start < 4:
        return 1
    near = np.inf
    for j in range(start, stop):
        near = min(near, ranges[j])
    if near <= 0.0:
        return 1
    step = (bearings[stop - 1] - bearings[start]) / (stop - 1 - start)
    wide = bearings[stop - 1] - bearings[start] + step
    return max(1, int(wide / (2.0 * math.asin(radius / (near + radius))) + 0.4))


@njit
def _edge_free(ranges, kinds, j, way):
    """Whether column ``j`` shows the true edge of a thing on one side: what is next is behind."""
    k = j + way
    if k < 0 or k >= ranges.shape[0]:
        return False
    return kinds[k] == 0 or ranges[k] > ranges[j]


@njit
def _estimate(bearings, ranges, start, stop, radius, low, high):
    """Centre, gap, and whether both edges are free, of the run [start, stop)."""
    near, at = np.inf, start
    for j in range(start, stop):
        if ranges[j] < near:
            near, at = ranges[j], j
    if radius == 0.0:
        return near * math.cos(bearings[at]), near * math.sin(bearings[at]), near, 1.0
    if not low and not high:
        x, y = _circle(bearings, ranges, start, stop, radius)
        return x, y, max(math.hypot(x, y) - radius, 0.0), 0.0
    first = bearings[start] - 0.5 * (bearings[start] - bearings[start - 1]) if low else 0.0
    last = bearings[stop - 1] + 0.5 * (bearings[stop] - bearings[stop - 1]) if high else 0.0
    distance = near + radius
    bearing = 0.5 * (first + last)
    for _ in range(4):
        if not (low and high):
            half = math.asin(min(1.0, radius / max(distance, 1e-6)))
            bearing = first + half if low else last - half
        total = 0.0
        for j in range(start, stop):
            off = bearings[j] - bearing
            across = ranges[j] * math.sin(off)
            total += ranges[j] * math.cos(off) + math.sqrt(
                max(radius * radius - across * across, 0.0)
            )
        distance = total / (stop - start)
    gap = max(distance - radius, 0.0)
    both = 1.0 if low and high else 0.0
    return distance * math.cos(bearing), distance * math.sin(bearing), gap, both


@njit
def _circle(bearings, ranges, start, stop, radius):
    """Centre of a circle of known radius through points, from the side: Gauss-Newton."""
    m = stop - start
    mx = my = 0.0
    for j in range(start, stop):
        mx += ranges[j] * math.cos(bearings[j]) / m
        my += ranges[j] * math.sin(bearings[j]) / m
    length = max(math.hypot(mx, my), 1e-9)
    x, y = mx * (1.0 + radius / length), my * (1.0 + radius / length)
    for _ in range(8):
        # damped across: points of a short piece do not say where along it the middle is
        a, b, d, g, h = 1e-3 * m, 0.0, 1e-3 * m, 0.0, 0.0
        for j in range(start, stop):
            ex = x - ranges[j] * math.cos(bearings[j])
            ey = y - ranges[j] * math.sin(bearings[j])
            away = max(math.hypot(ex, ey), 1e-9)
            ex, ey, miss = ex / away, ey / away, away - radius
            a += ex * ex
            b += ex * ey
            d += ey * ey
            g += ex * miss
            h += ey * miss
        det = a * d - b * b
        x -= (d * g - b * h) / det
        y -= (a * h - b * g) / det
    return x, y


@njit
def _join(row, count, radii):
    """Add the object in row ``count``, or let it be one with another piece of the same thing."""
    label = int(row[count, 0])
    reach = 0.7 * radii[label]
    for j in range(count):
        if int(row[j, 0]) != label:
            continue
        if radii[label] == 0.0:
            continue
        if math.hypot(row[j, 1] - row[count, 1], row[j, 2] - row[count, 2]) < reach:
            if row[count, 5] > row[j, 5]:
                row[j] = row[count]
            return count
    return count + 1
