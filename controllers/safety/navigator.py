"""A navigator whose safety is the barrier: for any study with the role ``navigator``."""

import dataclasses

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.motion import Navigator, NavigatorConfig
from controllers.safety.filters import Barrier, SafetyConfig

Array = NDArray[np.float64]
MARGIN = 0.025  # m: two robots' discs are kept 5 cm apart, whatever the search's margin is
# gamma in units of deceleration / top speed; above 1 robots come nearer at speed, and brake late
PACE = 2.0


class BarrierNavigator:
    """Bruce and Veloso's planner and motion control; the barrier instead of their search.

    ``mjmr run safe-navigation --with navigator=controllers.safety:BarrierNavigator``.

    Attributes:
        filter: The barrier.
        waypoints: Points steered for in the last step (n, 2) [m].
        sampled: Robots whose wish was overruled in the last step (n,).
    """

    def __init__(
        self,
        bounds: ArrayLike,
        boxes: ArrayLike | None,
        n: int,
        config: NavigatorConfig,
        rng: np.random.Generator,
    ):
        """See :class:`controllers.motion.Navigator`.

        The margin is this module's; of a config without search, which asks for no safety, the
        barrier is put in all the same.
        """
        self._inner = Navigator(bounds, boxes, n, dataclasses.replace(config, search=False), rng)
        safety = SafetyConfig(
            radius=config.radius, limits=config.limits, period=config.period, margin=MARGIN,
            rate=PACE * config.limits.deceleration / config.limits.max_speed,
        )  # fmt: skip
        self.filter = Barrier(np.asarray(bounds), boxes, n, safety, rng)
        self.waypoints, self.sampled = self._inner.waypoints, np.zeros(n, dtype=bool)

    def step(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        goals: ArrayLike,
        active: NDArray[np.bool_] | None = None,
    ) -> Array:
        """Commands (n, 2) [m/s]; see :meth:`controllers.motion.Navigator.step`."""
        wish = self._inner.step(position, velocity, goals, active)
        x, v = (np.asarray(a, dtype=np.float64) for a in (position, velocity))
        command = self.filter.step(x, v, wish, active)
        self.sampled = self.filter.overruled
        return command
