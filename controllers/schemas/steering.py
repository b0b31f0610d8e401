"""From vectors to what a two-wheel base takes."""

import numpy as np
from numpy.typing import ArrayLike

from controllers.schemas.percepts import Array
from mjmr.errors import InvalidInputError
from mjmr.geometry import wrap_angle


def steer(
    vector: Array,
    heading: ArrayLike,
    *,
    top_speed: float,
    top_turn: float,
    gain: float = 4.0,
) -> Array:
    """Commands of unicycles that follow vectors: turn towards them, go ahead as far as they face.

    Args:
        vector: Shape (n, 2), axes of fixed direction; length 1 or more asks for the top speed.
        heading: Of the robots in the same axes (n,) [rad].
        top_speed: [m/s].
        top_turn: [rad/s].
        gain: Turn rate per heading error [1/s].

    Returns:
        Shape (n, 2): forward [m/s], 0 where the vector lies 90 degrees off or more, and turn
        [rad/s]. A vector of length 0 stops the robot.

    Raises:
        InvalidInputError: A speed, turn or gain that is not positive.
    """
    if not min(top_speed, top_turn, gain) > 0:
        raise InvalidInputError(
            f"top_speed, top_turn and gain must be positive; got {top_speed}, {top_turn}, {gain}"
        )
    length = np.hypot(vector[:, 0], vector[:, 1])
    aim = np.arctan2(vector[:, 1], vector[:, 0])
    error = np.where(length > 1e-9, wrap_angle(aim - np.asarray(heading)), 0.0)
    forward = top_speed * np.minimum(length, 1.0) * np.maximum(np.cos(error), 0.0)
    return np.column_stack([forward, np.clip(gain * error, -top_turn, top_turn)])
