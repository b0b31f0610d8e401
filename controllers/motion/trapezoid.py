"""Trapezoidal velocity profile in one dimension: to rest at a target, with bounded acceleration.

Source: Bruce and Veloso 2005, section 3, "Motion control"; the order of the cases is the paper's,
the formulas are derived.
"""

import dataclasses
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError
from mjmr.jit import njit

# Below this excess a braking distance counts as equal to the way left: reversing for a rounding
# error would cost a whole cycle.
_RELATIVE = 1e-12
_ABSOLUTE = 1e-15


@dataclasses.dataclass(frozen=True, kw_only=True)
class Limits:
    """Bounds of one axis; speeding up and braking are bounded apart.

    The defaults are the robot of Bruce and Veloso 2005, section 5.

    Attributes:
        max_speed: V [m/s], > 0.
        acceleration: A [m/s^2], > 0, bound while speed grows.
        deceleration: B [m/s^2], > 0, bound while speed falls.

    Raises:
        InvalidInputError: A bound is not a positive finite number.
    """

    max_speed: float = 2.0
    acceleration: float = 3.0
    deceleration: float = 6.0

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if not (math.isfinite(value) and value > 0.0):
                raise InvalidInputError(
                    f"Limits.{field.name} is {value}; it must be positive and finite"
                )


class Dynamics(NamedTuple):
    """:class:`Limits` and the command period, in the form compiled functions take."""

    V: float
    A: float
    B: float
    T: float


@dataclasses.dataclass(frozen=True)
class Profile:
    """Velocity over time of one axis, from a given velocity to rest at the target.

    Attributes:
        start_velocity: Velocity at time 0 [m/s].
        segments: Shape (k, 2), rows (duration [s], signed acceleration [m/s^2]) in order of time,
            none of zero duration; read-only.
    """

    start_velocity: float
    segments: NDArray[np.float64]

    @property
    def duration(self) -> float:
        """Time until rest [s]."""
        return float(self.segments[:, 0].sum())

    def velocity(self, t: float) -> float:
        """Velocity [m/s] after ``t`` [s]; exactly 0 from the end on."""
        v, left = self.start_velocity, t
        for dt, a in self.segments:
            if left <= dt:
                return float(v + a * left)
            v, left = v + a * dt, left - dt
        return 0.0

    def position(self, t: float) -> float:
        """Displacement [m] since the start after ``t`` [s]; constant from the end on."""
        x, v, left = 0.0, self.start_velocity, t
        for dt, a in self.segments:
            step = min(left, dt)
            x += (v + 0.5 * a * step) * step
            if left <= dt:
                break
            v, left = v + a * dt, left - dt
        return float(x)


def profile(displacement: float, velocity: float, limits: Limits) -> Profile:
    """Profile that comes to rest ``displacement`` away.

    Args:
        displacement: Signed way to the target [m].
        velocity: Signed velocity now [m/s]; may exceed the speed bound.
        limits: Bounds of this axis.

    Returns:
        The profile: at most braking, speeding up, cruising, braking.

    Raises:
        InvalidInputError: A number is not finite.

    Source: Bruce and Veloso 2005, section 3. An over-speed start is braked to the bound first.
    """
    for name, value in (("displacement", displacement), ("velocity", velocity)):
        if not math.isfinite(value):
            raise InvalidInputError(f"{name} is {value}; it must be finite")
    slots = np.reshape(
        phases(
            float(displacement),
            float(velocity),
            limits.max_speed,
            limits.acceleration,
            limits.deceleration,
        ),
        (4, 2),
    )
    segments = slots[slots[:, 0] > 0.0]
    segments.flags.writeable = False
    return Profile(float(velocity), segments)


@njit
def phases(displacement, velocity, V, A, B):
    """Four (duration, signed acceleration) pairs: brake, speed up, cruise, brake.

    Phases that do not occur have zero duration. Arguments as in :func:`profile`, with the bounds
    V [m/s], A and B [m/s^2] spelt out.

    Returns:
        Flat tuple (t0, a0, t1, a1, t2, a2, t3, a3).
    """
    s = 1.0 if displacement >= 0.0 else -1.0
    D = s * displacement
    u = s * velocity
    t0 = 0.0
    a0 = 0.0
    if u < 0.0 or u * u / (2.0 * B) > D * (1.0 + _RELATIVE) + _ABSOLUTE:
        t0 = abs(u) / B
        a0 = -s * B if u > 0.0 else s * B
        D -= u * abs(u) / (2.0 * B)
        u = 0.0
        if D < 0.0:
            s, D = -s, -D
    elif u > V:
        t0 = (u - V) / B
        a0 = -s * B
        D -= (u * u - V * V) / (2.0 * B)
        u = V
    peak = math.sqrt(max(0.0, (2.0 * A * B * D + B * u * u) / (A + B)))
    if peak <= V:
        return t0, a0, max(peak - u, 0.0) / A, s * A, 0.0, 0.0, peak / B, -s * B
    cruise = max(0.0, (D - (V * V - u * u) / (2.0 * A) - V * V / (2.0 * B)) / V)
    return t0, a0, (V - u) / A, s * A, cruise, 0.0, V / B, -s * B


@njit
def duration(displacement, velocity, V, A, B):
    """Total time [s] of the profile; arguments as in :func:`phases`."""
    t0, _, t1, _, t2, _, t3, _ = phases(displacement, velocity, V, A, B)
    return t0 + t1 + t2 + t3


@njit
def velocity_after(displacement, velocity, V, A, B, T):
    """Velocity [m/s] of the profile after T [s], 0 if the profile is shorter: the command.

    Source: Bruce and Veloso 2005, section 3, last paragraph.
    """
    t0, a0, t1, a1, t2, _, t3, a3 = phases(displacement, velocity, V, A, B)
    v = velocity
    if t0 >= T:
        return v + a0 * T
    v += a0 * t0
    T -= t0
    if t1 >= T:
        return v + a1 * T
    v += a1 * t1
    T -= t1
    if t2 >= T:
        return v
    T -= t2
    if t3 >= T:
        return v + a3 * T
    return 0.0
