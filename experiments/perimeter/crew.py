"""What a trial reads of a team, whichever class takes the role, and what it works out itself."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.perimeter import MOVING, STATES, TRACKING, Percepts
from controllers.perimeter.percepts import SPOKEN
from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]


class Crew:
    """A team of the role ``team`` as the trial sees it.

    A team has ``step`` and ``state``. What else the published one tells of itself is taken from it
    if it is there; otherwise ``joined`` and ``told`` follow from the states, ``sensed`` is when one
    first had the perimeter in range, nobody counts hops, and d_des is not known.
    """

    def __init__(self, team: Any, n: int):
        """Watch it.

        Args:
            team: Of the role.
            n: How many robots.

        Raises:
            InvalidInputError: It has no states, or not such as can be read.
        """
        self._team, self._n = team, n
        self._joined, self._sensed = np.full(n, np.nan), np.full(n, np.nan)
        self._told = np.zeros(n, dtype=bool)
        self._check()

    def step(self, now: Percepts) -> Array:
        """Commands (n, 2) of the team."""
        command = self._team.step(now)
        self._check()
        state, new = self.state, np.isnan(self._joined)
        self._joined = np.where(new & (state == TRACKING), now.time, self._joined)
        self._told |= np.isnan(self._joined) & (state == MOVING)
        seen = np.isnan(self._sensed) & np.isfinite(now.edge[:, 0])
        self._sensed = np.where(seen, now.time, self._sensed)
        return command

    def speak(self, now: Percepts) -> NDArray[np.float32] | None:
        """What is broadcast (n, c); None of a team that does not speak.

        Raises:
            InvalidInputError: Rows of another length than ``SPOKEN``.
        """
        if not callable(getattr(self._team, "speak", None)):
            return None
        spoken = np.asarray(self._team.speak(now), dtype=np.float32)
        if spoken.shape != (self._n, len(SPOKEN)):
            raise InvalidInputError(
                f"a team of {self._n} speaks arrays of shape {(self._n, len(SPOKEN))}, columns "
                f"{', '.join(SPOKEN)}; got {spoken.shape}"
            )
        return spoken

    def tell(self, who: NDArray[np.bool_], place: Array, time: float) -> None:
        """An operator tells robots ``who`` (n,) that a perimeter is at ``place`` (2,).

        Raises:
            InvalidInputError: The team cannot be told.
        """
        if not callable(getattr(self._team, "tell", None)):
            raise InvalidInputError(
                "failure=lie tells robots a location: the team needs a method tell(who, place, "
                "time), and this one has none"
            )
        self._team.tell(who, place, time)

    @property
    def state(self) -> NDArray[np.int64]:
        """Of each robot (n,), index into ``STATES``."""
        return np.asarray(self._team.state)

    @property
    def joined(self) -> Array:
        """When each first tracked (n,) [s], NaN: not yet."""
        return getattr(self._team, "joined", self._joined)

    @property
    def told(self) -> NDArray[np.bool_]:
        """Who was ever MOVING before it first tracked (n,)."""
        return getattr(self._team, "told", self._told)

    @property
    def sensed(self) -> Array:
        """When each first sensed a perimeter (n,) [s], NaN: not yet."""
        return getattr(self._team, "sensed", self._sensed)

    @property
    def hops(self) -> NDArray[np.int64]:
        """Over how many radios the news each robot holds came (n,)."""
        return getattr(self._team, "hops", np.zeros(self._n, dtype=np.int64))

    @property
    def desired(self) -> Array:
        """d_des of each robot (n,) [m]; NaN: not known."""
        return getattr(self._team, "desired", np.full(self._n, np.nan))

    def _check(self) -> None:
        state = getattr(self._team, "state", None)
        found = np.asarray(() if state is None else state)
        whole = found.shape == (self._n,) and found.dtype.kind in "iu"
        if not (whole and ((found >= 0) & (found < len(STATES))).all()):
            told = "none" if state is None else repr(state)
            raise InvalidInputError(
                f"a team has an attribute state: an array of {self._n} whole numbers from 0 to "
                f"{len(STATES) - 1} for {', '.join(STATES)}; got {told}"
            )
