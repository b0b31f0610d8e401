"""Compiled rays against the shapes MuJoCo knows: fans of beams, lines of sight, incidence.

Every shape is treated exactly, as it stands in space. What makes fans fast is that their beams lie
in one plane, evenly spaced: a shape is tried against those beams alone that its bounding sphere's
section with the plane covers, and of these against those alone that nothing nearer has stopped.

Shapes are passed as arrays over p shapes; ``ShapeTable`` in :mod:`mjmr.sensors.shape_table` says
what they are. Local coordinates are those of a shape's own frame.
"""

import math

import numpy as np

from mjmr.jit import njit
from mjmr.sensors.ray_shapes import BOX, CAPSULE, CYLINDER, ELLIPSOID, PLANE, try_shape

_SECTORS = 128


@njit
def cast_fans(
    origins, frames, owners, cosines, sines, reach, shapes, geom_pos, geom_mat, body_pos, body_mat
):
    """Nearest hits of fans of beams.

    Args:
        origins: Where the fans' beams begin (m, 3) [m], world frame.
        frames: Rotations (m, 3, 3) whose columns are a fan's middle beam, its left and its upward
            normal, world frame.
        owners: Robot whose shapes a fan does not see (m,), -1 for none.
        cosines: Of the beams' angles to the middle one (b,): evenly spaced, increasing, at most a
            full turn, the same to both sides.
        sines: The same.
        reach: Hits further away than this do not count [m].
        shapes: Geoms, kinds, sizes, owners, carrying bodies, bounding spheres: see ``ShapeTable``.
        geom_pos: Of all geoms (., 3).
        geom_mat: The same (., 9).
        body_pos: Of all bodies (., 3).
        body_mat: The same (., 9).

    Returns:
        Ranges (m, b) [m], infinite where nothing is hit, and the geoms hit (m, b), there -1.
    """
    geoms, _, _, owner_of, bodies, offsets, radii = shapes
    m, beams = origins.shape[0], cosines.shape[0]
    ranges = np.full((m, beams), np.inf)
    hits = np.full((m, beams), -1, dtype=np.int32)
    first = math.atan2(sines[0], cosines[0])
    if sines[0] == 0.0 and cosines[0] < 0.0:
        first = -math.pi
    step = 1.0
    if beams > 1:
        step = math.atan2(
            sines[1] * cosines[0] - cosines[1] * sines[0],
            cosines[1] * cosines[0] + sines[1] * sines[0],
        )
    turn = 2.0 * math.pi / step
    behind = -1.0 if -first > math.pi / 2 + 1e-9 else 0.0  # less than half a turn sees none behind
    # shapes that some fan's plane may meet within reach
    low, high = np.inf, -np.inf
    for i in range(m):
        rise = reach * math.hypot(frames[i, 2, 0], frames[i, 2, 1])
        low = min(low, origins[i, 2] - rise)
        high = max(high, origins[i, 2] + rise)
    centres = _centres(bodies, offsets, body_pos, body_mat)
    kept, count = _between(low, high, centres, radii)
    for i in range(m):
        o = (origins[i, 0], origins[i, 1], origins[i, 2])
        x = (frames[i, 0, 0], frames[i, 1, 0], frames[i, 2, 0])
        y = (frames[i, 0, 1], frames[i, 1, 1], frames[i, 2, 1])
        z = (frames[i, 0, 2], frames[i, 1, 2], frames[i, 2, 2])
        best, hit = ranges[i], hits[i]
        best[:] = reach
        for n in range(count):
            k = kept[n]
            radius = radii[k]
            v = (centres[k, 0] - o[0], centres[k, 1] - o[1], centres[k, 2] - o[2])
            square = _dot(v, v)
            if square > (reach + radius) ** 2:
                continue
            if owner_of[k] >= 0 and owner_of[k] == owners[i]:
                continue
            above = _dot(v, z)
            section = radius * radius - above * above
            if section < 0.0:
                continue
            ahead = _dot(v, x)
            if behind == 0.0 and ahead < -radius:
                continue
            near = math.sqrt(square) - radius - 1e-9
            flat = square - above * above
            if flat <= section * (1.0 + 1e-9):
                try_shape(
                    k, shapes, geom_pos, geom_mat, o, x, y, cosines, sines, 0, beams, near, best,
                    hit,
                )  # fmt: skip
                continue
            middle = math.atan2(_dot(v, y), ahead)
            half = math.sqrt(section / flat)
            # of an angle whose sine is at most 1/2, pi / 3 times the sine is never less
            half = half * 1.0471976 if half <= 0.5 else math.asin(min(half, 1.0))
            half += 1e-9
            around = 1 if abs(middle) + half > math.pi else 0
            for lap in range(-around, around + 1):
                start = (middle - half - first) / step + lap * turn
                stop = (middle + half - first) / step + lap * turn
                if stop < 0.0 or start > beams - 1:
                    continue
                lo, hi = max(0, math.ceil(start)), min(beams, math.floor(stop) + 1)
                if lo < hi:
                    try_shape(
                        k, shapes, geom_pos, geom_mat, o, x, y, cosines, sines, lo, hi, near,
                        best, hit,
                    )  # fmt: skip
        for j in range(beams):
            if hit[j] < 0:
                best[j] = np.inf
    return ranges, hits


@njit
def clear_segments(starts, ends, start_owners, end_owners, shapes, geom_pos, geom_mat, body_pos,
                   body_mat):  # fmt: skip
    """Whether nothing is between points: (a, 3) and (b, 3) [m] -> (a, b).

    Args:
        starts: World frame.
        ends: World frame.
        start_owners: Robot that a start is on (a,), -1 for none: it is in nobody's way from there.
        end_owners: The same of the ends (b,).
        shapes: And the rest as in :func:`cast_fans`.
        geom_pos: The same.
        geom_mat: The same.
        body_pos: The same.
        body_mat: The same.
    """
    owner_of, bodies, offsets, radii = shapes[3:]
    clear = np.ones((starts.shape[0], ends.shape[0]), dtype=np.bool_)
    if clear.size == 0:
        return clear
    centres = _centres(bodies, offsets, body_pos, body_mat)
    one, nil, nowhere = np.ones(1), np.zeros(1), (0.0, 0.0, 0.0)
    best, hit = np.empty(1), np.empty(1, dtype=np.int32)
    low = min(starts[:, 2].min(), ends[:, 2].min())
    high = max(starts[:, 2].max(), ends[:, 2].max())
    kept, count = _between(low, high, centres, radii)
    for i in range(starts.shape[0]):
        o = (starts[i, 0], starts[i, 1], starts[i, 2])
        listed, begin = _by_bearing(o, kept[:count], centres, radii)
        for j in range(ends.shape[0]):
            d = (ends[j, 0] - o[0], ends[j, 1] - o[1], ends[j, 2] - o[2])
            length = math.sqrt(_dot(d, d))
            if length == 0.0:
                continue
            d = (d[0] / length, d[1] / length, d[2] / length)
            best[0], hit[0] = length, -1
            sector = int((math.atan2(d[1], d[0]) + math.pi) * (_SECTORS / (2.0 * math.pi)))
            sector = min(sector, _SECTORS - 1)
            if d[0] == 0.0 and d[1] == 0.0:
                sector = _SECTORS  # straight up or down: every shape
            for n in range(begin[sector], begin[sector + 1]):
                k = listed[n]
                v = (centres[k, 0] - o[0], centres[k, 1] - o[1], centres[k, 2] - o[2])
                along = min(max(_dot(v, d), 0.0), length)
                v = (v[0] - along * d[0], v[1] - along * d[1], v[2] - along * d[2])
                if _dot(v, v) > radii[k] * radii[k]:
                    continue
                owner = owner_of[k]
                if owner >= 0 and (owner == start_owners[i] or owner == end_owners[j]):
                    continue
                try_shape(
                    k, shapes, geom_pos, geom_mat, o, d, nowhere, one, nil, 0, 1, -1.0, best, hit
                )
                if hit[0] >= 0:
                    clear[i, j] = False
                    break
    return clear


@njit
def _between(low, high, centres, radii):
    """Shapes that may be met between two heights, and how many they are."""
    kept = np.empty(radii.shape[0], dtype=np.int64)
    count = 0
    for k in range(radii.shape[0]):
        if centres[k, 2] - radii[k] <= high and centres[k, 2] + radii[k] >= low:
            kept[count] = k
            count += 1
    return kept, count


@njit
def _by_bearing(o, kept, centres, radii):
    """Shapes of ``kept`` that each sector of bearings from a point may meet, and the lists' begins.

    The list after the last sector's has every shape.
    """
    count = kept.shape[0]
    scale = _SECTORS / (2.0 * math.pi)
    low, high = np.empty(count, dtype=np.int64), np.empty(count, dtype=np.int64)
    sizes = np.zeros(_SECTORS + 2, dtype=np.int64)
    for n in range(count):
        k = kept[n]
        x, y = centres[k, 0] - o[0], centres[k, 1] - o[1]
        away = math.sqrt(x * x + y * y)
        low[n], high[n] = 0, _SECTORS - 1
        if away > radii[k]:
            half = math.asin(radii[k] / away) + 1e-9
            middle = math.atan2(y, x) + math.pi
            low[n] = math.floor((middle - half) * scale)
            high[n] = min(math.floor((middle + half) * scale), low[n] + _SECTORS - 1)
        for sector in range(low[n], high[n] + 1):
            sizes[sector % _SECTORS + 1] += 1
    begin = np.cumsum(sizes)
    listed = np.empty(begin[_SECTORS] + count, dtype=np.int64)
    filled = begin[:-1].copy()
    for n in range(count):
        for sector in range(low[n], high[n] + 1):
            listed[filled[sector % _SECTORS]] = kept[n]
            filled[sector % _SECTORS] += 1
        listed[begin[_SECTORS] + n] = kept[n]
    begin[_SECTORS + 1] = begin[_SECTORS] + count
    return listed, begin


@njit
def incidence(
    origins, frames, cosines, sines, ranges, hits, geom_type, geom_size, geom_pos, geom_mat
):
    """Cosines of the angles between beams and the surfaces they hit (m, b), 0 where none is hit.

    Args:
        origins: As in :func:`cast_fans`, and so are ``frames``, ``cosines`` and ``sines``.
        frames: See there.
        cosines: See there.
        sines: See there.
        ranges: What :func:`cast_fans` returned.
        hits: The same.
        geom_type: Of all geoms (.,).
        geom_size: The same (., 3).
        geom_pos: The same (., 3).
        geom_mat: The same (., 9).
    """
    found = np.zeros(ranges.shape)
    p, d = np.empty(3), np.empty(3)
    for i in range(ranges.shape[0]):
        for j in range(ranges.shape[1]):
            g = hits[i, j]
            if g < 0:
                continue
            mat = geom_mat[g]
            p[:], d[:] = 0.0, 0.0
            for r in range(3):
                way = cosines[j] * frames[i, r, 0] + sines[j] * frames[i, r, 1]
                there = origins[i, r] + ranges[i, j] * way - geom_pos[g, r]
                for c in range(3):
                    p[c] += mat[3 * r + c] * there
                    d[c] += mat[3 * r + c] * way
            found[i, j] = abs(_along_normal(geom_type[g], geom_size[g], p, d))
    return found


@njit
def _along_normal(kind, size, p, d):
    """Part of a direction along the outward normal of a shape at p, both local."""
    if kind == PLANE:
        return d[2]
    if kind == BOX:
        face = 0
        for c in range(1, 3):
            if abs(p[c]) - size[c] > abs(p[face]) - size[face]:
                face = c
        return d[face]
    n0, n1, n2 = p[0], p[1], p[2]
    if kind == CYLINDER:
        if size[1] - abs(p[2]) < size[0] - math.hypot(p[0], p[1]):
            return d[2]
        n2 = 0.0
    elif kind == CAPSULE:
        n2 -= min(max(n2, -size[1]), size[1])
    elif kind == ELLIPSOID:
        n0, n1, n2 = n0 / size[0] ** 2, n1 / size[1] ** 2, n2 / size[2] ** 2
    return (n0 * d[0] + n1 * d[1] + n2 * d[2]) / math.sqrt(n0 * n0 + n1 * n1 + n2 * n2)


@njit
def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit
def _centres(bodies, offsets, body_pos, body_mat):
    """Middles of bounding spheres (p, 3), world frame."""
    centres = np.empty(offsets.shape)
    for k in range(bodies.shape[0]):
        b = bodies[k]
        for r in range(3):
            centres[k, r] = (
                body_pos[b, r] + body_mat[b, 3 * r] * offsets[k, 0]
                + body_mat[b, 3 * r + 1] * offsets[k, 1] + body_mat[b, 3 * r + 2] * offsets[k, 2]
            )  # fmt: skip
    return centres
