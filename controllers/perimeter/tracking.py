"""Tracking along the perimeter, and how a team spreads on it."""

import numpy as np
from numpy.typing import NDArray

from controllers.perimeter.config import PerimeterConfig

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


def bang_bang(inside: Array, forward: Array, config: PerimeterConfig) -> Array:
    """Turn rates (n,) of equation 7: right inside, left outside; 0 where nothing is known.

    They are scaled by forward / track_speed, so that the path is the same however slow (ours; at
    track speed it is the paper's).
    """
    sign = np.where(inside > 0.5, -1.0, 1.0)
    turn = config.track_turn * np.minimum(forward / config.track_speed, 1.0) * sign
    return np.where(np.isfinite(inside), turn, 0.0)


def spacing(apart: Array, bearing: Array, desired: Array, config: PerimeterConfig) -> Array:
    """Speeds (n,) of the whole team: equation 8, as printed or repaired.

    As printed two mutual nearest neighbours get the same speed and their gap never changes. The
    reading that reproduces every remark of the paper is that of a close pair the front robot alone
    moves: at k_p (d_des - d) if the nearest neighbour is behind and nearer than d_des, else not.

    Args:
        apart: To every other robot on the perimeter (n, n) [m], straight; NaN: not one, or unknown.
        bearing: Of it from the robot's heading (n, n) [rad].
        desired: d_des of each robot (n,) [m].
        config: With the gains.

    Returns:
        Track speed for who knows of nobody else.
    """
    known = np.where(np.isfinite(apart), apart, np.inf)
    nearest = np.argmin(known, axis=1)
    rows = np.arange(len(known))
    distance = known[rows, nearest]
    alone = ~np.isfinite(distance)
    short = np.where(alone, 0.0, desired - distance)
    speed = config.proportional * np.abs(short)
    if config.spacing == "repaired":
        behind = np.abs(bearing[rows, nearest]) > np.pi / 2
        speed = np.where(behind & (short > 0), speed, 0.0)
    speed = np.where(np.abs(short) < config.dead_band, 0.0, speed)
    return np.where(alone, config.track_speed, np.minimum(speed, config.track_speed))


class Zigzag:
    """Keeps a robot at track speed until it has crossed the edge so many times and is inside.

    A stopped robot that a growing edge has got deep into makes one whole zigzag (in, out, in):
    otherwise it resumes at every touch and winds away from the perimeter (our check). So does one
    from which a shrinking edge has gone back as far (ours). One that has just begun to track makes
    two, so that it does not stop where it took over, beside the edge; crossings may have been wrong
    readings, and nobody stops before the edge itself is near (ours).

    Attributes:
        active: Who is at it (n,).
    """

    def __init__(self, n: int, config: PerimeterConfig):
        """Args: n: How many robots. config: With the depth."""
        self._config = config
        self.active = np.zeros(n, dtype=bool)
        self._crossings = np.zeros(n, dtype=np.int64)  # still to be made
        self._was = np.full(n, np.nan)

    def speeds(self, speed: Array, error: Array, inside: Array, tracks: Flags, joins: Flags
               ) -> Array:  # fmt: skip
        """Speeds (n,): track speed for who is at it, ``speed`` for the others.

        Args:
            speed: As the spacing rule has it (n,).
            error: Of :class:`controllers.perimeter.approach.Edge` (n,) [m].
            inside: (n,).
            tracks: Who tracks (n,).
            joins: Who does since this step (n,).
        """
        with np.errstate(invalid="ignore"):
            stray = np.abs(error) > self._config.resume_depth
            stray &= (error < 0) == (inside > 0.5)
            crossed = np.abs(inside - self._was) > 0.5
            done = np.abs(error) < self._config.settle_error
        begins = tracks & (speed == 0.0) & stray & ~self.active
        left = self._crossings - crossed
        left = np.where(begins, 2, left)
        self._crossings = np.where(joins, 4, left)
        done &= (self._crossings <= 0) & (inside > 0.5)
        self.active = tracks & (begins | joins | (self.active & ~done))
        self._was = np.where(np.isfinite(inside), inside, self._was)
        return np.where(self.active, self._config.track_speed, speed)
