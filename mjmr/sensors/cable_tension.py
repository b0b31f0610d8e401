"""CableTension: load cells where the cable of a NIMS ends."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError
from mjmr.randomness import SampleNoise
from mjmr.sensors.base import Sensor

if TYPE_CHECKING:
    from mjmr.group import Group


class CableTension(Sensor):
    """Tension of the cable behind and in front of each carriage, with Gaussian noise.

    It sees the physics step that ended at its instant. Of a carriage on a curve these are the
    tensions of straight cables that press on it as curve and motor do; of one between tendons
    they are the tendons' own.
    """

    name = "tension"

    def __init__(
        self, *, rate: float = 10.0, latency: float = 0.0, phase: float = 0.0, noise: float = 0.0
    ):
        """Set schedule and error.

        Args:
            rate: Samples a second [Hz].
            latency: [s].
            phase: Instant of the first sample [s].
            noise: Standard deviation [N].

        Raises:
            InvalidInputError: A negative deviation.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        if not noise >= 0:
            raise InvalidInputError(f"noise is a standard deviation, 0 or more; got {noise} N")
        self.noise = noise

    def read(self) -> NDArray[np.float64]:
        """Newest tensions delivered by now, shape (n, 2) [N]; NaN before the first."""
        return super().read()

    def prepare(self, sequence: np.random.SeedSequence, group: "Group") -> None:
        """Set up the noise; checks that there is a cable with forces in it.

        Raises:
            InvalidInputError: Another robot, or a simulation without forces.
        """
        simulation: Any = self._simulation
        drive: Any = simulation.drive_of(group) if hasattr(simulation, "drive_of") else None
        if not hasattr(drive, "tensions"):
            raise InvalidInputError(
                f"{group.name} has no cable whose tension could be measured: that takes robots of "
                "platform nims in a Simulation, which has forces"
            )
        self._drive = drive
        self._noise = SampleNoise(sequence, (group.n, 2), "normal")

    def observe(self, time: float) -> Any:
        """Tensions now."""
        simulation: Any = self._simulation
        return self._drive.tensions(simulation.data)

    def compute(self, state: Any, number: int) -> NDArray[np.float64]:
        """Add noise."""
        return state + self.noise * self._noise.sample(number) if self.noise else state

    def nothing(self) -> NDArray[np.float64]:
        """All NaN."""
        return np.full((self._group.n, 2), np.nan)
