import math

import numpy as np
import pytest

from mjmr import statistics
from mjmr.errors import InvalidInputError


def wilson(k, n, z=1.959963984540054):
    p = k / n
    middle = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / (1 + z * z / n)
    return max(0.0, middle - half), min(1.0, middle + half)


@pytest.mark.parametrize(("k", "n"), [(0, 10), (10, 10), (1, 1), (7, 12), (250, 1000)])
def test_wilson_interval_is_the_closed_form(k, n):
    found = statistics.proportion(k, n)
    assert found.value == k / n
    assert found.interval == pytest.approx(wilson(k, n), abs=1e-12)
    flags = statistics.proportion(np.arange(n) < k)
    assert flags == found


def test_wilson_ends_are_exact_where_everything_agrees():
    assert statistics.proportion(10, 10).high == 1.0
    assert statistics.proportion(0, 10).low == 0.0


def test_bootstrap_intervals_cover_at_their_confidence():
    generator = np.random.default_rng(1)
    inside = 0
    for _ in range(100):
        sample = generator.exponential(1.0, 40)
        found = statistics.mean(sample, resamples=500)
        inside += found.low <= 1.0 <= found.high
    assert 86 <= inside <= 100


def test_intervals_do_not_depend_on_what_was_drawn_before():
    values = np.random.default_rng(0).normal(size=30)
    generator = np.random.default_rng(5)
    np.random.seed(1)  # noqa: NPY002
    first = statistics.mean(values, rng=generator)
    np.random.random(100)  # noqa: NPY002
    assert statistics.mean(values, rng=generator) == first
    assert statistics.mean(values, rng=5) == first
    assert statistics.mean(values, rng=6) != first


def test_pairing_removes_what_pairs_share():
    generator = np.random.default_rng(0)
    shared = generator.normal(0.0, 10.0, 50)
    a, b = shared + 1.0 + generator.normal(0, 0.1, 50), shared + generator.normal(0, 0.1, 50)
    paired = statistics.paired_difference(a, b)
    unpaired = statistics.difference_of_means(a, b)
    assert 0.9 < paired.low < 1.0 < paired.high < 1.1
    assert unpaired.low < 0.0 < unpaired.high
    assert statistics.paired_ratio(3.0 * b + 600, b + 200).value == pytest.approx(3.0)
    assert statistics.wilcoxon(a, b) < 1e-6
    assert statistics.wilcoxon(a, b, "less") > 0.5
    assert statistics.wilcoxon(a, a) == 1.0


def test_ratio_of_means():
    generator = np.random.default_rng(0)
    found = statistics.ratio_of_means(generator.normal(2, 0.1, 100), generator.normal(8, 0.1, 80))
    assert found.low < 0.25 < found.high
    assert found.high - found.low < 0.02
    assert found.n == 80


def test_values_without_spread_have_an_interval_without_width():
    assert statistics.mean([0.0] * 40).interval == (0.0, 0.0)
    assert statistics.ratio_of_means([0.0] * 4, [2.0] * 4).interval == (0.0, 0.0)


def test_one_value_says_nothing_about_spread():
    assert statistics.mean([3.0]).interval == (-math.inf, math.inf)


def test_one_constant_side_still_gives_an_interval():
    found = statistics.ratio_of_means([0.0] * 20, np.linspace(1.0, 2.0, 20))
    assert found.interval == (0.0, 0.0)
    found = statistics.paired_difference(np.linspace(1.0, 2.0, 20), [0.0] * 20)
    assert 1.0 < found.low < 1.5 < found.high < 2.0


@pytest.mark.parametrize(
    "call",
    [
        lambda: statistics.mean([]),
        lambda: statistics.mean([1.0, math.nan]),
        lambda: statistics.mean([1.0, math.inf]),
        lambda: statistics.mean([[1.0]]),
        lambda: statistics.proportion(3, 2),
        lambda: statistics.proportion(0, 0),
        lambda: statistics.proportion([0.5]),
        lambda: statistics.paired_difference([1.0], [1.0, 2.0]),
        lambda: statistics.ratio_of_means([1.0], [0.0, 0.0]),
    ],
)
def test_what_has_no_answer_is_refused(call):
    with pytest.raises(InvalidInputError):
        call()


def test_a_ratio_of_nothing_to_something_is_exactly_zero():
    """Even where most denominators are 0, so that some resamples of them are all 0."""
    found = statistics.paired_ratio(np.zeros(24), np.array([0.0] * 22 + [3.0, 5.0]))
    assert (found.value, found.interval, found.n) == (0.0, (0.0, 0.0), 24)
