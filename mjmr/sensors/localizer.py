"""Localizer: reports poses in the world frame, as an overhead camera system or GPS does."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.geometry import wrap_angle
from mjmr.randomness import Drift, SampleNoise
from mjmr.sensors.base import Sensor, check_errors

if TYPE_CHECKING:
    from mjmr.group import Group


class Localizer(Sensor):
    """Poses of the robots with Gaussian noise, slow drift, latency and lost samples.

    It sees the pose alone: no velocity, no identity errors, and every robot from everywhere.
    """

    name = "localizer"

    def __init__(
        self,
        *,
        rate: float = 60.0,
        latency: float = 0.0,
        phase: float = 0.0,
        position_noise: float = 0.0,
        yaw_noise: float = 0.0,
        loss: float = 0.0,
        drift: float = 0.0,
        drift_time: float = 60.0,
    ):
        """Set schedule and errors.

        Args:
            rate: Reports a second [Hz].
            latency: [s].
            phase: Instant of the first report [s].
            position_noise: Standard deviation along x and along y [m].
            yaw_noise: Standard deviation [rad].
            loss: Probability that a robot is missing from a report.
            drift: Standard deviation along x and along y of an error that wanders slowly, as GPS's
                does, each robot's by itself [m].
            drift_time: Over which its correlation falls to 1/e [s].

        Raises:
            InvalidInputError: A negative deviation, a probability outside [0, 1], or a time that
                is not positive.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        if not (position_noise >= 0 and yaw_noise >= 0):
            raise InvalidInputError("noise is a standard deviation, 0 or more")
        if not 0 <= loss <= 1:
            raise InvalidInputError(f"loss is a probability, 0 to 1; got {loss}")
        check_errors(drift=drift)
        if not 0 < drift_time < math.inf:
            raise InvalidInputError(f"drift_time must be positive and finite; got {drift_time} s")
        self.position_noise, self.yaw_noise, self.loss = position_noise, yaw_noise, loss
        self.drift, self.drift_time = float(drift), float(drift_time)

    def read(self) -> NDArray[np.float64]:
        """Newest report delivered by now, shape (n, 3): x, y, yaw [m, m, rad], world frame.

        A row of NaN: the robot was not in that report.
        """
        return super().read()

    @property
    def reading_bounds(self) -> tuple[ArrayLike, ArrayLike]:
        """Yaw is wrapped; noise has no bounds."""
        return [-np.inf, -np.inf, -np.pi], [np.inf, np.inf, np.pi]

    def prepare(self, sequence: np.random.SeedSequence, group: "Group") -> None:
        """Set up the noise streams."""
        noise, loss, drift = sequence.spawn(3)
        self._noise = SampleNoise(noise, (group.n, 3), "normal")
        self._losses = SampleNoise(loss, (group.n,), "uniform")
        keep = math.exp(-1.0 / (self.rate * self.drift_time))
        self._drift = Drift(drift, (group.n, 2), keep)
        self._scale = np.array([self.position_noise, self.position_noise, self.yaw_noise])

    def observe(self, time: float) -> Any:
        """True poses now, and who is hidden by a fault."""
        assert self._simulation is not None
        return self._simulation.poses_of(self._group), self._group.faults.unreported(time)

    def compute(self, state: Any, number: int) -> NDArray[np.float64]:
        """Add noise, drop what is lost."""
        poses, hidden = state
        if self._scale.any():
            poses = poses + self._scale * self._noise.sample(number)
            poses[:, 2] = wrap_angle(poses[:, 2])
        else:
            poses = poses.copy()
        if self.drift > 0:
            poses[:, :2] += self.drift * self._drift.sample(number)
        if self.loss > 0:
            poses[self._losses.sample(number) < self.loss] = np.nan
        if hidden is not None:
            poses[hidden] = np.nan
        return poses

    def nothing(self) -> NDArray[np.float64]:
        """All NaN."""
        return np.full((self._group.n, 3), np.nan)
