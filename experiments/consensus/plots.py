"""Plots: who hears whom, hands and spread over time; time to agreement over team and graph."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.consensus import plots_moving
from mjmr import statistics
from mjmr.conditions import format_value
from mjmr.plot import edge_rows, figure, interval_line
from mjmr.table import Table

Array = NDArray[np.float64]
_SHOWN = (
    "schedule", "dwell", "noise", "loss", "delay", "fault", "sight", "cone_deg", "scan", "heading",
)  # fmt: skip
_SHORT = {"sight": "", "cone_deg": "", "schedule": "", "fault": "", "heading": ""}


def plots(table: Table, folder: Path) -> list[Path]:
    """Draw what a run has."""
    made: list[Path] = []
    bodies = table.where(mode="physical", experiment="three")
    if bodies.finished:
        given = bodies.where(sight="given", dwell=5.0, noise=0.0, loss=0.0, delay=0.0)
        seen = bodies.where(sight=("rays", "camera"))
        for name, rows in (("given", given), ("seen", seen)):
            if rows.finished:
                made += [_edges(rows, folder / f"graph-{name}.svg"),
                         _hands(rows, folder / f"hands-{name}.svg")]  # fmt: skip
        for rows, file in ((bodies.where(sight="given"), "spread"), (seen, "spread-seen")):
            if rows.finished:
                made.append(_spread(rows, folder / f"{file}.svg"))
    crowds = table.where(experiment="graph")
    if crowds.finished:
        made.append(_growth(crowds, folder / "time-to-agreement.svg"))
    return [*made, *plots_moving.plots(table, folder)]


def series(metrics: Any) -> tuple[Array, NDArray[np.bool_]]:
    """Outputs (k, 3, 2) [m] and graphs (k, 3, 3) of a trial, once a second."""
    outputs = np.array([float(v) for v in metrics["outputs"].split()]).reshape(-1, 3, 2)
    codes = np.array([int(v) for v in metrics["heard"].split()])
    return outputs, (codes[:, None] >> np.arange(9) & 1).astype(bool).reshape(-1, 3, 3)


def _first(rows: Table) -> Any:
    """The first run, of those in which robots that see nobody look round if there are any."""
    done = [row for row in rows.rows if row.status == "ok"]
    return next((row for row in done if row.condition["scan"]), done[0])


def _told(row: Any) -> str:
    c = row.condition
    if c["sight"] == "given":
        return f"graphs given, {c['schedule']}, dwell {c['dwell']:g} s"
    return f"by {c['sight']}, cone {c['cone_deg']:g} degrees{', scan' if c['scan'] else ''}"


def _edges(rows: Table, path: Path) -> Path:
    row = _first(rows)
    _, heard = series(row.metrics)
    with figure(path, f"Who hears whom: {_told(row)}, seed {row.seed}", "time / s", "") as axes:
        edge_rows(axes, np.arange(len(heard), dtype=float).tolist(), heard, ["0", "1", "2"])
    return path


def _hands(rows: Table, path: Path) -> Path:
    row = _first(rows)
    outputs, _ = series(row.metrics)
    title = f"Hands less offsets: {_told(row)}, seed {row.seed}"
    with figure(path, title, "time / s", "x and y / m") as axes:
        for i in range(3):
            axes.plot(outputs[:, i, 0], color=f"C{i}", label=f"robot {i}, x")
            axes.plot(outputs[:, i, 1], color=f"C{i}", linestyle="--", label=f"robot {i}, y")
        axes.legend(ncols=3, fontsize=8)
    return path


def _spread(rows: Table, path: Path) -> Path:
    title = "Spread of the hands less offsets, first seed of each condition; 0.5 mm: less"
    with figure(path, title, "time / s", "spread / m") as axes:
        shown = [c for c in rows.conditions if c["side"] == 2.0]
        for k, condition in enumerate(shown):
            row = next(
                (r for r in rows.rows if r.condition == condition and r.status == "ok"), None
            )
            if row is None:
                continue
            outputs, _ = series(row.metrics)
            apart = np.linalg.norm(outputs[:, :, None] - outputs[:, None], axis=3).max(axis=(1, 2))
            axes.plot(np.maximum(apart, 5e-4), color=f"C{k % 10}", linewidth=1.2,
                      linestyle=("-", "--", ":")[k // 10 % 3], label=_label(condition))  # fmt: skip
        axes.set_yscale("log")
        axes.legend(fontsize=7, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return path


def _label(condition: Any) -> str:
    plain = {"schedule": "alternate", "dwell": 5.0, "noise": 0.0, "loss": 0.0, "delay": 0.0,
             "fault": "none", "sight": "given", "cone_deg": 0.0, "scan": False,
             "heading": "random"}  # fmt: skip
    if condition["sight"] == "given":
        plain["cone_deg"] = condition["cone_deg"]
    told = [
        f"{_SHORT.get(name, name + '=')}{format_value(condition[name])}"
        for name in _SHOWN
        if condition[name] != plain[name]
    ]
    if not condition["calibrated"]:
        told.append("uncalibrated")
    return " ".join(told).replace("scan=true", "scan") or "dwell=5"


def _growth(rows: Table, path: Path) -> Path:
    title = "Time until n robots agree to 0.1 m (lines: linear model, crosses: MuJoCo)"
    with figure(path, title, "robots", "time / s") as axes:
        for k, (graph, of_graph) in enumerate(rows.split("graph")):
            model = of_graph.where(mode="linear")
            counts = sorted(int(n) for n in model.distinct("robots")) if model.finished else []
            times = [model.where(robots=n).values("agree_s") for n in counts]
            if counts:
                interval_line(
                    axes, [float(n) for n in counts], [statistics.mean(t) for t in times],
                    str(graph),
                )  # fmt: skip
            bodies = of_graph.where(mode="physical")
            if bodies.finished:
                done = [r for r in bodies.rows if r.status == "ok"]
                axes.plot([r.condition["robots"] for r in done],
                          [r.metrics["agree_s"] for r in done], "x", color=f"C{k}")  # fmt: skip
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.legend()
    return path
