"""What a trial needs of the place its robots are in, planar or physical."""

from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


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
    """

    way: Array
    bumps: NDArray[np.int64]
    place: Array
    groups: tuple[int, int, int, int]


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
