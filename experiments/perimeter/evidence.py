"""Measures the claims of this study share."""

from collections.abc import Callable

import numpy as np

from mjmr import statistics
from mjmr.claims import Evidence, Table
from mjmr.errors import InvalidInputError

Test = Callable[[Table], np.ndarray]


def share(test: Test) -> Callable[[Table], Evidence]:
    """Trials that pass a test, in per cent of those run, without an interval."""

    def evaluate(table: Table) -> Evidence:
        passed = test(table)
        return Evidence(100.0 * float(np.mean(passed)), n=len(passed))

    return evaluate


def share_interval(test: Test) -> Callable[[Table], Evidence]:
    """The same in per cent with Wilson's interval: what is known of seeds that were not run."""

    def evaluate(table: Table) -> Evidence:
        found = statistics.proportion(test(table))
        low, high = found.interval
        return Evidence(100.0 * found.value, (100.0 * low, 100.0 * high), found.n)

    return evaluate


def extreme(metric: str, pick: Callable = max) -> Callable[[Table], Evidence]:
    """The largest or least value of a metric over all trials; unmeasured ones (-1) are an error."""

    def evaluate(table: Table) -> Evidence:
        values = table.values(metric)
        missing = int(np.count_nonzero(values == -1.0))
        if missing:
            return Evidence.untestable(f"{missing} of {len(values)} trials measured no {metric}")
        return Evidence(float(pick(values.tolist())), n=len(values))

    return evaluate


def total(metric: str) -> Callable[[Table], Evidence]:
    """Sum of a metric over all trials."""

    def evaluate(table: Table) -> Evidence:
        values = table.values(metric)
        return Evidence(float(values.sum()), n=len(values))

    return evaluate


def joined_and_found(table: Table) -> np.ndarray:
    """All track; at least one was told and one found it alone."""
    told, own = table.values("by_relay") >= 1, table.values("own_finders") >= 1
    return table.values("all_track").astype(bool) & told & own


def untouched(table: Table) -> np.ndarray:
    """No contact of trucks with each other, with walls or with the spill."""
    contacts, obstacles = table.values("contacts"), table.values("obstacle_contact_s")
    if (contacts < 0).any():
        raise InvalidInputError("bodies without contact have none to count")
    return (contacts == 0) & (obstacles == 0.0)


def flags(metric: str, wanted: bool = True) -> Test:
    """Whether a metric is true, or not."""
    return lambda table: table.values(metric).astype(bool) == wanted


def both(first: Test, second: Test) -> Test:
    """Whether two tests pass."""
    return lambda table: first(table) & second(table)


def gain_of_radio(table: Table) -> Evidence:
    """Mean time until all track without a radio less that with one of 25 m, paired by seed [s].

    Trials in which not all track count with their whole duration.
    """
    without, with_it = table.where(d_com=0.0).pair(table.where(d_com=25.0), "last_joined_s")
    return Evidence.of(statistics.paired_difference(without, with_it))
