"""News of a perimeter: who sensed it tells, who hears it tells on."""

import numpy as np
from numpy.typing import NDArray

from controllers.perimeter import percepts
from controllers.perimeter.percepts import Percepts

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


class Relay:
    """The newest news each robot holds, which it repeats in all it broadcasts.

    So news hops on to whoever is in reach of somebody who holds it. News that turned out to be
    false is not believed again unless its origin tells something newer.

    Attributes:
        place: Where (n, 2) [m], world frame; NaN rows: no news.
        told_at: When it was sensed (n,) [s], -inf: no news.
        origin: Who sensed it (n,), -1: none.
        hops: Over how many radios it came (n,).
    """

    def __init__(self, n: int):
        """Start without news."""
        self.place = np.full((n, 2), np.nan)
        self.told_at = np.full(n, -np.inf)
        self.origin = np.full(n, -1, dtype=np.int64)
        self.hops = np.zeros(n, dtype=np.int64)
        self._believed_after = np.full((n, n + 1), -np.inf)  # robot, origin (last: an operator)

    def sense(self, who: Flags, place: Array, time: float) -> None:
        """Robots ``who`` (n,) sense a perimeter at ``place`` (n, 2) now."""
        self._take(who, place, np.full(len(who), time), np.arange(len(who)), 0)

    def tell(self, who: Flags, place: Array, time: float) -> None:
        """An operator tells robots ``who`` (n,) of a place (2,); true or not, they cannot know."""
        n = len(who)
        self._take(who, np.tile(place, (n, 1)), np.full(n, time), np.full(n, n), 0)

    def hear(self, now: Percepts, fresh: Flags) -> None:
        """Take over what is newer than one's own.

        Args:
            now: With what was heard.
            fresh: Which of it counts (n, n).
        """
        heard = now.heard
        n = len(heard)
        with np.errstate(invalid="ignore"):
            at = np.where(fresh, heard[..., percepts.NEWS_AT], -np.inf)
        at = np.where(np.isfinite(at), at, -np.inf)
        origin = np.where(np.isfinite(at), heard[..., percepts.NEWS_OF], -1).astype(np.int64)
        believed = at > np.take_along_axis(self._believed_after, np.maximum(origin, 0), axis=1)
        at = np.where(believed & (origin != np.arange(n)[:, None]), at, -np.inf)
        best = np.argmax(at, axis=1)
        rows = np.arange(n)
        newer = at[rows, best] > self.told_at
        told = heard[rows, best]
        hops = np.nan_to_num(told[:, percepts.HOPS]).astype(np.int64) + 1
        place = told[:, [percepts.NEWS_X, percepts.NEWS_Y]]
        self._take(newer, place, at[rows, best], origin[rows, best], hops)

    def disbelieve(self, who: Flags) -> None:
        """Robots ``who`` (n,) found nothing where they were told."""
        rows = np.flatnonzero(who & (self.origin >= 0))
        self._believed_after[rows, self.origin[rows]] = self.told_at[rows]
        self.place[rows], self.told_at[rows], self.origin[rows] = np.nan, -np.inf, -1

    def _take(self, who: Flags, place: Array, at: Array, origin, hops) -> None:
        self.place = np.where(who[:, None], place, self.place)
        self.told_at = np.where(who, at, self.told_at)
        self.origin = np.where(who, origin, self.origin)
        self.hops = np.where(who, hops, self.hops)
