"""States and the team's radio graph over time, joining, and spacing, as plots."""

from pathlib import Path
from typing import Any

import numpy as np

from controllers.perimeter.states import STATES
from experiments.perimeter.sizes import LONG
from mjmr import statistics
from mjmr.plot import figure, flag_rows, interval_line
from mjmr.table import Table

_COLOURS = ("0.8", "tab:orange", "tab:cyan", "tab:blue")


def plots(table: Table, folder: Path) -> list[Path]:
    """Write every plot the table has trials for; returns the files."""
    written = []
    joins = table.where(mode="physical", failure="none")
    for task in ("join", "stay"):
        rows = joins.where(task=task)
        if rows.finished:
            written += [_states(rows, folder, task), _graph(rows, folder, task)]
    sweep = table.where(task="stay", mode="unicycle", robots=5, growth=0.0, duration=600.0)
    if sweep.finished and len(sweep.distinct("factor")) > 2:
        written.append(_spacing(sweep, folder))
    counts = table.where(task="stay", mode="unicycle", factor=0.0, growth=0.0, duration=LONG)
    if counts.finished and len(counts.distinct("robots")) > 2:
        written.append(_counts(counts, folder))
    ranges = table.where(task="join", mode="unicycle")
    if ranges.finished and len(ranges.distinct("d_com")) > 1:
        written.append(_ranges(ranges, folder))
    return written


def _states(rows: Table, folder: Path, task: str) -> Path:
    path = folder / f"states-{task}.svg"
    told, end = rows.values("states")[0], float(rows.values("time_s")[0])
    title = f"States of the trucks, first trial ({task})"
    with figure(path, title, "time [s]", "truck") as axes:
        shown = set()
        for robot, times, states in _runs(str(told)):
            ends = [*times[1:], end]
            for start, stop, state in zip(times, ends, states, strict=True):
                label = None if state in shown else STATES[state]
                shown.add(state)
                axes.barh(
                    robot, stop - start, left=start, height=0.7, color=_COLOURS[state], label=label
                )
        axes.legend(loc="upper center", ncols=4, bbox_to_anchor=(0.5, -0.16))
        axes.set_xlim(0, end)
        axes.invert_yaxis()
    return path


def _graph(rows: Table, folder: Path, task: str) -> Path:
    """A row for every pair of trucks, drawn while one of the two hears the other."""
    path = folder / f"graph-{task}.svg"
    told, end = str(rows.values("heard")[0]), float(rows.values("time_s")[0])
    spans = []
    for entry in told.split():
        pair, times = entry.split(":")
        start, stop = (float(t) for t in times.split("-"))
        spans.append((pair, start, stop))
    pairs = sorted({pair for pair, *_ in spans})
    times = sorted({0.0, end, *(t for _, *ends in spans for t in ends)})
    flags = np.zeros((len(times), len(pairs)), dtype=bool)
    for pair, start, stop in spans:
        flags[times.index(start) : times.index(stop), pairs.index(pair)] = True
    title = (
        f"Radio graph: pairs of whom one heard the other in the last second, first trial ({task})"
    )
    with figure(path, title, "time [s]", "pair of trucks") as axes:
        flag_rows(axes, times, flags, pairs)
        axes.set_xlim(0, end)
    return path


def _spacing(rows: Table, folder: Path) -> Path:
    path = folder / "spacing.svg"
    title = f"d_des on unicycle bodies, static disc of 10 m ({rows.finished} runs)"
    with figure(path, title, "d_des / even chord", "largest gap / mean gap") as axes:
        found = {float(f): part for f, part in rows.split("factor") if float(f) > 0}
        order = sorted(found)
        gaps = [statistics.mean(found[f].values("gap_ratio")) for f in order]
        interval_line(axes, order, gaps, "largest gap, mean")
        moving = [float(np.mean(found[f].values("moving_share"))) for f in order]
        axes.plot(order, moving, marker="s", label="share of the last 30 s in which anybody moves")
        axes.axhline(1.1, color="0.6", linewidth=1)
        axes.legend()
    return path


def _counts(rows: Table, folder: Path) -> Path:
    path = folder / "robots.svg"
    title = f"Until the team stands still, unicycle bodies, static disc of 10 m ({rows.finished})"
    with figure(path, title, "robots", "time [s]") as axes:
        found: dict[int, Any] = {int(n): part for n, part in rows.split("robots")}
        order = sorted(found)
        times = [statistics.mean(found[n].values("stopped_at_s")) for n in order]
        interval_line(axes, order, times, "mean; two stand unevenly: no chord exceeds the diameter")
        axes.axhline(LONG, color="0.6", linewidth=1, label="end of the runs")
        axes.legend()
    return path


def _ranges(rows: Table, folder: Path) -> Path:
    path = folder / "radio-range.svg"
    title = f"Until some of five track, unicycle bodies ({rows.finished} runs, at most 900 s)"
    with figure(path, title, "range of the radio [m]", "time [s]") as axes:
        found: dict[float, Any] = {float(r): part for r, part in rows.split("d_com")}
        order = sorted(found)
        for k in (1, 3, 5):
            times = [statistics.mean(_until(found[r], k)) for r in order]
            interval_line(axes, list(range(len(order))), times, f"until {k} track, mean")
        axes.legend()
        axes.set_xticks(range(len(order)), [f"{r:g}" for r in order])
    return path


def _until(rows: Table, k: int) -> np.ndarray:
    """When the k-th robot joined [s], of every trial; the end where it never did."""
    joins = [[float(t) for t in str(told).split()] for told in rows.values("joins")]
    ends = rows.values("time_s")
    return np.array([t[k - 1] if len(t) >= k else e for t, e in zip(joins, ends, strict=True)])


def _runs(told: str) -> list[tuple[int, list[float], list[int]]]:
    """Robot, instants and states of what :class:`Log` wrote."""
    found = []
    for entry in told.split():
        robot, rest = entry.split(":")
        steps = [step.split("@") for step in rest.split(",")]
        found.append((int(robot), [float(t) for _, t in steps], [int(s) for s, _ in steps]))
    return found
