"""What each robot knows of the goal, and what finishers tell the rest: the succession.

A scout that found the goal sends its vector. A worker that reaches it sends, by the rule in force:

- ``none``: nothing; everybody drives by the scout's vector.
- ``average``: the mean of the workers' own vectors; the scout's, which wandered, is replaced by
  the first of them.
- ``via``: up to four via-points of its own path, if that path is shorter than the one known by
  more than 3 %; the vector stays the scout's.
- ``both``.

Source: MacKunis and Raviv 2003, sections 2.1 and 3.5, where the content of the improvement is left
open ("shorter path, location of obstacles"); these rules are our reading. The mean is taken by the
sender, from what it has heard itself and its own vector, and rounded to a message each time.
"""

import numpy as np
from numpy.typing import NDArray

from controllers.scouting.coding import (
    FARTHEST,
    KINDS,
    RECORD,
    VECTOR,
    VIA,
    VIA_POINTS,
    Codec,
    from_code,
    to_code,
)
from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Ints = NDArray[np.int64]

SHORTER = 0.97
SIMPLIFY = 2.0
"""Via-points are the corners of a path simplified to this [units]: 0.15 m."""


def kinds_needed(succession: str) -> int:
    """Kinds of group that are sent under a rule."""
    return {"none": 1, "average": RECORD + 1}.get(succession, KINDS)


class Records:
    """Records of n robots.

    Attributes:
        known: Who has a goal (n,).
        goal: Vector from the nest (n, 2) [units].
        count: Workers it is the mean of (n,); 0: the scout's.
        length: Path length known (n,) [units]; infinite if none.
        vias: (n, 4, 2) [units]; NaN where there is none.
        outgoing: What each robot sends.
        dropped: Groups of each robot that failed their checks (n,).
    """

    def __init__(self, n: int, codec: Codec, succession: str = "none"):
        """Empty records.

        Args:
            n: Robots.
            codec: How messages are packed.
            succession: ``"none"``, ``"average"``, ``"via"`` or ``"both"``.
        """
        self.codec = codec
        self._average = succession in ("average", "both")
        self._via = succession in ("via", "both")
        if codec.kinds < kinds_needed(succession):
            raise InvalidInputError(
                f"succession {succession} needs {kinds_needed(succession)} kinds of group; the "
                f"codec has {codec.kinds}"
            )
        self.known = np.zeros(n, dtype=bool)
        self.goal = np.full((n, 2), np.nan)
        self.count = np.zeros(n, dtype=np.int64)
        self.length = np.full(n, np.inf)
        self.vias = np.full((n, VIA_POINTS, 2), np.nan)
        self.outgoing: list[bytes] = [b""] * n
        self.dropped = np.zeros(n, dtype=np.int64)

    def hear(self, receivers: Ints, groups: NDArray[np.uint8]) -> Flags:
        """Take groups as read, in order; returns which passed their checks (k,)."""
        if not len(receivers):
            return np.zeros(0, dtype=bool)
        kind = self.codec.kind(groups)
        valid = kind >= 0
        np.add.at(self.dropped, receivers[~valid], 1)
        # of equal groups the first is news; an endless repetition says nothing more
        told = np.column_stack([receivers, kind, groups])[valid]
        for robot, what, first, _, second, _ in dict.fromkeys(map(tuple, told.tolist())):
            self._take(robot, what, first, second)
        return valid

    def via_count(self, robot: int) -> int:
        """Via-points a robot knows."""
        return int(np.isfinite(self.vias[robot, :, 0]).cumprod().sum())

    def _take(self, robot: int, kind: int, first: int, second: int) -> None:
        if kind == VECTOR:
            self.known[robot] = True
            self.goal[robot] = from_code(first, second)
        elif kind == RECORD:
            self.count[robot] = first
            if float(second) != self.length[robot]:
                self.length[robot] = second
                self.vias[robot] = np.nan  # of a path that is no longer the one known
        elif kind >= VIA:
            self.vias[robot, kind - VIA] = from_code(first, second)

    def finish(
        self, robot: int, *, travelled: Array, length: float, trail: Array, scout: bool
    ) -> None:
        """A robot sees the goal: it updates its record, and what it sends from now on.

        Args:
            robot: Which.
            travelled: Its reckoning (2,) [units].
            length: Of its way [units].
            trail: Its reckoned way (k, 2) [units].
            scout: Whether it is a scout.
        """
        silent = not scout and not self._average and not self._via
        if silent:
            return
        shorter = length < SHORTER * self.length[robot]
        if scout or not self.known[robot]:
            self.known[robot] = True
            self.goal[robot], self.count[robot] = travelled, 0
        elif self._average:
            k = int(self.count[robot])
            self.goal[robot] = (k * self.goal[robot] + travelled) / (k + 1)
            self.count[robot] = min(k + 1, 127)
        elif not shorter:
            return
        if not scout and shorter:
            self.length[robot] = length
            if self._via:
                corners = _corners(trail)
                self.vias[robot] = np.nan
                self.vias[robot, : len(corners)] = corners
        self.outgoing[robot] = self._message(robot)

    def _message(self, robot: int) -> bytes:
        vector = self.codec.encode(*to_code(self.goal[robot]))
        if not (self._average or self._via):
            return vector
        points = b"".join(
            self.codec.encode(*to_code(self.vias[robot, k]), kind=VIA + k)
            for k in range(self.via_count(robot))
        )
        least = min(int(min(self.length[robot], FARTHEST)), FARTHEST)
        count = int(self.count[robot])
        # the path's length is for comparison only: of a few, the first without false phases
        told = b""
        for length in [*range(least, FARTHEST + 1), *range(least)]:
            told = vector + self.codec.encode(count, length, kind=RECORD) + points
            if not self.codec.impostors(told):
                break
        return told


def _corners(trail: Array) -> Array:
    """Up to four points of a path simplified to :data:`SIMPLIFY`, both ends left out."""
    from shapely.geometry import LineString

    if len(trail) < 3:
        return np.empty((0, 2))
    line = np.vstack([[0.0, 0.0], trail])
    corners = np.array(LineString(line).simplify(SIMPLIFY).coords)[1:-1]
    if len(corners) > VIA_POINTS:
        keep = np.linspace(0, len(corners) - 1, VIA_POINTS).round().astype(int)
        corners = corners[keep]
    return corners
