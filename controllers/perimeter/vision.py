"""Inside or outside of a red perimeter, from the picture of a camera that looks down beside one."""

import cv2
import numpy as np
from numpy.typing import NDArray

from controllers.perception.hues import hue_mask
from mjmr.errors import InvalidInputError

WINDOW = (16, 20)  # px, high and wide, in the middle of the picture
HUE = 9  # of 180, red reaches so far to both sides of 0
SATURATION, VALUE = 101, 41  # of 255, at least


def red_mask(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """What of an RGB image (h, w, 3) is red: (h, w), 255 or 0."""
    hsv = cv2.cvtColor(image, cv2.COLOR_RGB2HSV)
    return hue_mask(hsv, -HUE, HUE, SATURATION, VALUE)


def window(shape: tuple[int, ...]) -> tuple[slice, slice]:
    """Rows and columns of the look-ahead window of an image of this shape."""
    (h, w), (high, wide) = shape[:2], WINDOW
    if h < high or w < wide:
        raise InvalidInputError(
            f"the look-ahead window needs {wide} x {high} px; the image has {w} x {h}"
        )
    return slice((h - high) // 2, (h + high) // 2), slice((w - wide) // 2, (w + wide) // 2)


def inside(images: NDArray[np.uint8]) -> NDArray[np.float64]:
    """1 where more than half of the look-ahead window is red, 0 where not: (n,).

    Args:
        images: RGB (n, h, w, 3); the window's middle is what the camera is aimed at. A black image
            was lost and gives NaN.
    """
    rows, columns = window(images.shape[1:])
    found = np.empty(len(images))
    for i, image in enumerate(images):
        part = np.ascontiguousarray(image[rows, columns])
        found[i] = np.nan if not image.any() else float(red_mask(part).mean() > 127.5)
    return found
