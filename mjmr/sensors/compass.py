"""Compass: the heading of every robot, with noise, drift, biases and whole steps."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError
from mjmr.geometry import wrap_angle
from mjmr.randomness import Drift, SampleNoise
from mjmr.sensors.ambient_field import AmbientField
from mjmr.sensors.base import Sensor, check_errors

if TYPE_CHECKING:
    from mjmr.group import Group


class Compass(Sensor):
    """Yaw in the world frame, as a magnetic compass has it; tilt does not disturb it.

    Its errors, all off by default: white noise, a drift that wanders (a robot's own currents and
    motors), a bias of each robot that stays, and one that depends on the place: iron and mains
    bend the field of a room, the same for every robot and every compass in it.
    """

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
        drift: float = 0.0,
        drift_time: float = 5.0,
        place_bias: float = 0.0,
        place_scale: float = 2.0,
    ):
        """Set schedule and errors.

        Args:
            rate: Reports a second [Hz].
            latency: [s].
            phase: Instant of the first report [s].
            noise: Standard deviation of every report [rad].
            bias: Standard deviation over the robots of an error that stays for the trial [rad].
            step: Headings are rounded to whole multiples of it [rad]; 0 does not round.
            drift: Standard deviation of an error that wanders, each robot's by itself [rad].
            drift_time: Over which its correlation falls to 1/e [s].
            place_bias: Bound of the error that depends on the place [rad]; see
                :class:`mjmr.sensors.ambient_field.AmbientField`.
            place_scale: Over which that error changes: its waves' mean length [m].

        Raises:
            InvalidInputError: One of them is negative or not finite, or a time or scale is zero.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        check_errors(noise=noise, bias=bias, step=step, drift=drift, place_bias=place_bias)
        for name, value, unit in (
            ("drift_time", drift_time, "s"),
            ("place_scale", place_scale, "m"),
        ):
            if not 0 < value < math.inf:
                raise InvalidInputError(f"{name} must be positive and finite; got {value} {unit}")
        self.noise, self.bias, self.step = float(noise), float(bias), float(step)
        self.drift, self.drift_time = float(drift), float(drift_time)
        self.place_bias, self.place_scale = float(place_bias), float(place_scale)

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
        """Set up the noise streams, and draw the biases and the room's field."""
        assert self._simulation is not None
        noise, bias, drift = sequence.spawn(3)
        self._noise = SampleNoise(noise, (group.n,), "normal")
        self._bias = self.bias * SampleNoise(bias, (group.n,), "normal").sample(0)
        keep = math.exp(-1.0 / (self.rate * self.drift_time))
        self._drift = Drift(drift, (group.n,), keep)
        # of the room, not of the sensor: every compass draws it from the same stream
        room = self._simulation.rng("ambient field")
        self._field = AmbientField(room, self.place_bias, self.place_scale)

    def observe(self, time: float) -> Any:
        """True poses now."""
        assert self._simulation is not None
        return self._simulation.poses_of(self._group)

    def compute(self, state: Any, number: int) -> NDArray[np.float64]:
        """Add errors, round."""
        yaw = state[:, 2] + self._bias
        if self.drift > 0:
            yaw = yaw + self.drift * self._drift.sample(number)
        if self.place_bias > 0:
            yaw = yaw + self._field.at(state[:, :2])
        if self.noise > 0:
            yaw = yaw + self.noise * self._noise.sample(number)
        if self.step > 0:
            yaw = np.round(yaw / self.step) * self.step
        return wrap_angle(yaw)

    def nothing(self) -> NDArray[np.float64]:
        """All NaN."""
        return np.full(self._group.n, np.nan)
