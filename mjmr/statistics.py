"""Intervals and paired tests: thin wrappers of scipy.stats, with the degenerate cases settled.

Bootstrap intervals are BCa where that is defined and percentile where it is not, with a fixed
generator, so that the same values give the same interval. Two rules scipy leaves open: values
without any spread have an interval of zero width, and a single value says nothing about spread,
so that its interval is the whole line (a claim resting on it stays inconclusive).
"""

import math
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError

RESAMPLES = 5000
Rng = int | np.random.Generator


@dataclass(frozen=True)
class Estimate:
    """A value with its interval.

    Args:
        value: The point estimate.
        low: Lower end of the interval.
        high: Upper end of the interval.
        n: Number of trials (pairs, where paired) it rests on.
    """

    value: float
    low: float
    high: float
    n: int

    @property
    def interval(self) -> tuple[float, float]:
        """``(low, high)``."""
        return self.low, self.high


def proportion(successes: ArrayLike, n: int | None = None, *, confidence: float = 0.95) -> Estimate:
    """Share of successes with Wilson's score interval.

    Args:
        successes: Booleans of shape (n,), or their count if ``n`` is given.
        n: Number of trials, if ``successes`` is a count.
        confidence: Two-sided coverage, 0 to 1.

    Raises:
        InvalidInputError: No trials, or values other than 0 and 1.

    Source: E. B. Wilson, JASA 22 (1927); scipy.stats.binomtest.
    """
    from scipy.stats import binomtest

    given = np.asarray(successes)
    if n is None:
        if not np.isin(given, (0, 1)).all():
            raise InvalidInputError("a proportion takes booleans, or a count and n")
        count, n = int(np.count_nonzero(given)), given.size
    else:
        count = int(given)
    if n < 1 or not 0 <= count <= n:
        raise InvalidInputError(f"a proportion needs 0 <= successes <= n, n >= 1: {count} of {n}")
    found = binomtest(count, n).proportion_ci(confidence, method="wilson")
    # Rounding may put the exact ends 0 and 1 a hair beside themselves.
    low = 0.0 if count == 0 else float(found.low)
    high = 1.0 if count == n else float(found.high)
    return Estimate(count / n, low, high, n)


def mean(
    values: ArrayLike, *, rng: Rng = 0, confidence: float = 0.95, resamples: int = RESAMPLES
) -> Estimate:
    """Mean with a bootstrap interval.

    Args:
        values: Shape (n,), finite.
        rng: Seed or generator of the resampling.
        confidence: Two-sided coverage, 0 to 1.
        resamples: Number of bootstrap resamples.

    Raises:
        InvalidInputError: No values, or values that are not finite.
    """
    v = _checked(values)
    return _bootstrap((v,), _mean, False, rng, confidence, resamples)


def difference_of_means(
    a: ArrayLike,
    b: ArrayLike,
    *,
    paired: bool = False,
    rng: Rng = 0,
    confidence: float = 0.95,
    resamples: int = RESAMPLES,
) -> Estimate:
    """``mean(a) - mean(b)`` with a bootstrap interval.

    Args:
        a: Shape (n,).
        b: Shape (m,); if paired, shape (n,) with ``b[i]`` of the same seed as ``a[i]``.
        paired: Resample pairs together.
        rng: Seed or generator of the resampling.
        confidence: Two-sided coverage, 0 to 1.
        resamples: Number of bootstrap resamples.

    Raises:
        InvalidInputError: No values, values that are not finite, or pairs of unequal number.
    """
    x, y = _checked_pair(a, b, paired)
    return _bootstrap((x, y), _difference, paired, rng, confidence, resamples)


def ratio_of_means(
    numerator: ArrayLike,
    denominator: ArrayLike,
    *,
    paired: bool = False,
    rng: Rng = 0,
    confidence: float = 0.95,
    resamples: int = RESAMPLES,
) -> Estimate:
    """``mean(numerator) / mean(denominator)`` with a bootstrap interval.

    Args:
        numerator: Shape (n,).
        denominator: Shape (m,), its mean not 0; if paired, shape (n,) in the same seed order.
        paired: Resample pairs together.
        rng: Seed or generator of the resampling.
        confidence: Two-sided coverage, 0 to 1.
        resamples: Number of bootstrap resamples.

    Raises:
        InvalidInputError: As for `difference_of_means`, or a denominator of mean 0.
    """
    x, y = _checked_pair(numerator, denominator, paired)
    if y.mean() == 0.0:
        raise InvalidInputError("a ratio of means needs a denominator whose mean is not 0")
    if not x.any():  # 0 whatever the denominator: resamples of it that are all 0 say nothing
        return Estimate(0.0, 0.0, 0.0, min(x.size, y.size))
    return _bootstrap((x, y), _ratio, paired, rng, confidence, resamples)


def paired_difference(a: ArrayLike, b: ArrayLike, **options: Any) -> Estimate:
    """Mean of ``a[i] - b[i]`` over seeds; see :func:`difference_of_means`."""
    return difference_of_means(a, b, paired=True, **options)


def paired_ratio(a: ArrayLike, b: ArrayLike, **options: Any) -> Estimate:
    """``mean(a) / mean(b)``, resampled over seeds; see :func:`ratio_of_means`."""
    return ratio_of_means(a, b, paired=True, **options)


def wilcoxon(a: ArrayLike, b: ArrayLike, alternative: str = "two-sided") -> float:
    """p-value of Wilcoxon's signed-rank test on pairs; 1 where every pair is equal.

    Args:
        a: Shape (n,).
        b: Shape (n,), in the same seed order.
        alternative: ``"two-sided"``, ``"less"`` (a below b) or ``"greater"``.

    Raises:
        InvalidInputError: No values, values that are not finite, or pairs of unequal number.
    """
    from scipy import stats

    x, y = _checked_pair(a, b, True)
    if np.array_equal(x, y):
        return 1.0
    return float(stats.wilcoxon(x, y, alternative=alternative).pvalue)  # pyright: ignore[reportAttributeAccessIssue]


def _checked(values: ArrayLike) -> NDArray[np.float64]:
    v = np.asarray(values, dtype=np.float64)
    if v.ndim != 1 or v.size == 0 or not np.isfinite(v).all():
        raise InvalidInputError(
            f"statistics take a list of at least one finite value; got shape {v.shape}, "
            f"{int(np.count_nonzero(~np.isfinite(v)))} of them not finite"
        )
    return v


def _checked_pair(a: ArrayLike, b: ArrayLike, paired: bool):
    x, y = _checked(a), _checked(b)
    if paired and x.size != y.size:
        raise InvalidInputError(f"pairs need as many values on both sides: {x.size} and {y.size}")
    return x, y


def _mean(a, axis):
    return np.mean(a, axis=axis)


def _difference(a, b, axis):
    return np.mean(a, axis=axis) - np.mean(b, axis=axis)


def _ratio(a, b, axis):
    return np.mean(a, axis=axis) / np.mean(b, axis=axis)


def _bootstrap(data, statistic, paired, rng, confidence, resamples) -> Estimate:
    value = float(statistic(*data, axis=-1))
    n = min(d.size for d in data)
    if n == 1:
        return Estimate(value, -math.inf, math.inf, n)
    if all(np.ptp(d) == 0.0 for d in data):
        return Estimate(value, value, value, n)
    for method in ("BCa", "percentile"):
        low, high = _interval(data, statistic, paired, rng, confidence, resamples, method)
        if not math.isnan(low) and not math.isnan(high):
            break
    return Estimate(value, low, high, n)


def _interval(data, statistic, paired, rng, confidence, resamples, method):
    from scipy.stats import bootstrap

    # A generator given is copied: BCa and percentile then see the same resamples, and the caller's
    # generator is left alone, so that claims do not depend on their order.
    bits = np.random.default_rng(rng) if isinstance(rng, int) else _copy(rng)
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        found = bootstrap(
            data,
            statistic,
            paired=paired,
            vectorized=True,
            n_resamples=resamples,
            confidence_level=confidence,
            method=method,
            rng=bits,
        ).confidence_interval
    return float(found.low), float(found.high)


def _copy(rng: np.random.Generator) -> np.random.Generator:
    bits = type(rng.bit_generator)()
    bits.state = rng.bit_generator.state
    return np.random.Generator(bits)
