"""The paper's Figure 6, foraging's paired times, and what became of discs, as plots."""

from pathlib import Path

import numpy as np

from experiments.versatile_pushing.sizes import SHORT
from experiments.versatile_pushing.worlds import HALF, NEST
from mjmr import statistics
from mjmr.plot import figure, interval_line
from mjmr.table import Table

_PLAIN = {"failure": "none", "vision": "arcs"}


def plots(table: Table, folder: Path) -> list[Path]:
    """Write every plot the table has trials for; returns the files."""
    written = []
    transport = table.where(task="transport", weight=1, duration=SHORT, recovery=False, **_PLAIN)
    transport = transport.where(robots=(2, 3, 4))
    if transport.finished and len(transport.distinct("p")) > 1:
        written.append(_figure_6(transport, folder, "figure6", "within 60 s"))
    recovered = table.where(task="transport", weight=1, recovery=True, **_PLAIN)
    recovered = recovered.where(robots=(2, 3, 4))
    if recovered.finished and len(recovered.distinct("p")) > 1:
        written.append(_figure_6(recovered, folder, "figure6-recovery", "with recovery, 120 s"))
    foraging = table.where(task="foraging", recovery=False, **_PLAIN)
    if foraging.finished and len(foraging.distinct("c")) == 2:
        written.append(_paired(foraging, folder))
    nests = table.where(task="construction", b=True, **_PLAIN)
    if nests.finished:
        written.append(_ring(nests, folder))
    return written


def _figure_6(rows: Table, folder: Path, name: str, words: str) -> Path:
    path = folder / f"{name}.svg"
    n = rows.finished
    title = f"Figure 6: transport of weight 1 {words} ({n} runs)"
    with figure(path, title, "p [robot radii]", "runs that succeed [%]") as axes:
        for robots in sorted(int(r) for r in rows.distinct("robots")):
            team = rows.where(robots=robots)
            found = {}
            for p, part in team.split("p"):
                if part.finished:
                    share = statistics.proportion(part.values("success"))
                    found[float(p)] = statistics.Estimate(
                        100 * share.value, 100 * share.low, 100 * share.high, share.n
                    )
            order = sorted(found)
            x = [p + 0.05 * (robots - 3) for p in order]  # so that bars do not hide each other
            interval_line(axes, x, [found[p] for p in order], f"{robots} robots")
            axes.set_xticks(order)
        axes.set_ylim(-4, 104)
        axes.legend()
    return path


def _paired(rows: Table, folder: Path) -> Path:
    path = folder / "foraging-times.svg"
    a, b = rows.where(c=0.0).pair(rows.where(c=1.0), "time_s")
    title = f"Foraging: time until all discs are home, maps paired ({len(a)} pairs)"
    with figure(path, title, "c = 1 [s]", "c = 0 [s]") as axes:
        top = 1.05 * float(max(a.max(), b.max()))
        axes.plot([0, top], [0, top], color="0.6", linewidth=1, label="equal")
        axes.plot([0, top], [0, 0.83 * top], color="0.6", linewidth=1, linestyle="--",
                  label="0.83, the paper's ratio")  # fmt: skip
        axes.scatter(b, a, s=18, label="one map")
        ratio = float(np.mean(a) / np.mean(b))
        axes.plot([0, top], [0, ratio * top], linewidth=1.5, label=f"{ratio:.2f}, ratio of means")
        axes.set_xlim(0, top)
        axes.set_ylim(0, top)
        axes.legend()
    return path


def _ring(rows: Table, folder: Path) -> Path:
    path = folder / "nest.svg"
    told = rows.values("places")
    n = len(told)
    title = f"Construction: where discs are in the end ({n} trials)"
    with figure(path, title, "x [m]", "y [m]") as axes:
        for k, text in enumerate(told):
            places = np.array([spot.split(",") for spot in text.split()], dtype=float)
            axes.scatter(*places.T, s=10, alpha=1.0 if n == 1 else 0.6, label=f"trial {k + 1}")
        turn = np.linspace(0, 2 * np.pi, 200)
        axes.plot(NEST * np.cos(turn), NEST * np.sin(turn), color="0.6", linewidth=1)
        axes.set_xlim(-HALF, HALF)
        axes.set_ylim(-HALF, HALF)
        axes.set_aspect("equal")
    return path
