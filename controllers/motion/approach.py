"""Closest approach of two predicted motions, each of constant acceleration piece by piece.

Source: Bruce and Veloso 2005, section 4, "minimum distance between two accelerating bodies",
which the paper solves numerically. Here: exact stationary points of the quartic on each interval.
"""

import math

from mjmr.jit import njit

_NEWTON_STEPS = 60


@njit
def _crossing(c3, c2, c1, c0, low, high):
    """Root in [low, high] of a cubic that rises from below to above 0 there.

    Newton's step where it stays inside the bracket, halving where not: always converges.
    """
    t = 0.5 * (low + high)
    width = high - low
    for _ in range(_NEWTON_STEPS):
        g = ((c3 * t + c2) * t + c1) * t + c0
        if g < 0.0:
            low = t
        else:
            high = t
        slope = (3.0 * c3 * t + 2.0 * c2) * t + c1
        new = t - g / slope if slope != 0.0 else low
        if not (low < new < high):
            new = 0.5 * (low + high)
        if abs(new - t) <= 1e-13 * width:
            return new
        t = new
    return t


@njit
def interval_minimum(rx, ry, ux, uy, ax, ay, h):
    """Least squared length [m^2] of rho(t) = r + u t + a t^2 / 2 over t in [0, h].

    The derivative of the quartic |rho|^2 is a cubic; its own derivative, a quadratic, splits
    [0, h] into pieces on which the cubic is monotone, so that each holds at most one minimum and
    no degenerate case (no acceleration, no motion) needs a branch of its own.
    """
    best = rx * rx + ry * ry
    ex = rx + (ux + 0.5 * ax * h) * h
    ey = ry + (uy + 0.5 * ay * h) * h
    best = min(best, ex * ex + ey * ey)
    c3 = 0.5 * (ax * ax + ay * ay)
    c2 = 1.5 * (ux * ax + uy * ay)
    c1 = ux * ux + uy * uy + rx * ax + ry * ay
    c0 = rx * ux + ry * uy
    first = h
    second = h
    if c3 > 0.0:
        discriminant = c2 * c2 - 3.0 * c3 * c1
        if discriminant > 0.0:
            q = -(c2 + math.copysign(math.sqrt(discriminant), c2))
            root_a = q / (3.0 * c3)
            root_b = c1 / q
            first = min(h, max(0.0, min(root_a, root_b)))
            second = min(h, max(0.0, max(root_a, root_b)))
    low = 0.0
    g_low = c0
    for piece in range(3):
        high = first if piece == 0 else (second if piece == 1 else h)
        if high <= low:
            continue
        g_high = ((c3 * high + c2) * high + c1) * high + c0
        if g_low < 0.0 < g_high:
            t = _crossing(c3, c2, c1, c0, low, high)
            ex = rx + (ux + 0.5 * ax * t) * t
            ey = ry + (uy + 0.5 * ay * t) * t
            best = min(best, ex * ex + ey * ey)
        low = high
        g_low = g_high
    return best


@njit
def closest_approach(one, two, enough):
    """Least distance [m] of two predictions from now until both rest.

    Args:
        one: Shape (k, 7), rows of start time, position, velocity, acceleration, the last at rest
            (:func:`controllers.motion.prediction.fill_prediction`).
        two: Likewise.
        enough: Distances from here on need no exact value [m]: the result may be any distance
            not below ``enough`` where the true one is not. Infinite for the exact distance.
    """
    last_one = one.shape[0] - 1
    last_two = two.shape[0] - 1
    i = 0
    j = 0
    t = 0.0
    best = math.inf
    while True:
        while i < last_one and one[i + 1, 0] <= t:
            i += 1
        while j < last_two and two[j + 1, 0] <= t:
            j += 1
        s = t - one[i, 0]
        w = t - two[j, 0]
        ax = one[i, 5] - two[j, 5]
        ay = one[i, 6] - two[j, 6]
        ux = one[i, 3] + one[i, 5] * s - two[j, 3] - two[j, 5] * w
        uy = one[i, 4] + one[i, 6] * s - two[j, 4] - two[j, 6] * w
        rx = one[i, 1] + (one[i, 3] + 0.5 * one[i, 5] * s) * s
        rx -= two[j, 1] + (two[j, 3] + 0.5 * two[j, 5] * w) * w
        ry = one[i, 2] + (one[i, 4] + 0.5 * one[i, 6] * s) * s
        ry -= two[j, 2] + (two[j, 4] + 0.5 * two[j, 6] * w) * w
        if i == last_one and j == last_two:
            return math.sqrt(min(best, rx * rx + ry * ry))
        until = one[i + 1, 0] if i < last_one else math.inf
        if j < last_two:
            until = min(until, two[j + 1, 0])
        h = until - t
        # The relative velocity is linear in time, so its length is greatest at an end.
        vx = ux + ax * h
        vy = uy + ay * h
        reach = h * math.sqrt(max(ux * ux + uy * uy, vx * vx + vy * vy))
        near = math.sqrt(rx * rx + ry * ry) - reach
        if near < enough and near * abs(near) < best:
            best = min(best, interval_minimum(rx, ry, ux, uy, ax, ay, h))
        t = until
