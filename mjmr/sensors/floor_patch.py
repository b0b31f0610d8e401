"""FloorPatch: which marked patches of the floor are under every robot."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.sensors.base import Sensor

if TYPE_CHECKING:
    from mjmr.group import Group

Flags = NDArray[np.bool_]


class FloorPatch(Sensor):
    """A detector under the robot that knows round patches painted on the floor, each by its colour.

    It sees the patch that is under the robot's origin, or under ``ahead`` of it; neither how far
    away one is nor in what direction. A beacon that is heard within its range and no further is
    the same thing.

    Attributes:
        patches: x, y and radius of each (k, 3) [m], world frame.
        ahead: Place of the detector in front of the robot's origin [m].
    """

    name = "floor_patch"

    def __init__(
        self,
        patches: ArrayLike,
        *,
        ahead: float = 0.0,
        rate: float = 10.0,
        latency: float = 0.0,
        phase: float = 0.0,
    ):
        """Say which patches there are.

        Args:
            patches: x, y, radius of each, shape (k, 3) [m], world frame.
            ahead: Place of the detector in front of the robot's origin [m].
            rate: Readings a second [Hz].
            latency: [s].
            phase: Instant of the first reading [s].

        Raises:
            InvalidInputError: Patches of another shape, not finite or without area, or a place that
                is not finite.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        rows = np.array(patches, dtype=np.float64)
        if rows.ndim != 2 or rows.shape[1] != 3 or not len(rows) or not np.isfinite(rows).all():
            raise InvalidInputError(
                f"patches must be finite and of shape (k, 3): x, y, radius; got {rows.shape}"
            )
        if (rows[:, 2] <= 0).any():
            raise InvalidInputError(f"a patch's radius must be positive; got {rows[:, 2].min()} m")
        if not np.isfinite(ahead):
            raise InvalidInputError(f"a detector's place must be finite; got {ahead} m")
        rows.setflags(write=False)
        self.patches, self.ahead = rows, float(ahead)

    def read(self) -> Flags:
        """Newest reading delivered by now, (n, k): whether the robot is on the patch.

        On none before the first delivery.
        """
        return super().read()

    @property
    def reading_bounds(self) -> tuple[bool, bool]:
        """Least and largest value of a reading."""
        return False, True

    def prepare(self, sequence: np.random.SeedSequence, group: "Group") -> None:
        """Nothing is random."""

    def observe(self, time: float) -> Any:
        """True poses now."""
        assert self._simulation is not None
        return self._simulation.poses_of(self._group)

    def compute(self, state: Any, number: int) -> Flags:
        """Distances against radii."""
        yaw = state[:, 2]
        x = state[:, 0] + self.ahead * np.cos(yaw)
        y = state[:, 1] + self.ahead * np.sin(yaw)
        away = np.hypot(x[:, None] - self.patches[:, 0], y[:, None] - self.patches[:, 1])
        return away <= self.patches[:, 2]

    def nothing(self) -> Flags:
        """On none."""
        return np.zeros((self._group.n, len(self.patches)), dtype=bool)
