"""Relative poses from mutual bearings: two robots that see each other share no other frame.

Robot i keeps a frame F_i of its own, by its odometry, whose heading and origin nobody else knows.
Sgorbissa and Arkin, "Local Navigation Strategies for a Team of Robots", section III.A.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.geometry import rotate, wrap_angle

Array = NDArray[np.float64]


def heading_between(own: ArrayLike, other: ArrayLike) -> Array:
    """Heading of the other's frame in one's own frame [rad], the paper's theta_12.

    ``theta_12 = 180 + alpha_12 - alpha_21``: the two bearings are of one line, seen from its two
    ends.

    Args:
        own: Bearing of the other robot in one's own frame, the paper's alpha_12 [rad], any shape.
        other: Bearing of oneself in the other's frame, as it told, alpha_21 [rad], same shape.

    Returns:
        In (-pi, pi].
    """
    return wrap_angle(np.pi + np.asarray(own) - np.asarray(other))


def point_from_other(
    position: ArrayLike, own: ArrayLike, distance: ArrayLike, other: ArrayLike, point: ArrayLike
) -> Array:
    """A point that another robot tells, in one's own frame: ``p_12 + Rot(theta_12) G``.

    Args:
        position: One's own position in one's own frame (..., 2) [m].
        own: Bearing of the other robot in one's own frame (...) [rad].
        distance: Of the other robot (...) [m].
        other: Bearing of oneself in the other's frame, as it told (...) [rad].
        point: As the other tells it (..., 2) [m]: from the place where it stands, in its axes.

    Returns:
        Shape (..., 2) [m].
    """
    own, distance = np.asarray(own, dtype=np.float64), np.asarray(distance, dtype=np.float64)
    there = np.asarray(position) + distance[..., None] * np.stack(
        [np.cos(own), np.sin(own)], axis=-1
    )
    return there + rotate(point, heading_between(own, other))
