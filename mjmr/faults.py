"""What goes wrong on purpose: robots that stop dead, reports and commands that get lost."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError, UnknownNameError

KINDS = ("dead", "stopped", "reports-lost", "commands-lost")


@dataclass(frozen=True, kw_only=True)
class Fault:
    """One fault of one robot over a span of time.

    Attributes:
        kind: ``"dead"``: brakes at its platform's bound, whatever is commanded, and stays, and
            says nothing; ``"stopped"``: the same, announced by its telemetry as it begins;
            ``"commands-lost"``: the radio delivers nothing, and the robot's watchdog brakes it the
            same way until commands come again; ``"reports-lost"``: no localizer reports it.
        robot: Index in the group.
        start: [s], simulated.
        end: [s], simulated; infinite by default.
    """

    kind: str
    robot: int
    start: float
    end: float = np.inf

    def __post_init__(self):
        if self.kind not in KINDS:
            raise UnknownNameError("fault", self.kind, KINDS)
        if not self.start < self.end:
            raise InvalidInputError(f"a fault must end after it starts; got {self}")


class FaultSchedule:
    """The faults of one group."""

    def __init__(self, n: int):
        """Args: n: Number of robots in the group."""
        self._n = n
        self._faults: list[Fault] = []

    def add(self, fault: Fault) -> None:
        """Schedule a fault.

        Raises:
            InvalidInputError: The group has no such robot.
        """
        if not 0 <= fault.robot < self._n:
            raise InvalidInputError(f"no robot {fault.robot} here; valid: 0 to {self._n - 1}")
        self._faults.append(fault)

    def braked(self, time: float) -> NDArray[np.bool_] | None:
        """Robots that brake by themselves at ``time`` [s], shape (n,); None when there are none."""
        return self._mask(("dead", "stopped", "commands-lost"), time)

    def announced(self, time: float) -> NDArray[np.bool_]:
        """Robots that say at ``time`` [s] that they stop by themselves, shape (n,)."""
        mask = self._mask(("stopped",), time)
        return np.zeros(self._n, dtype=bool) if mask is None else mask

    def unreported(self, time: float) -> NDArray[np.bool_] | None:
        """Robots no localizer reports at ``time`` [s], shape (n,); None when there are none."""
        return self._mask(("reports-lost",), time)

    def silent(self, time: float) -> NDArray[np.bool_] | None:
        """Robots whose radio sends nothing at ``time`` [s], shape (n,); None if there are none."""
        return self._mask(("dead",), time)

    def deaf(self, time: float) -> NDArray[np.bool_] | None:
        """Robots whose radio hears nothing at ``time`` [s], shape (n,); None if there are none."""
        return self._mask(("dead", "commands-lost"), time)

    def _mask(self, kinds: tuple[str, ...], time: float) -> NDArray[np.bool_] | None:
        if not self._faults:
            return None
        # half a microsecond of tolerance: a tick computed in floating point is still "at start"
        now = time + 5e-7
        hit = [f.robot for f in self._faults if f.kind in kinds and f.start <= now < f.end]
        if not hit:
            return None
        mask = np.zeros(self._n, dtype=bool)
        mask[hit] = True
        return mask
