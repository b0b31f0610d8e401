"""Plots of what moves: how far followers are from their places, and what averages end with."""

from collections.abc import Mapping
from pathlib import Path as File
from typing import Any

import numpy as np

from experiments.consensus.graphs import leader_of
from experiments.consensus.linear import START
from experiments.consensus.moving import Path
from mjmr.plot import figure
from mjmr.table import Table


def plots(table: Table, folder: File) -> list[File]:
    """Draw what a run has of experiments moving and average."""
    made: list[File] = []
    moving = table.where(experiment="moving", loss=0.0, delay=0.0, weight=0.2)
    if moving.finished:
        made.append(_followed(moving, folder / "moving.svg"))
    means = table.where(experiment="average")
    if means.finished:
        made.append(_bias(means, folder / "average-bias.svg"))
    return made


def _done(rows: Table) -> list[Any]:
    return [row for row in rows.rows if row.status == "ok"]


def _followed(rows: Table, path: File) -> File:
    title = "Followers' distance from their places (solid: first, dashed: second), lines: loop"
    with figure(path, title, "time / s", "distance / m") as axes:
        for k, condition in enumerate(rows.conditions):
            row = next((r for r in _done(rows) if r.condition == condition), None)
            if row is None:
                continue
            y = np.array([float(v) for v in row.metrics["outputs"].split()]).reshape(-1, 3, 2)
            c: Mapping[str, Any] = row.condition
            leader = leader_of(c["schedule"])
            way = Path(c["path"], START[leader], c["speed"], c["turn_rate"], np.zeros((3, 2)))
            at = np.array([way.point(float(t))[0] for t in range(len(y))])
            away = np.linalg.norm(y - at[:, None], axis=2)
            known = "told" if condition["feedforward"] == "told" else "law alone"
            label = f"{condition['path']}, {known}"
            followers = [i for i in range(3) if i != leader]
            for i, style in zip(followers, ("-", "--"), strict=True):
                axes.plot(np.maximum(away[:, i], 1e-3), style, color=f"C{k}",
                          label=label if style == "-" else None)  # fmt: skip
                expected = row.metrics[f"theory_{i + 1}_m"]
                if condition["feedforward"] == "none" and condition["path"] in ("line", "circle"):
                    axes.axhline(expected, color=f"C{k}", linewidth=0.5)
        axes.set_yscale("log")
        axes.legend(fontsize=7, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return path


def _bias(rows: Table, path: File) -> File:
    title = "Average by radio: mean of the estimates less the readings' mean"
    with figure(path, title, "seed", "bias / deviations of a reading") as axes:
        for k, condition in enumerate(rows.conditions):
            done = [r for r in _done(rows) if r.condition == condition]
            label = (
                f"{condition['rule']}, {'patrol' if condition['patrol'] else 'stand'}, "
                f"loss {condition['loss']:g}"
            )
            axes.plot([r.seed for r in done], [r.metrics["average_bias"] for r in done],
                      "ox+sd^"[k % 6], color=f"C{k}", label=label)  # fmt: skip
        axes.legend(fontsize=7, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return path
