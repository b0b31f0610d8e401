"""Parameters of one gait, and the loci its feet follow: a trot of "constant swing speed"."""

from dataclasses import astuple, dataclass

import numpy as np
from numpy.typing import NDArray

from controllers.legged.leg import LegGeometry
from mjmr.errors import InvalidInputError

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
    """
    period, gain = rows[:, :1], rows[:, 11:]
    # (n, 5, 4): duty, height, lift, ahead and out of each leg
    pairs = rows[:, 1:11].reshape(-1, 5, 2)[:, :, [0, 0, 1, 1]]
    duty, height, lift, ahead, out = np.moveaxis(pairs, 1, 0)
    x, y = leg.hips[:, 0] + ahead, leg.hips[:, 1] + leg.signs[:, 1] * out
    stance = period * duty * gain
    forward, left, turn = np.moveaxis(twist[:, :, None], 1, 0)
    along, across = (forward - turn * y) * stance, (left + turn * x) * stance
    local = np.remainder(phase[:, None] + PHASES, 1.0)
    swing = (local - duty) / (1.0 - duty)
    aloft = swing > 0.0
    share = np.where(aloft, swing - 0.5, 0.5 - local / duty)
    rise = np.where(aloft, lift * np.sin(np.pi * swing), 0.0)
    return np.stack([x + along * share, y + across * share, rise - height], axis=-1)
