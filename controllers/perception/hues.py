"""Pixels of a range of hues, which red divides."""

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

HUES = 180  # OpenCV's hue in 8 bits counts 2 degrees


def hue_mask(hsv: Any, low: int, high: int, saturation: int, value: int) -> NDArray[np.uint8]:
    """Pixels whose hue, saturation and value are in a range: (h, w), 255 or 0.

    Args:
        hsv: Image (h, w, 3) as OpenCV has it in 8 bits.
        low: Least hue [2 degrees]; below 0 the range goes over hue 0.
        high: Largest hue [2 degrees]; from 180 on likewise.
        saturation: Least, of 255.
        value: Least, of 255.
    """
    least = (saturation, value)
    if low >= 0 and high < HUES:
        return cv2.inRange(hsv, (low, *least), (high, 255, 255))  # pyright: ignore
    # red lies on both sides of hue 0
    above = cv2.inRange(hsv, (low % HUES, *least), (HUES - 1, 255, 255))  # pyright: ignore
    below = cv2.inRange(hsv, (0, *least), (high % HUES, 255, 255))  # pyright: ignore
    return cv2.bitwise_or(above, below)  # pyright: ignore[reportReturnType]
