"""Head of a robot with a neck: where its camera is, looking at points in closed form, scanning."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]
_SLACK = 1e-9  # rad and m^2; what rounding may put a point outside
# from x forward, y left, z up to the image's right, down and forward, as columns
_IMAGE = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])


@dataclass(frozen=True, kw_only=True)
class HeadGeometry:
    """A neck that tilts (tilt1), a head that turns on it (pan) and nods (tilt2), and its camera.

    Tilts raise what is before their axes, pan turns left; at zero the neck is upright and the
    camera looks straight ahead.

    Attributes:
        neck: A point of tilt1's axis (3,) [m], body frame.
        length: From there up to where the axes of pan and tilt2 meet [m].
        camera: Before that point and above it (2,) [m].
        limits: Lowest and highest tilt1, pan and tilt2 (3, 2) [rad].
    """

    neck: Array
    length: float
    camera: tuple[float, float]
    limits: Array

    def camera_pose(self, angles: ArrayLike) -> tuple[Array, Array]:
        """Position (..., 3) [m] and rotation (..., 3, 3) of the camera, body frame.

        Columns of the rotation are the image's right, down and forward, as those of
        :class:`mjmr.geometry.Pinhole`.

        Args:
            angles: tilt1, pan and tilt2 (..., 3) [rad].
        """
        tilt1, pan, tilt2 = np.moveaxis(_threes(angles, "head angles"), -1, 0)
        tilted = _raising(tilt1)
        head = tilted @ _turning(pan) @ _raising(tilt2)
        ahead, above = self.camera
        spot = self.length * tilted[..., 2] + ahead * head[..., 0] + above * head[..., 2]
        return self.neck + spot, head @ _IMAGE

    def look_at(
        self, points: ArrayLike, tilt1: ArrayLike = -0.35
    ) -> tuple[Array, NDArray[np.bool_]]:
        """Angles that put points in the middle of the camera's image.

        The neck tilts as preferred as long as the nod gets there; else the nod goes to its limit
        and the neck tilts as far as it must.

        Args:
            points: Shape (..., 3) [m], body frame.
            tilt1: Preferred tilt of the neck, broadcast against (...) [rad]; within its limits.

        Returns:
            tilt1, pan and tilt2 (..., 3) [rad] within the limits, and a mask (...) of the points
            that are looked at; the other angles are not far off, if the camera can see there.

        Raises:
            InvalidInputError: Another shape, or a number that is not finite.
        """
        local = _threes(points, "points") - self.neck
        tilt1 = np.clip(np.broadcast_to(tilt1, local.shape[:-1]), *self.limits[0])
        first, seen = self._turn_to(local, tilt1)
        low, high = self.limits[2]
        nod = first[..., 2].clip(low, high)
        tilt, possible = self._tilt_for(local, nod)
        second, after = self._turn_to(local, tilt.clip(*self.limits[0]))
        better = ((first[..., 2] < low - _SLACK) | (first[..., 2] > high + _SLACK)) & possible
        angles = np.where(better[..., None], second, first)
        low, high = self.limits[:, 0], self.limits[:, 1]
        within = ((angles >= low - _SLACK) & (angles <= high + _SLACK)).all(axis=-1)
        return angles.clip(low, high), within & np.where(better, after, seen)

    def _turn_to(self, local: Array, tilt1: Array) -> tuple[Array, NDArray[np.bool_]]:
        """Pan and nod for points (..., 3) from the neck's axis, and whether there are any."""
        x, y, z = np.moveaxis(local, -1, 0)
        c, s = np.cos(tilt1), np.sin(tilt1)
        x, z = c * x + s * z, c * z - s * x - self.length
        level = np.hypot(x, y)
        ahead, above = self.camera
        # the ray is straight ahead of the camera, which turns about a point beside the ray
        along = np.sqrt(np.maximum(level**2 + z**2 - above**2, 0.0))
        nod = np.arctan2(z, level) - np.arctan2(above, along)
        return np.stack([tilt1, np.arctan2(y, x), nod], axis=-1), along > ahead

    def _tilt_for(self, local: Array, nod: Array) -> tuple[Array, NDArray[np.bool_]]:
        """Tilt of the neck (...) with which a nod (...) looks at points, and whether there is."""
        above, up = self.camera[1], self.length
        # |point|^2 from the law of cosines: a quadratic for the way along the ray
        half = up * np.sin(nod)
        rest = above**2 + 2 * up * above * np.cos(nod) + up**2 - (local**2).sum(axis=-1)
        root = half**2 - rest
        along = np.sqrt(np.maximum(root, 0.0)) - half
        height = up + along * np.sin(nod) + above * np.cos(nod)
        radius = np.hypot(local[..., 0], local[..., 2])
        cosine = height / np.maximum(radius, 1e-300)
        tilt = np.arccos(cosine.clip(-1.0, 1.0)) - np.arctan2(local[..., 0], local[..., 2])
        return tilt, (root >= -_SLACK) & (np.abs(cosine) <= 1.0 + _SLACK)


@dataclass(frozen=True, kw_only=True)
class HeadScan:
    """The head goes left and right, and looks far one way and near the other.

    Attributes:
        pan: To either side [rad].
        period: There and back [s].
        far: tilt1 and tilt2 [rad] while it goes left.
        near: The same while it goes right.
    """

    pan: float = 1.3
    period: float = 2.4
    far: tuple[float, float] = (-0.35, 0.25)
    near: tuple[float, float] = (-0.75, 0.0)

    def __post_init__(self):
        if not (self.pan >= 0 and self.period > 0):
            raise InvalidInputError(
                f"a scan needs a pan of 0 or more and a positive period; got {self.pan} rad, "
                f"{self.period} s"
            )

    def angles(self, time: ArrayLike) -> Array:
        """tilt1, pan and tilt2 (..., 3) [rad] at times (...) [s] since the scan began.

        It begins in the middle, on the way to the left; tilts change while pan is at its ends.
        """
        turn = 2.0 * np.pi * np.asarray(time, dtype=np.float64) / self.period
        # 1 on the way left, 0 on the way right, and a quick smooth change at the ends
        far = (0.5 + np.cos(turn)).clip(0.0, 1.0)[..., None]
        tilts = far * np.array(self.far) + (1.0 - far) * np.array(self.near)
        return np.stack([tilts[..., 0], self.pan * np.sin(turn), tilts[..., 1]], axis=-1)


def _raising(angle: Array) -> Array:
    """Rotations (..., 3, 3) that raise what is ahead by angles (...)."""
    c, s, nil, one = np.cos(angle), np.sin(angle), np.zeros_like(angle), np.ones_like(angle)
    rows = [[c, nil, -s], [nil, one, nil], [s, nil, c]]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _turning(angle: Array) -> Array:
    """Rotations (..., 3, 3) to the left by angles (...)."""
    c, s, nil, one = np.cos(angle), np.sin(angle), np.zeros_like(angle), np.ones_like(angle)
    rows = [[c, -s, nil], [s, c, nil], [nil, nil, one]]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _threes(values: ArrayLike, what: str) -> Array:
    array = np.asarray(values, dtype=np.float64)
    if array.shape[-1:] != (3,):
        raise InvalidInputError(f"{what} must have shape (..., 3); got {array.shape}")
    if not np.isfinite(array).all():
        raise InvalidInputError(f"{what} must be finite")
    return array


# Sony AIBO ERS-7: dimensions from Tekkotsu's ERS-7.kin, limits from its ERS7Info.h
ERS7_HEAD = HeadGeometry(
    neck=np.array([0.0675, 0.0, 0.0195]),
    length=0.080,
    camera=(0.08106, -0.0146),
    limits=np.radians([[-75.0, 0.0], [-88.0, 88.0], [-15.0, 45.0]]),
)
