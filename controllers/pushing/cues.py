"""In position: whether what a robot pushes lies on the way to where it shall go."""

from dataclasses import KW_ONLY, dataclass

import numpy as np

from controllers.schemas import Cue, View
from controllers.schemas.percepts import Array, Flags
from mjmr.errors import InvalidInputError
from mjmr.jit import njit

FLOOR = 0.1  # radii: of p = 0, which exact equality would never let through


@dataclass(frozen=True, eq=False)
class InPosition(Cue):
    """Whether the target lies between the robot and home, or for building the robot between both.

    With ``h`` the unit vector from the robot to home (from home to the robot when building) and
    ``a`` the vector to the target's centre: in position if the lateral offset ``|a x h|`` is at
    most ``p`` robot radii, ``a . h > 0``, and not building ``|a| < |home|``. It stays so up to
    ``1.5 p + 0.5`` radii.

    Source: Cherry and Zhang, sections 2.2 and 2.3, *betweenness*; the tolerance for staying, the
    least offset of 0.1 radii (p = 0) and ``|a| < |home|`` are ours.

    Attributes:
        p: Robot radii.
        radius: Of the robot [m].
        build: Whether home's polarity is reversed.
        share: Name of a percept (n, 2) whose first column replaces ``p`` robot by robot; empty:
            none.
    """

    p: float
    _: KW_ONLY
    radius: float
    build: bool = False
    share: str = ""

    def __post_init__(self):
        if not (0 <= self.p < np.inf and 0 < self.radius < np.inf):
            raise InvalidInputError(
                f"in position: p must be 0 or more and the radius positive; got {self.p} and "
                f"{self.radius} m"
            )

    def offset(self, view: View) -> Array:
        """Lateral offsets (n,) [m]; infinite where the target is not between, or there is none."""
        return _offset(view.vector("home"), view.vector("target"), self.build)

    def holds(self, view: View, before: Flags) -> Flags:
        """Flags (n,)."""
        p = view.vector(self.share)[:, 0] if self.share else np.full(view.n, self.p)
        enter = np.maximum(p, FLOOR) * self.radius
        leave = (1.5 * p + 0.5) * self.radius
        return self.offset(view) <= np.where(before, leave, enter)


@njit
def _offset(home, target, build):
    offset = np.full(len(home), np.inf)
    for i in range(len(home)):
        away = np.hypot(home[i, 0], home[i, 1])
        if not away > 0.0:
            continue
        sign = -1.0 if build else 1.0
        x, y = sign * home[i, 0] / away, sign * home[i, 1] / away
        along = target[i, 0] * x + target[i, 1] * y
        near = np.hypot(target[i, 0], target[i, 1]) < away
        if along > 0.0 and (build or near):
            offset[i] = abs(target[i, 0] * y - target[i, 1] * x)
    return offset
