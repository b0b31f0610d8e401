"""From reports to commands: state estimation, goals, latency compensation, the navigator."""

import time
from collections import deque

import numpy as np
from numpy.typing import NDArray

from controllers.estimation import PoseFilter, PoseFilterConfig
from controllers.motion import (
    Navigator,
    NavigatorConfig,
    body_twist,
    forward_predict,
    world_velocity,
)
from experiments.safe_navigation.worlds import Scene

Array = NDArray[np.float64]
ARRIVED = 0.05  # [m]


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


class RawTracker:
    """The paper's evaluation: the noisy report is the position, the velocity is known exactly.

    A lost report is replaced by dead reckoning from the last one.
    """

    def __init__(self, starts: Array, period: float):
        """Start from where the robots were put.

        Args:
            starts: Nominal starts (n, 2) [m], believed until a robot's first report.
            period: Control period [s].
        """
        self._period = period
        self._position = starts
        self._velocity = np.zeros(starts.shape)
        self.yaw = np.zeros(len(starts))

    def update(self, report: Array, executed: Array) -> tuple[Array, Array]:
        """Position [m] and velocity [m/s], (n, 2) each, world frame.

        Args:
            report: (n, 3), NaN rows where lost.
            executed: Twists the robots say they execute, (n, 3), body frame.
        """
        lost = np.isnan(report[:, 0])
        some = lost.any()
        self.yaw = np.where(lost, self.yaw, report[:, 2]) if some else report[:, 2].copy()
        velocity = world_velocity(executed, self.yaw)
        position = report[:, :2]
        if some:
            reckoned = self._position + 0.5 * (self._velocity + velocity) * self._period
            position = np.where(lost[:, None], reckoned, position)
        self._position, self._velocity = position, velocity
        return self._position, self._velocity


class FilterTracker:
    """The paper's real system: an extended Kalman filter behind the cameras."""

    def __init__(self, starts: Array, period: float, position_noise: float):
        """Start from where the robots were put.

        Args:
            starts: Nominal starts (n, 2) [m], believed until a robot's first report.
            period: Control period [s].
            position_noise: Deviation of reported positions [m]; the filter assumes at least
                0.1 mm, for what its model leaves out.
        """
        config = PoseFilterConfig(
            position_noise=max(position_noise, 1e-4), yaw_noise=1e-3, speed_noise=0.01
        )
        self._filter = PoseFilter(len(starts), config)
        self._starts, self._period = starts, period
        self._started = False
        self.yaw = np.zeros(len(starts))

    def update(self, report: Array, executed: Array) -> tuple[Array, Array]:
        """Position and velocity, (n, 2) each; see :meth:`RawTracker.update`."""
        if self._started:
            self._filter.predict(executed, self._period)
        self._filter.update(report)
        self._started = True
        pose, velocity = self._filter.pose, self._filter.velocity
        unknown = np.isnan(pose[:, 0])
        if unknown.any():
            pose[unknown] = np.column_stack([self._starts, np.zeros(len(pose))])[unknown]
            velocity[unknown] = 0.0
        self.yaw = pose[:, 2].copy()
        return pose[:, :2], velocity


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
        navigator: Navigator,
        config: NavigatorConfig,
        tracker: RawTracker | FilterTracker,
        latency: int,
        predict: bool,
    ):
        """Put the parts together.

        Args:
            scene: Starts and goals.
            navigator: The navigator; of it only ``step`` is called.
            config: What the navigator was given; its period and limits count here.
            tracker: Turns reports into positions and velocities.
            latency: Cycles from a command to its execution.
            predict: Whether to plan for the state in which a command will take effect.
        """
        n = len(scene.starts)
        self.shuttle, self.navigator = Shuttle(scene), navigator
        self._config = config
        self._tracker, self._predict = tracker, predict
        self._pending: deque[Array] = deque([np.zeros((n, 2))] * latency)
        self._cycle = (scene.starts, np.zeros((n, 2)), np.zeros((n, 2)))
        self.seconds = 0.0

    def step(self, report: Array, executed: Array, hearing: NDArray[np.bool_]) -> Array:
        """Commands (n, 3), body frame.

        A robot that does not hear, or whose report is missing, is told to brake, and the others
        expect it to.

        Args:
            report: Newest report (n, 3), world frame; NaN rows where lost.
            executed: Twists the robots say they execute, (n, 3), body frame.
            hearing: Robots that acknowledged the last command and announce no stop, (n,).
        """
        active = hearing & ~np.isnan(report[:, 0])
        position, velocity = self._tracker.update(report, executed)
        self.shuttle.update(position)
        if self._predict and self._pending:
            position, velocity = forward_predict(
                position, velocity, np.stack(self._pending), self._config.period
            )
        start = time.perf_counter()
        planar = self.navigator.step(position, velocity, self.shuttle.goals, active)
        self.seconds = time.perf_counter() - start
        if self._pending:
            self._pending.append(planar)
            self._pending.popleft()
        self._cycle = position, velocity, planar
        return body_twist(planar, self._tracker.yaw)

    @property
    def stops(self) -> Array:
        """Where the last commands followed by braking end, (n, 2) [m], world frame; for films."""
        position, velocity, command = self._cycle
        config = self._config
        speed = np.hypot(command[:, 0], command[:, 1])[:, None]
        braking = command * speed / (2.0 * config.limits.deceleration)
        return position + 0.5 * (velocity + command) * config.period + braking
