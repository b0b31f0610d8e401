"""Avoid past: towards where a robot has been least."""

from dataclasses import KW_ONLY, dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from controllers.motion.free_way import free_past
from controllers.schemas.base import Schema, View
from controllers.schemas.percepts import Array
from controllers.schemas.visits import ANGLES, HEADINGS, OFF_ROUND, Past, due, heading, visit
from mjmr.errors import InvalidInputError
from mjmr.jit import njit

_BLOCKED = 1e-3  # m: a way this short is none


class _Pasts(NamedTuple):
    """Of n robots: see :class:`controllers.schemas.visits.Past`."""

    visits: NDArray[np.int64]
    low: Array
    cell: NDArray[np.int64]
    place: Array
    heading: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class AvoidPast(Schema):
    """Along the one of 16 headings that leads where this robot has been least.

    Each robot counts its visits to the cells of a grid, and chooses after the way of a cell; see
    :mod:`controllers.schemas.visits`.

    Source: T. Balch and R. C. Arkin, Avoiding the past: a simple but effective strategy for
    reactive navigation, ICRA 1993, give counts a repelling force each; choosing among headings is
    ours, since the sum of those forces goes to and fro.

    Attributes:
        place: Percept: where the robot is by its own reckoning, (n, 2) from its start.
        walls: Percept: things that block.
        towards: Percept of the goal, or None.
        cell: Side of a cell [m].
        clearance: Of a heading from things, robot's radius included [m].
        bias: Visits that a heading straight away from the goal costs against one straight at it.
        extent: From its start a robot's visits are told apart this far in x and y [m]; further
            away they count as those at the border.
    """

    place: str
    _: KW_ONLY
    walls: str
    towards: str | None = None
    cell: float = 0.4
    clearance: float = 0.3
    bias: float = 0.6
    extent: float = 25.0

    def __post_init__(self):
        if not (0 < self.cell < np.inf and self.clearance >= 0 and self.bias >= 0):
            raise InvalidInputError(
                f"{self.label}: cell must be positive, clearance and bias 0 or more; got "
                f"{self.cell} m, {self.clearance} m and {self.bias}"
            )
        if not self.cell < self.extent < np.inf:
            raise InvalidInputError(
                f"{self.label}: extent must be more than a cell of {self.cell} m and finite; got "
                f"{self.extent} m"
            )

    @property
    def label(self) -> str:
        """Avoid past."""
        return "avoid past"

    @property
    def percepts(self) -> tuple[str, ...]:
        """Place, walls and goal."""
        return (self.place, self.walls, *((self.towards,) if self.towards else ()))

    def start(self, n: int, rng: np.random.Generator) -> _Pasts:
        """Nowhere yet."""
        side = int(np.ceil(2 * self.extent / self.cell)) + 1
        return _Pasts(
            np.zeros((n, side, side), dtype=np.int64),
            np.full(2, -self.extent - OFF_ROUND * self.cell),
            np.full((n, 2), -1, dtype=np.int64), np.full((n, 2), np.inf),
            np.zeros((n, 1), dtype=np.int64),
        )  # fmt: skip

    def field(self, view: View) -> Array:
        """Unit vectors (n, 2); 0 for robots that do not know where they are."""
        walls, pasts = view.things(self.walls), view.memory(self)
        goal = view.direction(self.towards) if self.towards else np.zeros((view.n, 2))
        return _least_visited(
            pasts, view.vector(self.place), walls.offset, walls.radius, walls.valid, goal,
            self.cell, self.clearance, self.bias,
        )  # fmt: skip


@njit
def _least_visited(pasts, place, offset, radius, valid, goal, size, clearance, bias):
    n = len(place)
    out = np.zeros((n, 2))
    ranges = np.empty(HEADINGS)
    for i in range(n):
        x, y = place[i, 0], place[i, 1]
        if not (np.isfinite(x) and np.isfinite(y)):
            continue
        been = Past(pasts.visits[i], pasts.low, pasts.cell[i], pasts.place[i], pasts.heading[i])
        for k in range(HEADINGS):
            c, s = np.cos(ANGLES[k]), np.sin(ANGLES[k])
            ranges[k] = _free(offset[i], radius[i], valid[i], c, s, clearance)
        visit(been, x, y, size)
        if due(been, x, y, size) or ranges[been.heading[0]] < _BLOCKED:
            heading(been, x, y, goal[i, 0], goal[i, 1], ANGLES, ranges, size, bias)
        angle = ANGLES[been.heading[0]]
        out[i, 0], out[i, 1] = np.cos(angle), np.sin(angle)
    return out


@njit
def _free(offset, radius, valid, c, s, clearance):
    """How far the way along (c, s) keeps clear of things."""
    free = np.inf
    for j in range(len(radius)):
        if not valid[j]:
            continue
        x, y = offset[j, 0], offset[j, 1]
        free = min(free, free_past(c, s, x, y, np.hypot(x, y), radius[j] + clearance))
    return free
