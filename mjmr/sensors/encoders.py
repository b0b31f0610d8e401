"""WheelEncoders: counts of how far each wheel has turned."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError
from mjmr.sensors.base import Sensor

if TYPE_CHECKING:
    from mjmr.group import Group


class WheelEncoders(Sensor):
    """Whole counts of the angle each driven wheel has turned since the start, forwards positive.

    They see the wheels alone: a wheel that slips or spins counts all the same. Counters do not
    overflow.

    Attributes:
        counts_per_turn: Of a wheel.
    """

    name = "encoders"

    def __init__(
        self,
        *,
        rate: float = 10.0,
        latency: float = 0.0,
        phase: float = 0.0,
        counts_per_turn: float = 9850.0,
    ):
        """Set schedule and resolution.

        Args:
            rate: Reports a second [Hz].
            latency: [s].
            phase: Instant of the first report [s].
            counts_per_turn: Of a wheel; by default a Pioneer 2-DX's, 500 lines behind a gear of
                19.7 (assets/pioneer2dx/README.md).

        Raises:
            InvalidInputError: Counts that are not positive and finite.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        if not (counts_per_turn > 0 and math.isfinite(counts_per_turn)):
            raise InvalidInputError(
                f"counts_per_turn must be positive and finite; got {counts_per_turn}"
            )
        self.counts_per_turn = float(counts_per_turn)

    def read(self) -> NDArray[np.int64]:
        """Newest counts delivered by now, shape (n, wheels), in the platform's order of wheels.

        Zeros, the count at the start, before the first delivery.
        """
        return super().read()

    def prepare(self, sequence: np.random.SeedSequence, group: "Group") -> None:
        """Nothing is random; checks that there are wheels.

        Raises:
            InvalidInputError: The platform has no wheels to count.
        """
        if not group.platform.wheels:
            raise InvalidInputError(
                f"{group.name} cannot carry wheel encoders: {group.platform.name} has no wheels "
                "with counters"
            )

    def observe(self, time: float) -> Any:
        """Angles of the wheels now."""
        assert self._simulation is not None
        return self._simulation.wheel_angles_of(self._group)

    def compute(self, state: Any, number: int) -> NDArray[np.int64]:
        """Whole counts, rounded down."""
        return np.floor(state * (self.counts_per_turn / (2.0 * math.pi))).astype(np.int64)

    def nothing(self) -> NDArray[np.int64]:
        """All zero."""
        return np.zeros((self._group.n, len(self._group.platform.wheels)), dtype=np.int64)
