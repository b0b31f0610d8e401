"""Angles, planar transforms and the pinhole camera: pure numpy, for testbed and controllers.

Frames: x forward, y left, z up, yaw anticlockwise. A pose is ``(x, y, yaw)`` in m, m, rad.
"""

from dataclasses import dataclass

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


@dataclass(frozen=True)
class Pinhole:
    """An ideal camera: square pixels, the optical axis through the middle of the image.

    Pixel coordinates are (right, down) with the middle of the upper left pixel at (0.5, 0.5).

    Attributes:
        position: Optical centre (3,) [m], in the frame called world here.
        rotation: R_world_camera (3, 3); columns are the image's right, down and forward.
        focal: [px].
        width: Of the image [px].
        height: Of the image [px].
    """

    position: Array
    rotation: Array
    focal: float
    width: int
    height: int

    @property
    def centre(self) -> Array:
        """Where the optical axis meets the image (2,) [px]."""
        return np.array([self.width / 2, self.height / 2])

    @property
    def T_world_camera(self) -> Array:
        """Homogeneous transform (4, 4) from the camera's frame (right, down, forward)."""
        transform = np.eye(4)
        transform[:3, :3], transform[:3, 3] = self.rotation, self.position
        return transform

    def project(self, points: ArrayLike) -> Array:
        """Pixels (..., 2) of points (..., 3) [m]; NaN for what lies behind the camera."""
        local = (np.asarray(points, dtype=np.float64) - self.position) @ self.rotation
        depth = np.where(local[..., 2:] > 1e-6, local[..., 2:], np.nan)
        return local[..., :2] / depth * self.focal + self.centre

    def rays(self, pixels: ArrayLike) -> Array:
        """Directions (..., 3) from the optical centre through pixels (..., 2), 1 m deep."""
        across = (np.asarray(pixels, dtype=np.float64) - self.centre) / self.focal
        local = np.concatenate([across, np.ones((*across.shape[:-1], 1))], axis=-1)
        return local @ self.rotation.T

    def on_plane(self, pixels: ArrayLike, z: float) -> Array:
        """Where the rays through pixels (..., 2) meet the plane at height ``z``: (..., 2) [m].

        NaN where a ray is parallel to the plane or leaves it behind.
        """
        rays = self.rays(pixels)
        with np.errstate(divide="ignore", invalid="ignore"):
            along = (z - self.position[2]) / rays[..., 2:]
        along = np.where(np.isfinite(along) & (along > 0), along, np.nan)
        return self.position[:2] + rays[..., :2] * along

    def on_floor(self, points: Array, z: float = 0.003) -> Array:
        """Pixels (..., 2) of points (..., 2) at height ``z`` [m]."""
        height = np.full((*points.shape[:-1], 1), z)
        return self.project(np.concatenate([points, height], axis=-1))


def look_at(position: ArrayLike, target: ArrayLike) -> Array:
    """Rotation (3, 3) of a camera at ``position`` that looks at ``target``, both (3,) [m].

    Columns are the image's right, down and forward. Up in the image is up in the world, or +y when
    the camera looks straight down or up; the two must differ.
    """
    forward = np.asarray(target, dtype=np.float64) - np.asarray(position, dtype=np.float64)
    forward /= np.linalg.norm(forward)
    up = np.array([0.0, 1.0, 0.0] if np.hypot(*forward[:2]) < 1e-6 else [0.0, 0.0, 1.0])
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    return np.column_stack([right, np.cross(forward, right), forward])


def rotation_matrix(quaternion: ArrayLike) -> Array:
    """Rotation (3, 3) of a quaternion ``(w, x, y, z)`` of any length but 0."""
    q = np.asarray(quaternion, dtype=np.float64)
    w, x, y, z = q / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
