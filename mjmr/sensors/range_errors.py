"""What lidars, sonars and infra-red rangers share: fans, checks of what is asked, and errors."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError
from mjmr.randomness import SampleNoise

Array = NDArray[np.float64]
METHODS = ("auto", "compiled", "mujoco")  # of casting rays, see RayScene


def fan_angles(beams: int, width: float) -> Array:
    """Angles (beams,) [rad], evenly spaced over ``width`` and symmetric; of one beam 0.

    Of a full turn the last beam is one step before the first one would come again.
    """
    if beams == 1:
        return np.zeros(1)
    if width >= 2 * math.pi - 1e-9:
        return -math.pi + 2 * math.pi * np.arange(beams) / beams
    return np.linspace(-width / 2, width / 2, beams)


@dataclass(frozen=True, kw_only=True)
class RangeErrors:
    """What becomes of a true range; the rules of ROS's REP 117.

    Attributes:
        min_range: Nearer returns read minus infinity [m].
        max_range: [m].
        noise: Standard deviation [m], Gaussian.
        proportional_noise: The same as a share of the range; the larger of both counts.
        drop_out: Probability that a range reads NaN.

    Raises:
        InvalidInputError: Ranges, deviations or a probability that cannot be.
    """

    min_range: float
    max_range: float
    noise: float
    proportional_noise: float
    drop_out: float

    def __post_init__(self):
        if not (0 <= self.min_range < self.max_range and math.isfinite(self.max_range)):
            raise InvalidInputError(
                f"ranges must be finite with 0 <= min_range < max_range; got {self.min_range} and "
                f"{self.max_range} m"
            )
        for name in ("noise", "proportional_noise"):
            value = getattr(self, name)
            if not (value >= 0 and math.isfinite(value)):
                raise InvalidInputError(f"{name} is a standard deviation, 0 or more; got {value}")
        if not 0 <= self.drop_out <= 1:
            raise InvalidInputError(f"drop_out is a probability, 0 to 1; got {self.drop_out}")

    def streams(self, sequence: np.random.SeedSequence, shape: tuple[int, ...]) -> "RangeStreams":
        """Streams for samples of ``shape``, robots first."""
        noise, drops = sequence.spawn(2)
        return RangeStreams(
            SampleNoise(noise, shape, "normal"), SampleNoise(drops, shape, "uniform")
        )

    def apply(self, ranges: Array, streams: "RangeStreams", number: int) -> Array:
        """Spoil the true ranges of sample ``number``, infinite where nothing returns, in place."""
        near = ranges < self.min_range if self.min_range > 0 else None
        if self.noise or self.proportional_noise:
            size: float | Array = self.noise
            if self.proportional_noise:
                # infinite times nothing would be NaN
                size = np.maximum(
                    self.noise, self.proportional_noise * np.minimum(ranges, self.max_range)
                )
            ranges += size * streams.noise.sample(number)
            np.maximum(ranges, 0.0, out=ranges)
        if near is not None:
            ranges[near] = -np.inf
        if self.drop_out > 0:
            ranges[streams.drops.sample(number) < self.drop_out] = np.nan
        return ranges


@dataclass(frozen=True)
class RangeStreams:
    """Random streams of one sensor.

    Attributes:
        noise: Deviations of 1.
        drops: 0 to 1.
    """

    noise: SampleNoise
    drops: SampleNoise
