"""Measures the claims of this study share."""

from collections.abc import Callable, Sequence

import numpy as np

from mjmr import statistics
from mjmr.claims import Evidence, Table

Pick = Callable[[Sequence[float]], float]
_FIRST = 6  # trials of each condition that size standard began with


def share(table: Table) -> Evidence:
    """Trials that were done, in per cent of those run, without an interval."""
    values = table.values("success")
    return Evidence(100.0 * float(np.mean(values)), n=len(values))


def share_with_interval(table: Table) -> Evidence:
    """The same with Wilson's interval."""
    estimate = statistics.proportion(table.values("success"))
    low, high = 100.0 * estimate.low, 100.0 * estimate.high
    return Evidence(100.0 * estimate.value, (low, high), estimate.n)


def first_share(table: Table) -> Evidence:
    """Share of the first six seeds of each condition that were done [%]."""
    done = _first(table)
    return Evidence(100.0 * float(np.mean(done)), n=len(done))


def gain_of_firsts(table: Table) -> Evidence:
    """Share done with recovery less that without, first six seeds, all p together [points]."""
    done = [
        _first(table.where(recovery=on, duration=d)) for on, d in ((True, 120.0), (False, 60.0))
    ]
    gain = 100.0 * (float(np.mean(done[0])) - float(np.mean(done[1])))
    return Evidence(gain, n=sum(map(len, done)))


def lesser_gain(table: Table) -> Evidence:
    """The same with every seed, the lesser one over p [points]."""
    table.values("success")  # says so if there are no trials
    gains = []
    for _, part in table.split("p"):
        with_it = part.where(recovery=True, duration=120.0).values("success")
        without = part.where(recovery=False, duration=60.0).values("success")
        gains.append(100.0 * (float(np.mean(with_it)) - float(np.mean(without))))
    return Evidence(min(gains), n=len(table))


def extreme(metric: str, pick: Pick) -> Callable[[Table], Evidence]:
    """The largest or least value of a metric, as ``pick`` has it, over all trials."""

    def evaluate(table: Table) -> Evidence:
        values = table.values(metric)
        return Evidence(float(pick(values.tolist())), n=len(values))

    return evaluate


def extreme_share(pick: Pick, *names: str) -> Callable[[Table], Evidence]:
    """The largest or least share of trials done [%] over the values of some parameters."""

    def shares(table: Table, left: Sequence[str]) -> list[float]:
        if not left:
            return [share(table).measured or 0.0]
        return [s for _, part in table.split(left[0]) for s in shares(part, left[1:])]

    def evaluate(table: Table) -> Evidence:
        table.values("success")  # says so if there are no trials
        return Evidence(pick(shares(table, names)), n=len(table))

    return evaluate


def median(metric: str) -> Callable[[Table], Evidence]:
    """Median of a metric over all trials."""

    def evaluate(table: Table) -> Evidence:
        values = table.values(metric)
        return Evidence(float(np.median(values)), n=len(values))

    return evaluate


def _first(table: Table) -> np.ndarray:
    return table.values("success")[table.seeds < _FIRST]
