"""Recovery from stagnation: robots whose push gets nowhere become more or less fussy. Ours."""

import numpy as np
from numpy.typing import NDArray

from controllers.schemas import Percepts, Things

Array = NDArray[np.float64]


class Recovery:
    """Changes each robot's p by itself once its target has not moved for a while.

    A robot watches how far its target is from home. If that changes by less than ``progress`` in
    ``patience`` seconds with a target in sight all along, it draws another p from ``low`` to
    ``high``; one that has made progress keeps what it has. Robots tell each other nothing.

    The paper names stagnation recovery as future work.
    """

    def __init__(
        self,
        n: int,
        p: float,
        rng: np.random.Generator,
        *,
        patience: float = 8.0,
        progress: float = 0.1,
        low: float = 1.0,
        high: float = 3.0,
    ):
        """Args as above; ``p`` is what all begin with."""
        self._rng, self._patience, self._progress = rng, patience, progress
        self._low, self._high = low, high
        self.p = np.full(n, float(p))
        self.changes = 0
        self._since = np.zeros(n)
        self._distance = np.full(n, np.nan)

    def step(self, percepts: Percepts, state: NDArray[np.int64], time: float) -> Array:
        """Each robot's p in the first column (n, 2)."""
        target, home = percepts["target"], percepts["home"]
        assert isinstance(target, Things) and isinstance(home, np.ndarray)
        seen = target.valid[:, 0]
        away = target.offset[:, 0] - home
        distance = np.where(seen, np.hypot(away[:, 0], away[:, 1]), np.nan)
        with np.errstate(invalid="ignore"):
            still = np.abs(distance - self._distance) < self._progress
        self._since = np.where(still, self._since, time)
        self._distance = np.where(still, self._distance, distance)
        stuck = still & (time - self._since >= self._patience)
        # every robot draws at every step, so that one robot's luck is not another's
        fresh = self._rng.uniform(self._low, self._high, len(self.p))
        self.p = np.where(stuck, fresh, self.p)
        self.changes += int(stuck.sum())
        self._since = np.where(stuck, time, self._since)
        return np.column_stack([self.p, np.zeros_like(self.p)])
