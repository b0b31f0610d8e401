"""AmbientField: how far a room's iron and mains turn a compass, by place."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_WAVES = 3


class AmbientField:
    """A smooth error of headings over the plane: the sum of a few plane waves.

    Waves run in any direction, have lengths within half and one and a half of the scale and share
    the amplitude evenly, so that the error never exceeds it anywhere; over a large room its mean is
    0 and its standard deviation ``amplitude / sqrt(2 * 3)``. Real fields have dipoles near iron:
    what counts here is that the error is the same wherever one comes back to.
    """

    def __init__(self, rng: np.random.Generator, amplitude: float, scale: float):
        """Draw the waves; the same draws whatever amplitude and scale are.

        Args:
            rng: Of the room.
            amplitude: Bound of the error [rad].
            scale: Mean length of the waves [m].
        """
        lengths = scale * rng.uniform(0.5, 1.5, _WAVES)
        ways = rng.uniform(-np.pi, np.pi, _WAVES)
        self._waves = 2.0 * np.pi / lengths * np.array([np.cos(ways), np.sin(ways)])
        self._phases = rng.uniform(-np.pi, np.pi, _WAVES)
        self._share = amplitude / _WAVES

    def at(self, places: Array) -> Array:
        """Error (n,) [rad] at places (n, 2) [m], world frame."""
        return self._share * np.sin(places @ self._waves + self._phases).sum(axis=1)
