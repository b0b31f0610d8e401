"""Desired velocity in the plane from two one-dimensional profiles; obstacles are ignored.

:func:`along_perpendicular` is the rule of Bruce and Veloso 2005, section 3;
:func:`synchronised` is an ablation that is **not** in that paper.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.motion.trapezoid import Limits, duration, velocity_after
from mjmr.errors import InvalidInputError
from mjmr.finite import finite
from mjmr.jit import njit

NEAR = 0.010
"""Distance [m] below which the last direction to the target is kept (the paper gives none)."""

BISECTIONS = 40
"""Halvings of the angle; 40 bring the two axes' times within 1e-9 s."""


def along_perpendicular(
    position: ArrayLike,
    velocity: ArrayLike,
    target: ArrayLike,
    limits: Limits,
    period: float,
    direction: ArrayLike = (0.0, 0.0),
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """One cycle of the paper's rule: profile towards the target, brake across it.

    Args:
        position: Shape (2,) [m], world frame.
        velocity: Shape (2,) [m/s], world frame.
        target: Shape (2,) [m], world frame.
        limits: Bounds of each of the two axes.
        period: Command period [s].
        direction: Shape (2,), unit vector returned by the last call; zero if there was none.

    Returns:
        Command, shape (2,) [m/s] in the world frame, and the direction used, shape (2,).

    Raises:
        InvalidInputError: A shape is wrong or a number is not finite.

    Source: Bruce and Veloso 2005, section 3 and figure 5. Nearer than :data:`NEAR` the last
    direction is kept, and the way left is then measured along it, so that an overshoot has the
    right sign. Each axis has the full bounds: together they reach sqrt(2) times as much.
    """
    p, v, g = (
        _vector("position", position),
        _vector("velocity", velocity),
        _vector("target", target),
    )
    e = _vector("direction", direction).copy()
    cx, cy = along_velocity(
        p[0],
        p[1],
        v[0],
        v[1],
        g[0],
        g[1],
        e,
        limits.max_speed,
        limits.acceleration,
        limits.deceleration,
        _period(period),
    )
    return np.array([cx, cy]), e


def synchronised(
    position: ArrayLike,
    velocity: ArrayLike,
    target: ArrayLike,
    limits: Limits,
    period: float,
) -> NDArray[np.float64]:
    """One cycle of the ablation: both world axes arrive at the same time. Not in the paper.

    The bounds are split by an angle alpha, cos to x and sin to y, found by bisection on the
    difference of the axes' times. The acceleration keeps its bound as a vector; the speed passes
    its own by a little (measured: 2.1 %) where the split changes under way.

    Args:
        position: Shape (2,) [m], world frame.
        velocity: Shape (2,) [m/s], world frame.
        target: Shape (2,) [m], world frame.
        limits: Bounds of the motion as a whole.
        period: Command period [s].

    Returns:
        Command, shape (2,) [m/s], world frame.

    Raises:
        InvalidInputError: A shape is wrong or a number is not finite.
    """
    p, v, g = (
        _vector("position", position),
        _vector("velocity", velocity),
        _vector("target", target),
    )
    V, A, B = limits.max_speed, limits.acceleration, limits.deceleration
    d = g - p
    return np.array(synchronised_velocity(d[0], d[1], v[0], v[1], V, A, B, _period(period)))


def _vector(name: str, value: ArrayLike) -> NDArray[np.float64]:
    v = finite(value, (2,))
    if v is None:
        raise InvalidInputError(f"{name} must be two finite numbers, not {value!r}")
    return v


def _period(period: float) -> float:
    if not (math.isfinite(period) and period > 0.0):
        raise InvalidInputError(f"period is {period}; it must be positive and finite")
    return float(period)


@njit
def along_velocity(px, py, vx, vy, gx, gy, direction, V, A, B, T):
    """Compiled :func:`along_perpendicular`; ``direction`` (2,) is read and written in place."""
    dx = gx - px
    dy = gy - py
    distance = math.sqrt(dx * dx + dy * dy)
    known = direction[0] != 0.0 or direction[1] != 0.0
    if distance >= NEAR or (distance > 0.0 and not known):
        direction[0] = dx / distance
        direction[1] = dy / distance
    elif not known:
        direction[0] = 1.0
    ex = direction[0]
    ey = direction[1]
    along = velocity_after(dx * ex + dy * ey, vx * ex + vy * ey, V, A, B, T)
    across = ex * vy - ey * vx
    if across > 0.0:
        across = max(0.0, across - B * T)
    else:
        across = min(0.0, across + B * T)
    return along * ex - across * ey, along * ey + across * ex


@njit
def synchronising_angle(dx, dy, vx, vy, V, A, B):
    """Angle alpha [rad] in (0, pi/2) at which x with cos and y with sin take equally long."""
    low = 0.0
    high = 0.5 * math.pi
    for _ in range(BISECTIONS):
        alpha = 0.5 * (low + high)
        c = math.cos(alpha)
        s = math.sin(alpha)
        if duration(dx, vx, V * c, A * c, B * c) > duration(dy, vy, V * s, A * s, B * s):
            high = alpha
        else:
            low = alpha
    return 0.5 * (low + high)


@njit
def synchronised_velocity(dx, dy, vx, vy, V, A, B, T):
    """Compiled :func:`synchronised`, from the displacement (dx, dy) [m] to the target."""
    alpha = synchronising_angle(dx, dy, vx, vy, V, A, B)
    c = math.cos(alpha)
    s = math.sin(alpha)
    return (
        velocity_after(dx, vx, V * c, A * c, B * c, T),
        velocity_after(dy, vy, V * s, A * s, B * s, T),
    )
