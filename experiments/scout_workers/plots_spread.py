"""Plots of spreads that no claim shows: the scout's error, the radio's latency, its jitter."""

from pathlib import Path

import numpy as np

from controllers.scouting import LOOP
from experiments.scout_workers.mazes import REACH
from mjmr.plot import figure
from mjmr.table import Table


def spreads(table: Table, pairs: Table, folder: Path) -> list[Path]:
    """Write those of these plots the tables have trials for; returns the files.

    Args:
        table: All trials.
        pairs: Those of a scout and a worker with the card's values.
        folder: Where to write.
    """
    written = []
    if pairs.finished:
        written.append(_scout_error(pairs, folder / "scout_error.svg"))
    heard = table.where(experiment="maze", maze="m3", mode="planar", failure="none", forced=1)
    heard = heard.where(margin_deg=35.0, compass_deg=2.0, servo_pct=5.0, vector="scout")
    if heard.finished:
        written.append(_latency(heard, folder / "latency.svg"))
    phase = table.where(experiment="phase", spacing_ms=5.0, pause_ms=20.0)
    if phase.finished and len(phase.distinct("jitter_ms")) > 1:
        written.append(_jitter(phase, folder / "jitter.svg"))
    return written


def _finite(table: Table, metric: str):
    values = table.values(metric)
    return values[np.isfinite(values)]


def _scout_error(pairs: Table, path: Path) -> Path:
    title = "How far the scout's vector is off when it sees the goal: every scout, quartiles"
    with figure(path, title, "maze and simulation", "error [m]") as axes:
        labels: list[str] = []
        for mode, of_mode in pairs.split("mode"):
            for name, at in of_mode.split("maze"):
                values = _finite(at, "scout_error_m")
                k = len(labels)
                labels.append(f"{name}\n{mode}")
                axes.plot(np.full(len(values), k), values, ".", color="0.5", markersize=4)
                if len(values):
                    for level, width in ((25, 1.2), (50, 2.5), (75, 1.2)):
                        height = np.percentile(values, level)
                        axes.plot([k - 0.2, k + 0.2], [height] * 2, color="C0", linewidth=width)
        axes.axhline(REACH, linestyle=":", color="C3", label="radius of the goal's patch")
        axes.set_xticks(range(len(labels)), labels, fontsize=7)
        axes.set_ylim(bottom=0.0)
        axes.legend()
    return path


def _latency(rows: Table, path: Path) -> Path:
    title = "From the scout's first byte to a worker that knows, m3, planar: share of runs"
    with figure(path, title, "latency [s]; a worker looks once a loop, 0.5 s", "share") as axes:
        for error, at in rows.split("bit_error"):
            values = np.sort(_finite(at, "latency_s"))
            if not len(values):
                continue
            share = np.arange(1, len(values) + 1) / len(values)
            axes.step(
                [LOOP / 2, *values, 2 * values[-1]], [0.0, *share, 1.0], where="post",
                label=f"{100 * float(error):g} % of bits wrong",
            )  # fmt: skip
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.legend(loc="lower right")
    return path


def _jitter(rows: Table, path: Path) -> Path:
    title = "Time between two valid groups over jitter: mean, and the shortest and longest of all"
    with figure(path, title, "jitter of every interval [ms]", "time [ms]") as axes:
        jitters = sorted(rows.distinct("jitter_ms"), key=float)
        for metric, reduce, mark in (
            ("period_most_ms", np.max, "v"), ("period_ms", np.mean, "o"),
            ("period_least_ms", np.min, "^"),
        ):  # fmt: skip
            heights = [reduce(_finite(rows.where(jitter_ms=j), metric)) for j in jitters]
            label = {"v": "longest", "o": "mean", "^": "shortest"}[mark]
            axes.plot([float(j) for j in jitters], heights, marker=mark, label=label)
        axes.set_yscale("log")
        axes.yaxis.set_major_formatter("{x:g}")
        axes.legend()
    return path
