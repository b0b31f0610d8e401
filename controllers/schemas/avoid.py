"""Avoid and swirl: away from things, or round them."""

from dataclasses import KW_ONLY, dataclass

import numpy as np

from controllers.schemas.base import Schema, View, check_ranges, label_of
from controllers.schemas.percepts import Array
from mjmr.errors import InvalidInputError
from mjmr.jit import njit


def _check(schema: str, reach: float, stop: float) -> None:
    check_ranges(schema, reach=reach, stop=stop)
    if not stop < reach:
        raise InvalidInputError(f"{schema}: stop must be below reach; got {stop} and {reach} m")


@dataclass(frozen=True, eq=False)
class Avoid(Schema):
    """Away from every thing within reach.

    A thing whose surface is ``gap`` from the robot's centre gives a vector of length 0 beyond
    ``reach``, (reach - gap) / (reach - stop) between, 1 within ``stop``; the vectors are added.

    Source: R. C. Arkin, IJRR 8(4), 1989, schema *avoid-static-obstacle*.

    Attributes:
        of: Percept.
        reach: [m].
        stop: [m].
    """

    of: str
    _: KW_ONLY
    reach: float
    stop: float

    def __post_init__(self):
        _check(self.label, self.reach, self.stop)

    @property
    def label(self) -> str:
        """Avoid and what."""
        return f"avoid {self.of}"

    @property
    def percepts(self) -> tuple[str, ...]:
        """What it avoids."""
        return (self.of,)

    def field(self, view: View) -> Array:
        """Vectors (n, 2)."""
        things = view.things(self.of)
        return _avoid(things.offset, things.radius, things.valid, self.reach, self.stop)


@dataclass(frozen=True, eq=False)
class Swirl(Schema):
    """Round every thing within reach, on the side that a direction prefers.

    Perpendicular to the thing's bearing, with the ramp of :class:`Avoid`; of the two
    perpendiculars the one with a positive product with the direction of ``towards`` is taken, the
    left one where neither has. With ``saturation`` the vector shrinks as robot, thing and direction
    get into line, so that a robot settles there instead of going to and fro: its length is the
    sine of the misalignment over the saturation, at most 1, and 1 on the wrong side of the thing.

    Source: the Clay library of TeamBots (T. Balch), *swirl obstacles*; the saturation is ours.

    Attributes:
        of: Percept.
        towards: Percept or schema.
        away: Take the direction's opposite: a robot that swirls away from home gets a thing between
            itself and home.
        reach: [m]; inf: full strength at any range.
        stop: [m].
        saturation: Sine of the misalignment from which on the vector has its full length; 0: it
            always has.
    """

    of: str
    _: KW_ONLY
    towards: str | Schema
    away: bool = False
    reach: float = np.inf
    stop: float = 0.0
    saturation: float = 0.0

    def __post_init__(self):
        _check(self.label, self.reach, self.stop)
        if not 0 <= self.saturation <= 1:
            raise InvalidInputError(
                f"{self.label}: saturation is a sine, 0 to 1; got {self.saturation}"
            )

    @property
    def label(self) -> str:
        """Swirl, what, and where to."""
        return f"swirl {self.of} {'away from' if self.away else 'to'} {label_of(self.towards)}"

    @property
    def percepts(self) -> tuple[str, ...]:
        """What it goes round, and what decides the side."""
        return (self.of, self.towards) if isinstance(self.towards, str) else (self.of,)

    @property
    def asks(self) -> tuple[Schema, ...]:
        """The schema that decides the side."""
        return () if isinstance(self.towards, str) else (self.towards,)

    def field(self, view: View) -> Array:
        """Vectors (n, 2)."""
        things = view.things(self.of)
        side = view.direction(self.towards)
        return _swirl(
            things.offset, things.radius, things.valid, -side if self.away else side,
            self.reach, self.stop, self.saturation,
        )  # fmt: skip


@njit
def ramp(gap: float, reach: float, stop: float) -> float:
    """Strength of a thing at a gap: 0 beyond reach, 1 within stop, linear between."""
    if gap >= reach:
        return 0.0
    if gap <= stop or reach == np.inf:
        return 1.0
    return (reach - gap) / (reach - stop)


@njit
def _avoid(offset, radius, valid, reach, stop):
    n, k = radius.shape
    total = np.zeros((n, 2))
    for i in range(n):
        for j in range(k):
            if not valid[i, j]:
                continue
            distance = np.hypot(offset[i, j, 0], offset[i, j, 1])
            if distance == 0.0:
                continue
            strength = ramp(distance - radius[i, j], reach, stop) / distance
            total[i, 0] -= strength * offset[i, j, 0]
            total[i, 1] -= strength * offset[i, j, 1]
    return total


@njit
def _swirl(offset, radius, valid, side, reach, stop, saturation):
    n, k = radius.shape
    total = np.zeros((n, 2))
    for i in range(n):
        if side[i, 0] == 0.0 and side[i, 1] == 0.0:
            continue
        for j in range(k):
            if not valid[i, j]:
                continue
            distance = np.hypot(offset[i, j, 0], offset[i, j, 1])
            if distance == 0.0:
                continue
            strength = ramp(distance - radius[i, j], reach, stop)
            if strength == 0.0:
                continue
            x, y = offset[i, j, 0] / distance, offset[i, j, 1] / distance
            left = -y * side[i, 0] + x * side[i, 1]  # sine from the thing's bearing to the side
            if saturation > 0.0 and x * side[i, 0] + y * side[i, 1] < 0.0:
                strength *= min(1.0, abs(left) / saturation)
            if left >= 0.0:
                total[i, 0] -= strength * y
                total[i, 1] += strength * x
            else:
                total[i, 0] += strength * y
                total[i, 1] -= strength * x
    return total
