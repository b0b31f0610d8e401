"""Parameters of one gait, and the loci its feet follow: a trot of "constant swing speed"."""

import math
from dataclasses import astuple, dataclass

import numpy as np
from numpy.typing import NDArray

from controllers.legged.leg import LegGeometry
from mjmr.errors import InvalidInputError
from mjmr.jit import njit

Array = NDArray[np.float64]
Pair = tuple[float, float]
# half a period between the pairs fore left + hind right and fore right + hind left
PHASES = np.array([0.0, 0.5, 0.5, 0.0])


@dataclass(frozen=True, kw_only=True)
class GaitSet:
    """One gait; pairs are (forelegs, hind legs).

    Attributes:
        period: Of a step of all four legs [s].
        duty: Share of the period a foot is on the floor, between 0 and 1.
        height: Of the hips over the centres of the standing feet [m].
        lift: Of a foot in the middle of its swing [m].
        ahead: Of the middle of a stroke before its hip [m], hind legs too.
        out: The same, outwards [m].
        gain: Length of a stroke over the way that is commanded for a stance.
        clipped: The servos may be asked for more than their rates; they then lag behind.
    """

    period: float
    duty: Pair
    height: Pair
    lift: Pair
    ahead: Pair
    out: Pair
    gain: float = 1.0
    clipped: bool = False

    def __post_init__(self):
        row = self.row()
        if not np.isfinite(row).all():
            raise InvalidInputError(f"parameters of a gait must be finite; got {self}")
        if not (self.period > 0 and self.gain > 0 and 0 < min(self.duty) <= max(self.duty) < 1):
            raise InvalidInputError(
                f"a gait needs a positive period and gain and duties between 0 and 1; got "
                f"{self.period}, {self.gain} and {self.duty}"
            )
        if min(self.lift) < 0:
            raise InvalidInputError(f"feet are lifted by 0 or more; got {self.lift} m")

    def row(self) -> Array:
        """The numbers in a row (12,), which mix linearly; :func:`feet` reads it."""
        period, *pairs, gain, _ = astuple(self)
        return np.array([period, *np.ravel(pairs), gain])


def feet(leg: LegGeometry, rows: Array, phase: Array, twist: Array) -> Array:
    """Centres of the feet (n, 4, 3) [m], body frame.

    On the floor a foot goes straight back by the way of the hips, and in the air at constant speed
    along the floor and up and down a half sine.

    Args:
        leg: Of the robots.
        rows: Parameters (n, 12), each :meth:`GaitSet.row` or a mixture.
        phase: Of the pair fore left + hind right (n,), in periods; 0 where it touches down.
        twist: Commanded (n, 3): forward, left [m/s], anticlockwise [rad/s].

    Any of them may have a single row, which then serves all.
    """
    n = max(len(rows), len(phase), len(twist))
    if not len(rows) == len(phase) == len(twist):
        rows, twist = np.tile(rows, (n // len(rows), 1)), np.tile(twist, (n // len(twist), 1))
        phase = np.tile(phase, n // len(phase))
    return _feet(leg.hips, leg.signs, rows, phase, twist)


@njit
def _feet(hips, signs, rows, phase, twist):
    centres = np.empty((rows.shape[0], 4, 3))
    for i in range(rows.shape[0]):
        forward, left, turn = twist[i, 0], twist[i, 1], twist[i, 2]
        for leg in range(4):
            pair = leg // 2
            duty, height, lift = rows[i, 1 + pair], rows[i, 3 + pair], rows[i, 5 + pair]
            x = hips[leg, 0] + rows[i, 7 + pair]
            y = hips[leg, 1] + signs[leg, 1] * rows[i, 9 + pair]
            stance = rows[i, 0] * duty * rows[i, 11]
            local = (phase[i] + PHASES[leg]) % 1.0
            swing = (local - duty) / (1.0 - duty)
            if swing > 0.0:
                share, rise = swing - 0.5, lift * math.sin(math.pi * swing)
            else:
                share, rise = 0.5 - local / duty, 0.0
            centres[i, leg, 0] = x + (forward - turn * y) * stance * share
            centres[i, leg, 1] = y + (left + turn * x) * stance * share
            centres[i, leg, 2] = rise - height
    return centres
