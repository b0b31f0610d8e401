"""Selections of the table that several claims and plots share."""

import numpy as np
from numpy.typing import NDArray

from mjmr.claims import Evidence, Table
from mjmr.statistics import Estimate, paired_ratio

POINT = {"mode": "point", "scene": "tour"}
PLAIN = {**POINT, "noise": False, "fault": "none"}
NAMES = {"avoid-past": "Avoid Past", "visbug": "VisBug", "potential-field": "potential field"}


def cell(table: Table, world: str, planner: str, robots: int, reading: str) -> Table:
    """One entry of the paper's tables: the trials of a planner with a team, without noise."""
    return table.where(
        **PLAIN, world=world, planner=planner, robots=robots,
        reading="none" if robots == 1 else reading,
    )  # fmt: skip


def steps(table: Table) -> NDArray[np.float64]:
    """Steps of each task (k,), by seed."""
    found = table.by_seed("steps")
    return np.array([found[seed] for seed in sorted(found)])


def ratio(table: Table, reference: Table) -> Estimate:
    """Steps of the table's tasks against the same tasks of the reference."""
    return paired_ratio(steps(table), steps(reference))


def rise(table: Table, world: str, planner: str, reading: str) -> Evidence:
    """Largest rise of the mean with one supporter more, less one standard error.

    The error is that of the mean of the tasks' differences. The potential field is compared from
    one supporter on: alone it cannot finish.
    """
    first = 2 if planner == "potential-field" else 1
    worst, n = -np.inf, 0
    for robots in range(first, 4):
        fewer = steps(cell(table, world, planner, robots, reading))
        more = steps(cell(table, world, planner, robots + 1, reading))
        difference = more - fewer
        error = difference.std(ddof=1) / np.sqrt(len(difference)) if len(difference) > 1 else np.inf
        worst = max(worst, float((difference.mean() - error) / fewer.mean()))
        n += len(difference)
    return Evidence(worst, n=n)
