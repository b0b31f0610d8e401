"""MotionStatus: what robots' motion engines say that they are doing."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError
from mjmr.sensors.base import Sensor

if TYPE_CHECKING:
    from mjmr.group import Group


class MotionStatus(Sensor):
    """Status of each robot's motion engine, by radio; what the numbers mean is the engine's.

    It is what the engine takes to be so: one that says it walks may push against a wall.
    """

    name = "motion_status"

    def __init__(self, *, rate: float = 25.0, latency: float = 0.0, phase: float = 0.0):
        """Set the schedule; see :class:`mjmr.sensors.base.Sensor`."""
        super().__init__(rate=rate, latency=latency, phase=phase)

    def read(self) -> NDArray[np.int64]:
        """Newest status delivered by now, shape (n,); zeros before the first delivery."""
        return super().read()

    def prepare(self, sequence: np.random.SeedSequence, group: "Group") -> None:
        """Nothing is random; checks that there is an engine that says what it is doing.

        Raises:
            InvalidInputError: The robots have no motion engine with a ``status``.
        """
        # asked again at every sample: the simulation's drives are bound by now
        if self._status() is None:
            raise InvalidInputError(
                f"{group.name} has no motion status: {group.platform.name} needs a motion engine "
                "with a status, such as controllers.legged.motion.AiboMotion"
            )

    def observe(self, time: float) -> Any:
        """Status now."""
        return self._status()

    def compute(self, state: Any, number: int) -> NDArray[np.int64]:
        """As it was."""
        return state

    def nothing(self) -> NDArray[np.int64]:
        """All zero."""
        return np.zeros(self._group.n, dtype=np.int64)

    def _status(self) -> Any:
        ask = getattr(self._simulation, "motion_status_of", None)
        return None if ask is None else ask(self._group)
