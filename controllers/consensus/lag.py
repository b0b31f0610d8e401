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
        InvalidInputError: Gains that cannot be, or somebody who does not hear the leader, not even
            through others.
    """
    v = np.asarray(velocity, dtype=np.float64)
    laplacian, follows = _followers(gains, leader)
    others = 1.0 - np.diag(check_gains(gains))
    rest = (0.0 if told else 2.0) + others[follows] * delay
    lag = np.zeros((len(others), len(v)))
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
        InvalidInputError: As :func:`ramp_lag`, or a rate that is not positive.
    """
    if not rate > 0:
        raise InvalidInputError(f"a rate is above 0; got {rate} rad/s")
    g = check_gains(gains)
    _, follows = _followers(g, leader)
    p, d = np.asarray(path, dtype=np.complex128), np.asarray(offsets, dtype=np.complex128)
    s, late = 1j * rate, np.exp(-1j * rate * delay)
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
    return np.linalg.solve(matrix, drive) - p


def _followers(gains: ArrayLike, leader: int) -> tuple[Array, NDArray[np.int64]]:
    """I - G with rows of weights given to others alone, and who follows."""
    g = check_gains(gains)
    if not 0 <= leader < len(g):
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
    return np.eye(len(g)) - g, np.array([i for i in range(len(g)) if i != leader])
