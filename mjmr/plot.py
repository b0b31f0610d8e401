"""Plots in one style, written as SVG that is the same for the same data."""

import contextlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from mjmr.statistics import Estimate


@contextlib.contextmanager
def figure(path: Path, title: str, x: str, y: str) -> Iterator[Any]:
    """Axes to draw on; the file is written when the block ends without an error.

    Args:
        path: SVG file to write.
        title: Above the axes.
        x: Label with unit.
        y: Label with unit.

    Yields:
        Matplotlib axes.
    """
    import matplotlib

    with matplotlib.rc_context(
        {"svg.hashsalt": "mjmr", "font.size": 10, "axes.spines.top": False,
         "axes.spines.right": False, "axes.grid": True, "grid.alpha": 0.25,
         "legend.frameon": False}
    ):  # fmt: skip
        # the object interface touches no global state and needs no display
        from matplotlib.backends.backend_svg import FigureCanvasSVG
        from matplotlib.figure import Figure

        drawing = Figure(figsize=(7.0, 4.2), layout="constrained")
        FigureCanvasSVG(drawing)
        axes = drawing.add_subplot()
        axes.set_title(title, fontsize=10)
        axes.set_xlabel(x)
        axes.set_ylabel(y)
        yield axes
        drawing.savefig(path, metadata={"Date": None})


def interval_line(axes: Any, x: Sequence[float], estimates: Sequence[Estimate], label: str) -> None:
    """Draw means over ``x`` with their intervals as bars."""
    values = [e.value for e in estimates]
    finite = [(min(e.value, e.low), max(e.value, e.high)) if e.n > 1 else (e.value, e.value)
              for e in estimates]  # fmt: skip
    below = [v - low for v, (low, _) in zip(values, finite, strict=True)]
    above = [high - v for v, (_, high) in zip(values, finite, strict=True)]
    axes.errorbar(x, values, yerr=[below, above], marker="o", capsize=3, label=label)
