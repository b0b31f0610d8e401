"""What a trial needs of the place its robots are in, planar or physical."""

import math
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from controllers.scouting.coding import Codec
from mjmr.byte_channel import ByteTiming
from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
DRIFT = 0.2  # Hz, at which a compass's drift is cut off
CLEARANCE = 0.01  # m, round a robot that is put down


@dataclass(frozen=True, kw_only=True)
class CompassErrors:
    """Errors of the compass.

    Args:
        noise: Deviation of every reading [rad].
        drift: Deviation of an error that wanders, cut off at ``DRIFT`` [rad].
        bias: Bound of an error that depends on the place, in waves about 2 m long [rad].
        step: Readings are whole multiples of it [rad]; 0: not rounded.
    """

    noise: float = math.radians(2.0)
    drift: float = math.radians(1.0)
    bias: float = math.radians(5.0)
    step: float = math.radians(2.0)


EXACT = CompassErrors(noise=0.0, drift=0.0, bias=0.0, step=0.0)


def _nobody() -> Flags:
    return np.zeros(0, dtype=bool)


@dataclass(frozen=True, kw_only=True, eq=False)
class Setting:
    """What a field is made from: an empty maze and n robots beside it.

    Args:
        n: Robots.
        seed: Of the trial.
        size: Side of the arena [m].
        blocks: Corners (k, 4) [m].
        nest: (2,) [m].
        goal: (2,) [m].
        compass: Its errors.
        servo_spread: Each servo is up to this much fast or slow, for good; below 1.
        timing: Of the radio.
        codec: Whose checks count accepted groups, and in MuJoCo the receivers make; the team has
            its own.
        blind: Whose infrared detectors are dead (n,); default: nobody's.

    Raises:
        InvalidInputError: Flags of another number of robots.
    """

    n: int
    seed: int
    size: float
    blocks: Array
    nest: Array
    goal: Array
    compass: CompassErrors = field(default_factory=CompassErrors)
    servo_spread: float = 0.05
    timing: ByteTiming = field(default_factory=ByteTiming)
    codec: Codec = field(default_factory=Codec)
    blind: Flags = field(default_factory=_nobody)

    def __post_init__(self):
        for name in ("blocks", "nest", "goal"):
            object.__setattr__(self, name, np.array(getattr(self, name), dtype=np.float64))
        blind = np.array(self.blind, dtype=bool)
        blind = blind if blind.size else np.zeros(self.n, dtype=bool)
        if blind.shape != (self.n,):
            raise InvalidInputError(f"blind are {self.n} flags; got shape {blind.shape}")
        object.__setattr__(self, "blind", blind)


class Senses(NamedTuple):
    """Readings of one program loop, arrays over the team.

    Attributes:
        heading: Compass (n,) [rad]; NaN for robots that are not there.
        ir: Left and right detector (n, 2).
        bump: Left and right half of the front bumper, pressed since the last loop (n, 2).
        goal: Whether the goal is seen (n,).
    """

    heading: Array
    ir: Flags
    bump: Flags
    goal: Flags


class Tally(NamedTuple):
    """What is measured of a run; truth, read after it.

    Attributes:
        way: Path length of each robot (n,) [m].
        bumps: Loops in which a robot's bumper was pressed (n,).
        place: Where each robot is, or was when it was taken away (n, 2) [m].
        groups: Read while a carrier was there, accepted, dropped, accepted though not sent so.
        hidden: Loops in which a dead detector of a robot had something to be tripped by (n,).
    """

    way: Array
    bumps: NDArray[np.int64]
    place: Array
    groups: tuple[int, int, int, int]
    hidden: NDArray[np.int64]


class Field(Protocol):
    """Robots in a maze, one program loop after the other.

    An experimenter puts robots down in the nest and picks them up; between that they move by their
    wheels alone.
    """

    time: float

    def put_down(self, robot: int) -> bool:
        """Put a robot into the nest, heading anywhere; False if it is not free."""
        ...

    def take_away(self, robot: int) -> None:
        """Pick a robot up; it can still send and hear."""
        ...

    def kill(self, robot: int) -> None:
        """From now on the robot stands still, sends nothing and hears nothing."""
        ...

    @property
    def running(self) -> Flags:
        """Who is in the maze and alive (n,)."""
        ...

    def sense(self) -> Senses:
        """Readings now."""
        ...

    def transmit(self, robot: int, message: bytes, duration: float) -> None:
        """Let a robot repeat a message from now on, for ``duration`` [s]."""
        ...

    def listen(self) -> tuple[NDArray[np.int64], NDArray[np.uint8]]:
        """Receivers (k,) and groups (k, 4) read since the last call."""
        ...

    def advance(self, command: Array) -> None:
        """Drive on for one loop with v [m/s] and w [rad/s], (n, 2)."""
        ...

    def tally(self) -> Tally:
        """What is measured."""
        ...
