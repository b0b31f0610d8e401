"""Plots in one style, written as SVG that is the same for the same data."""

import contextlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from mjmr.errors import InvalidInputError
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


def flag_rows(axes: Any, times: Sequence[float], flags: Any, labels: Sequence[str]) -> None:
    """Draw what holds when: a row for each label, a bar where its flag is set.

    Args:
        axes: To draw on; the first label is uppermost.
        times: Of the flags, ascending (k,) [s]; a flag holds until the next time, the last for as
            long as the one before.
        flags: (k, m).
        labels: Of the rows (m,).

    Raises:
        InvalidInputError: Shapes that do not fit, or fewer than two times.
    """
    import numpy as np

    at, held = np.asarray(times, dtype=np.float64), np.asarray(flags, dtype=bool)
    if len(at) < 2 or held.shape != (len(at), len(labels)):
        raise InvalidInputError(
            f"flags have shape (k, {len(labels)}), k times, 2 or more; got {held.shape} and "
            f"{at.shape}"
        )
    ends = np.append(at[1:], 2 * at[-1] - at[-2])
    for row in range(len(labels)):
        edges = np.diff(np.concatenate([[0], held[:, row], [0]]).astype(int))
        first, last = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
        spans = [(at[a], ends[b] - at[a]) for a, b in zip(first, last, strict=True)]
        axes.broken_barh(spans, (row - 0.35, 0.7), facecolors=f"C{row % 10}")
    axes.set_yticks(range(len(labels)), labels)
    axes.set_ylim(len(labels) - 0.4, -0.6)
    axes.set_xlim(at[0], ends[-1])


def edge_rows(axes: Any, times: Sequence[float], graphs: Any, labels: Sequence[str]) -> None:
    """Draw a team's graph over time: a row for each pair of which the first ever hears the second.

    Args:
        axes: To draw on.
        times: Ascending (k,) [s].
        graphs: Who hears whom at these (k, n, n); the diagonal is not drawn.
        labels: Of the robots (n,).

    Raises:
        InvalidInputError: Shapes that do not fit.
    """
    import numpy as np

    held = np.array(graphs, dtype=bool)
    n = len(labels)
    if held.ndim != 3 or held.shape[1:] != (n, n):
        raise InvalidInputError(f"graphs have shape (k, {n}, {n}); got {held.shape}")
    held[:, np.arange(n), np.arange(n)] = False
    pairs = np.argwhere(held.any(axis=0))
    names = [f"{labels[i]} hears {labels[j]}" for i, j in pairs]
    flag_rows(axes, times, held[:, pairs[:, 0], pairs[:, 1]], names)
