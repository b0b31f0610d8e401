"""From positions and goals to safe velocities: a wish, the rule of the road, the filter."""

import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.consensus import acceleration, equal_gains, offset_relative
from controllers.motion import Limits
from controllers.safety import keep_right

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
NEAR = 2.5  # times the distance kept: who is nearer ahead makes a robot turn its wish
TURN = 0.45  # rad, by how much
_GAIN = 1.5  # 1/s, of going to a goal


class GoToGoal:
    """Straight to the goal, slower near it."""

    def __init__(self, limits: Limits):
        """Args: limits: Of the robots."""
        self._limits = limits

    def step(self, position: Array, velocity: Array, goals: Array, active: Flags) -> Array:
        """Wished velocities (n, 2) [m/s]."""
        return capped(_GAIN * (goals - position), self._limits.max_speed)


class PlainConsensus:
    """Relative-form consensus on what is left of each way: the formation's places are the goals.

    Every robot hears every other one (a complete graph, equal weights), so that all go home at
    once, straight. Qu, Wang and Hull, with the speed cap that robots have.
    """

    def __init__(self, n: int, limits: Limits, period: float):
        """Args: n: Robots. limits: Of them. period: Between steps [s]."""
        self._gains = equal_gains(np.ones((n, n)))
        self._limits, self._period = limits, period

    def step(self, position: Array, velocity: Array, goals: Array, active: Flags) -> Array:
        """Wished velocities (n, 2) [m/s]."""
        relative = offset_relative(position[None] - position[:, None], goals)
        rate = acceleration(velocity, relative, self._gains)
        return capped(velocity + self._period * rate, self._limits.max_speed)


def capped(velocity: Array, top: float) -> Array:
    """Velocities (n, 2) no faster than ``top``, directions kept."""
    speed = np.hypot(velocity[:, 0], velocity[:, 1])
    return velocity * np.minimum(1.0, top / np.maximum(speed, 1e-9))[:, None]


class Guarded:
    """A navigator made of a wisher, the rule of the road and a filter.

    Attributes:
        seconds: CPU time of the filter in the last step [s].
        stopped: Whether the last step's program had no solution.
        turned: Robots whose wish the rule turned in the last step (n,).
    """

    def __init__(self, wisher: Any, part: Any, right: bool, distance: float):
        """Put them together.

        Args:
            wisher: ``step(position, velocity, goals, active)`` returns wishes.
            part: The safety filter.
            right: Whether wishes are turned right while somebody is near ahead.
            distance: That the filter keeps between two robots [m].
        """
        self._wisher, self._part, self._right = wisher, part, right
        self._reach = NEAR * distance
        self.seconds, self.stopped = 0.0, False
        self.turned: Flags = np.zeros(0, dtype=bool)

    def step(self, position: Array, velocity: Array, goals: Array, active: Flags) -> Array:
        """Commands (n, 2) [m/s], world frame."""
        wish = self._wisher.step(position, velocity, goals, active)
        turned = wish
        if self._right:
            turned = keep_right(position, wish, self._reach, TURN)
        self.turned = (turned != wish).any(axis=1)
        before = getattr(self._part, "infeasible", 0)
        # of this thread alone: what else runs on the machine is no cost of the filter
        start = time.thread_time()
        command = self._part.step(position, velocity, turned, active)
        self.seconds = time.thread_time() - start
        self.stopped = getattr(self._part, "infeasible", 0) > before
        return command
