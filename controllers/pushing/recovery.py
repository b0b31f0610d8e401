"""Recovery from stagnation: robots whose push gets nowhere become more or less fussy. Ours."""

import numpy as np
from numpy.typing import NDArray

from controllers.schemas import Percepts, Things

Array = NDArray[np.float64]


class Recovery:
    """Changes each robot's p by itself once its target has not moved for a while.

    A robot watches how far its target is from home, smoothed over ``smooth`` seconds. If that has
    changed by less than ``progress`` for ``patience`` seconds, with a target in sight all along, it
    draws another p from ``low`` to ``high``; one that makes progress keeps what it has. Robots tell
    each other nothing.

    The paper names stagnation recovery as future work.

    Attributes:
        p: Of every robot now (n,) [robot radii].
        changes: Drawn so far, of all robots.
    """

    def __init__(
        self,
        n: int,
        p: float,
        rng: np.random.Generator,
        *,
        patience: float = 8.0,
        progress: float = 0.15,
        low: float = 1.0,
        high: float = 3.0,
        smooth: float = 1.0,
    ):
        """Args as above; ``p`` is what all begin with."""
        self._rng, self._patience, self._progress = rng, patience, progress
        self._low, self._high, self._smooth = low, high, smooth
        self.p = np.full(n, float(p))
        self.changes = 0
        self._time = 0.0
        self._since = np.zeros(n)
        self._distance = np.full(n, np.nan)
        self._mark = np.full(n, np.nan)

    def step(self, percepts: Percepts, time: float) -> Array:
        """Each robot's p in the first column (n, 2).

        Args:
            percepts: ``target`` and ``home``.
            time: Of this step [s].
        """
        target, home = percepts["target"], percepts["home"]
        assert isinstance(target, Things)
        assert isinstance(home, np.ndarray)
        away = np.where(target.valid, target.offset[:, 0], np.nan) - home
        fresh = np.hypot(away[:, 0], away[:, 1])
        share = 1.0 - np.exp(-(time - self._time) / self._smooth)
        kept = np.where(np.isnan(self._distance), fresh, self._distance)
        self._time, self._distance = time, kept + share * (fresh - kept)
        with np.errstate(invalid="ignore"):
            still = np.abs(self._distance - self._mark) < self._progress
        self._mark = np.where(still, self._mark, self._distance)
        self._since = np.where(still, self._since, time)
        stuck = time - self._since >= self._patience
        # every robot draws at every step, so that one robot's luck is not another's
        drawn = self._rng.uniform(self._low, self._high, len(self.p))
        self.p = np.where(stuck, drawn, self.p)
        self.changes += int(stuck.sum())
        self._since = np.where(stuck, time, self._since)
        return np.column_stack([self.p, np.zeros_like(self.p)])
