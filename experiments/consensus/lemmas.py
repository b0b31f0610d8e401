"""Lemmas 2.1 to 2.3 on random matrices."""

import numpy as np
from numpy.typing import NDArray

from controllers.consensus import CanonicalModel, delta, reducible

Array = NDArray[np.float64]
_CASES = 400
_PRODUCTS = 300


def lemmas(rng: np.random.Generator) -> dict[str, float | int | str | bool | None]:
    """Counts of random cases that agree with each lemma.

    Returns:
        ``cases`` and ``agree_21``: whether the chain matrix of mixed relative degrees is
        irreducible exactly if E is; ``irreducible`` of them were; ``delta_22`` and ``weight_22``:
        how far products of lower-triangular matrices are from 1 c, and what c gives to later
        groups; ``delta_23`` the same with other matrices in between.
    """
    agree = irreducible = 0
    for _ in range(_CASES):
        q = int(rng.integers(2, 8))
        e = np.where(rng.uniform(size=(q, q)) < rng.uniform(0.1, 0.7), rng.uniform(size=(q, q)), 0)
        e[np.arange(q), rng.integers(q, size=q)] += 0.1  # no row is empty
        e /= e.sum(axis=1, keepdims=True)
        whole = CanonicalModel(rng.integers(1, 4, q)).expanded(e)
        agree += reducible(e > 0) == reducible(whole > 0)
        irreducible += not reducible(e > 0)
    sizes = rng.integers(1, 4, 3)
    product, mixed = np.eye(sizes.sum()), np.eye(sizes.sum())
    for _ in range(_PRODUCTS):
        step = _triangular(sizes, rng)
        product, mixed = step @ product, step @ mixed
        mixed = _positive_diagonal(len(mixed), rng) @ mixed
    return {
        "cases": _CASES,
        "agree_21": agree,
        "irreducible": irreducible,
        "delta_22": delta(product),
        "weight_22": float(product[:, sizes[0] :].max()),
        "delta_23": delta(mixed),
    }


def _triangular(sizes: NDArray[np.int64], rng: np.random.Generator) -> Array:
    """Row-stochastic, lower block-triangular; P_ii >= eps J, a nonzero earlier block a row."""
    ends = np.cumsum(sizes)
    matrix = np.zeros((ends[-1], ends[-1]))
    for k, end in enumerate(ends):
        own = slice(end - sizes[k], end)
        matrix[own, own] = rng.uniform(0.1, 1.0, (sizes[k], sizes[k]))
        if k:
            other = int(rng.integers(k))
            earlier = slice(ends[other] - sizes[other], ends[other])
            matrix[own, earlier] = rng.uniform(0.1, 1.0, (sizes[k], sizes[other]))
    return matrix / matrix.sum(axis=1, keepdims=True)


def _positive_diagonal(size: int, rng: np.random.Generator) -> Array:
    matrix = np.where(rng.uniform(size=(size, size)) < 0.2, rng.uniform(size=(size, size)), 0.0)
    matrix += np.eye(size) * rng.uniform(0.5, 1.0, size)
    return matrix / matrix.sum(axis=1, keepdims=True)
