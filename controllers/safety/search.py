"""The velocity-space safety search of Bruce and Veloso 2005 as a filter of any wishes.

It is the search of :class:`controllers.motion.Navigator`, given the wishes of somebody else.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.motion.clearance import check_bounds, prepare_boxes
from controllers.motion.safety import choose_commands, make_search
from controllers.motion.streams import seed_streams
from controllers.motion.trapezoid import Dynamics
from controllers.safety.filters import SafetyConfig, reachable

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


class VelocitySearch:
    """Robots choose one after the other; see controllers/motion/safety.py.

    Attributes:
        overruled: Whose wish was not clear in the last call (n,).
        infeasible: Always 0: a robot without a clear command takes the least bad one.
    """

    def __init__(
        self,
        bounds: ArrayLike,
        boxes: ArrayLike | None,
        n: int,
        config: SafetyConfig,
        rng: np.random.Generator,
        *,
        within_reach: bool = False,
    ):
        """Set the search up; see :class:`controllers.safety.filters.SafetyFilter`.

        Args:
            bounds: Of the world (4,) [m].
            boxes: What stands there (k, 5), or None.
            n: Robots.
            config: Of robots and filter.
            rng: Seeds the robots' streams, once.
            within_reach: Whether wishes are within reach of one period already, as a motion
                control's are; else they are brought there first, which the search relies on.
        """
        limits = config.limits
        self._config, self._within_reach = config, within_reach
        self._dynamics = Dynamics(
            float(limits.max_speed), float(limits.acceleration), float(limits.deceleration),
            float(config.period),
        )  # fmt: skip
        self._everyone = np.ones(n, dtype=bool)
        # as the navigator's, whose first n streams are its planner's
        self._search = make_search(
            check_bounds(bounds, config.radius), prepare_boxes(boxes),
            config.radius + config.margin, False, config.samples, np.zeros(n, dtype=bool), 0.35,
            seed_streams(rng, 2 * n), n,
        )  # fmt: skip
        self.overruled, self.infeasible = np.zeros(n, dtype=bool), 0

    def step(
        self, position: Array, velocity: Array, wish: Array, active: Flags | None = None
    ) -> Array:
        """See :class:`controllers.safety.filters.SafetyFilter`."""
        config = self._config
        wanted = np.ascontiguousarray(wish)
        if not self._within_reach:
            wanted = reachable(velocity, wish, config.limits, config.period)
        command = np.empty_like(wanted)
        choose_commands(
            np.ascontiguousarray(position), np.ascontiguousarray(velocity), wanted,
            self._everyone if active is None else active, self._dynamics, self._search, command,
            self.overruled,
        )  # fmt: skip
        return command
