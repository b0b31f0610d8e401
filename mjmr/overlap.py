"""Compiled inner loops of the overlap metric: discs on known ramps against discs and boxes."""

import math

from mjmr.jit import njit


@njit
def pair_overlap(p0, v0, v1, radii, period, samples):
    """Depth times time of disc pairs over one linear velocity ramp.

    Args:
        p0: Positions at its start, (n, 2) [m].
        v0: Velocities at its start, (n, 2) [m/s].
        v1: Velocities at its end, (n, 2) [m/s].
        radii: (n,) [m].
        period: Of the ramp [s].
        samples: Instants at which the depth is taken.

    Returns:
        (metric [m s], deepest [m]).
    """
    n = p0.shape[0]
    total, deepest = 0.0, 0.0
    for i in range(n):
        for j in range(i + 1, n):
            reach = radii[i] + radii[j]
            dx, dy = p0[i, 0] - p0[j, 0], p0[i, 1] - p0[j, 1]
            ux, uy = v0[i, 0] - v0[j, 0], v0[i, 1] - v0[j, 1]
            wx, wy = v1[i, 0] - v1[j, 0], v1[i, 1] - v1[j, 1]
            # neither can have come nearer than this inside the period
            far = reach + period * max(math.hypot(ux, uy), math.hypot(wx, wy))
            if dx * dx + dy * dy > far * far:
                continue
            for k in range(samples):
                t = (k + 0.5) / samples * period
                half = 0.5 * t * t / period
                x = dx + ux * t + (wx - ux) * half
                y = dy + uy * t + (wy - uy) * half
                depth = reach - math.hypot(x, y)
                if depth > 0.0:
                    total += depth * period / samples
                    deepest = max(deepest, depth)
    return total, deepest


@njit
def box_overlap(p0, v0, v1, radii, boxes, bounds, period, samples):
    """Depth times time [m s] of discs in boxes (k, 5) and beyond bounds (4,); see pair_overlap."""
    total = 0.0
    for i in range(p0.shape[0]):
        r = radii[i]
        for k in range(samples):
            t = (k + 0.5) / samples * period
            half = 0.5 * t * t / period
            x = p0[i, 0] + v0[i, 0] * t + (v1[i, 0] - v0[i, 0]) * half
            y = p0[i, 1] + v0[i, 1] * t + (v1[i, 1] - v0[i, 1]) * half
            depth = max(
                max(bounds[0] + r - x, x + r - bounds[2]),
                max(bounds[1] + r - y, y + r - bounds[3]),
            )
            total += max(0.0, depth) * period / samples
            for b in range(boxes.shape[0]):
                dx, dy = x - boxes[b, 0], y - boxes[b, 1]
                reach = r + boxes[b, 3] + boxes[b, 4]
                if dx * dx + dy * dy > reach * reach:
                    continue
                c, s = math.cos(boxes[b, 2]), math.sin(boxes[b, 2])
                ex = abs(c * dx + s * dy) - boxes[b, 3]
                ey = abs(-s * dx + c * dy) - boxes[b, 4]
                outside = math.hypot(max(ex, 0.0), max(ey, 0.0))
                inside = min(max(ex, ey), 0.0)
                total += max(0.0, r - outside - inside) * period / samples
    return total
