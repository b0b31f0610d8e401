"""Where trucks take themselves to be by their rear wheels, and by a compass if they have one."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.estimation.odometry import Odometry

Array = NDArray[np.float64]


class Reckoning:
    """Poses from the starting pose, which is known, and all that the wheels have counted since.

    With a compass the headings are its own, and the counts say only how far it went.
    """

    def __init__(self, scene: Any):
        """Begin where they start, with all counts 0."""
        trucks = scene.trucks
        self._odometry = Odometry(
            scene.start,
            radius=trucks.platform.rolling_radius,
            track=trucks.platform.track,
            counts_per_turn=trucks.encoders.counts_per_turn,
        )
        self._counts = np.zeros((trucks.n, 2), dtype=np.int64)
        self._odometry.step(self._counts)

    @property
    def poses(self) -> Array:
        """Newest estimate (n, 3) [m, m, rad], world frame."""
        return self._odometry.poses

    def step(self, counts: Array, heading: Array | None = None) -> Array:
        """Take counts (n, 2) and headings (n,) [rad]; NaN: none came, nothing is changed.

        Returns:
            The estimate (n, 3), a new array.
        """
        came = np.isfinite(counts).all(axis=1)
        self._counts[came] = counts[came].astype(np.int64)
        poses = self._odometry.step(self._counts)
        if heading is not None:
            poses[:, 2] = np.where(np.isfinite(heading), heading, poses[:, 2])
            self._odometry.poses[:, 2] = poses[:, 2]
        return poses
