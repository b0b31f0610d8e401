"""Measures the claims of this study share."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mjmr import statistics
from mjmr.claims import Evidence
from mjmr.table import Table

Array = NDArray[np.float64]
PLAIN = {
    "margin_deg": 35.0, "avoid_deg": 20.0, "forced": 1, "compass": "card", "compass_deg": 2.0,
    "servo_pct": 5.0, "bit_error": 0.0, "check": "crc8", "vector": "scout", "succession": "none",
    "failure": "none",
}  # fmt: skip
"""The card's values of everything a maze is run with."""
_RESAMPLES = 5000


def successes(table: Table) -> Evidence:
    """Share of trials whose worker arrived, with Wilson's interval."""
    return Evidence.of(statistics.proportion(table.values("success")))


def ratio_of_medians(table: Table) -> Evidence:
    """Median time of workers that arrived over that of their scouts, resampled over seeds."""
    worker, scout = table.values("worker_s"), table.values("scout_s")
    both = np.isfinite(worker) & np.isfinite(scout)
    worker, scout = worker[both], scout[both]
    ratio = float(np.median(worker) / np.median(scout))
    low, high = _resampled(
        lambda k: np.median(worker[k], axis=1) / np.median(scout[k], axis=1), len(worker)
    )
    missing = f"{int((~both).sum())} of {len(both)} runs without either left out"
    return Evidence(ratio, (low, high), len(worker), missing if not both.all() else "")


def median_of(metric: str):
    """Median of a metric where it is there, resampled over seeds."""

    def evaluate(table: Table) -> Evidence:
        values = table.values(metric)
        values = values[np.isfinite(values)]
        interval = _resampled(lambda k: np.median(values[k], axis=1), len(values))
        return Evidence(float(np.median(values)), interval, len(values))

    return evaluate


def extreme(metric: str, largest: bool = True):
    """Largest (or least) value of a metric over all trials; exact."""

    def evaluate(table: Table) -> Evidence:
        values = table.values(metric)
        if not np.isfinite(values).all():
            return Evidence.untestable(f"{metric} is missing in some trials")
        return Evidence(float(values.max() if largest else values.min()), n=len(values))

    return evaluate


def total(metric: str):
    """Sum of a metric over all trials; exact."""

    def evaluate(table: Table) -> Evidence:
        values = table.values(metric)
        return Evidence(float(values.sum()), n=len(values))

    return evaluate


def mean_of(metric: str):
    """Mean of a metric with a bootstrap interval."""
    return lambda table: Evidence.of(statistics.mean(table.values(metric)))


def points_lost(table: Table, whole: dict[str, Any], worse: dict[str, Any]) -> Evidence:
    """Share of successes of one condition minus that of another, paired by maze and seed.

    Seeds that one of the two was not run with do not count.
    """
    a, b = [], []
    for _, rows in table.split("maze"):
        one = rows.where(**whole).by_seed("success")
        other = rows.where(**worse).by_seed("success")
        common = sorted(set(one) & set(other))
        a += [float(one[s]) for s in common]
        b += [float(other[s]) for s in common]
    if not a:
        return Evidence.untestable("no runs of both kinds")
    return Evidence.of(statistics.paired_difference(a, b))


def _resampled(statistic, n: int) -> tuple[float, float]:
    if n == 1:
        return -np.inf, np.inf
    draws = np.random.default_rng(0).integers(n, size=(_RESAMPLES, n))
    low, high = np.percentile(statistic(draws), [2.5, 97.5])
    return float(low), float(high)
