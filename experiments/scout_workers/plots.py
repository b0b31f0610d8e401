"""Plots: tracks as in the paper's figure 3.8, and what a table alone would hide."""

from pathlib import Path
from typing import Any

import numpy as np

from experiments.scout_workers.plots_spread import spreads
from experiments.scout_workers.sizes import CHOSEN
from mjmr import statistics
from mjmr.plot import figure, interval_line
from mjmr.table import Table

_PLAIN: dict[str, Any] = {
    "experiment": "maze", "robots": 2, "forced": 1, "margin_deg": 35.0, "avoid_deg": 20.0,
    "compass_deg": 2.0, "servo_pct": 5.0, "bit_error": 0.0, "vector": "scout", "failure": "none",
}  # fmt: skip


def plots(table: Table, folder: Path) -> list[Path]:
    """Write every plot the table has trials for; returns the files."""
    written = [tracks(folder / "tracks.svg")]
    pairs = table.where(**_PLAIN)
    if pairs.finished:
        written.append(_times(pairs, folder / "times.svg"))
    lines = table.where(experiment="succession")
    if lines.finished:
        written.append(_succession(lines, folder / "succession.svg"))
    for name, axis, wanted, label, by in (
        ("margins", "margin_deg", {"forced": (0, 1), "experiment": "maze", "maze": "m3",
         "compass_deg": 2.0, "servo_pct": 5.0, "bit_error": 0.0, "failure": "none",
         "vector": "scout", "mode": "planar"}, "error margin [deg]", "forced"),
        ("compass", "compass_deg", {k: v for k, v in _PLAIN.items() if k != "compass_deg"}
         | {"mode": "planar", "maze": CHOSEN}, "step of the compass [deg]", "maze"),
        ("teams", "robots", {"experiment": "scaling", "maze": "m3"}, "robots", "finish"),
        ("traps", "depth", {"experiment": "trap"}, "depth of the trap's lips [m]", "forced"),
    ):  # fmt: skip
        rows = table.where(**wanted)
        if rows.finished and len(rows.distinct(axis)) > 1:
            written.append(_shares(rows, folder / f"{name}.svg", axis, label, by))
    return [*written, *spreads(table, pairs, folder)]


def tracks(path: Path, seed: int = 0) -> Path:
    """Scout's and worker's track in each of the four mazes, planar, with their times."""
    from controllers.scouting import LOOP
    from experiments.scout_workers import study
    from experiments.scout_workers.mazes import maze
    from experiments.scout_workers.run import run
    from experiments.scout_workers.trial import build

    title = f"Tracks of scout (grey) and worker (red) from nest to goal, planar, seed {seed}"
    with figure(path, title, "[m], four mazes side by side", "[m]") as axes:
        for k, name in enumerate(CHOSEN):
            place = maze(name)
            parts = build(study.condition(maze=name), seed)
            out = run(*parts, keep_trails=True)
            trail = np.array(out.trails) + [k * (place.size + 0.3), 0.0]
            until = int(np.nan_to_num(out.found[0] / LOOP, nan=len(trail))) + 1
            axes.plot(*trail[:until, 0].T, color="0.55", linewidth=0.6)
            axes.plot(*trail[:, 1].T, color="tab:red", linewidth=1.4)
            x = k * (place.size + 0.3)
            axes.plot(*np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]).T * place.size
                      + [[x], [0.0]], color="k", linewidth=1.0)  # fmt: skip
            for x0, y0, x1, y1 in place.blocks:
                axes.fill([x + x0, x + x1, x + x1, x + x0], [y0, y0, y1, y1], color="0.8")
            axes.plot(place.nest[0] + x, place.nest[1], "bs", markersize=5)
            axes.plot(place.goal[0] + x, place.goal[1], "g*", markersize=10)
            scout, worker = out.found_after
            axes.text(x, place.size + 0.08, f"{name}: {scout:.0f} s, {worker:.0f} s", fontsize=8)
        axes.set_aspect("equal")
        axes.grid(visible=False)
    return path


def _times(rows: Table, path: Path) -> Path:
    title = "Time to the goal: every scout and the worker it sent"
    with figure(path, title, "maze and simulation", "time [s]") as axes:
        labels: list[str] = []
        for mode, of_mode in rows.split("mode"):
            for name, at in of_mode.split("maze"):
                k = len(labels)
                labels.append(f"{name}\n{mode}")
                for metric, shift, colour in (("scout_s", -0.15, "0.5"), ("worker_s", 0.15, "C3")):
                    values = at.values(metric)
                    values = values[np.isfinite(values)]
                    axes.plot(
                        np.full(len(values), k + shift), values, ".", color=colour, markersize=3,
                        alpha=0.5,
                    )  # fmt: skip
                    axes.plot([k + shift - 0.12, k + shift + 0.12], [np.median(values)] * 2,
                              color=colour, linewidth=2.5,
                              label=metric[:-2] if not k else None)  # fmt: skip
        axes.set_yscale("log")
        axes.yaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_minor_formatter("{x:g}")
        axes.set_xticks(range(len(labels)), labels, fontsize=7)
        axes.legend()
    return path


def _succession(rows: Table, path: Path) -> Path:
    title = "Ways of workers that leave one after the other, mean over scouts and mazes"
    with figure(path, title, "worker", "path / shortest") as axes:
        for mode, at in rows.split("succession"):
            points, estimates = [], []
            for k in range(1, 11):
                values = at.values(f"path_{k:02d}")
                points.append(float(k))
                estimates.append(statistics.mean(values[np.isfinite(values)]))
            mazes = ", ".join(str(m) for m in at.distinct("maze"))
            interval_line(axes, points, estimates, f"{mode} ({mazes})")
        axes.axhline(1.0, linestyle=":", color="0.5")
        axes.legend()
    return path


def _shares(rows: Table, path: Path, axis: str, label: str, by: str) -> Path:
    with figure(path, f"Share of workers that arrive, over {label}", label, "share") as axes:
        for value, at in rows.split(by):
            for mode, of_mode in at.split("mode"):
                points, estimates = [], []
                for x in sorted(of_mode.distinct(axis), key=float):
                    values = of_mode.where(**{axis: x}).values("success").astype(float)
                    points.append(float(x))
                    whole = bool(np.isin(values, (0, 1)).all())
                    estimates.append((statistics.proportion if whole else statistics.mean)(values))
                interval_line(axes, points, estimates, f"{by} {value}, {mode}")
        axes.set_ylim(-0.03, 1.03)
        axes.legend(fontsize=8)
    return path
