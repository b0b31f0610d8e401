"""Avoid past: towards where a robot has been least."""

from dataclasses import KW_ONLY, dataclass

import numpy as np
from numpy.typing import NDArray

from controllers.schemas.base import Schema, View
from controllers.schemas.percepts import Array
from mjmr.errors import InvalidInputError
from mjmr.jit import njit

_HEADINGS = 16
_LOOKS = 3  # cells ahead


@dataclass(slots=True)
class _Visits:
    counts: NDArray[np.int64]
    cell: NDArray[np.int64]
    heading: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class AvoidPast(Schema):
    """Along the one of 16 headings that leads where this robot has been least.

    Each robot counts its visits to the cells of a grid. As it enters a cell it takes the heading
    with the least mean count one, two and three cells ahead, and keeps it until the next cell.
    What a thing blocks counts as the most visited cell, and so does what lies behind it. A bias
    towards a goal decides between equals.

    Source: T. Balch and R. C. Arkin, Avoiding the past: a simple but effective strategy for
    reactive navigation, ICRA 1993, give counts a repelling force each; choosing among headings is
    ours, since the sum of those forces goes to and fro.

    Attributes:
        place: Percept: where the robot is by its own reckoning, (n, 2) from its start.
        walls: Percept: things that block.
        towards: Percept of the goal, or None.
        cell: Side of a cell [m].
        clearance: Of a heading from things, robot's radius included [m].
        bias: Visits that heading straight for the goal is worth.
        cells: The grid's side in cells; further places are counted as if the grid were rolled up.
    """

    place: str
    _: KW_ONLY
    walls: str
    towards: str | None = None
    cell: float = 0.4
    clearance: float = 0.3
    bias: float = 0.3
    cells: int = 128

    def __post_init__(self):
        if not (0 < self.cell < np.inf and self.clearance >= 0 and self.bias >= 0):
            raise InvalidInputError(
                f"{self.label}: cell must be positive, clearance and bias 0 or more; got "
                f"{self.cell} m, {self.clearance} m and {self.bias}"
            )
        if self.cells < 2 * _LOOKS + 1:
            raise InvalidInputError(
                f"{self.label}: the grid has {2 * _LOOKS + 1} cells a side or more; "
                f"got {self.cells}"
            )

    @property
    def label(self) -> str:
        """Avoid past."""
        return "avoid past"

    @property
    def percepts(self) -> tuple[str, ...]:
        """Place, walls and goal."""
        return (self.place, self.walls, *((self.towards,) if self.towards else ()))

    def start(self, n: int, rng: np.random.Generator) -> _Visits:
        """Nowhere yet."""
        return _Visits(
            np.zeros((n, self.cells, self.cells), dtype=np.int64),
            np.full((n, 2), np.iinfo(np.int64).min),
            np.zeros(n, dtype=np.int64),
        )

    def field(self, view: View) -> Array:
        """Unit vectors (n, 2); 0 for robots that do not know where they are."""
        walls, memory = view.things(self.walls), view.memory(self)
        goal = view.direction(self.towards) if self.towards else np.zeros((view.n, 2))
        return _least_visited(
            memory.counts, memory.cell, memory.heading, view.vector(self.place),
            walls.offset, walls.radius, walls.valid, goal, self.cell, self.clearance, self.bias,
        )  # fmt: skip


@njit
def _least_visited(
    counts, cell, heading, place, offset, radius, valid, goal, side, clearance, bias
):
    n, cells = counts.shape[0], counts.shape[1]
    out = np.zeros((n, 2))
    for i in range(n):
        x, y = place[i, 0], place[i, 1]
        if not (np.isfinite(x) and np.isfinite(y)):
            continue
        col, row = int(np.floor(x / side)), int(np.floor(y / side))
        angle = 2.0 * np.pi * heading[i] / _HEADINGS
        free = _free(offset[i], radius[i], valid[i], np.cos(angle), np.sin(angle), clearance)
        entered = col != cell[i, 0] or row != cell[i, 1]
        if entered:
            cell[i, 0], cell[i, 1] = col, row
            counts[i, col % cells, row % cells] += 1
        if entered or free < side / 2.0:
            most = 0
            for u in range(-_LOOKS, _LOOKS + 1):
                for v in range(-_LOOKS, _LOOKS + 1):
                    most = max(most, counts[i, (col + u) % cells, (row + v) % cells])
            best = np.inf
            for h in range(_HEADINGS):
                a = 2.0 * np.pi * h / _HEADINGS
                c, s = np.cos(a), np.sin(a)
                free = _free(offset[i], radius[i], valid[i], c, s, clearance)
                seen = 0.0
                for k in range(1, _LOOKS + 1):
                    d = k * side
                    if d > free:
                        seen += most + 1.0
                    else:
                        u = int(np.floor((x + d * c) / side)) % cells
                        v = int(np.floor((y + d * s) / side)) % cells
                        seen += counts[i, u, v]
                score = seen / _LOOKS - bias * (c * goal[i, 0] + s * goal[i, 1])
                if score < best - 1e-9:
                    best = score
                    heading[i] = h
        angle = 2.0 * np.pi * heading[i] / _HEADINGS
        out[i, 0], out[i, 1] = np.cos(angle), np.sin(angle)
    return out


@njit
def _free(offset, radius, valid, c, s, clearance):
    """How far the way along (c, s) keeps clear of things."""
    free = np.inf
    for j in range(len(radius)):
        if not valid[j]:
            continue
        along = offset[j, 0] * c + offset[j, 1] * s
        across = offset[j, 1] * c - offset[j, 0] * s
        reach = radius[j] + clearance
        if abs(across) < reach and along > 0.0:
            free = min(free, max(0.0, along - np.sqrt(reach * reach - across * across)))
    return free
