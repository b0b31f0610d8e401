"""Compiled inner loops of the overlap metric: discs on known ramps against discs and boxes."""

import math

import numpy as np

from mjmr.jit import njit


@njit
def overlap(pose, start, end, radii, outside, boxes, moved, bounds, period, samples):
    """Depth times time, of disc pairs and of discs and fixed things, over one ramp of twists.

    Args:
        pose: Poses at the ramp's start, (n, 3) [m, m, rad].
        start: Twists at its start, (n, 3), body frame.
        end: Twists at its end, (n, 3), body frame.
        radii: (n,) [m].
        outside: (n,) bool, robots whose pairs are counted apart.
        boxes: (k, 5): x, y, yaw, half length, half width, at the ramp's start.
        moved: (k, 5), the same at its end; boxes go straight in between.
        bounds: (4,): xmin, ymin, xmax, ymax [m].
        period: Of the ramp [s].
        samples: Instants at which depths are taken.

    Returns:
        (pairs [m s], deepest pair [m], pairs with an outside robot [m s], fixed things and boxes
        [m s]). Turning inside the ramp is neglected:
        the velocity's direction is taken at the ramp's ends' mean yaw.
    """
    n = pose.shape[0]
    ramp = np.empty((n, 6))
    for i in range(n):
        yaw = pose[i, 2] + 0.25 * (start[i, 2] + end[i, 2]) * period
        c, s = math.cos(yaw), math.sin(yaw)
        ramp[i, 0], ramp[i, 1] = pose[i, 0], pose[i, 1]
        ramp[i, 2] = c * start[i, 0] - s * start[i, 1]
        ramp[i, 3] = s * start[i, 0] + c * start[i, 1]
        ramp[i, 4] = (c * end[i, 0] - s * end[i, 1] - ramp[i, 2]) / period
        ramp[i, 5] = (s * end[i, 0] + c * end[i, 1] - ramp[i, 3]) / period
    pairs, deepest, apart = _pairs(ramp, radii, outside, period, samples)
    return pairs, deepest, apart, _fixed(ramp, radii, boxes, moved, bounds, period, samples)


@njit
def _pairs(ramp, radii, outside, period, samples):
    total, deepest, apart = 0.0, 0.0, 0.0
    for i in range(ramp.shape[0]):
        for j in range(i + 1, ramp.shape[0]):
            reach = radii[i] + radii[j]
            dx, dy = ramp[i, 0] - ramp[j, 0], ramp[i, 1] - ramp[j, 1]
            ux, uy = ramp[i, 2] - ramp[j, 2], ramp[i, 3] - ramp[j, 3]
            ax, ay = ramp[i, 4] - ramp[j, 4], ramp[i, 5] - ramp[j, 5]
            # neither can have come nearer than this inside the period
            last = math.hypot(ux + ax * period, uy + ay * period)
            far = reach + period * max(math.hypot(ux, uy), last)
            if dx * dx + dy * dy > far * far:
                continue
            depth = reach - _nearest(dx, dy, ux, uy, ax, ay, period)
            if depth <= 0.0:
                continue
            inside = 0.0
            for k in range(samples):
                t = (k + 0.5) / samples * period
                x = dx + (ux + 0.5 * ax * t) * t
                y = dy + (uy + 0.5 * ay * t) * t
                inside += max(0.0, reach - math.hypot(x, y)) * period / samples
            # a touch that falls between samples still counts: nothing but 0 is 0
            if inside <= 0.0:
                inside = depth * period / samples
            if outside[i] or outside[j]:
                apart += inside
            else:
                total += inside
                deepest = max(deepest, depth)
    return total, deepest, apart


@njit
def _nearest(dx, dy, ux, uy, ax, ay, period):
    """Least distance [m] inside a ramp: the best of a few instants, narrowed down by thirds."""
    parts = 8
    best, at = math.inf, 0
    for k in range(parts + 1):
        d2 = _squared(dx, dy, ux, uy, ax, ay, k * period / parts)
        if d2 < best:
            best, at = d2, k
    low, high = max(0, at - 1) * period / parts, min(parts, at + 1) * period / parts
    for _ in range(60):
        third = (high - low) / 3.0
        a, b = low + third, high - third
        if _squared(dx, dy, ux, uy, ax, ay, a) < _squared(dx, dy, ux, uy, ax, ay, b):
            high = b
        else:
            low = a
    return math.sqrt(min(best, _squared(dx, dy, ux, uy, ax, ay, 0.5 * (low + high))))


@njit
def _squared(dx, dy, ux, uy, ax, ay, t):
    x = dx + (ux + 0.5 * ax * t) * t
    y = dy + (uy + 0.5 * ay * t) * t
    return x * x + y * y


@njit
def _fixed(ramp, radii, boxes, moved, bounds, period, samples):
    total = 0.0
    for i in range(ramp.shape[0]):
        r = radii[i]
        for k in range(samples):
            t = (k + 0.5) / samples * period
            x = ramp[i, 0] + (ramp[i, 2] + 0.5 * ramp[i, 4] * t) * t
            y = ramp[i, 1] + (ramp[i, 3] + 0.5 * ramp[i, 5] * t) * t
            depth = max(
                max(bounds[0] + r - x, x + r - bounds[2]),
                max(bounds[1] + r - y, y + r - bounds[3]),
            )
            total += max(0.0, depth) * period / samples
            for b in range(boxes.shape[0]):
                share = t / period
                dx = x - boxes[b, 0] - (moved[b, 0] - boxes[b, 0]) * share
                dy = y - boxes[b, 1] - (moved[b, 1] - boxes[b, 1]) * share
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
