"""The radius of the circle a robot tracks, from where it has been: for d_des on line (ours)."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
POINTS = 60
STEP = 0.5  # m, between two points that are kept
ENOUGH = 24  # points: on a shorter arc noise makes circles too small


class TrackedCircles:
    """Circles through the last 30 m of each robot's track, by least squares (Kasa 1976)."""

    def __init__(self, n: int):
        """Start with no track."""
        self._points = np.full((n, POINTS, 2), np.nan)
        self._count = np.zeros(n, dtype=np.int64)
        self._radius = np.full(n, np.nan)

    @property
    def radius(self) -> Array:
        """Of each robot's circle (n,) [m]; NaN before 12 m of track."""
        return self._radius.copy()

    def add(self, pose: Array, tracks: NDArray[np.bool_]) -> None:
        """Go on with the tracks of those who track (n,) at poses (n, 3); others forget theirs."""
        self._count = np.where(tracks, self._count, 0)
        rows = np.arange(len(pose))
        last = self._points[rows, (self._count - 1) % POINTS]
        moved = np.hypot(*(pose[:, :2] - last).T)
        with np.errstate(invalid="ignore"):
            fresh = tracks & np.isfinite(pose[:, 0]) & ((self._count == 0) | ~(moved < STEP))
        for i in np.flatnonzero(fresh):
            if self._count[i] == 0:
                self._points[i] = np.nan
            self._points[i, self._count[i] % POINTS] = pose[i, :2]
            self._count[i] += 1
            if self._count[i] >= ENOUGH:
                self._radius[i] = circle(self._points[i, : min(self._count[i], POINTS)])
        self._radius = np.where(self._count >= ENOUGH, self._radius, np.nan)


def circle(points: Array) -> float:
    """Radius of the circle through points (k, 2), least squares; inf for a straight line."""
    middle = points.mean(axis=0)
    at = points - middle
    matrix = np.column_stack([at, np.ones(len(at))])
    found, _, rank, _ = np.linalg.lstsq(matrix, (at**2).sum(axis=1), rcond=1e-9)
    if rank < 3:
        return float("inf")
    return float(np.sqrt(found[2] + (found[0] ** 2 + found[1] ** 2) / 4.0))
