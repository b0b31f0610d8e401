"""Potential field: a unit pull to the target, and a push from every wall within reach.

The push of a direction falls linearly from 1 at the wall to 0 at ``reach``; it comes from rays,
evenly spread, not from pieces of wall, so that cutting a wall in two changes nothing. It gets
stuck in local minima, which is the point of it here.

Source: Sgorbissa and Arkin name "a standard potential field algorithm"; the linear push, its reach
and its gain are ours.
"""

import numpy as np

from controllers.schemas.avoid import ramp
from mjmr.jit import njit


@njit
def direction(tx, ty, angles, ranges, reach, gain):
    """Where to go.

    Args:
        tx: Offset of the target [m].
        ty: Offset of the target [m].
        angles: Directions of the rays (k,) [rad], evenly spread over the circle.
        ranges: Free way along them (k,) [m].
        reach: Walls farther than this [m] do not push.
        gain: Of the push; 1 balances the pull where every ray of a half circle reads 0 and the
            robot heads into its middle.

    Returns:
        Unit vector; (0, 0) in perfect balance.
    """
    far = max(np.hypot(tx, ty), 1e-9)
    vx, vy = tx / far, ty / far
    # the sum of cos over a half circle of k rays is k / pi
    weight = gain * np.pi / angles.shape[0]
    for k in range(angles.shape[0]):
        push = weight * ramp(ranges[k], reach, 0.0)
        vx -= push * np.cos(angles[k])
        vy -= push * np.sin(angles[k])
    size = np.hypot(vx, vy)
    if size < 1e-9:
        return 0.0, 0.0
    return vx / size, vy / size
