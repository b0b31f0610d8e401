"""What schemas perceive: things and directions around every robot of a team, as arrays.

All offsets have their origin in the robot that perceives and axes of fixed direction, such as
those of its odometry or compass; no common frame of the team is needed.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Things:
    """Up to k round things that each of n robots perceives.

    Attributes:
        offset: From the robot to the thing's centre (n, k, 2) [m]; anything where not valid.
        radius: Of the things (n, k) [m]; 0 for points, such as the nearest point of a wall.
        valid: Whether there is such a thing (n, k).
    """

    offset: Array
    radius: Array
    valid: Flags

    @classmethod
    def of(cls, offset: ArrayLike, radius: ArrayLike = 0.0) -> "Things":
        """Things at finite offsets.

        Args:
            offset: Shape (n, k, 2), or (n, 2) for one thing a robot; NaN where there is none [m].
            radius: Broadcast to (n, k) [m].

        Raises:
            InvalidInputError: Another shape, or a negative radius.
        """
        given = np.asarray(offset, dtype=np.float64)
        given = given[:, None] if given.ndim == 2 else given
        if given.ndim != 3 or given.shape[2] != 2:
            raise InvalidInputError(f"offsets have shape (n, k, 2) or (n, 2); got {given.shape}")
        radii = np.broadcast_to(np.asarray(radius, dtype=np.float64), given.shape[:2])
        if (radii < 0).any():
            raise InvalidInputError("radii of things are 0 or more")
        valid = np.asarray(np.isfinite(given).all(axis=2))
        return cls(np.ascontiguousarray(given), np.ascontiguousarray(radii), valid)

    @classmethod
    def from_scan(
        cls, ranges: Array, angles: Array, heading: ArrayLike, *, sectors: int = 12
    ) -> "Things":
        """The nearest return in each sector of a scan, as points.

        Args:
            ranges: Shape (n, b) [m]; what is not finite is no return.
            angles: Of the beams in the robot's frame (b,) [rad], increasing.
            heading: Of the robots (n,) [rad]; its axes are those of the offsets.
            sectors: Parts of equal angle, at most b: k.

        Raises:
            InvalidInputError: Shapes that do not fit, or sectors outside 1 to b.
        """
        scan = np.asarray(ranges, dtype=np.float64)
        if scan.ndim != 2 or scan.shape[1] != len(angles) or not 1 <= sectors <= len(angles):
            raise InvalidInputError(
                f"ranges have shape (n, {len(angles)}) for {len(angles)} angles, in 1 to as many "
                f"sectors; got {scan.shape} and {sectors}"
            )
        away = np.where(np.isfinite(scan), scan, np.inf)
        starts = np.arange(sectors) * len(angles) // sectors
        near = np.stack([s.argmin(axis=1) for s in np.split(away, starts[1:], axis=1)], axis=1)
        near += starts
        gap = np.take_along_axis(away, near, axis=1)
        gap = np.where(np.isfinite(gap), gap, np.nan)
        bearing = np.asarray(angles)[near] + np.asarray(heading, dtype=np.float64)[:, None]
        return cls.of(gap[..., None] * np.stack([np.cos(bearing), np.sin(bearing)], axis=2))

    @property
    def n(self) -> int:
        """Robots that perceive."""
        return len(self.offset)

    @property
    def gap(self) -> Array:
        """From the robots' centres to the things' surfaces (n, k) [m]; inf where there is none."""
        distance = np.hypot(self.offset[..., 0], self.offset[..., 1]) - self.radius
        return np.where(self.valid, distance, np.inf)

    def nearest(self) -> "Things":
        """The one thing whose surface is nearest, for each robot: k = 1."""
        if self.offset.shape[1] == 0:
            n = self.n
            return Things(np.full((n, 1, 2), np.nan), np.zeros((n, 1)), np.zeros((n, 1), bool))
        first = self.gap.argmin(axis=1)[:, None]
        return Things(
            np.take_along_axis(self.offset, first[..., None], axis=1),
            np.take_along_axis(self.radius, first, axis=1),
            np.take_along_axis(self.valid, first, axis=1),
        )


Percept = Things | Array
Percepts = Mapping[str, Percept]
"""By name: things, or one vector (n, 2) a robot [m], NaN where there is none."""
