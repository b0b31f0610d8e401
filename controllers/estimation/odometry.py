"""Dead reckoning of two-wheel robots from the counts of their wheel encoders."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.jit import njit


class Odometry:
    """Poses of n robots, integrated from wheel counts.

    Between two readings both wheels are taken to turn steadily, so that a robot goes along an arc,
    which is integrated exactly. What is wrong with ``radius``, ``track`` or the wheels' grip adds
    up without bound (Borenstein and Feng 1996, section 2: systematic and other errors).

    Attributes:
        poses: Newest estimate (n, 3) [m, m, rad], world frame, yaw in (-pi, pi].
    """

    def __init__(
        self, start: ArrayLike, *, radius: ArrayLike, track: ArrayLike, counts_per_turn: float
    ):
        """Set the start and the base's kinematics.

        Args:
            start: Poses at the first reading (n, 3) [m, m, rad], world frame.
            radius: At which the wheels roll [m]; one number, one a wheel (2,), or (n, 2).
            track: Between the wheels [m]; one number or (n,).
            counts_per_turn: Of a wheel.

        Raises:
            InvalidInputError: Another shape, or a number that is not finite or not positive.
        """
        poses = np.array(start, dtype=np.float64)
        if poses.ndim != 2 or poses.shape[1] != 3 or not np.isfinite(poses).all():
            raise InvalidInputError(
                f"start must be finite poses of shape (n, 3); got shape {poses.shape}"
            )
        n = len(poses)
        self.poses = poses
        per_count = 2.0 * math.pi / _positive(counts_per_turn, (), "counts_per_turn")
        self._per_count = _positive(radius, (n, 2), "radius") * per_count
        self._track = _positive(track, (n,), "track")
        self._counts: NDArray[np.int64] | None = None

    def step(self, counts: ArrayLike) -> NDArray[np.float64]:
        """Take a reading; the first one is the reference.

        Args:
            counts: Left and right wheels' (n, 2), whole numbers.

        Returns:
            The estimate, (n, 3), a new array.

        Raises:
            InvalidInputError: Another shape, or not whole numbers.
        """
        fresh = np.array(counts)
        if fresh.shape != (len(self.poses), 2) or fresh.dtype.kind not in "iu":
            raise InvalidInputError(
                f"counts must be whole numbers of shape ({len(self.poses)}, 2); "
                f"got {fresh.dtype} of shape {fresh.shape}"
            )
        fresh = fresh.astype(np.int64)
        if self._counts is not None:
            way = (fresh - self._counts) * self._per_count
            self.poses = integrate_arcs(self.poses, way, self._track)
        self._counts = fresh
        return self.poses.copy()


@njit
def integrate_arcs(poses, way, track):
    """Poses after the wheels rolled ``way`` along arcs.

    Args:
        poses: (n, 3) [m, m, rad].
        way: Of the left and the right wheel (n, 2) [m].
        track: Between the wheels (n,) [m].

    Returns:
        Poses (n, 3), yaw in (-pi, pi].
    """
    moved = np.empty_like(poses)
    for i in range(poses.shape[0]):
        turn = (way[i, 1] - way[i, 0]) / track[i]
        half = 0.5 * turn
        # the chord of the arc; its direction is the mean heading
        chord = 0.5 * (way[i, 0] + way[i, 1])
        if half != 0.0:
            chord *= math.sin(half) / half
        heading = poses[i, 2] + half
        moved[i, 0] = poses[i, 0] + chord * math.cos(heading)
        moved[i, 1] = poses[i, 1] + chord * math.sin(heading)
        moved[i, 2] = math.pi - (math.pi - poses[i, 2] - turn) % (2.0 * math.pi)
    return moved


def _positive(value: ArrayLike, shape: tuple[int, ...], name: str) -> NDArray[np.float64]:
    array = np.array(value, dtype=np.float64)
    try:
        array = np.broadcast_to(array, shape).copy()
    except ValueError:
        raise InvalidInputError(
            f"{name} must be one number or have shape {shape}; got {array.shape}"
        ) from None
    if not (np.isfinite(array).all() and (array > 0).all()):
        raise InvalidInputError(f"{name} must be positive and finite; got {value}")
    return array
