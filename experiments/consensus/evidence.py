"""Measures the claims of this study share."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from mjmr import statistics
from mjmr.claims import Evidence
from mjmr.table import Table

Measure = Callable[[Table], Evidence]
SEEN_BEFORE = 6
"""Seeds of runs by sight when their shares were first decided."""


def largest(metric: str) -> Measure:
    """Largest value of a metric over all trials; exact. NaN in one makes it infinite."""

    def evaluate(table: Table) -> Evidence:
        values = np.asarray(table.values(metric), dtype=np.float64)
        values = np.where(np.isnan(values), np.inf, values)
        return Evidence(float(values.max()), n=len(values))

    return evaluate


def least(metric: str) -> Measure:
    """Least value of a metric over all trials; exact. NaN in one makes it minus infinite."""

    def evaluate(table: Table) -> Evidence:
        values = np.asarray(table.values(metric), dtype=np.float64)
        values = np.where(np.isnan(values), -np.inf, values)
        return Evidence(float(values.min()), n=len(values))

    return evaluate


def total(metric: str) -> Measure:
    """Sum of a metric over all trials; exact."""

    def evaluate(table: Table) -> Evidence:
        values = np.asarray(table.values(metric), dtype=np.float64)
        return Evidence(float(values.sum()), n=len(values))

    return evaluate


def mean(metric: str) -> Measure:
    """Mean of a metric with a bootstrap interval."""
    return lambda table: Evidence.of(statistics.mean(table.values(metric)))


def share(metric: str, most: float) -> Measure:
    """Share of trials whose metric is at most ``most``, with Wilson's interval; NaN is not."""

    def evaluate(table: Table) -> Evidence:
        values = np.asarray(table.values(metric), dtype=np.float64)
        return Evidence.of(statistics.proportion(values <= most))

    return evaluate


def first(measure: Measure) -> Measure:
    """A measure over the seeds that were run when its claim was first decided."""
    return lambda table: measure(table.where_seed(below=SEEN_BEFORE))


def unseen(measure: Measure) -> Measure:
    """A measure over the seeds that came after them."""
    return lambda table: measure(table.where_seed(least=SEEN_BEFORE))


def outside(metric: str, low: float, high: float) -> Measure:
    """How far a metric is outside of a range, largest; exact. NaN in one makes it infinite."""

    def evaluate(table: Table) -> Evidence:
        values = np.asarray(table.values(metric), dtype=np.float64)
        values = np.where(np.isnan(values), np.inf, values)
        off = np.maximum(np.maximum(low - values, values - high), 0.0)
        return Evidence(float(off.max()), n=len(values))

    return evaluate


def off(wanted: dict[float, tuple[float, float]]) -> Measure:
    """Largest distance of the consensus point from a table by dwell [m]."""

    def evaluate(table: Table) -> Evidence:
        errors = []
        for dwell, (x, y) in wanted.items():
            rows = table.where(dwell=dwell)
            errors += list(np.hypot(rows.values("x_m") - x, rows.values("y_m") - y))
        return Evidence(float(max(errors)), n=len(errors))

    return evaluate


def off_point(x: float, y: float) -> Measure:
    """Largest distance of the consensus point from one place [m]."""

    def evaluate(table: Table) -> Evidence:
        found = np.hypot(table.values("x_m") - x, table.values("y_m") - y)
        return Evidence(float(found.max()), n=len(found))

    return evaluate


def off_values(metric: str, by: str, wanted: Mapping[Any, float]) -> Measure:
    """Largest difference of a metric from what is wanted for each value of a parameter."""

    def evaluate(table: Table) -> Evidence:
        errors: list[float] = []
        for value, number in wanted.items():
            errors += list(np.abs(table.where(**{by: value}).values(metric) - number))
        return Evidence(float(max(errors)), n=len(errors))

    return evaluate
