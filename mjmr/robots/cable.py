"""The cable of a carriage: its curve, what it carries, how fast a package below it swings."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mjmr.errors import InvalidInputError
from mjmr.jit import njit
from mjmr.robots.platform import Array

GRAVITY = 9.81  # m/s^2, MuJoCo's default


@dataclass(frozen=True, kw_only=True)
class Cable:
    """A parabola between two supports of one height; x along it from the middle, z up.

    Attributes:
        span: Between the supports [m].
        height: Of its ends above the floor [m].
        sag: How far its middle hangs below its ends [m].
    """

    span: float
    height: float
    sag: float

    def __post_init__(self):
        if not (
            all(math.isfinite(v) for v in (self.span, self.height, self.sag))
            and 0 < self.sag < self.height
            and self.sag <= self.span / 4
        ):
            raise InvalidInputError(
                "a cable needs a positive span, and a sag of at most a quarter of it and less than "
                f"its height; got span {self.span}, height {self.height} and sag {self.sag} m"
            )

    def curve(self, along: ArrayLike) -> Array:
        """Heights [m] at ``along`` [m] from the middle, any shape."""
        return self.height - self.sag + self.sag * (np.asarray(along) / (self.span / 2)) ** 2

    def tensions(self, along: ArrayLike, weight: float) -> Array:
        """Tensions at rest (..., 2) [N] behind and in front of a carriage, by statics.

        The cable itself weighs nothing, so that it is straight on both sides.

        Args:
            along: Of the carriage from the middle [m], any shape.
            weight: Of carriage and package [N].
        """
        x = np.asarray(along, dtype=np.float64)
        both = pulls(x.ravel(), self.curve(x).ravel(), *self.shape, 0.0 * x.ravel(), weight)
        return both.reshape(*x.shape, 2)

    @property
    def shape(self) -> tuple[float, float]:
        """Half the span and the height of the ends [m], for compiled functions."""
        return self.span / 2, self.height


@njit
def pulls(x, z, half, height, forward, upward):
    """Tensions (n, 2) [N] of straight cables, behind and in front, that add up to a force.

    Args:
        x: Of the carriages from the middle (n,) [m].
        z: Heights (n,) [m].
        half: Half the span [m].
        height: Of the ends [m].
        forward: Force along the span on each carriage (n,) [N].
        upward: The same upwards, (n,) or one number [N].
    """
    up = np.zeros_like(x) + upward
    result = np.empty((x.shape[0], 2))
    for i in range(x.shape[0]):
        back, front, rise = half + x[i], half - x[i], height - z[i]
        behind, ahead = math.hypot(back, rise), math.hypot(front, rise)
        # T1 (-back, rise) / behind + T2 (front, rise) / ahead = (forward, up)
        share = 1.0 / (rise * (back + front))
        result[i, 0] = behind * share * (up[i] * front - forward[i] * rise)
        result[i, 1] = ahead * share * (up[i] * back + forward[i] * rise)
    return result


def swing_period(length: Any, gyration: float = 0.0) -> Any:
    """Period [s] of small swings of a package on a line, without damping.

    Args:
        length: From the pivot to the package's centre of mass [m].
        gyration: Radius of gyration of the package about an axis across the swing [m].
    """
    return 2.0 * math.pi * np.sqrt((length + gyration**2 / length) / GRAVITY)
