"""Compiled intersections of rays with one shape, as MuJoCo has them."""

import math

import numpy as np

from mjmr.jit import njit

# MuJoCo's mjtGeom
PLANE, SPHERE, CAPSULE, ELLIPSOID, CYLINDER, BOX = 0, 2, 3, 4, 5, 6


@njit
def _local(mats, g, v):
    """A vector in the frame of geom g."""
    return (
        mats[g, 0] * v[0] + mats[g, 3] * v[1] + mats[g, 6] * v[2],
        mats[g, 1] * v[0] + mats[g, 4] * v[1] + mats[g, 7] * v[2],
        mats[g, 2] * v[0] + mats[g, 5] * v[1] + mats[g, 8] * v[2],
    )


@njit
def try_shape(
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
