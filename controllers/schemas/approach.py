"""Move to, draw and follow: along the line to one thing."""

from dataclasses import KW_ONLY, dataclass

import numpy as np

from controllers.schemas.base import Schema, View, check_ranges, unit
from controllers.schemas.percepts import Array
from mjmr.errors import InvalidInputError


class _ToOne(Schema):
    """A vector along the line to the nearest thing, of a length that depends on its range."""

    to: str

    @property
    def percepts(self) -> tuple[str, ...]:
        """Where it goes."""
        return (self.to,)

    def field(self, view: View) -> Array:
        """Vectors (n, 2); 0 for robots that perceive no such thing."""
        things = view.things(self.to)
        nearest = things if things.offset.shape[1] == 1 else things.nearest()
        gap = np.where(nearest.valid, nearest.gap, 0.0)
        offset = np.where(nearest.valid, nearest.offset[:, 0], 0.0)
        return self._length(gap) * unit(offset)

    def _length(self, gap: Array) -> Array:
        """Signed lengths (n, 1) at ranges (n, 1) from the robot's centre to the surface [m]."""
        raise NotImplementedError


@dataclass(frozen=True, eq=False)
class MoveTo(_ToOne):
    """Towards a thing at full strength, down to a dead zone; back off if too near.

    Source: the Clay library of TeamBots (T. Balch), *linear attraction* with controlled and dead
    zone; backing off is ours.

    Attributes:
        to: Percept; of several things the nearest.
        dead_zone: Range from the robot's centre to the thing's surface within which it is idle
            [m].
        slow: Beyond the dead zone the length grows from 0 to 1 over this range [m].
        repel: Range within which it backs off instead; at most the dead zone [m].
        touch: Range at which it backs off at full strength; below ``repel`` [m].
    """

    to: str
    _: KW_ONLY
    dead_zone: float = 0.0
    slow: float = 0.0
    repel: float = 0.0
    touch: float = 0.0

    def __post_init__(self):
        check_ranges(self.label, dead_zone=self.dead_zone, slow=self.slow, repel=self.repel,
                     touch=self.touch)  # fmt: skip
        if self.repel > self.dead_zone or (self.repel > 0 and not self.touch < self.repel):
            raise InvalidInputError(
                f"{self.label}: touch < repel <= dead_zone; got {self.touch}, {self.repel} and "
                f"{self.dead_zone} m"
            )

    @property
    def label(self) -> str:
        """Move to, and where."""
        return f"move to {self.to}"

    def _length(self, gap: Array) -> Array:
        beyond = gap - self.dead_zone
        length = np.minimum(1.0, beyond / self.slow) if self.slow else 1.0
        length = np.where(beyond > 0, length, 0.0)
        if self.repel > 0:
            within = (self.repel - gap) / (self.repel - self.touch)
            length = np.where(within > 0, -np.minimum(1.0, within), length)
        return length


@dataclass(frozen=True, eq=False)
class Draw(_ToOne):
    """Linear attraction: the stronger the further away, 1 from ``full`` on.

    Attributes:
        to: Percept.
        full: Range from which on it has its full strength [m].
    """

    to: str
    _: KW_ONLY
    full: float

    def __post_init__(self):
        if not 0 < self.full < np.inf:
            raise InvalidInputError(
                f"{self.label}: full must be positive and finite; got {self.full} m"
            )

    @property
    def label(self) -> str:
        """Draw to, and where."""
        return f"draw to {self.to}"

    def _length(self, gap: Array) -> Array:
        return np.clip(gap / self.full, 0.0, 1.0)


@dataclass(frozen=True, eq=False)
class Follow(_ToOne):
    """Keep a distance from a thing that moves: towards it beyond, away from it within.

    Attributes:
        to: Percept.
        distance: From the robot's centre to its surface [m].
        slack: Away from that distance the length grows from 0 to 1 over this range [m].
    """

    to: str
    _: KW_ONLY
    distance: float
    slack: float

    def __post_init__(self):
        check_ranges(self.label, distance=self.distance)
        if not self.slack > 0:
            raise InvalidInputError(f"{self.label}: slack must be positive; got {self.slack} m")

    @property
    def label(self) -> str:
        """Follow, and what."""
        return f"follow {self.to}"

    def _length(self, gap: Array) -> Array:
        return np.clip((gap - self.distance) / self.slack, -1.0, 1.0)
