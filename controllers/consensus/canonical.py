"""The canonical model of cooperative systems, and its exact motion while the graph is constant.

Source: Z. Qu, J. Wang and R. A. Hull, Multi-Objective Cooperative Control of Dynamical Systems,
section 2. Every system i is, channel by channel, a chain of l_i first-order lags whose last input
is u_i: stage p follows stage p + 1 at rate 1, the output is the first stage. With outputs weighted
by a row-stochastic gain, u_i = sum_j G_ij y_j, the whole is dx/dt = (-I + D) x with a D that is
row-stochastic too, so that all stages of a channel tend to one value if the graph allows it.

Here channels are the last axis and stages of all systems are stacked: robots with different
relative degrees fit side by side.
"""

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.consensus.gains import as_array, check_gains
from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class CanonicalModel:
    """q systems of relative degrees l_i with m channels each.

    Attributes:
        degrees: Relative degree l_i of each system (q,), 1 or more.
    """

    degrees: NDArray[np.int64]

    def __init__(self, degrees: ArrayLike):
        """Args: see the class.

        Raises:
            InvalidInputError: No system, or a degree that is no whole number above 0 (which).
        """
        given = np.atleast_1d(np.asarray(degrees))
        if given.ndim != 1 or not len(given):
            raise InvalidInputError(f"degrees have shape (q,), q >= 1; got {given.shape}")
        bad = np.flatnonzero((given < 1) | (given != np.floor(given)))
        if len(bad):
            raise InvalidInputError(
                f"relative degrees are whole numbers, 1 or more; system {bad[0]} has "
                f"{given[bad[0]]}"
            )
        object.__setattr__(self, "degrees", given.astype(np.int64))

    @property
    def q(self) -> int:
        """Systems."""
        return len(self.degrees)

    @property
    def outputs(self) -> NDArray[np.int64]:
        """Rows of the first stages in the stacked state (q,)."""
        return np.concatenate([[0], np.cumsum(self.degrees)[:-1]])

    def start(self, positions: ArrayLike, velocities: ArrayLike | None = None) -> Array:
        """Stacked state (sum l, m) of systems with these outputs and output rates.

        The first stage is the output y, the second y + dy/dt, and so on; rates beyond the second
        stage are taken as those of a constant: all further stages equal the second.

        Args:
            positions: Outputs (q, m).
            velocities: Their rates (q, m), for systems of degree 2 or more; None: at rest.
        """
        y = np.asarray(positions, dtype=np.float64)
        rate = np.zeros_like(y) if velocities is None else np.asarray(velocities, dtype=np.float64)
        if y.ndim != 2 or len(y) != self.q or rate.shape != y.shape:
            raise InvalidInputError(
                f"positions and velocities have shape ({self.q}, m); got {y.shape}, {rate.shape}"
            )
        stages = [np.tile(y[i] + rate[i], (degree, 1)) for i, degree in enumerate(self.degrees)]
        state = np.concatenate(stages)
        state[self.outputs] = y
        return state

    def expanded(self, gains: ArrayLike) -> Array:
        """Row-stochastic D (sum l, sum l) of one channel: equation 8's blocks.

        Args:
            gains: Of that channel (q, q), rows summing to one.
        """
        g = check_gains(gains, self.q)
        first, size = self.outputs, int(self.degrees.sum())
        table = np.zeros((size, size))
        last = first + self.degrees - 1
        rows = np.setdiff1d(np.arange(size), last)
        table[rows, rows + 1] = 1.0
        table[np.ix_(last, first)] = g
        return table

    def transition(self, gains: ArrayLike, duration: float) -> Array:
        """P = exp(-(I - D) t) (sum l, sum l) of one channel; row-stochastic, positive diagonal.

        Args:
            gains: Of that channel (q, q).
            duration: t [s].

        Returns:
            Not to be written to: it is kept for the next time.
        """
        table = self.expanded(gains)
        return _exponential(table.tobytes(), len(table), float(duration))

    def advance(self, state: Array, gains: ArrayLike, duration: float) -> Array:
        """State after the gains were constant for a time, exactly.

        Args:
            state: Stacked (sum l, m).
            gains: (q, q) for all channels alike, or (m, q, q).
            duration: [s].

        Raises:
            InvalidInputError: A state or gains of another shape, or gains that cannot be.
        """
        state = self._state(state)
        g = self._gains(gains, state.shape[1])
        if g.ndim == 2:
            return self.transition(g, duration) @ state
        columns = [self.transition(own, duration) @ state[:, s] for s, own in enumerate(g)]
        return np.stack(columns, axis=1)

    def input_of(self, state: Array, gains: ArrayLike) -> Array:
        """u_i = sum_j G_ij y_j (q, m) in a state; gains and errors as in :meth:`advance`."""
        y = self._state(state)[self.outputs]
        g = self._gains(gains, y.shape[1])
        for own in g if g.ndim == 3 else g[None]:
            check_gains(own, self.q)
        return g @ y if g.ndim == 2 else np.einsum("sij,js->is", g, y)

    def _state(self, state: ArrayLike) -> Array:
        given, size = as_array(state, np.float64, "states"), int(self.degrees.sum())
        if given.ndim != 2 or len(given) != size:
            raise InvalidInputError(f"a stacked state has shape ({size}, m); got {given.shape}")
        return given

    def _gains(self, gains: ArrayLike, channels: int) -> Array:
        g, q = as_array(gains, np.float64, "gains"), self.q
        if g.shape not in ((q, q), (channels, q, q)):
            raise InvalidInputError(
                f"gains of {channels} channels have shape ({q}, {q}) or ({channels}, {q}, {q}); "
                f"got {g.shape}"
            )
        return g


@functools.lru_cache(maxsize=64)
def _exponential(table: bytes, size: int, duration: float) -> Array:
    """exp(-(I - D) t) of the bytes of D (size, size)."""
    rates = np.frombuffer(table).reshape(size, size) - np.eye(size)
    from scipy.linalg import expm

    found = np.asarray(expm(rates * duration), dtype=np.float64)
    found.setflags(write=False)
    return found


def spread(positions: ArrayLike) -> float:
    """Largest distance between two of the points (q, m)."""
    y = np.asarray(positions, dtype=np.float64)
    return float(np.sqrt(((y[:, None] - y[None]) ** 2).sum(axis=2)).max())


def delta(matrix: ArrayLike) -> float:
    """Largest difference between two entries of a column: 0 iff all rows are alike (section 2)."""
    e = np.asarray(matrix, dtype=np.float64)
    return float((e.max(axis=0) - e.min(axis=0)).max())


def overlap_coefficient(matrix: ArrayLike) -> float:
    """lambda(E) = 1 - min over row pairs of sum_j min(E_ij, E_kj): below 1 it contracts."""
    e = np.asarray(matrix, dtype=np.float64)
    shared = np.minimum(e[:, None], e[None]).sum(axis=2)
    return float(1.0 - shared.min())
