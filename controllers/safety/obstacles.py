"""Where walls and boxes are nearest: what a filter has to know of things that stand."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.motion.clearance import check_bounds, prepare_boxes

Array = NDArray[np.float64]


class NearestPoints:
    """Nearest points of the four walls and of every box.

    Attributes:
        count: Points a robot: 4 and the boxes.
    """

    def __init__(self, bounds: ArrayLike, boxes: ArrayLike | None):
        """Know what stands there.

        Args:
            bounds: Inner faces of the walls (4,): xmin, ymin, xmax, ymax [m].
            boxes: (k, 5): x, y, yaw, half-length, half-width [m, rad], or None.

        Raises:
            InvalidInputError: Another shape, or numbers that are not finite.
        """
        self._bounds = check_bounds(bounds, 0.0)
        prepared = prepare_boxes(boxes)
        self._centre, self._cos, self._sin = prepared[:, :2], prepared[:, 2], prepared[:, 3]
        self._half = prepared[:, 4:6]
        self.count = 4 + len(prepared)

    def of(self, position: Array) -> Array:
        """Nearest points (n, count, 2) [m] to positions (n, 2); inside a box, the position."""
        n = len(position)
        points = np.empty((n, self.count, 2))
        points[:, :4] = position[:, None]
        points[:, 0, 0], points[:, 1, 1], points[:, 2, 0], points[:, 3, 1] = self._bounds
        away = position[:, None] - self._centre
        c, s, half = self._cos, self._sin, self._half
        x = np.clip(c * away[..., 0] + s * away[..., 1], -half[:, 0], half[:, 0])
        y = np.clip(c * away[..., 1] - s * away[..., 0], -half[:, 1], half[:, 1])
        points[:, 4:, 0] = self._centre[:, 0] + c * x - s * y
        points[:, 4:, 1] = self._centre[:, 1] + s * x + c * y
        return points
