"""The paper's Figures 8 and 9, and what latency does, as plots."""

from pathlib import Path

import numpy as np

from mjmr import statistics
from mjmr.plot import figure, interval_line
from mjmr.table import Table

_METRIC = "robot overlap [mm s] in a run"
_ERROR = "vision error sigma [mm]"


def plots(table: Table, folder: Path) -> list[Path]:
    """Write every plot the table has trials for; returns the files."""
    base = table.where(mode="metric", failure="none", latency=0)
    written = []
    for scene in base.where(margin_mm=0.0, motion="paper").distinct("scene"):
        rows = base.where(scene=scene, margin_mm=0.0, motion="paper")
        if len(rows.distinct("search")) == 2 and len(rows.distinct("sigma_mm")) > 1:
            written.append(_figure_8(rows, str(scene), folder))
    base = base.where(motion="paper")
    margins = base.where(scene="cross4", search=True)
    if len(margins.distinct("margin_mm")) > 1:
        written.append(_figure_9(margins, folder))
    bodies = table.where(mode="physical", scene="cross4", search=True, drive="planar",
                         sensing="report", sigma_mm=0.0, margin_mm=1.0)  # fmt: skip
    if len(bodies.distinct("latency")) > 1:
        written.append(_latency(bodies, folder))
    return written


def _means(rows: Table, metric: str) -> tuple[list, list[statistics.Estimate]]:
    points, estimates = [], []
    for sigma, at in rows.split("sigma_mm"):
        if at.finished:
            points.append(sigma)
            estimates.append(statistics.mean(at.values(metric)))
    order = np.argsort(points)
    return [points[i] for i in order], [estimates[i] for i in order]


def _figure_8(rows: Table, scene: str, folder: Path) -> Path:
    n = rows.finished
    title = f"Figure 8: search on and off, scene {scene} (metric mode, {n} runs)"
    with figure(folder / f"figure8-{scene}.svg", title, _ERROR, _METRIC) as axes:
        for search, label in ((False, "search off"), (True, "search on")):
            interval_line(axes, *_means(rows.where(search=search), "overlap_mm_s"), label)
        axes.set_yscale("symlog", linthresh=1.0)
        axes.set_ylim(bottom=-0.05)
        axes.legend()
    return folder / f"figure8-{scene}.svg"


def _figure_9(rows: Table, folder: Path) -> Path:
    title = f"Figure 9: margins, search on, scene cross4 (metric mode, {rows.finished} runs)"
    with figure(folder / "figure9-cross4.svg", title, _ERROR, _METRIC) as axes:
        for margin in sorted(float(m) for m in rows.distinct("margin_mm")):
            points = _means(rows.where(margin_mm=margin), "overlap_mm_s")
            dodge = 0.03 * (margin - 2.0)  # so that bars do not hide each other
            x = [sigma + dodge for sigma in points[0]]
            interval_line(axes, x, points[1], f"margin {margin:g} mm")
        axes.set_ylim(bottom=0)
        axes.legend()
    return folder / "figure9-cross4.svg"


def _latency(rows: Table, folder: Path) -> Path:
    title = f"Command latency, scene cross4, margin 1 mm (physical mode, {rows.finished} runs)"
    path = folder / "latency-cross4.svg"
    with figure(path, title, "latency [cycles of 1/60 s]", "robot contact [s] in a run") as axes:
        for predict, label in ((False, "ignored"), (True, "predicted forward")):
            # without latency there is nothing to predict
            found = {}
            for cycles, at in rows.split("latency"):
                runs = at.where(predict=predict if cycles else True)
                if runs.finished:
                    found[cycles] = statistics.mean(runs.values("contact_s"))
            order = sorted(found)
            interval_line(axes, order, [found[c] for c in order], label)
            axes.set_xticks(order)
        axes.set_ylim(bottom=-0.005)
        axes.legend()
    return path
