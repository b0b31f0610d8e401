"""Angles and planar transforms: pure numpy, shared by the testbed and the controllers.

Frames: x forward, y left, z up, yaw anticlockwise. A pose is ``(x, y, yaw)`` in m, m, rad.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def wrap_angle(angle: ArrayLike) -> Array:
    """Wrap angles [rad] of any shape to (-pi, pi]."""
    a = np.asarray(angle, dtype=np.float64)
    return np.pi - np.remainder(np.pi - a, 2.0 * np.pi)


def angle_difference(a: ArrayLike, b: ArrayLike) -> Array:
    """Smallest signed rotation [rad] that takes ``b`` to ``a``, in (-pi, pi]."""
    return wrap_angle(np.asarray(a, dtype=np.float64) - np.asarray(b, dtype=np.float64))


def rotate(vector: ArrayLike, angle: ArrayLike) -> Array:
    """Rotate planar vectors anticlockwise.

    Args:
        vector: Shape (..., 2).
        angle: Shape (...) [rad], broadcast against the leading axes of ``vector``.

    Returns:
        Shape (..., 2), the unit of ``vector``.
    """
    v = np.asarray(vector, dtype=np.float64)
    c, s = np.cos(angle), np.sin(angle)
    x, y = v[..., 0], v[..., 1]
    along = c * x - s * y
    turned = np.empty((*along.shape, 2))
    turned[..., 0] = along
    turned[..., 1] = s * x + c * y
    return turned


def compose(T_a_b: ArrayLike, T_b_c: ArrayLike) -> Array:
    """Pose of frame c in frame a, from poses of b in a and c in b; shapes (..., 3)."""
    ab, bc = np.asarray(T_a_b, dtype=np.float64), np.asarray(T_b_c, dtype=np.float64)
    xy = ab[..., :2] + rotate(bc[..., :2], ab[..., 2])
    return np.concatenate([xy, wrap_angle(ab[..., 2] + bc[..., 2])[..., None]], axis=-1)


def invert(T_a_b: ArrayLike) -> Array:
    """Pose of frame a in frame b, from the pose of b in a; shape (..., 3)."""
    ab = np.asarray(T_a_b, dtype=np.float64)
    xy = -rotate(ab[..., :2], -ab[..., 2])
    return np.concatenate([xy, wrap_angle(-ab[..., 2])[..., None]], axis=-1)


def transform_points(T_a_b: ArrayLike, points_b: ArrayLike) -> Array:
    """Points of frame b expressed in frame a.

    Args:
        T_a_b: Pose of b in a, shape (3,).
        points_b: Shape (..., 2) [m].
    """
    ab = np.asarray(T_a_b, dtype=np.float64)
    return ab[:2] + rotate(points_b, ab[2])


def quaternion_yaw(quaternion: ArrayLike) -> Array:
    """Yaw [rad] of unit quaternions ``(w, x, y, z)``, shape (..., 4) -> (...)."""
    q = np.asarray(quaternion, dtype=np.float64)
    w, x, y, z = q[..., 0], q[..., 1], q[..., 2], q[..., 3]
    return np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
