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

# MuJoCo's mjtGeom
PLANE, SPHERE, CAPSULE, ELLIPSOID, CYLINDER, BOX = 0, 2, 3, 4, 5, 6


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
    kept = np.empty(geoms.shape[0], dtype=np.int64)
    count = 0
    for k in range(geoms.shape[0]):
        if centres[k, 2] - radii[k] <= high and centres[k, 2] + radii[k] >= low:
            kept[count] = k
            count += 1
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
                _shape(
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
                    _shape(
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
    geoms, _, _, owner_of, bodies, offsets, radii = shapes
    clear = np.ones((starts.shape[0], ends.shape[0]), dtype=np.bool_)
    centres = _centres(bodies, offsets, body_pos, body_mat)
    one, nil, nowhere = np.ones(1), np.zeros(1), (0.0, 0.0, 0.0)
    best, hit = np.empty(1), np.empty(1, dtype=np.int32)
    for i in range(starts.shape[0]):
        o = (starts[i, 0], starts[i, 1], starts[i, 2])
        for j in range(ends.shape[0]):
            d = (ends[j, 0] - o[0], ends[j, 1] - o[1], ends[j, 2] - o[2])
            length = math.sqrt(_dot(d, d))
            if length == 0.0:
                continue
            d = (d[0] / length, d[1] / length, d[2] / length)
            best[0], hit[0] = length, -1
            for k in range(geoms.shape[0]):
                v = (centres[k, 0] - o[0], centres[k, 1] - o[1], centres[k, 2] - o[2])
                along = min(max(_dot(v, d), 0.0), length)
                v = (v[0] - along * d[0], v[1] - along * d[1], v[2] - along * d[2])
                if _dot(v, v) > radii[k] * radii[k]:
                    continue
                owner = owner_of[k]
                if owner >= 0 and (owner == start_owners[i] or owner == end_owners[j]):
                    continue
                _shape(
                    k, shapes, geom_pos, geom_mat, o, d, nowhere, one, nil, 0, 1, -1.0, best, hit
                )
                if hit[0] >= 0:
                    clear[i, j] = False
                    break
    return clear


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


@njit
def _local(mats, g, v):
    """A vector in the frame of geom g."""
    return (
        mats[g, 0] * v[0] + mats[g, 3] * v[1] + mats[g, 6] * v[2],
        mats[g, 1] * v[0] + mats[g, 4] * v[1] + mats[g, 7] * v[2],
        mats[g, 2] * v[0] + mats[g, 5] * v[1] + mats[g, 8] * v[2],
    )


@njit
def _shape(
    k, shapes, geom_pos, geom_mat, origin, ahead, left, cosines, sines, lo, hi, near, best, hit
):
    """Try beams lo to hi of a fan against shape k.

    Their directions, of length 1, are cosine * ahead + sine * left. Those that something not
    further away than ``near`` has stopped are passed over.
    """
    geoms, kinds, sizes = shapes[:3]
    g, kind = geoms[k], kinds[k]
    p = _local(
        geom_mat, g,
        (origin[0] - geom_pos[g, 0], origin[1] - geom_pos[g, 1], origin[2] - geom_pos[g, 2]),
    )  # fmt: skip
    a, b = _local(geom_mat, g, ahead), _local(geom_mat, g, left)
    s0, s1, s2 = sizes[k, 0], sizes[k, 1], sizes[k, 2]
    if kind == BOX:
        _box(p, a, b, s0, s1, s2, cosines, sines, lo, hi, near, best, hit, g)
        return
    if kind == SPHERE:
        s1, s2 = s0, s0
    px, py, pz = p
    for j in range(lo, hi):
        if best[j] <= near:
            continue
        c, s = cosines[j], sines[j]
        dx, dy, dz = c * a[0] + s * b[0], c * a[1] + s * b[1], c * a[2] + s * b[2]
        if kind in (SPHERE, ELLIPSOID):
            u = _ball(px / s0, py / s1, pz / s2, dx / s0, dy / s1, dz / s2)
        elif kind == CYLINDER:
            u = _cylinder(px, py, pz, dx, dy, dz, s0, s1)
        elif kind == CAPSULE:
            u = _capsule(px, py, pz, dx, dy, dz, s0, s1)
        else:
            u = _plane(px, py, pz, dx, dy, dz, s0, s1)
        if u < best[j]:
            best[j], hit[j] = u, g


@njit
def _box(p, a, b, hx, hy, hz, cosines, sines, lo, hi, near, best, hit, g):
    px, py, pz = p
    # way to the face that looks at the origin along each axis, 0 where none does
    fx = hx - px if px > hx else (-hx - px if px < -hx else 0.0)
    fy = hy - py if py > hy else (-hy - py if py < -hy else 0.0)
    fz = hz - pz if pz > hz else (-hz - pz if pz < -hz else 0.0)
    inside = fx == 0.0 and fy == 0.0 and fz == 0.0
    near = max(near, math.sqrt(fx * fx + fy * fy + fz * fz) - 1e-9)
    for j in range(lo, hi):
        t = best[j]
        if t <= near:
            continue
        c, s = cosines[j], sines[j]
        dx, dy, dz = c * a[0] + s * b[0], c * a[1] + s * b[1], c * a[2] + s * b[2]
        if inside:
            u = min(
                (math.copysign(hx, dx) - px) / dx if dx != 0.0 else np.inf,
                (math.copysign(hy, dy) - py) / dy if dy != 0.0 else np.inf,
                (math.copysign(hz, dz) - pz) / dz if dz != 0.0 else np.inf,
            )
            if u < t:
                best[j], hit[j] = u, g
            continue
        if fx * dx > 0.0:
            u = fx / dx
            if u < t and abs(py + u * dy) <= hy and abs(pz + u * dz) <= hz:
                best[j], hit[j] = u, g
                continue
        if fy * dy > 0.0:
            u = fy / dy
            if u < t and abs(px + u * dx) <= hx and abs(pz + u * dz) <= hz:
                best[j], hit[j] = u, g
                continue
        if fz * dz > 0.0:
            u = fz / dz
            if u < t and abs(px + u * dx) <= hx and abs(py + u * dy) <= hy:
                best[j], hit[j] = u, g


@njit
def _ball(px, py, pz, dx, dy, dz):
    """Way to the unit sphere, out of it from inside; infinite if none."""
    a = dx * dx + dy * dy + dz * dz
    b = px * dx + py * dy + pz * dz
    c = px * px + py * py + pz * pz - 1.0
    root = b * b - a * c
    if root < 0.0 or (c > 0.0 and b >= 0.0):
        return np.inf
    root = math.sqrt(root)
    return (-b - root) / a if c > 0.0 else (-b + root) / a


@njit
def _cylinder(px, py, pz, dx, dy, dz, radius, half):
    a = dx * dx + dy * dy
    b = px * dx + py * dy
    c = px * px + py * py - radius * radius
    root = b * b - a * c
    if root < 0.0:
        return np.inf
    beyond = half - pz if pz > half else (-half - pz if pz < -half else 0.0)
    if beyond == 0.0 and c <= 0.0:
        out = (-b + math.sqrt(root)) / a if a > 0.0 else np.inf
        return min(out, (math.copysign(half, dz) - pz) / dz if dz != 0.0 else np.inf)
    if c > 0.0 and b < 0.0:
        u = (-b - math.sqrt(root)) / a
        if abs(pz + u * dz) <= half:
            return u
    if beyond * dz > 0.0:
        u = beyond / dz
        if (px + u * dx) ** 2 + (py + u * dy) ** 2 <= radius * radius:
            return u
    return np.inf


@njit
def _capsule(px, py, pz, dx, dy, dz, radius, half):
    found = np.inf
    a = dx * dx + dy * dy
    b = px * dx + py * dy
    root = b * b - a * (px * px + py * py - radius * radius)
    if root >= 0.0 and a > 0.0:
        for side in (-1.0, 1.0):
            u = (-b + side * math.sqrt(root)) / a
            if 0.0 <= u < found and abs(pz + u * dz) <= half:
                found = u
    a += dz * dz
    for end in (-half, half):
        q = pz - end
        b = px * dx + py * dy + q * dz
        root = b * b - a * (px * px + py * py + q * q - radius * radius)
        if root < 0.0:
            continue
        for side in (-1.0, 1.0):
            u = (-b + side * math.sqrt(root)) / a
            if 0.0 <= u < found and (q + u * dz) * end >= 0.0:
                found = u
    return found


@njit
def _plane(px, py, pz, dx, dy, dz, half_x, half_y):
    """From above alone; a size of 0 is no bound."""
    if pz <= 0.0 or dz >= -1e-15:
        return np.inf
    u = -pz / dz
    if (half_x > 0.0 and abs(px + u * dx) > half_x) or (half_y > 0.0 and abs(py + u * dy) > half_y):
        return np.inf
    return u
