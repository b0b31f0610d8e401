"""Offices: walls, doors, rooms with goals and patrol routes from a JSON file, checked.

A file is an object with ``name``, ``size`` [width, height], ``walls`` [[x0, y0, x1, y1], ...],
``doors`` [{"x", "y", "dir": "h" or "v", "width"}, ...], ``rooms`` [{"rect": [x0, y0, x1, y1],
"goal": [x0, y0, x1, y1]}, ...] and ``routes`` [[[x, y], ...], ...], all in metres. Doors are gaps
between walls; listing them says which gaps are meant, so that another one is found out.
"""

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LineString, Point, Polygon, box
from shapely.geometry.polygon import orient

from mjmr.errors import InvalidInputError
from mjmr.finite import finite

Array = NDArray[np.float64]
_TOUCH = 1e-6  # m


@dataclass(frozen=True)
class Office:
    """An office that has been checked; see :func:`load_office`.

    Args:
        name: Of the file.
        size: Width and height (2,) [m]; the corner at the lower left is (0, 0).
        walls: Shape (k, 4): x0, y0, x1, y1 [m].
        doors: Shape (k, 4): x, y, width [m], and 1 for a gap along x, 0 along y.
        rooms: Rectangles (k, 4): x0, y0, x1, y1 [m].
        goals: Rectangles (k, 4) goals are drawn from, one a room [m].
        routes: Closed ways over waypoints, each (k, 2) [m].
    """

    name: str
    size: Array
    walls: Array
    doors: Array
    rooms: Array
    goals: Array
    routes: tuple[Array, ...]

    def free_space(self, clearance: float) -> Polygon:
        """Where a robot's centre may be, ``clearance`` [m] from every wall.

        Wall ends are square and corners mitred, so that the free space keeps few vertices. Of
        several pieces the largest.

        Raises:
            InvalidInputError: Nothing is left.
        """
        return free_space(self.size, self.walls, clearance)

    def edges(self, clearance: float) -> tuple[Array, NDArray[np.int64]]:
        """Edges of the free space and which of them follow each other.

        Args:
            clearance: See :meth:`free_space` [m].

        Returns:
            Edges (m, 4): x0, y0, x1, y1 [m], each with the free space on its left, and (m, 2): the
            index of the edge after and before each.
        """
        polygon = self.free_space(clearance)
        edges, links, first = [], [], 0
        for ring in (polygon.exterior, *polygon.interiors):
            points = np.asarray(ring.coords)
            k = len(points) - 1
            edges.append(np.hstack([points[:-1], points[1:]]))
            index = np.arange(k)
            links.append(np.column_stack([(index + 1) % k, (index - 1) % k]) + first)
            first += k
        return np.vstack(edges), np.vstack(links).astype(np.int64)

    def goal(self, room: int, rng: np.random.Generator, free: Polygon) -> Array:
        """A point (2,) [m], uniform in what is free of a room's goal rectangle.

        Args:
            room: Its index.
            rng: Draws.
            free: Free space, see :meth:`free_space`; the rectangle may reach up to a wall.
        """
        x0, y0, x1, y1 = self.goals[room]
        while True:  # the loader made sure that some of it is free
            point = rng.uniform([x0, y0], [x1, y1])
            if free.contains(Point(point)):
                return point


def free_space(size: Any, walls: Any, clearance: float) -> Polygon:
    """See :meth:`Office.free_space`."""
    lines = shapely.linestrings(np.asarray(walls, dtype=np.float64).reshape(-1, 2, 2))
    thick = shapely.buffer(lines, clearance, cap_style="square", join_style="mitre")
    left = box(0.0, 0.0, *size).difference(shapely.union_all(thick))
    pieces = list(getattr(left, "geoms", [left]))
    largest = max(pieces, key=lambda piece: piece.area)
    if largest.is_empty or not isinstance(largest, Polygon):
        raise InvalidInputError(f"no room is left {clearance:g} m from the walls of this office")
    # without vertices on straight sides
    slim = largest.simplify(0.0)
    assert isinstance(slim, Polygon)
    return orient(slim)


def load_office(path: str | Path, clearance: float = 0.235) -> Office:
    """Read and check an office.

    Args:
        path: JSON file, see the module.
        clearance: Robots' centres stay this far from walls [m]; goals and routes must.

    Raises:
        InvalidInputError: Not such a file, the office does not close, a goal lies in a wall or out
            of reach, or a route crosses a wall; names the entry and the file's line.
    """
    path = Path(path)
    try:
        text = path.read_text()
        given = json.loads(text)
    except (OSError, ValueError) as e:
        raise InvalidInputError(f"cannot read office {path}: {e}") from e
    return _Checker(path.name, text, given).office(clearance)


class _Checker:
    """Checks one file; every error says where."""

    def __init__(self, file: str, text: str, given: Any):
        if not isinstance(given, Mapping):
            raise InvalidInputError(f"office {file}: expected an object with size, walls, rooms")
        self.file, self.text, self.given = file, text, given

    def office(self, clearance: float) -> Office:
        size = self._numbers("size", self.given.get("size"), 2)
        if not (size > 0).all():
            raise self._error("size", None, f"must be positive, not {size.tolist()}")
        walls = self._rows("walls", 4)
        doors = np.array([self._door(k, d) for k, d in enumerate(self._list("doors"))])
        rooms, goals = self._rooms()
        routes = tuple(self._route(k, r) for k, r in enumerate(self._list("routes")))
        office = Office(
            str(self.given.get("name", self.file)), size, walls, doors.reshape(-1, 4), rooms, goals,
            routes,
        )  # fmt: skip
        self._walls_fit(office)
        self._closes(office)
        free = office.free_space(clearance)
        self._goals_lie(office, free, clearance)
        self._routes_run(office, free, clearance)
        return office

    def _error(self, key: str, index: int | None, words: str) -> InvalidInputError:
        line = self._line(key, *([] if index is None else [index]))
        entry = key if index is None else f"{key.removesuffix('s')} {index}"
        where = f" (line {line})" if line else ""
        return InvalidInputError(f"office {self.file}: {entry}{where} {words}")

    def _line(self, key: str, *indices: int) -> int | None:
        """Line of the file, from 1, that an entry begins on, or one of a list in it."""
        found = re.search(rf'"{key}"\s*:\s*', self.text)
        if found is None:
            return None
        at = found.end() if indices else found.start()
        for index in indices:
            at = self._skip(at + 1)  # past the bracket
            for _ in range(index):
                at = self._skip(json.JSONDecoder().raw_decode(self.text, at)[1])
        return self.text.count("\n", 0, at) + 1

    def _skip(self, at: int) -> int:
        while self.text[at] in " \t\r\n,":
            at += 1
        return at

    def _list(self, key: str) -> list[Any]:
        found = self.given.get(key, [])
        if not isinstance(found, list):
            raise self._error(key, None, f"must be a list, not {found!r}")
        return found

    def _numbers(self, key: str, value: Any, count: int, index: int | None = None) -> Array:
        row = finite(value, (count,))
        if row is None:
            raise self._error(key, index, f"must be {count} numbers, not {value!r}")
        return row

    def _rows(self, key: str, count: int) -> Array:
        rows = [self._numbers(key, row, count, k) for k, row in enumerate(self._list(key))]
        if not rows:
            raise self._error(key, None, "must not be empty")
        return np.array(rows)

    def _door(self, index: int, door: Any) -> Array:
        if not isinstance(door, Mapping) or door.get("dir") not in ("h", "v"):
            raise self._error("doors", index, f"needs x, y, width and dir h or v; got {door!r}")
        place = [door.get("x"), door.get("y"), door.get("width")]
        x, y, width = self._numbers("doors", place, 3, index)
        if not width > 0:
            raise self._error("doors", index, f"needs a width above 0, not {width:g}")
        return np.array([x, y, width, 1.0 if door["dir"] == "h" else 0.0])

    def _rooms(self) -> tuple[Array, Array]:
        rooms, goals = [], []
        for k, room in enumerate(self._list("rooms")):
            if not isinstance(room, Mapping):
                raise self._error("rooms", k, f"needs rect and goal; got {room!r}")
            for key, into in (("rect", rooms), ("goal", goals)):
                row = self._numbers("rooms", room.get(key), 4, k)
                if not (row[2] > row[0] and row[3] > row[1]):
                    raise self._error(
                        "rooms", k, f"has a {key} that is empty: x0, y0, x1, y1 = {row.tolist()}"
                    )
                into.append(row)
        if not rooms:
            raise self._error("rooms", None, "must not be empty")
        return np.array(rooms), np.array(goals)

    def _route(self, index: int, route: Any) -> Array:
        if not isinstance(route, list) or len(route) < 2:
            raise self._error("routes", index, f"needs two waypoints or more, not {route!r}")
        for k, point in enumerate(route):
            if finite(point, (2,)) is None:
                line = self._line("routes", index, k)
                raise self._error(
                    "routes", index,
                    f"has waypoint {k} (line {line}), which must be 2 numbers, not {point!r}",
                )  # fmt: skip
        return np.array(route, dtype=np.float64)

    def _walls_fit(self, office: Office) -> None:
        whole = box(-_TOUCH, -_TOUCH, *(office.size + _TOUCH))
        for k, wall in enumerate(office.walls):
            line = LineString(wall.reshape(2, 2))
            if line.length < _TOUCH:
                raise self._error("walls", k, f"has no length: {wall.tolist()}")
            if not whole.contains(line):
                raise self._error("walls", k, f"{wall.tolist()} leaves the office's size")

    def _closes(self, office: Office) -> None:
        """The outline by walls; every room that has a wall at all, by walls and doors."""
        walls = shapely.union_all(shapely.linestrings(office.walls.reshape(-1, 2, 2)))
        self._open_side("size", None, np.array([0.0, 0.0, *office.size]), walls, office)
        gaps = [
            LineString([(x - w / 2 * h, y - w / 2 * (1 - h)), (x + w / 2 * h, y + w / 2 * (1 - h))])
            for x, y, w, h in office.doors
        ]
        closed = shapely.union_all([walls, *gaps]).buffer(_TOUCH)
        for k, rect in enumerate(office.rooms):
            outline = box(*rect).exterior
            if outline.intersection(closed).length > 10 * _TOUCH:
                self._open_side("rooms", k, rect, closed, office)

    def _open_side(
        self, key: str, index: int | None, rect: Array, closed: Any, office: Office
    ) -> None:
        x0, y0, x1, y1 = rect
        sides = {
            "south": [(x0, y0), (x1, y0)],
            "east": [(x1, y0), (x1, y1)],
            "north": [(x1, y1), (x0, y1)],
            "west": [(x0, y1), (x0, y0)],
        }
        for side, ends in sides.items():
            left = LineString(ends).difference(closed.buffer(_TOUCH))
            if left.length < 10 * _TOUCH:
                continue
            gap = max(getattr(left, "geoms", [left]), key=lambda piece: piece.length)
            (ax, ay), (bx, by) = gap.coords[0], gap.coords[-1]
            lines = shapely.linestrings(office.walls.reshape(-1, 2, 2))
            near = int(np.argmin(shapely.distance(lines, Point(ax, ay))))
            what = "outline" if key == "size" else "room"
            raise self._error(
                key, index,
                f"does not close: its {what} is open on the {side} side from ({ax:g}, {ay:g}) to "
                f"({bx:g}, {by:g}), with neither wall nor door; the nearest wall is wall {near} "
                f"(line {self._line('walls', near)})",
            )  # fmt: skip

    def _goals_lie(self, office: Office, free: Polygon, clearance: float) -> None:
        whole = box(0.0, 0.0, *office.size)
        lines = shapely.linestrings(office.walls.reshape(-1, 2, 2))
        for k, goal in enumerate(office.goals):
            area = box(*goal)
            told = f"has its goal {goal.tolist()}"
            if not whole.contains(area):
                raise self._error("rooms", k, f"{told} outside the office")
            # a rectangle may reach up to a wall, but no wall may go through it
            through = np.flatnonzero(shapely.crosses(lines, area) | shapely.within(lines, area))
            if through.size:
                wall = int(through[0])
                raise self._error(
                    "rooms", k, f"{told} in wall {wall} (line {self._line('walls', wall)})"
                )
            if free.intersection(area).area < 0.25 * area.area:
                raise self._error(
                    "rooms", k,
                    f"{told} where a robot that keeps {clearance:g} m from walls cannot get",
                )  # fmt: skip

    def _routes_run(self, office: Office, free: Polygon, clearance: float) -> None:
        lines = shapely.linestrings(office.walls.reshape(-1, 2, 2))
        for k, route in enumerate(office.routes):
            for a, b in zip(route, np.roll(route, -1, axis=0), strict=True):
                leg = LineString([a, b])
                told = f"crosses a wall on its way from {a.tolist()} to {b.tolist()}"
                if free.covers(leg):
                    continue
                near = int(np.argmin(shapely.distance(lines, leg)))
                raise self._error(
                    "routes", k,
                    f"{told}: wall {near} (line {self._line('walls', near)}) is nearer than "
                    f"{clearance:g} m",
                )  # fmt: skip
