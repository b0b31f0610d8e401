"""Mazes as data: read, checked, and what of them can be driven through."""

import functools
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.robots.tj_pro import TJPro

Array = NDArray[np.float64]
FILE = Path(__file__).with_name("mazes.json")
ROBOT = TJPro.radius  # m
GAP = 0.45  # m, narrowest passage that a maze may have
WALL_HEIGHT = 0.15  # m, of walls and blocks
REACH = 0.15  # m, radius of nest's and goal's patches; a goal is seen from its patch
_TOUCH = 1e-9


@dataclass(frozen=True, kw_only=True)
class Maze:
    """A walled square with blocks, a nest and a goal.

    Attributes:
        name: As in its file.
        size: Side of the square, whose corner is the origin [m].
        nest: Where robots start (2,) [m].
        goal: Middle of the goal's patch (2,) [m].
        blocks: Corners x0, y0, x1, y1 of upright blocks (k, 4) [m].
    """

    name: str
    size: float
    nest: Array
    goal: Array
    blocks: Array

    def __post_init__(self):
        self._check_blocks()
        self._check_gaps()
        for what, place in (("nest", self.nest), ("goal", self.goal)):
            self._check_place(what, place)
        free = self.free_space()
        home, end = shapely.Point(self.nest), shapely.Point(self.goal).buffer(REACH)
        parts = shapely.get_parts(free)
        if not any(part.covers(home) and part.intersects(end) for part in parts):
            raise InvalidInputError(
                f"maze {self.name}: no way of {2 * ROBOT:g} m leads from the nest "
                f"{_told(self.nest)} to the goal {_told(self.goal)}"
            )

    def free_space(self, radius: float = ROBOT) -> Any:
        """Where the middle of a round robot can be: a shapely (multi)polygon [m]."""
        arena = shapely.box(radius, radius, self.size - radius, self.size - radius)
        solid = shapely.union_all([shapely.box(*b).buffer(radius) for b in self.blocks])
        return shapely.difference(arena, solid)

    def _check_blocks(self) -> None:
        for k, block in enumerate(self.blocks):
            x0, y0, x1, y1 = block
            if not (x0 < x1 and y0 < y1):
                raise InvalidInputError(
                    f"maze {self.name}: block {k} must have x0 < x1 and y0 < y1; got {_told(block)}"
                )
            if min(x0, y0) < 0 or max(x1, y1) > self.size:
                raise InvalidInputError(
                    f"maze {self.name}: block {k} {_told(block)} is out of the arena, 0 to "
                    f"{self.size:g} m"
                )

    def _check_gaps(self) -> None:
        """Every passage is wide enough, or too narrow for any robot."""
        shapes = [(f"block {k}", shapely.box(*b)) for k, b in enumerate(self.blocks)]
        s = self.size
        corners = {"west": (0, 0, 0, s), "east": (s, 0, s, s), "south": (0, 0, s, 0),
                   "north": (0, s, s, s)}  # fmt: skip
        walls = [
            (f"the {side} wall", shapely.LineString([c[:2], c[2:]])) for side, c in corners.items()
        ]
        for k, (name, shape) in enumerate(shapes):
            for other, solid in shapes[k + 1 :] + walls:
                gap = shapely.distance(shape, solid)
                if 2 * ROBOT <= gap < GAP - _TOUCH:
                    raise InvalidInputError(
                        f"maze {self.name}: {name} and {other} leave a gap of {gap:.3g} m; a gap "
                        f"is {GAP} m or more, or below {2 * ROBOT} m, where no robot fits in"
                    )

    def _check_place(self, what: str, place: Array) -> None:
        x, y = place
        if not (0 <= x <= self.size and 0 <= y <= self.size):
            raise InvalidInputError(
                f"maze {self.name}: the {what} {_told(place)} is out of the arena, 0 to "
                f"{self.size:g} m"
            )
        point = shapely.Point(place)
        for k, block in enumerate(self.blocks):
            away = shapely.distance(point, shapely.box(*block))
            if away == 0:
                raise InvalidInputError(
                    f"maze {self.name}: the {what} {_told(place)} lies in block {k} {_told(block)}"
                )
            if away < ROBOT - _TOUCH:
                raise InvalidInputError(
                    f"maze {self.name}: a robot does not fit on the {what} {_told(place)}: "
                    f"block {k} is {away:.3g} m away, its radius {ROBOT} m"
                )
        away = min(x, y, self.size - x, self.size - y)
        if away < ROBOT - _TOUCH:
            raise InvalidInputError(
                f"maze {self.name}: a robot does not fit on the {what} {_told(place)}: a wall is "
                f"{away:.3g} m away, its radius {ROBOT} m"
            )


def load(path: Path = FILE) -> dict[str, Maze]:
    """Every maze of a file, by name.

    The file is JSON: ``size`` [m] of the square arenas, and ``mazes``, by name each with ``nest``
    and ``goal`` ``[x, y]`` and ``blocks``, a list of ``[x0, y0, x1, y1]``.

    Raises:
        InvalidInputError: The file cannot be read, is not such JSON, or a maze of it cannot be: the
            message names the maze and the block, nest or goal.
    """
    try:
        data = json.loads(path.read_text())
    except OSError as e:
        raise InvalidInputError(f"cannot read mazes from {path}: {e.strerror}") from e
    except json.JSONDecodeError as e:
        raise InvalidInputError(f"{path}, line {e.lineno}: no JSON ({e.msg})") from e
    if not isinstance(data, Mapping) or not isinstance(data.get("mazes"), Mapping):
        raise InvalidInputError(f"{path}: a file of mazes has size and mazes, by name")
    (size,) = _numbers(f"{path}: size", [data.get("size")], 1)
    if size <= 0:
        raise InvalidInputError(f"{path}: size must be positive; got {size:g} m")
    return {name: _maze(name, found, size) for name, found in data["mazes"].items()}


def maze(name: str) -> Maze:
    """One of the study's own mazes.

    Raises:
        UnknownNameError: No such maze; lists those there are.
    """
    mazes = _own()
    if name not in mazes:
        raise UnknownNameError("maze", name, mazes)
    return mazes[name]


@functools.cache
def _own() -> dict[str, Maze]:
    """The study's mazes, read and checked once a process."""
    return load()


def _maze(name: str, found: Any, size: float) -> Maze:
    if not isinstance(found, Mapping):
        raise InvalidInputError(f"maze {name}: it has nest, goal and blocks; got {found!r}")
    for key in ("nest", "goal", "blocks"):
        if key not in found:
            raise InvalidInputError(f"maze {name}: it has no {key}")
    if not isinstance(found["blocks"], list):
        raise InvalidInputError(f"maze {name}: blocks is a list; got {found['blocks']!r}")
    blocks = [_numbers(f"maze {name}: block {k}", b, 4) for k, b in enumerate(found["blocks"])]
    table = np.array(blocks, dtype=np.float64).reshape(-1, 4)
    table.setflags(write=False)
    return Maze(
        name=name,
        size=size,
        nest=_numbers(f"maze {name}: nest", found["nest"], 2),
        goal=_numbers(f"maze {name}: goal", found["goal"], 2),
        blocks=table,
    )


def _numbers(what: str, given: Any, count: int) -> Array:
    """A list of that many finite numbers, as an array that cannot be written to."""
    good = isinstance(given, list) and len(given) == count
    # bool is a kind of int in Python
    good = good and all(isinstance(v, int | float) and not isinstance(v, bool) for v in given)
    if not good or not all(math.isfinite(v) for v in given):
        shown = given[0] if count == 1 and isinstance(given, list) else given
        many = "a finite number" if count == 1 else f"{count} finite numbers"
        raise InvalidInputError(f"{what} must be {many}; got {shown!r}")
    array = np.array(given, dtype=np.float64)
    array.setflags(write=False)
    return array


def _told(numbers: Array) -> str:
    return f"({', '.join(f'{v:g}' for v in numbers)})"
