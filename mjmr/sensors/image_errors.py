"""What spoils a colour image: pixel noise, and a lens and lamps that leave some of it darker."""

import cv2
import numpy as np
from numpy.typing import NDArray

from mjmr.randomness import SampleNoise

Picture = NDArray[np.uint8]
_MARGIN = 128  # px by which a noise tile is larger than the image


class PixelNoise:
    """Gaussian noise on every pixel and channel, a function of (stream, row, sample) alone.

    One tile of noise, a little larger than the image, is drawn once; each sample takes it at an
    offset of its own (one of 16,384) and with a sign of its own. Within an image the noise is
    white; between two images it is uncorrelated unless they share the offset.
    """

    def __init__(self, sequence: np.random.SeedSequence, rows: int, deviation: float):
        """Prepare; nothing is drawn before the first sample.

        Args:
            sequence: The stream.
            rows: Cameras that share it.
            deviation: Standard deviation in grey levels.
        """
        tile, choice = sequence.spawn(2)
        self._tile_sequence, self._deviation = tile, deviation
        self._choice = SampleNoise(choice, (rows, 3), "uniform")
        self._tiles: tuple[Picture, Picture] | None = None

    def add(self, images: Picture, number: int) -> None:
        """Add sample ``number`` to images (rows, h, w, 3) in place, saturating at 0 and 255."""
        if self._tiles is None:
            self._tiles = self._draw(images.shape[1:])
        height, width = images.shape[1:3]
        for image, (down, right, sign) in zip(images, self._choice.sample(number), strict=True):
            top, left = int(down * _MARGIN), int(right * _MARGIN)
            window = (slice(top, top + height), slice(left, left + width))
            plus, minus = self._tiles if sign < 0.5 else self._tiles[::-1]
            cv2.add(image, plus[window], dst=image)
            cv2.subtract(image, minus[window], dst=image)

    def _draw(self, shape: tuple[int, ...]) -> tuple[Picture, Picture]:
        generator = np.random.Generator(np.random.PCG64(self._tile_sequence))
        size = (shape[0] + _MARGIN, shape[1] + _MARGIN, shape[2])
        # rounding to whole levels adds a variance of 1/12
        deviation = np.sqrt(max(self._deviation**2 - 1 / 12, 0.0))
        noise = np.round(generator.standard_normal(size, dtype=np.float32) * np.float32(deviation))
        plus = np.clip(noise, 0, 255).astype(np.uint8)
        return plus, np.clip(-noise, 0, 255).astype(np.uint8)


class GainField:
    """Multiplies every pixel by a fixed gain, largest 1."""

    def __init__(self, width: int, height: int, vignetting: float, unevenness: float):
        """Compute the field.

        Args:
            width: Of the image [px].
            height: Of the image [px].
            vignetting: Share of the light lost in the corners; grows with the squared distance
                from the middle.
            unevenness: Share of the light lost at the right edge against the left, linearly.
        """
        x = (np.arange(width) + 0.5) / width * 2 - 1
        y = (np.arange(height) + 0.5) / height * 2 - 1
        distance = (x**2 * width**2 + y[:, None] ** 2 * height**2) / (width**2 + height**2)
        gain = (1 - vignetting * distance) * (1 - unevenness * (x + 1) / 2)
        levels = np.round(255 * gain / gain.max()).astype(np.uint8)
        self._levels = np.repeat(levels[..., None], 3, axis=2)

    def apply(self, images: Picture) -> None:
        """Multiply images (rows, h, w, 3) in place."""
        for image in images:
            cv2.multiply(image, self._levels, dst=image, scale=1 / 255)
