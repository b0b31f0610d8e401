"""How a robot stands or lies, told by its accelerometer alone."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mjmr.jit import njit

Array = NDArray[np.float64]
STANDING, FRONT, LEFT, RIGHT, BACK = range(5)
POSTURES = ("standing", "front", "left", "right", "back")


def classify(up: Array) -> NDArray[np.int64]:
    """Postures (n,) for directions of up.

    ``STANDING`` is a trunk within 32 degrees of upright: a robot that lies on its belly reads the
    same, no accelerometer can tell. ``FRONT`` is anything else that is on no side and not on its
    back: nose or rump down.

    Args:
        up: Body frame (n, 3), of any length: what an accelerometer at rest reads.
    """
    return _classify(up)


@njit
def _classify(up):
    found = np.full(up.shape[0], FRONT)
    for i in range(up.shape[0]):
        x, y, z = up[i]
        length = max(math.sqrt(x * x + y * y + z * z), 1e-9)
        side, top = y / length, z / length
        if top > 0.85:
            found[i] = STANDING
        elif abs(top) < 0.6 and abs(side) > 0.5:
            found[i] = LEFT if side < 0.0 else RIGHT
        elif top < -0.5:
            found[i] = BACK
    return found


class Posture:
    """Postures of n robots from low-passed accelerations.

    Attributes:
        up: Low-passed reading (n, 3) [m/s^2], body frame; NaN before the first.
    """

    def __init__(self, n: int, *, frame: float, lag: float = 0.1, limit: float = 30.0):
        """Start with n robots; their first reading is taken as it is.

        Args:
            n: Number of robots.
            frame: Between two readings [s].
            lag: Time constant of the low pass [s].
            limit: Readings are clipped to this [m/s^2]: a foot that strikes is no tilt.
        """
        self.up = np.full((n, 3), np.nan)
        self._share, self._limit = 1.0 - np.exp(-frame / lag), limit

    def update(self, accelerometer: Array) -> NDArray[np.int64]:
        """Take a reading (n, 3) [m/s^2] and return the postures (n,)."""
        clipped = accelerometer.clip(-self._limit, self._limit)
        known = np.where(np.isnan(self.up), clipped, self.up)
        self.up = known + self._share * (clipped - known)
        return classify(self.up)

    def state(self) -> Any:
        """All that later postures depend on; a copy."""
        return self.up.copy()

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        self.up = state.copy()
