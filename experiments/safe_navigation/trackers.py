"""From reports to positions and velocities: dead reckoning, and filters of robots and carts."""

from collections import deque

import numpy as np
from numpy.typing import NDArray

from controllers.estimation import PoseFilter, PoseFilterConfig
from controllers.motion import world_velocity
from mjmr.world import World

Array = NDArray[np.float64]


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

    def update(self, report: Array, age: int | None, executed: Array) -> tuple[Array, Array]:
        """Position [m] and velocity [m/s], (n, 2) each, world frame.

        Args:
            report: (n, 3), NaN rows where lost.
            age: Periods since the report was taken; None if it was seen before. Here always 0.
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
    """The paper's real system: an extended Kalman filter behind the cameras.

    The filter waits at the instant of the newest report; what the robots have executed since
    bridges the time to now, so that late and rare reports are taken for what they are.
    """

    def __init__(
        self,
        starts: Array,
        period: float,
        config: PoseFilterConfig,
        ramp_from_command: bool = False,
    ):
        """Start from where the robots were put.

        Args:
            starts: Nominal starts (n, 2) [m], believed until a robot's first report.
            period: Control period [s].
            config: The filter's noises.
            ramp_from_command: Whether velocities are those the robots say they execute, so that
                commands ramp from there; else the filter's.
        """
        self._ramp_from_command = ramp_from_command
        self._filter = PoseFilter(len(starts), config)
        self._starts, self._period = starts, period
        self._since: deque[Array] = deque()
        self._started = False
        self.yaw = np.zeros(len(starts))

    def update(self, report: Array, age: int | None, executed: Array) -> tuple[Array, Array]:
        """Position and velocity, (n, 2) each; see :meth:`RawTracker.update`."""
        since = self._since
        since.append(executed)
        if age is not None:
            while len(since) > age:
                done = since.popleft()
                if self._started:
                    self._filter.predict(done, self._period)
            self._filter.update(report)
            self._started = True
        if since:
            pose, velocity = self._filter.ahead(np.stack(since), self._period)
        else:
            pose, velocity = self._filter.pose, self._filter.velocity
        unknown = np.isnan(pose[:, 0])
        if unknown.any():
            pose[unknown] = np.column_stack([self._starts, np.zeros(len(pose))])[unknown]
            velocity[unknown] = 0.0
        self.yaw = pose[:, 2].copy()
        if self._ramp_from_command:
            velocity = world_velocity(executed, self.yaw)
        return pose[:, :2], velocity


class CartTracker:
    """Fixed boxes and carts; a filter expects the carts to keep their velocity.

    A cart that turns round does not. Its box is therefore longer by what its acceleration, known
    as its size is, adds to its way in a stated time.

    Attributes:
        boxes: Shape (k, 5): x, y, yaw, half-length, half-width [m, rad].
        velocity: Shape (k, 2) [m/s].
    """

    def __init__(self, world: World, period: float, position_noise: float, reaction: float):
        """Know where the boxes are, of the carts where their ways are.

        Args:
            world: With a report of its carts mounted.
            period: Control period [s].
            position_noise: Deviation of reported positions [m].
            reaction: Time in which a robot can stop [s].
        """
        config = PoseFilterConfig(
            position_noise=max(position_noise, 1e-4),
            yaw_noise=1e-3,
            speed_noise=0.01,
            turn_noise=1e-3,
            start_speed=0.5,
            start_turn=1e-3,
        )
        carts = [cart for _, cart in world.carts]
        self._filter, self._period = PoseFilter(len(carts), config), period
        self._report, self._fixed = world.sensors["cart_report"], world.boxes
        self._started = False
        self._longer = np.array([[0.5 * cart.acceleration * reaction**2, 0.0] for cart in carts])
        self.boxes = np.concatenate([self._fixed, [cart.box(0.0) for cart in carts]])
        self.velocity = np.zeros((len(self.boxes), 2))

    def ahead(self, time: float) -> Array:
        """The boxes (k, 5) ``time`` [s] from now."""
        boxes = self.boxes.copy()
        boxes[:, :2] += self.velocity * time
        return boxes

    def update(self) -> None:
        """Take in the newest report."""
        report, count = self._report.read(), len(self._fixed)
        if self._started:
            self._filter.predict(self._filter.twist, self._period)
        self._filter.update(report[:, :3])
        self._started = True
        self.boxes[count:] = np.column_stack([self._filter.pose, report[:, 3:] + self._longer])
        self.velocity[count:] = self._filter.velocity
