"""How far behind a moving leader the relative form leaves its followers, from the closed loop.

Followers obey p_i'' = -2 p_i' + sum_j g_ij (y_j(t - tau) - y_i) with y_i = p_i - d_i(t); the
leader's output is the path itself. On a straight line at velocity V all outputs end on a line
behind it, where 2 V = sum_j g_ij (lag_i - lag_j - V tau): in a chain 2 V / g + V tau a link. Where
path or offsets turn or swing at the rate Omega, outputs do so too, with amplitudes that solve the
same equation for s = i Omega. With velocities and accelerations told along the graph, those of what
is told are added and the 2 V go. Derived here; the paper has no moving formation.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.consensus.gains import check_gains
from mjmr.errors import InvalidInputError
from mjmr.finite import finite, numbers

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


def ramp_lag(
    gains: ArrayLike, leader: int, velocity: ArrayLike, *, delay: float = 0.0, told: bool = False
) -> Array:
    """Path less outputs (n, m) [m] in the end, on a straight line.

    Args:
        gains: (n, n), rows summing to one; the leader's row is not used.
        leader: Whose output is the path.
        velocity: V (m,) [m/s].
        delay: tau, of what is heard [s].
        told: Whether the velocity is told along the graph, so that followers add it.

    Raises:
        InvalidInputError: Gains, leader, velocity or delay that cannot be, or somebody who does not
            hear the leader, not even through others.
    """
    g, follows = _followers(gains, leader)
    v = numbers(velocity)
    if v is None or v.ndim != 1 or not np.isfinite(v).all():
        raise InvalidInputError(f"a velocity is finite numbers (m,) [m/s]; got {velocity}")
    others = 1.0 - np.diag(g)
    rest = (0.0 if told else 2.0) + others[follows] * _late(delay)
    lag = np.zeros((len(g), len(v)))
    laplacian = np.eye(len(g)) - g
    lag[follows] = np.linalg.solve(laplacian[np.ix_(follows, follows)], rest[:, None] * v)
    return lag


def harmonic_error(
    gains: ArrayLike, leader: int, rate: float, path: ArrayLike, offsets: ArrayLike, *,
    delay: float = 0.0, told: bool = False,
) -> Complex:  # fmt: skip
    """Outputs less the path, as complex amplitudes (n, m) [m] at one rate, in the end.

    Args:
        gains: As of :func:`ramp_lag`.
        leader: As there.
        rate: Omega [rad/s], above 0.
        path: Amplitudes of the path's swing (m,) [m]; it is the real part of these times
            exp(i Omega t).
        offsets: The same of the offsets (n, m) [m].
        delay: tau, of what is heard [s].
        told: Whether the path's velocity and acceleration are told along the graph, each hop late
            by the delay; followers add them and those of their own offsets.

    Raises:
        InvalidInputError: As :func:`ramp_lag`, a rate that is not positive and finite, or
            amplitudes that are not finite or do not fit.
    """
    speed = finite(rate, ())
    if speed is None or not speed > 0:
        raise InvalidInputError(f"a rate is above 0; got {rate} rad/s")
    g, _ = _followers(gains, leader)
    p, d = numbers(path, np.complex128), numbers(offsets, np.complex128)
    if p is None or p.ndim != 1 or not np.isfinite(p).all():
        raise InvalidInputError(f"the amplitudes of a path are finite numbers (m,) [m]; got {path}")
    shape = (len(g), len(p))
    if d is None or d.shape != shape or not np.isfinite(d).all():
        given = "no numbers" if d is None else f"shape {d.shape}"
        raise InvalidInputError(
            f"the amplitudes of offsets are finite numbers of shape {shape} [m]; got {given}"
        )
    s, late = 1j * rate, np.exp(-1j * rate * _late(delay))
    swing = s * s + 2.0 * s
    heard = g - np.diag(np.diag(g))
    out = heard.sum(axis=1)
    matrix = np.diag(swing + out) - late * heard
    matrix[leader] = np.eye(len(g))[leader]
    drive = -swing * d
    if told:
        share = late * heard / np.maximum(out, 1e-300)[:, None]
        known = np.eye(len(g), dtype=np.complex128) - share
        known[leader] = np.eye(len(g))[leader]
        source = np.zeros((len(g), len(p)), dtype=np.complex128)
        source[leader] = p
        drive = drive + swing * (np.linalg.solve(known, source) + d)
    drive[leader] = p
    return np.asarray(np.linalg.solve(matrix, drive) - p, dtype=np.complex128)


def _followers(gains: ArrayLike, leader: int) -> tuple[Array, NDArray[np.int64]]:
    """Gains (n, n), and who follows."""
    g = check_gains(gains)
    if not isinstance(leader, (int, np.integer)) or not 0 <= leader < len(g):
        raise InvalidInputError(f"the leader is one of 0 to {len(g) - 1}; got {leader}")
    reached = {leader}
    while True:
        more = {i for i in range(len(g)) if i not in reached and g[i, list(reached)].any()}
        if not more:
            break
        reached |= more
    if len(reached) < len(g):
        deaf = min(set(range(len(g))) - reached)
        raise InvalidInputError(f"robot {deaf} does not hear robot {leader}, directly or not")
    return g, np.array([i for i in range(len(g)) if i != leader], dtype=np.int64)


def _late(delay: float) -> float:
    found = finite(delay, ())
    if found is None or not found >= 0:
        raise InvalidInputError(f"a delay is 0 or more and finite; got {delay} s")
    return float(found)
