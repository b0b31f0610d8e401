"""CartReport: where the carts are, as the overhead system that reports the robots sees them."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError
from mjmr.randomness import SampleNoise
from mjmr.sensors.base import Sensor

if TYPE_CHECKING:
    from mjmr.loop import TickedSimulation


class CartReport(Sensor):
    """Boxes that move by themselves, with Gaussian noise; stands in the world.

    It sees place and size, no velocity and no plan.
    """

    name = "cart_report"
    stands = True

    def __init__(
        self,
        *,
        rate: float = 60.0,
        latency: float = 0.0,
        phase: float = 0.0,
        position_noise: float = 0.0,
    ):
        """Set schedule and errors.

        Args:
            rate: Reports a second [Hz].
            latency: [s].
            phase: Instant of the first report [s].
            position_noise: Standard deviation along x and along y [m].

        Raises:
            InvalidInputError: A negative deviation.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        if not (position_noise >= 0 and math.isfinite(position_noise)):
            raise InvalidInputError("noise is a standard deviation, 0 or more")
        self.position_noise = position_noise

    def bind(self, simulation: "TickedSimulation", group: Any, stream: str) -> None:
        """Start afresh; counts the carts there are."""
        self._count = len(simulation.world.carts)
        super().bind(simulation, group, stream)

    def read(self) -> NDArray[np.float64]:
        """Newest report, shape (k, 5): x, y, yaw, half-length, half-width [m, rad], world frame."""
        return super().read()

    def prepare(self, sequence: np.random.SeedSequence, group: Any) -> None:
        """Set up the noise stream."""
        self._noise = SampleNoise(sequence, (max(1, self._count), 2), "normal")

    def observe(self, time: float) -> Any:
        """True boxes now."""
        assert self._simulation is not None
        return self._simulation.cart_boxes()

    def compute(self, state: Any, number: int) -> NDArray[np.float64]:
        """Add noise."""
        boxes = state.copy()
        if self.position_noise > 0:
            boxes[:, :2] += self.position_noise * self._noise.sample(number)[: self._count]
        return boxes

    def nothing(self) -> NDArray[np.float64]:
        """All NaN."""
        return np.full((self._count, 5), np.nan)
