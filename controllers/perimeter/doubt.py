"""What to do where readings of inside and outside cannot all be right (ours).

Of readings that are wrong at random the bang-bang law averages as many a metre as it takes: on a
disc of 10 m it has 0.02 rad/s left to come back with if a fifth is wrong, and strays at 0.4 m/s.
Who has had such readings goes slower on the same path, and takes the majority of the last few.
"""

import numpy as np
from numpy.typing import NDArray

from controllers.perimeter.config import PerimeterConfig

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
VOTES = 5
MEMORY = 5.0  # s, in which what was counted fades
# counted: readings that are right give 2 at most on a disc, a fifth wrong 8
BEGINS, ENDS = 3.0, 1.0
# of the speed it may have; at lower ones a truck that sways crosses the edge to and fro
FAST = 0.75
STANDS = 6  # steps, after which it sways no more


class Doubt:
    """Who has had several readings lately that differ from the one before and the one after.

    Attributes:
        doubts: Who goes at ``doubt_speed`` at most, by the majority of ``VOTES`` readings (n,).
    """

    def __init__(self, n: int, config: PerimeterConfig):
        """Args: n: How many robots. config: With the speeds."""
        self._config = config
        self.doubts = np.zeros(n, dtype=bool)
        self._count = np.zeros(n)
        self._inside = np.full((VOTES, n), np.nan)  # newest first
        self._speeds = np.full((STANDS, n), np.nan)

    def believed(self, inside: Array, moved: Array, tracks: Flags) -> Array:
        """Inside or outside (n,), after those who doubt have voted.

        Args:
            inside: As read (n,).
            moved: Speed since the step before (n,) [m/s].
            tracks: Who tracks (n,); others know nothing of it.
        """
        c = self._config
        self._inside = np.stack([np.where(tracks, inside, np.nan), *self._inside[:-1]])
        self._speeds = np.stack([moved, *self._speeds[:-1]])
        now, last, before = self._inside[:3]
        fast = FAST * np.where(self.doubts, c.doubt_speed, c.track_speed)
        with np.errstate(invalid="ignore"):
            alone = (np.abs(last - before) > 0.5) & (np.abs(last - now) > 0.5)
            learns = (self._speeds[:3] >= fast).all(axis=0) | (self._speeds == 0.0).all(axis=0)
        faded = self._count * (1.0 - np.where(learns, c.period / MEMORY, 0.0))
        self._count = np.where(tracks, faded + (alone & learns), 0.0)
        self.doubts = self._count > np.where(self.doubts, ENDS, BEGINS)
        known = np.isfinite(self._inside)
        votes = np.where(known, self._inside, 0.0).sum(axis=0) > 0.5 * known.sum(axis=0)
        return np.where(self.doubts & known[0], votes, inside)

    def limit(self, speed: Array) -> Array:
        """Speeds (n,) [m/s], those of who doubts at most ``doubt_speed``."""
        return np.where(self.doubts, np.minimum(speed, self._config.doubt_speed), speed)
