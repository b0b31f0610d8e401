"""Patrols: robots that go round loops of waypoints."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]
_BACK = 5  # waypoints that are tried


class Patrol:
    """Waypoints of n robots, each round a loop of its own.

    Attributes:
        index: Of each robot's next waypoint in its loop (n,).
        skipped: Waypoints given up so far (n,).
    """

    def __init__(
        self,
        routes: Sequence[ArrayLike],
        *,
        phase: Sequence[int] | None = None,
        reach: float = 0.35,
        patience: float = 20.0,
    ):
        """Set the loops.

        Args:
            routes: Waypoints (k, 2) [m] of each robot's loop.
            phase: Index of the waypoint each makes for first; default: spread evenly, the first
                robot at 0.
            reach: A waypoint this near is passed [m].
            patience: One that has not come nearer for so long, since something is in the way, is
                skipped [s].

        Raises:
            InvalidInputError: A loop without waypoints.
        """
        self._routes = [np.array(r, dtype=np.float64).reshape(-1, 2) for r in routes]
        if any(not len(r) for r in self._routes):
            raise InvalidInputError("a patrol needs at least one waypoint")
        n = len(self._routes)
        if phase is None:
            phase = [len(r) * i // max(n, 1) for i, r in enumerate(self._routes)]
        self.index = np.array([p % len(r) for p, r in zip(phase, self._routes, strict=True)], int)
        self.skipped = np.zeros(n, dtype=np.int64)
        self._reach, self._patience = reach, patience
        self._nearest, self._since = np.full(n, np.inf), np.zeros(n)

    def step(
        self,
        position: ArrayLike,
        time: float,
        sees: Callable[[int, Array], bool] | None = None,
    ) -> Array:
        """Waypoints to make for now.

        Who made way for another may have lost sight of its waypoint; it first goes back to the
        last one that is in sight.

        Args:
            position: Of the robots (n, 2) [m], in the frame of the loops.
            time: [s].
            sees: Whether the straight way of robot i to a place (2,) [m] is free; default: always.

        Returns:
            (n, 2) [m].
        """
        goals = np.empty((len(self._routes), 2))
        for i, (at, route) in enumerate(zip(np.asarray(position), self._routes, strict=True)):
            apart = float(np.hypot(*(route[self.index[i]] - at)))
            if apart < self._nearest[i] - 0.1:
                self._nearest[i], self._since[i] = apart, time
            late = time - self._since[i] > self._patience
            if apart < self._reach or late:
                self.skipped[i] += late and apart >= self._reach and len(route) > 1
                self.index[i] = (self.index[i] + 1) % len(route)
                self._nearest[i], self._since[i] = np.inf, time
            goals[i] = route[self.index[i]]
            if sees is not None and not sees(i, goals[i]):
                for back in range(1, min(_BACK, len(route))):
                    place = route[(self.index[i] - back) % len(route)]
                    if sees(i, place):
                        goals[i] = place
                        break
        return goals
