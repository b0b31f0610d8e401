"""Compass: the heading of every robot, with noise, a bias of its own and whole steps."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mjmr.geometry import wrap_angle
from mjmr.randomness import SampleNoise
from mjmr.sensors.base import Sensor, check_errors

if TYPE_CHECKING:
    from mjmr.group import Group


class Compass(Sensor):
    """Yaw in the world frame; it knows nothing of place and is not disturbed by iron or tilt."""

    name = "compass"

    def __init__(
        self,
        *,
        rate: float = 10.0,
        latency: float = 0.0,
        phase: float = 0.0,
        noise: float = 0.0,
        bias: float = 0.0,
        step: float = 0.0,
    ):
        """Set schedule and errors.

        Args:
            rate: Reports a second [Hz].
            latency: [s].
            phase: Instant of the first report [s].
            noise: Standard deviation of every report [rad].
            bias: Standard deviation over the robots of an error that stays for the trial [rad].
            step: Headings are rounded to whole multiples of it [rad]; 0 does not round.

        Raises:
            InvalidInputError: One of them is negative or not finite.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        check_errors(noise=noise, bias=bias, step=step)
        self.noise, self.bias, self.step = float(noise), float(bias), float(step)

    def read(self) -> NDArray[np.float64]:
        """Newest headings delivered by now, shape (n,) [rad], world frame, in (-pi, pi].

        NaN before the first delivery.
        """
        return super().read()

    @property
    def reading_bounds(self) -> tuple[float, float]:
        """Least and largest value of a reading."""
        return -np.pi, np.pi

    def prepare(self, sequence: np.random.SeedSequence, group: "Group") -> None:
        """Set up the noise stream, and draw the biases."""
        noise, bias = sequence.spawn(2)
        self._noise = SampleNoise(noise, (group.n,), "normal")
        self._bias = self.bias * SampleNoise(bias, (group.n,), "normal").sample(0)

    def observe(self, time: float) -> Any:
        """True yaws now."""
        assert self._simulation is not None
        return self._simulation.poses_of(self._group)[:, 2]

    def compute(self, state: Any, number: int) -> NDArray[np.float64]:
        """Add errors, round."""
        yaw = state + self._bias
        if self.noise > 0:
            yaw = yaw + self.noise * self._noise.sample(number)
        if self.step > 0:
            yaw = np.round(yaw / self.step) * self.step
        return wrap_angle(yaw)

    def nothing(self) -> NDArray[np.float64]:
        """All NaN."""
        return np.full(self._group.n, np.nan)
