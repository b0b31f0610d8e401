"""Beacon: bearing and distance of one point, from every robot; abstract."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.finite import finite
from mjmr.geometry import wrap_angle
from mjmr.randomness import SampleNoise
from mjmr.sensors.base import Sensor, check_errors

if TYPE_CHECKING:
    from mjmr.group import Group


class Beacon(Sensor):
    """A point that every robot hears from everywhere: its bearing and its distance.

    Abstract: nothing is in its way, and no signal is modelled. It stands for what papers assume
    with words such as "the robot is constantly able to sense its home".
    """

    name = "beacon"

    def __init__(
        self,
        *,
        position: ArrayLike = (0.0, 0.0),
        rate: float = 10.0,
        latency: float = 0.0,
        phase: float = 0.0,
        bearing_noise: float = 0.0,
        distance_noise: float = 0.0,
    ):
        """Set place, schedule and errors.

        Args:
            position: Of the beacon (2,) [m], world frame.
            rate: Reports a second [Hz].
            latency: [s].
            phase: Instant of the first report [s].
            bearing_noise: Standard deviation of a bearing [rad].
            distance_noise: Of a distance, as a share of it.

        Raises:
            InvalidInputError: A position of another shape, or a deviation that is negative.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        check_errors(bearing_noise=bearing_noise, distance_noise=distance_noise)
        place = finite(position, (2,))
        if place is None:
            raise InvalidInputError(f"a beacon's position is two finite numbers; got {position}")
        self.position = place
        self.bearing_noise = float(bearing_noise)
        self.distance_noise = float(distance_noise)

    def read(self) -> NDArray[np.float64]:
        """Newest report delivered by now, shape (n, 2): bearing [rad] and distance [m].

        Bearings are relative to the robot's heading, anticlockwise, in (-pi, pi]. NaN before the
        first delivery.
        """
        return super().read()

    @property
    def reading_bounds(self) -> tuple[ArrayLike, ArrayLike]:
        """Of bearing and distance."""
        return [-np.pi, 0.0], [np.pi, np.inf]

    def prepare(self, sequence: np.random.SeedSequence, group: "Group") -> None:
        """Set up the noise stream."""
        self._noise = SampleNoise(sequence, (group.n, 2), "normal")

    def observe(self, time: float) -> Any:
        """True poses now."""
        assert self._simulation is not None
        return self._simulation.poses_of(self._group)

    def compute(self, state: Any, number: int) -> NDArray[np.float64]:
        """Bearing and distance, with errors."""
        offset = self.position - state[:, :2]
        bearing = np.arctan2(offset[:, 1], offset[:, 0]) - state[:, 2]
        distance = np.hypot(offset[:, 0], offset[:, 1])
        if self.bearing_noise or self.distance_noise:
            noise = self._noise.sample(number)
            bearing = bearing + self.bearing_noise * noise[:, 0]
            distance = np.maximum(0.0, distance * (1.0 + self.distance_noise * noise[:, 1]))
        return np.column_stack([wrap_angle(bearing), distance])

    def nothing(self) -> NDArray[np.float64]:
        """All NaN."""
        return np.full((self._group.n, 2), np.nan)
