"""IMU: accelerometer and gyroscope at a site of every robot."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.randomness import Drift, SampleNoise
from mjmr.sensors.base import check_errors
from mjmr.sensors.site_sensors import SiteSensor

if TYPE_CHECKING:
    from mjmr.group import Group


class IMU(SiteSensor):
    """Specific force and rates of turn, in the frame of the site.

    At rest and level it reads (0, 0, 9.81) m/s^2, in free fall 0, as real ones do. It sees neither
    place nor heading, does not saturate, and needs forces: :class:`mjmr.simulation.Simulation`.
    """

    name = "imu"
    kinds = ("ACCELEROMETER", "GYRO")

    def __init__(
        self,
        *,
        rate: float = 100.0,
        latency: float = 0.0,
        phase: float = 0.0,
        site: str = "",
        body: str = "",
        position: ArrayLike = (0.0, 0.0, 0.0),
        acceleration_noise: float = 0.0,
        gyro_noise: float = 0.0,
        acceleration_bias: float = 0.0,
        gyro_bias: float = 0.0,
        bias_time: float = float("inf"),
    ):
        """Set schedule, place and errors, the latter alike for all three axes.

        Args:
            rate: Samples a second [Hz].
            latency: [s].
            phase: Instant of the first sample [s].
            site: Of the robot's model; or give a place:
            body: Of the robot; default: its first.
            position: In the frame of that body (3,) [m].
            acceleration_noise: Noise density [m/s^2/sqrt(Hz)], one-sided as in data sheets: a
                sample's deviation is density * sqrt(rate / 2).
            gyro_noise: Noise density [rad/s/sqrt(Hz)].
            acceleration_bias: Standard deviation of the bias [m/s^2].
            gyro_bias: Standard deviation of the bias [rad/s].
            bias_time: Over which the correlation of a bias falls to 1/e [s]; infinite: it stays
                for the trial.

        Raises:
            InvalidInputError: Errors that are negative or not finite, a time that is not positive,
                or both a site and a place.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        check_errors(
            acceleration_noise=acceleration_noise,
            gyro_noise=gyro_noise,
            acceleration_bias=acceleration_bias,
            gyro_bias=gyro_bias,
        )
        if not bias_time > 0:
            raise InvalidInputError(f"bias_time must be positive, or infinite; got {bias_time} s")
        self._place(site, body, position)
        self.bias_time = float(bias_time)
        self._noise_scale = np.repeat([acceleration_noise, gyro_noise], 3) * (rate / 2.0) ** 0.5
        self._bias_scale = np.repeat([acceleration_bias, gyro_bias], 3)

    def read(self) -> NDArray[np.float64]:
        """Newest sample delivered by now, shape (n, 6), in the frame of the site.

        Columns 0 to 2: specific force along x, y, z [m/s^2]; 3 to 5: rates about x, y, z [rad/s].
        NaN before the first delivery.
        """
        return super().read()

    def prepare(self, sequence: np.random.SeedSequence, group: "Group") -> None:
        """Set up the noise streams and indices."""
        super().prepare(sequence, group)
        noise, bias = sequence.spawn(2)
        self._noise = SampleNoise(noise, (group.n, 6), "normal")
        self._bias = Drift(bias, (group.n, 6), np.exp(-1.0 / (self.rate * self.bias_time)))

    def compute(self, state: Any, number: int) -> NDArray[np.float64]:
        """Add noise and bias."""
        sample = state
        if self._bias_scale.any():
            sample = sample + self._bias_scale * self._bias.sample(number)
        if self._noise_scale.any():
            sample = sample + self._noise_scale * self._noise.sample(number)
        return sample
