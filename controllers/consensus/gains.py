"""Gain matrices: who is weighted how much, row-stochastic and zero where nobody is heard.

Source: Qu, Wang and Hull, section 2 and Assumption 4.1: gains are nonnegative, each row sums to
one, and G_ij is zero unless i hears j (S_ij = 1; S_ii = 1).
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.finite import numbers

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
_SUM_TOLERANCE = 1e-9


def as_array(values: ArrayLike, dtype: type, what: str) -> NDArray:
    """An array of its own.

    Raises:
        InvalidInputError: Ragged rows, or entries that are no numbers.
    """
    found = numbers(values, dtype)
    if found is None:
        raise InvalidInputError(f"{what} are numbers in rows of one length")
    return found


def check_gains(gains: ArrayLike, q: int | None = None, heard: ArrayLike | None = None) -> Array:
    """Gains (q, q) as an array, if they are what the theory asks for.

    Args:
        gains: Row i: the weights system i gives to all, itself included.
        q: Systems there are; None: any.
        heard: Flags (q, q) of who hears whom; None: not looked at.

    Raises:
        InvalidInputError: Another shape, a negative entry, a row that does not sum to one, or a
            weight of somebody who is not heard; says which.
    """
    g = as_array(gains, np.float64, "gains")
    if g.ndim != 2 or g.shape[0] != g.shape[1] or (q is not None and len(g) != q):
        size = "(q, q)" if q is None else f"({q}, {q})"
        raise InvalidInputError(f"gains have shape {size}; got {g.shape}")
    if not np.isfinite(g).all() or (g < 0).any():
        i, j = np.argwhere(~(g >= 0) | ~np.isfinite(g))[0]
        raise InvalidInputError(f"gains are 0 or more and finite; row {i} gives {j} {g[i, j]:g}")
    sums = g.sum(axis=1)
    off = np.flatnonzero(np.abs(sums - 1.0) > _SUM_TOLERANCE)
    if len(off):
        raise InvalidInputError(
            f"each row of gains sums to one; row {off[0]} sums to {sums[off[0]]:.12g}"
        )
    if heard is not None:
        deaf = (g > 0) & ~graph(heard, len(g))
        if deaf.any():
            i, j = np.argwhere(deaf)[0]
            raise InvalidInputError(f"row {i} weights {j}, whom it does not hear")
    return g


def graph(heard: ArrayLike, q: int | None = None) -> Flags:
    """Who hears whom as flags (q, q) with everybody hearing itself.

    Raises:
        InvalidInputError: Another shape.
    """
    flags = as_array(heard, bool, "the flags of a graph")
    if flags.ndim != 2 or flags.shape[0] != flags.shape[1] or (q is not None and len(flags) != q):
        size = "(q, q)" if q is None else f"({q}, {q})"
        raise InvalidInputError(f"a graph has shape {size}; got {flags.shape}")
    np.fill_diagonal(flags, True)
    return flags


def equal_gains(heard: ArrayLike) -> Array:
    """Every system weights all it hears alike, itself included: S over its row sums (q, q)."""
    flags = graph(heard).astype(np.float64)
    return flags / flags.sum(axis=1, keepdims=True)


def neighbour_gains(heard: ArrayLike, weight: float) -> Array:
    """Every system shares ``weight`` among the others it hears and keeps the rest for itself.

    The paper's example: a follower weights its predecessor 0.2 and itself 0.8, who hears nobody
    itself 1.

    Args:
        heard: Flags (q, q).
        weight: In [0, 1].

    Raises:
        InvalidInputError: A weight outside [0, 1].
    """
    if not 0 <= weight <= 1:
        raise InvalidInputError(f"the weight of neighbours is 0 to 1; got {weight}")
    others = graph(heard).astype(np.float64)
    np.fill_diagonal(others, 0.0)
    count = others.sum(axis=1, keepdims=True)
    gains = weight * others / np.maximum(count, 1.0)
    np.fill_diagonal(gains, 1.0 - gains.sum(axis=1))
    return gains


def metropolis_gains(heard: ArrayLike) -> Array:
    """Doubly stochastic weights of an undirected graph (q, q): products tend to the average.

    Source: L. Xiao, S. Boyd, S. Lall, A scheme for robust distributed sensor fusion based on
    average consensus, IPSN 2005, *Metropolis weights*.

    Raises:
        InvalidInputError: Somebody hears one who does not hear it.
    """
    flags = graph(heard)
    if (flags != flags.T).any():
        i, j = np.argwhere(flags & ~flags.T)[0]
        raise InvalidInputError(
            f"average consensus needs links both ways; {i} hears {j}, who does not hear it"
        )
    degree = flags.sum(axis=1) - 1
    gains = np.where(flags, 1.0 / (1.0 + np.maximum(degree[:, None], degree[None])), 0.0)
    np.fill_diagonal(gains, 0.0)
    np.fill_diagonal(gains, 1.0 - gains.sum(axis=1))
    return gains
