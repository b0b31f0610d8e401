"""Obstacles that move: the ground they will cover while a robot could still be braking."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.geometry import rotate


def swept_boxes(boxes: ArrayLike, velocity: ArrayLike, horizon: float) -> NDArray[np.float64]:
    """Boxes grown over the way they go in ``horizon`` at constant velocity, without turning.

    Args:
        boxes: Shape (k, 5): x, y, yaw, half-length, half-width [m, rad], world frame.
        velocity: Shape (k, 2) [m/s], world frame.
        horizon: [s], 0 or more.

    Returns:
        Shape (k, 5), same form: exact for a box that moves along one of its axes, otherwise the
        smallest box of the same yaw around its way.

    Raises:
        InvalidInputError: Shapes do not fit, or a negative horizon.

    Not in the paper, whose obstacles stand still.
    """
    b, v = np.array(boxes, dtype=np.float64), np.asarray(velocity, dtype=np.float64)
    if b.ndim != 2 or b.shape[1] != 5 or v.shape != (len(b), 2):
        raise InvalidInputError(
            f"boxes {b.shape} and velocity {v.shape} must be (k, 5) and (k, 2) for one k"
        )
    if not horizon >= 0.0:
        raise InvalidInputError(f"horizon is {horizon} s; it must be 0 or more")
    way = v * horizon
    b[:, :2] += way / 2.0
    b[:, 3:] += np.abs(rotate(way, -b[:, 2])) / 2.0
    return b
