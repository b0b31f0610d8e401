"""How far a disc gets among points: the geometry that steering, rays and schemas share."""

import math

from mjmr.jit import njit

SKIN = 0.005  # m: what is nearer than it is to be kept off may come this much nearer


@njit
def free_past(cos, sin, x, y, distance, keep):
    """Way [m] along a direction until a point is ``keep`` away; inf if it never gets as near.

    What is inside already may not come nearer than by ``SKIN``, but does not hold the robot either.

    Args:
        cos: Of the direction.
        sin: Of the direction.
        x: Of the point [m], the disc's middle at the origin.
        y: Of the point [m].
        distance: Of the point [m].
        keep: Radius of the disc, and of the thing at the point [m].
    """
    along = cos * x + sin * y
    if along <= 0.0:
        return math.inf
    across = abs(cos * y - sin * x)
    keep = min(keep, distance - SKIN)
    if not across < keep:
        return math.inf
    return max(along - math.sqrt(keep * keep - across * across), 0.0)
