"""Least distance over time, time until all are home, and what a tick costs."""

from pathlib import Path

import numpy as np

from experiments.safety_filter.measures import SERIES
from mjmr import statistics
from mjmr.plot import figure, interval_line
from mjmr.table import Table

# method, rule: label
_SHOWN = {
    ("none", False): "straight to the goal",
    ("consensus", False): "plain consensus",
    ("barrier", False): "barrier, no rule",
    ("barrier", True): "barrier",
    ("search", False): "velocity search, no rule",
    ("search", True): "velocity search",
}


def plots(table: Table, folder: Path) -> list[Path]:
    """Write every plot the table has trials for; returns the files."""
    written = []
    for scene in ("swap", "symmetric"):
        rows = table.where(scene=scene, robots=10, sigma_mm=0.0)
        if rows.finished:
            written.append(_distances(rows, scene, folder))
    swaps = table.where(scene="swap", sigma_mm=0.0, right=True)
    if swaps.finished and len(swaps.distinct("robots")) > 1:
        written.append(_cost(swaps, folder))
    return written


def _series(rows: Table) -> np.ndarray:
    """Least distances (runs, k) [m], NaN after a run's end."""
    runs = [np.array([float(v) for v in text.split()]) for text in rows.values("least_cm")]
    found = np.full((len(runs), max(map(len, runs))), np.nan)
    for row, run in zip(found, runs, strict=True):
        row[: len(run)] = run / 100
    return found


def _distances(rows: Table, scene: str, folder: Path) -> Path:
    path = folder / f"distance-{scene}.svg"
    title = f"Least distance of two hands, ten robots, {scene}: median and range of runs"
    with figure(path, title, "time [s]", "least distance [m]") as axes:
        for (method, right), label in _SHOWN.items():
            at = rows.where(method=method, right=right)
            if not at.finished:
                continue
            found = _series(at)
            time = SERIES * (1 + np.arange(found.shape[1]))
            # from when the first run ends on, ranges would be of what is left
            whole = np.isfinite(found).all(axis=0)
            (line,) = axes.plot(time[whole], np.median(found[:, whole], axis=0), label=label)
            axes.fill_between(
                time[whole], found[:, whole].min(axis=0), found[:, whole].max(axis=0),
                color=line.get_color(), alpha=0.15, linewidth=0,
            )  # fmt: skip
        meet = float(rows.values("discs_meet_mm")[0]) / 1000
        axes.axhline(meet, color="black", linewidth=0.8, linestyle=":", label="discs meet")
        axes.set_ylim(bottom=0)
        axes.legend(fontsize=8)
    return path


def _cost(rows: Table, folder: Path) -> Path:
    path = folder / "cost.svg"
    title = f"CPU time of a call of the filter, swap ({rows.finished} runs)"
    with figure(path, title, "robots", "mean of a run [ms]") as axes:
        for method, label in (("barrier", "barrier"), ("search", "velocity search")):
            at = rows.where(method=method)
            counts = sorted(int(c) for c in at.distinct("robots"))  # pyright: ignore
            found = [statistics.mean(at.where(robots=c).values("wall_filter_mean_ms"))
                     for c in counts]  # fmt: skip
            if counts:
                interval_line(axes, counts, found, label)
        axes.axhline(1.0, color="black", linewidth=0.8, linestyle=":")
        axes.set_ylim(bottom=0)
        axes.legend()
    return path
