"""Blobs: spots of known colours in a colour image, by hue and saturation."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from controllers.perception.hues import HUES, hue_mask

Array = NDArray[np.float64]
_CROSS = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))
_SQUARE = np.ones((2, 2), dtype=np.uint8)
_WIDEST = 14  # a hue window reaches this far to either side at most


@dataclass(frozen=True)
class Blobs:
    """Spots of one colour.

    Attributes:
        centre: Centroids (k, 2) [px], the middle of the upper left pixel at (0.5, 0.5).
        area: (k,) [px].
    """

    centre: Array
    area: Array


class BlobFinder:
    """Finds round spots of given colours whatever the brightness they are lit with.

    A pixel belongs to the colour whose hue is nearest, if its saturation comes near that colour's
    and it is bright enough to have a hue. Hue and saturation do not change with brightness as long
    as no channel saturates.
    """

    def __init__(
        self, colours: Sequence[Sequence[float]], *, dark: int = 45, saturation: float = 0.6
    ):
        """Place the borders between the colours.

        Args:
            colours: RGB, 0 to 1: every colour that is to be told from the others.
            dark: A pixel whose brightest channel is below has no colour [grey levels].
            saturation: Least saturation of a pixel, as a share of its colour's.
        """
        rgb = np.array([colours], dtype=np.float32)
        hsv = cv2.cvtColor(rgb, cv2.COLOR_RGB2HSV)[0]
        hue = hsv[:, 0] / 2
        # a window reaches half way to the next hue on either side
        ahead = (hue - hue[:, None]) % HUES
        ahead[ahead == 0] = np.inf
        up = np.minimum(ahead.min(axis=1, initial=np.inf) / 2, _WIDEST)
        down = np.minimum(ahead.min(axis=0, initial=np.inf) / 2, _WIDEST)
        self._low, self._high = np.ceil(hue - down).astype(int), np.floor(hue + up).astype(int)
        self._least = np.round(255 * saturation * hsv[:, 1]).astype(int)
        self._dark = dark
        self._hsv: NDArray[np.uint8] | None = None

    def look(self, image: NDArray[np.uint8]) -> None:
        """Take an image, RGB (height, width, 3), for :meth:`find`."""
        self._hsv = cv2.cvtColor(image, cv2.COLOR_RGB2HSV)  # pyright: ignore

    def find(self, colour: int, smallest: float, widest: float) -> Blobs:
        """Spots of one colour in the image looked at.

        Args:
            colour: Index into the colours.
            smallest: Area [px] below which a spot is ignored.
            widest: Width or height [px] above which it is.
        """
        assert self._hsv is not None
        raw = self._mask(colour)
        # noise makes specks, cheapest removed here: what remains is made of squares of 2 x 2 px
        squares = cv2.erode(raw, _SQUARE, anchor=(0, 0))
        clean = cv2.dilate(squares, _SQUARE, anchor=(1, 1))
        contours, tree = cv2.findContours(clean, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
        rows = []
        # a spot as small as allowed still has this many pixels on its rim
        rim = 2 * np.sqrt(smallest)
        for k, contour in enumerate(contours):
            if len(contour) < rim or tree[0, k, 3] >= 0:
                continue
            x, y, width, height = cv2.boundingRect(contour)
            if max(width, height) > widest:
                continue
            # the spot and the pixels that touch it, without what else its bounding box reaches into
            left, top = max(x - 1, 0), max(y - 1, 0)
            window = raw[top : y + height + 1, left : x + width + 1]
            own = np.zeros(window.shape, dtype=np.uint8)
            cv2.drawContours(own, [contour], 0, 1, cv2.FILLED, offset=(-left, -top))
            own = cv2.bitwise_and(cv2.dilate(own, _CROSS), window)
            moments = cv2.moments(own, binaryImage=True)
            area = moments["m00"]
            if area >= smallest:
                rows.append((moments["m10"] / area + left, moments["m01"] / area + top, area))
        table = np.array(rows, dtype=np.float64).reshape(-1, 3)
        return Blobs(table[:, :2] + 0.5, table[:, 2])

    def mask(self, colour: int) -> NDArray[np.uint8]:
        """Pixels of one colour in the image looked at, (height, width), 0 or 255, without specks.

        Args:
            colour: Index into the colours.
        """
        return cv2.morphologyEx(self._mask(colour), cv2.MORPH_OPEN, _SQUARE)  # pyright: ignore

    def _mask(self, colour: int) -> NDArray[np.uint8]:
        low, high = int(self._low[colour]), int(self._high[colour])
        return hue_mask(self._hsv, low, high, int(self._least[colour]), self._dark)
