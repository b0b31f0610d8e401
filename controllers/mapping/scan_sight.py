"""What a scan tells of ways: whether a straight one is free for the body, and how far one is."""

import math

import numpy as np

from controllers.motion.free_way import SKIN, free_past
from mjmr.jit import njit


@njit
def way_is_clear(ranges, cos, sin, x, y, radius, reach):
    """Whether a disc can go straight to a point that is within reach: sight of a place to go to.

    The point is in sight in free space shrunk by the body's radius, which is what the point robot
    of a plane of inflated walls sees.

    Args:
        ranges: Scan (b,) [m]; not finite where nothing returned.
        cos: Of its beams (b,), body frame.
        sin: Of its beams (b,).
        x: The point [m], body frame.
        y: The point [m], body frame.
        radius: Of the disc [m].
        reach: Of sight [m].
    """
    far = math.hypot(x, y)
    if not far <= reach:
        return False
    if far < 1e-9:
        return True
    ux, uy = x / far, y / far
    for k in range(ranges.shape[0]):
        r = ranges[k]
        if not 0.0 < r < far + radius:
            continue
        px, py = r * cos[k], r * sin[k]
        along = ux * px + uy * py
        if along <= 0.0:
            continue
        keep = min(radius, r - SKIN)
        beyond = max(along - far, 0.0)
        if math.hypot(ux * py - uy * px, beyond) < keep:
            return False
    return True


@njit
def free_ranges(ranges, cos, sin, angles, radius, reach):
    """How far a disc gets in each of several directions (k,) [m], at most ``reach``.

    Args:
        ranges: Scan (b,) [m]; not finite where nothing returned.
        cos: Of its beams (b,), body frame.
        sin: Of its beams (b,).
        angles: The directions (k,) [rad], body frame.
        radius: Of the disc [m].
        reach: [m].
    """
    found = np.full(angles.shape[0], reach)
    c, s = np.cos(angles), np.sin(angles)
    for k in range(ranges.shape[0]):
        r = ranges[k]
        if not 0.0 < r < reach + radius:
            continue
        px, py = r * cos[k], r * sin[k]
        for i in range(angles.shape[0]):
            found[i] = min(found[i], free_past(c[i], s[i], px, py, r, radius))
    return found
