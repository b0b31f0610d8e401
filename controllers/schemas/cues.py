"""Perceptual cues: what switches a state machine, for every robot of a team at once."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from typing import Any

import numpy as np

from controllers.schemas.base import View
from controllers.schemas.percepts import Array, Flags
from mjmr.errors import InvalidInputError


class Cue(ABC):
    """Whether something holds, robot by robot."""

    @abstractmethod
    def holds(self, view: View, before: Flags) -> Flags:
        """Flags (n,) of this step, from those of the last one (all false at first)."""


@dataclass(frozen=True, eq=False)
class Sees(Cue):
    """Whether a robot perceives anything under a name."""

    percept: str

    def holds(self, view: View, before: Flags) -> Flags:
        """Flags (n,)."""
        return np.asarray(view.things(self.percept).valid.any(axis=1))


@dataclass(frozen=True, eq=False)
class Within(Cue):
    """Whether the surface of the nearest thing is within a distance, with hysteresis.

    Attributes:
        percept: Its name.
        distance: From the robot's centre: at most this switches it on [m].
        leave: More than this switches it off [m]; default: the same.
    """

    percept: str
    distance: float
    leave: float | None = None

    def __post_init__(self):
        _check_thresholds(f"within of {self.percept}", self.distance, self._leave)

    @property
    def _leave(self) -> float:
        return self.distance if self.leave is None else self.leave

    def holds(self, view: View, before: Flags) -> Flags:
        """Flags (n,)."""
        gaps = view.things(self.percept).gap
        gap = gaps.min(axis=1) if gaps.shape[1] else np.full(view.n, np.inf)
        return gap <= np.where(before, self._leave, self.distance)


@dataclass(frozen=True, eq=False)
class Hysteresis(Cue):
    """Whether a value is small: on at ``enter`` or less, off above ``leave`` or if not a number.

    Attributes:
        value: Function of the view, (n,).
        enter: Switches it on.
        leave: Switches it off; at least ``enter``.
    """

    value: Callable[[View], Array]
    _: KW_ONLY
    enter: float
    leave: float

    def __post_init__(self):
        _check_thresholds("hysteresis", self.enter, self.leave)

    def holds(self, view: View, before: Flags) -> Flags:
        """Flags (n,)."""
        with np.errstate(invalid="ignore"):
            return self.value(view) <= np.where(before, self.leave, self.enter)


@dataclass(frozen=True, eq=False)
class After(Cue):
    """Whether a robot has been in its state for so long [s]."""

    seconds: float

    def __post_init__(self):
        if not 0 <= self.seconds < np.inf:
            raise InvalidInputError(f"after: seconds must be 0 or more; got {self.seconds}")

    def holds(self, view: View, before: Flags) -> Flags:
        """Flags (n,)."""
        return view.state_time >= self.seconds - 1e-9


@dataclass(frozen=True, eq=False)
class Condition(Cue):
    """Any function of the view that returns flags (n,)."""

    test: Callable[[View], Any]

    def holds(self, view: View, before: Flags) -> Flags:
        """Flags (n,)."""
        return np.asarray(self.test(view), dtype=bool)


def _check_thresholds(name: str, enter: float, leave: float) -> None:
    if not enter <= leave:
        raise InvalidInputError(
            f"{name}: it must leave at the entering threshold or above; got {enter} and {leave}"
        )
