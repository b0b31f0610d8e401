"""From reports to commands: goals, latency compensation, the navigator."""

import time
from collections import deque
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.motion import (
    Limits,
    Navigator,
    NavigatorConfig,
    body_twist,
    forward_predict,
)
from experiments.safe_navigation.scenes import Scene
from experiments.safe_navigation.trackers import FilterTracker, RawTracker

Array = NDArray[np.float64]
ARRIVED = 0.05  # [m]
STRANGER_SPEED = 1.0  # [m/s]


class Shuttle:
    """Gives each robot its far and its near goal in turn, on its own time.

    Attributes:
        goals: Present goals, (n, 2) [m].
        reached: Goals reached so far, (n,).
    """

    def __init__(self, scene: Scene):
        """Args: scene: Whose goals to shuttle between."""
        self._ends = np.stack([scene.far, scene.near])
        self._robots = np.arange(len(scene.starts))
        self.reached = np.zeros(len(scene.starts), dtype=np.int64)
        self.goals = scene.far.copy()

    def update(self, position: Array) -> None:
        """Move on to the next goal where ``position`` (n, 2) is within 50 mm of the present one."""
        away = self.goals - position
        arrived = away[:, 0] ** 2 + away[:, 1] ** 2 < ARRIVED**2
        if arrived.any():
            self.reached += arrived
            self.goals = self._ends[self.reached % 2, self._robots]


class Pilot:
    """One cycle from reports to body-frame commands.

    Attributes:
        shuttle: The robots' goals.
        navigator: Plans, controls and searches.
        seconds: Wall time of this cycle's plan and search [s].
    """

    def __init__(
        self,
        scene: Scene,
        bounds: Array,
        navigator: Any,
        config: NavigatorConfig,
        tracker: RawTracker | FilterTracker,
        latency: int,
        predict: bool,
    ):
        """Put the parts together.

        Args:
            scene: Starts and goals.
            bounds: Of the world (4,) [m].
            navigator: The navigator; of it only ``step`` is called.
            config: What the navigator was made with.
            tracker: Turns reports into positions and velocities.
            latency: Cycles from a command to its execution.
            predict: Whether to plan for the state in which a command will take effect.
        """
        n = len(scene.starts)
        self.shuttle, self.navigator = Shuttle(scene), navigator
        self._config, self._tracker, self._predict = config, tracker, predict
        self._pending: deque[Array] = deque([np.zeros((n, 2))] * latency)
        self._cycle = (scene.starts, np.zeros((n, 2)), np.zeros((n, 2)))
        # of the newest report: its instant, and who was in it
        self._sampled_at, self._seen = np.nan, np.ones(n, dtype=bool)
        self._strangers = list(scene.strangers)
        self._stranger = (
            _stranger(len(scene.strangers), bounds, config) if scene.strangers else None
        )
        self.seconds = 0.0

    def step(
        self,
        now: float,
        report: Array,
        sampled_at: float,
        executed: Array,
        hearing: NDArray[np.bool_],
    ) -> Array:
        """Commands (n, 3), body frame.

        A robot that does not hear, or that the newest report misses, is told to brake, and the
        others expect it to.

        Args:
            now: Time [s].
            report: Newest report (n, 3), world frame; NaN rows where lost.
            sampled_at: Instant it was taken [s]; NaN before the first.
            executed: Twists the robots say they execute, (n, 3), body frame.
            hearing: Robots that acknowledged the last command and announce no stop, (n,).
        """
        position, velocity = self._tracker.update(
            report, self._age(now, report, sampled_at), executed
        )
        self.shuttle.update(position)
        if self._predict and self._pending:
            position, velocity = forward_predict(
                position, velocity, np.stack(self._pending), self._config.period
            )
        start = time.perf_counter()
        planar = self.navigator.step(position, velocity, self.shuttle.goals, hearing & self._seen)
        self.seconds = time.perf_counter() - start
        if self._stranger is not None:
            rows = self._strangers
            planar = np.array(planar)
            planar[rows] = self._stranger.step(
                position[rows], velocity[rows], self.shuttle.goals[rows]
            )
        if self._pending:
            self._pending.append(planar)
            self._pending.popleft()
        self._cycle = position, velocity, planar
        return body_twist(planar, self._tracker.yaw)

    def _age(self, now: float, report: Array, sampled_at: float) -> int | None:
        """Cycles since the report was taken; None if it was here in the last cycle, or none is."""
        if np.isnan(sampled_at) or sampled_at == self._sampled_at:
            return None
        self._sampled_at, self._seen = sampled_at, ~np.isnan(report[:, 0])
        return round((now - sampled_at) / self._config.period)

    @property
    def stops(self) -> Array:
        """Where the last commands followed by braking end, (n, 2) [m], world frame; for films."""
        position, velocity, command = self._cycle
        config = self._config
        speed = np.hypot(command[:, 0], command[:, 1])[:, None]
        braking = command * speed / (2.0 * config.limits.deceleration)
        return position + 0.5 * (velocity + command) * config.period + braking


def _stranger(n: int, bounds: Array, config: NavigatorConfig) -> Navigator:
    """Controller of robots that do not take part: straight to the goal, blind to everybody."""
    limits = Limits(
        max_speed=STRANGER_SPEED,
        acceleration=config.limits.acceleration,
        deceleration=config.limits.deceleration,
    )
    alone = NavigatorConfig(
        radius=config.radius, period=config.period, limits=limits, search=False, planner="straight"
    )
    return Navigator(bounds, None, n, alone, np.random.default_rng(0))
