"""Avoid Past: a robot keeps away from where it has been.

Visits of cells of a grid in the robot's own frame are counted. The robot chooses, among 16
headings, the one whose cells at 0.4, 0.8 and 1.2 m ahead were visited least; what a wall hides
counts as visited, and a small bias draws it to the target. It holds the heading for the way of a
cell: a sum of pushes from cells oscillates, and so does a new choice at every border of a cell.

Source: the schema is Balch and Arkin's (1993), which the paper adds to its potential field; it
gives no detail, and the choice among headings is ours.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mjmr.jit import njit

HEADINGS = 16
ANGLES = np.arange(HEADINGS) * (2 * np.pi / HEADINGS)
_AHEAD = (0.4, 0.8, 1.2)  # m
# cells: a grid's corner lies so far off where it is asked for. Routes, doors and waypoints have
# round numbers, and a robot on the border of two cells would count either by its last bit
OFF_ROUND = 0.382


class Past(NamedTuple):
    """Where one robot has been.

    Args:
        visits: Entries of each cell, and choices made in it (nx, ny).
        low: Corner of the grid (2,) [m], own frame.
        cell: Its present cell (2,); -1 before the first.
        place: Where it chose its heading (2,) [m]; far off if it has to choose.
        heading: The heading it holds (1,), an index of ``ANGLES``.
    """

    visits: NDArray[np.int64]
    low: NDArray[np.float64]
    cell: NDArray[np.int64]
    place: NDArray[np.float64]
    heading: NDArray[np.int64]


def past(low: NDArray[np.float64], high: NDArray[np.float64], cell: float) -> Past:
    """Been nowhere yet, in a rectangle (2,), (2,) [m] that is grown by 2 m, off round numbers."""
    low = np.asarray(low, dtype=np.float64) - 2.0 - OFF_ROUND * cell
    high = np.asarray(high, dtype=np.float64) + 2.0
    nx, ny = np.ceil((high - low) / cell).astype(int) + 1
    return Past(
        np.zeros((nx, ny), dtype=np.int64), low, np.full(2, -1, dtype=np.int64),
        np.full(2, np.inf), np.zeros(1, dtype=np.int64),
    )  # fmt: skip


@njit
def fade(been):
    """At a new goal: half of every count is forgotten, and a heading is to be chosen.

    Where it has been then bounds what it avoids, for any number of goals.
    """
    been.visits[:] = been.visits[:] // 2
    been.cell[:] = -1
    been.place[:] = np.inf


@njit
def _visits(been, x, y, size):
    i = int(np.floor((x - been.low[0]) / size))
    j = int(np.floor((y - been.low[1]) / size))
    nx, ny = been.visits.shape
    return been.visits[min(max(i, 0), nx - 1), min(max(j, 0), ny - 1)]


@njit
def visit(been, x, y, size):
    """Count the cell at (x, y) [m] if it was just entered; at every step, whoever steers."""
    nx, ny = been.visits.shape
    i = min(max(int(np.floor((x - been.low[0]) / size)), 0), nx - 1)
    j = min(max(int(np.floor((y - been.low[1]) / size)), 0), ny - 1)
    if i == been.cell[0] and j == been.cell[1]:
        return
    been.cell[0], been.cell[1] = i, j
    been.visits[i, j] += 1


@njit
def due(been, x, y, size):
    """Whether another heading is to be chosen: the way of a cell is gone, or none was chosen."""
    return not np.hypot(x - been.place[0], y - been.place[1]) < size - 1e-6


@njit
def heading(been, x, y, tx, ty, angles, ranges, size, bias):
    """Choose a heading and hold it; returns its unit vector. To be called after :func:`visit`.

    Args:
        been: Changed in place.
        x: Own position [m].
        y: Own position [m].
        tx: Offset of the target [m].
        ty: Offset of the target [m].
        angles: The headings (16,) [rad].
        ranges: Free way along them (16,) [m].
        size: Of a cell [m].
        bias: What heading straight away from the target costs against straight at it, in visits.
    """
    been.visits[been.cell[0], been.cell[1]] += 1  # to choose twice in a cell is to be there twice
    here = _visits(been, x, y, size)
    far = max(np.hypot(tx, ty), 1e-9)
    best, chosen = np.inf, 0
    for k in range(angles.shape[0]):
        c, s = np.cos(angles[k]), np.sin(angles[k])
        if ranges[k] < _AHEAD[0]:
            continue
        most = float(here)
        total = 0.0
        for way in _AHEAD:
            if ranges[k] >= way:
                seen = float(_visits(been, x + way * c, y + way * s, size))
                most = max(most, seen)
                total += seen
            else:
                total += most + 1.0
        cost = total / len(_AHEAD) - 0.5 * bias * (c * tx + s * ty) / far
        if cost < best:
            best, chosen = cost, k
    if best == np.inf:  # walls all around: the freest way
        for k in range(angles.shape[0]):
            if -ranges[k] < best:
                best, chosen = -ranges[k], k
    been.heading[0] = chosen
    been.place[0], been.place[1] = x, y
    return np.cos(angles[chosen]), np.sin(angles[chosen])
