"""Kicks: keyframes, where the ball must lie for them, and where it goes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from controllers.legged.keyframes import Keyframes
from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Kick:
    """A kick.

    Attributes:
        keyframes: From any stand and back to it.
        ball: Where the ball's centre must lie (2,) [m]: ahead and left of the robot's origin.
        direction: Where the ball goes, anticlockwise from ahead [rad].
        distance: How far it rolls at least on average [m].
    """

    keyframes: Keyframes
    ball: tuple[float, float]
    direction: float
    distance: float

    def __post_init__(self):
        numbers = [*self.ball, self.direction, self.distance]
        if len(numbers) != 4 or not np.isfinite(numbers).all():
            raise InvalidInputError(
                f"a kick needs a place (2,), a direction and a distance; got {numbers}"
            )

    def ready(self, balls: Array, tolerance: float = 0.012) -> NDArray[np.bool_]:
        """Whether balls (n, 2) [m] lie where they must, in the robots' own frames.

        Args:
            balls: Ahead and left of each robot's origin; NaN where none is seen.
            tolerance: How far off [m].
        """
        return np.hypot(*(np.asarray(balls) - self.ball).T) <= tolerance
