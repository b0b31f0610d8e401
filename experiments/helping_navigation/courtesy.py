"""Courtesy: robots tell each other by radio where they go, and the later ones make way."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.helping.frames import turn
from controllers.motion.yielding import YieldingConfig, give_way
from mjmr.geometry import wrap_angle
from mjmr.radio import Radio

Array = NDArray[np.float64]


class Courtesy:
    """Turns wishes into directions that make way for robots of lower index.

    Every robot tells the direction it goes in and the bearings at which it sees the others, all in
    its own frame. Who hears it and saw the sender at the same instant knows the sender's frame by
    the two bearings, and so where the sender goes.
    """

    def __init__(self, n: int, radio: Radio, config: YieldingConfig | None = None):
        """Args: n: How many robots. radio: That only reaches who is in sight. config: How."""
        self._n, self._radio, self._config = n, radio, config
        self._first = np.arange(n)[None, :] < np.arange(n)[:, None]
        self._before: tuple[float, Array] = (np.nan, np.full((n, n), np.nan))

    def step(
        self, time: float, wish: ArrayLike, heading: Array, sight: Array, ranges: Array,
        angles: Array, follows: NDArray[np.int64] | None = None,
    ) -> Array:  # fmt: skip
        """Directions to go in.

        Args:
            time: [s].
            wish: (n,) [rad], body frames; NaN stands still.
            heading: Of the bodies in their own frames F_i (n,) [rad].
            sight: Of :class:`TeammateSight` (n, n, 2).
            ranges: Scans (n, b) [m].
            angles: Of their beams (b,) [rad].
            follows: Whom each robot goes after (n,), -1 nobody: that one need not make way for it,
                but goes first.

        Returns:
            (n,) [rad], body frames.
        """
        after = np.full(self._n, -1) if follows is None else follows
        first = self._first.copy()
        led = np.flatnonzero(after >= 0)
        first[led, after[led]] = True
        bearing = wrap_angle(sight[..., 1] + heading[:, None])
        travel = self._travel(heading, time)
        others = sight[..., :1] * np.stack([np.cos(sight[..., 1]), np.sin(sight[..., 1])], axis=-1)
        aside = give_way(others, travel, first, ranges, angles, self._config)
        way = np.where(np.isfinite(aside), aside, np.asarray(wish, dtype=np.float64))
        self._radio.broadcast_arrays(
            np.column_stack([wrap_angle(way + heading), after, bearing]).astype(np.float32)
        )
        self._before = time, bearing
        return way

    def _travel(self, heading: Array, time: float) -> Array:
        """Where others go (n, n) [rad], body frame of who heard it; NaN where nothing was heard."""
        then, bearing = self._before
        if not np.isfinite(then):
            return np.full((self._n, self._n), np.nan)
        told, sent = self._radio.latest()
        theta = turn(bearing, np.einsum("iji->ij", told[:, :, 2:]))
        # only words said at the look before: both bearings are of one instant
        fresh = np.abs(sent - then) < 1e-6
        fresh &= told[:, :, 1] != np.arange(self._n)[:, None]
        return np.where(fresh, wrap_angle(told[:, :, 0] + theta - heading[:, None]), np.nan)
