"""Plots: the paper's tables as bars with the published figures beside, noise, paths."""

from pathlib import Path
from typing import Any

from experiments.helping_navigation.measures import NAMES, POINT, cell, steps
from experiments.helping_navigation.paths import drawn_paths
from experiments.helping_navigation.published import PUBLISHED
from mjmr.plot import figure, interval_line
from mjmr.statistics import mean
from mjmr.table import NoTrialsError, Table

_BARS = (("published", "#9a9a9a"), ("literal", "#d98c3f"), ("chain", "#2f6f9f"))


def plots(table: Table, folder: Path) -> list[Path]:
    """Write every plot the table has trials for; returns the files."""
    written = []
    for world in PUBLISHED:
        bars = _entries(table, world)
        if any(reading != "published" for _, _, reading in bars):
            written.append(_bars(bars, world, folder))
        noisy = table.where(**POINT, noise=True, fault="none", world=world)
        if len(noisy.distinct("err_max")) > 1:
            written += [_noise(table, noisy, world, r, folder) for r in noisy.distinct("reading")]
    return written + drawn_paths(folder)


def _entries(table: Table, world: str) -> dict[tuple[str, int, str], tuple[float, float]]:
    """Mean and deviation over tasks by (planner, robots, column)."""
    found: dict[tuple[str, int, str], tuple[float, float]] = {}
    for planner, row in PUBLISHED[world].items():
        for robots in (1, 2, 3, 4):
            if robots in row:
                value, percent = row[robots]
                found[planner, robots, "published"] = value, value * percent / 100
            if planner == "potential-field" and robots == 1:
                continue  # it finishes few targets, those that are in sight
            for reading in ("literal", "chain"):
                try:
                    values = steps(cell(table, world, planner, robots, reading))
                except NoTrialsError:
                    continue
                spread = values.std(ddof=1) if len(values) > 1 else 0.0
                found[planner, robots, reading] = float(values.mean()), float(spread)
    return found


def _bars(entries: dict[Any, tuple[float, float]], world: str, folder: Path) -> Path:
    path = folder / f"table-{world}.svg"
    title = f"{world}: steps a target, and deviation over tasks; alone, both readings are one"
    with figure(path, title, "robots", "steps") as axes:
        ticks, labels = [], []
        top = max(value for value, _ in entries.values())
        for p, planner in enumerate(NAMES):
            for robots in (1, 2, 3, 4):
                x = 5.0 * p + robots
                ticks.append(x)
                labels.append(str(robots))
                for b, (column, colour) in enumerate(_BARS):
                    if (planner, robots, column) in entries:
                        value, spread = entries[planner, robots, column]
                        axes.bar(x + 0.27 * (b - 1), value, 0.25, yerr=spread, color=colour,
                                 error_kw={"elinewidth": 0.8})  # fmt: skip
            axes.text(5.0 * p + 2.5, 1.10 * top, NAMES[planner], ha="center")
        axes.set_xticks(ticks, labels)
        axes.grid(visible=False, axis="x")
        for column, colour in _BARS:
            axes.bar(0, 0, color=colour, label=column)
        axes.set_xlim(0.2, 14.8)
        axes.legend(loc="upper center", ncols=3, bbox_to_anchor=(0.5, 0.98))
        axes.set_ylim(0, 1.3 * top)
    return path


def _noise(table: Table, noisy: Table, world: str, reading: Any, folder: Path) -> Path:
    path = folder / f"noise-{world}-{reading}.svg"
    title = f"{world}, {reading}: steps with three supporters that misperceive each other"
    with figure(path, title, "err_max", "steps") as axes:
        for k, (planner, name) in enumerate(NAMES.items()):
            rows = noisy.where(planner=planner, reading=reading)
            errors = sorted(float(e) for e in rows.distinct("err_max"))
            if not errors:
                continue
            estimates = [mean(steps(rows.where(err_max=e))) for e in errors]
            interval_line(axes, errors, estimates, name)
            if planner != "potential-field":
                alone = float(steps(cell(table, world, planner, 1, reading)).mean())
                axes.axhline(alone, linestyle=":", color=f"C{k}", label=f"{name} alone")
        axes.set_ylim(bottom=0)
        axes.legend(ncols=2)
    return path


def table_text(table: Table, world: str) -> str:
    """The paper's table of a world in Markdown, published | literal | chain in each entry."""
    entries = _entries(table, world)
    lines = ["| planner | R1 | +R2 | +R2,3 | +R2,3,4 |", "|---|---|---|---|---|"]
    for planner, name in NAMES.items():
        cells = []
        for robots in (1, 2, 3, 4):
            told = []
            for column, _ in _BARS:
                if (planner, robots, column) in entries:
                    value, spread = entries[planner, robots, column]
                    told.append(f"{value:.0f} ({100 * spread / value:.1f})")
                else:
                    told.append("-")
            cells.append(" / ".join(told[:2] if robots == 1 else told))
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"
