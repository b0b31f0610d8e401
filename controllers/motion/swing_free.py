"""Point-to-point moves that leave a hanging load at rest.

A constant acceleration shifts the rest position of a pendulum and lets it swing around that; after
one whole period it is where it began. So both ramps of a trapezoid last one period each. Derived
here for small swings without damping.
"""

import math

from controllers.motion.trapezoid import Limits, Profile, profile
from mjmr.errors import InvalidInputError


def swing_free(displacement: float, speed: float, period: float) -> Profile:
    """Velocity over time of a move from rest to rest whose ramps last a swing's period each.

    Args:
        displacement: Signed way [m].
        speed: Of the cruise, > 0 [m/s]; less is used where the way is shorter than both ramps.
        period: Of the load's swing, > 0 [s].

    Returns:
        The profile; without segments where there is no way.

    Raises:
        InvalidInputError: A number that is not finite, or a speed or period that is not positive.
    """
    for name, value in (("speed", speed), ("period", period)):
        if not (value > 0 and math.isfinite(value)):
            raise InvalidInputError(f"{name} is {value}; it must be positive and finite")
    # two ramps of one period cover the top speed times the period
    top = min(speed, abs(displacement) / period) or speed
    return profile(
        displacement,
        0.0,
        Limits(max_speed=top, acceleration=top / period, deceleration=top / period),
    )
