"""What a robot will do: one command for one cycle, then braking in whole cycles.

A robot that brakes gets a new, slower command each cycle, so it loses B T of speed a cycle and
the remainder over one full last cycle; it travels up to B T^2 / 8 further than v^2 / 2B. A
prediction with continuous braking misses that (0.2 mm here) and lets robots touch.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.jit import njit

PIECES = 4
"""Rows of a compiled prediction: the command's ramp, full braking, last cycle, rest."""


class Piece(NamedTuple):
    """Motion with constant acceleration from ``start`` until the next piece.

    Attributes:
        start: Time since now [s].
        position: Shape (2,) [m], world frame, at ``start``.
        velocity: Shape (2,) [m/s], world frame, at ``start``.
        acceleration: Shape (2,) [m/s^2], world frame.
    """

    start: float
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    acceleration: NDArray[np.float64]


def predict(
    position: ArrayLike,
    velocity: ArrayLike,
    command: ArrayLike,
    deceleration: float,
    period: float,
) -> list[Piece]:
    """Motion of one robot that gets ``command`` now and brakes from the next cycle on.

    Args:
        position: Shape (2,) [m], world frame.
        velocity: Shape (2,) [m/s], world frame.
        command: Shape (2,) [m/s], world frame; reached linearly at the end of the cycle.
        deceleration: Braking bound B [m/s^2].
        period: Command period T [s].

    Returns:
        Pieces in order of time; the last is rest and lasts for ever.

    Raises:
        InvalidInputError: A shape is wrong, a number not finite, or a bound not above 0.

    Source: Bruce and Veloso 2005, section 4 and figure 7; the ramp inside the cycle and braking
    in whole cycles are ours, because they are what is executed.
    """
    p, v, c = (np.asarray(a, dtype=np.float64) for a in (position, velocity, command))
    for name, a in (("position", p), ("velocity", v), ("command", c)):
        if a.shape != (2,) or not np.isfinite(a).all():
            raise InvalidInputError(f"{name} must be two finite numbers, not {a!r}")
    for name, x in (("deceleration", deceleration), ("period", period)):
        if not (math.isfinite(x) and x > 0.0):
            raise InvalidInputError(f"{name} is {x}; it must be positive and finite")
    rows = np.empty((PIECES, 7))
    fill_prediction(p[0], p[1], v[0], v[1], c[0], c[1], deceleration, period, rows)
    ends = [*rows[1:, 0], math.inf]
    return [
        Piece(float(r[0]), r[1:3].copy(), r[3:5].copy(), r[5:7].copy())
        for r, end in zip(rows, ends, strict=True)
        if end > r[0]
    ]


def forward_predict(
    position: ArrayLike, velocity: ArrayLike, pending: ArrayLike, period: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """State of a group when the next command takes effect, after commands already on their way.

    Args:
        position: Shape (n, 2) [m], world frame, now.
        velocity: Shape (n, 2) [m/s], world frame, now.
        pending: Shape (k, n, 2) [m/s], world frame, oldest first; each is reached linearly over
            one period. Shape (0, n, 2) for no latency.
        period: Command period [s].

    Returns:
        Position (n, 2) [m] and velocity (n, 2) [m/s] after k periods.

    Raises:
        InvalidInputError: Shapes do not fit.

    Not in the paper, whose simulation has no latency; without it one cycle of latency breaks the
    safety search at any margin.
    """
    p, v = np.array(position, dtype=np.float64), np.array(velocity, dtype=np.float64)
    queue = np.asarray(pending, dtype=np.float64)
    if p.ndim != 2 or p.shape[1] != 2 or v.shape != p.shape:
        raise InvalidInputError(f"position {p.shape} and velocity {v.shape} must both be (n, 2)")
    if queue.ndim != 3 or queue.shape[1:] != p.shape:
        raise InvalidInputError(f"pending has shape {queue.shape}; it must be (k, {len(p)}, 2)")
    for command in queue:
        p += 0.5 * (v + command) * period
        v = command.copy()
    return p, v


@njit
def fill_prediction(px, py, vx, vy, cx, cy, B, T, rows):
    """Write the prediction of :func:`predict` into ``rows``, shape (4, 7).

    A row is start time, position, velocity, acceleration; pieces may have zero duration.

    Returns:
        Upper bound of the distance [m] from p that the motion ever reaches.
    """
    rows[0, 0] = 0.0
    rows[0, 1] = px
    rows[0, 2] = py
    rows[0, 3] = vx
    rows[0, 4] = vy
    rows[0, 5] = (cx - vx) / T
    rows[0, 6] = (cy - vy) / T
    speed = math.sqrt(cx * cx + cy * cy)
    ex = 0.0
    ey = 0.0
    if speed > 0.0:
        ex = cx / speed
        ey = cy / speed
    cycles = math.floor(speed / (B * T))
    full = cycles * T
    rest = max(0.0, speed - cycles * B * T)
    rows[1, 0] = T
    rows[1, 1] = px + 0.5 * (vx + cx) * T
    rows[1, 2] = py + 0.5 * (vy + cy) * T
    rows[1, 3] = cx
    rows[1, 4] = cy
    rows[1, 5] = -B * ex
    rows[1, 6] = -B * ey
    way = (speed - 0.5 * B * full) * full
    rows[2, 0] = T + full
    rows[2, 1] = rows[1, 1] + way * ex
    rows[2, 2] = rows[1, 2] + way * ey
    rows[2, 3] = rest * ex
    rows[2, 4] = rest * ey
    rows[2, 5] = -rest / T * ex
    rows[2, 6] = -rest / T * ey
    last = 0.5 * rest * T
    rows[3, 0] = rows[2, 0] + (T if rest > 0.0 else 0.0)
    rows[3, 1] = rows[2, 1] + last * ex
    rows[3, 2] = rows[2, 2] + last * ey
    for k in range(3, 7):
        rows[3, k] = 0.0
    return 0.5 * (math.sqrt(vx * vx + vy * vy) + speed) * T + way + last
