"""Somebody ahead, from the ranges of sonars: echoes that nothing known explains.

A sonar tells a range alone, neither what it met nor who. A robot knows the boundary as coordinates
and its own pose, and its camera knows the perimeter by its colour; what comes back from nearer than
both is taken for somebody, on the axis of the cone, so within half a beam's width.
"""

import numpy as np
from numpy.typing import NDArray

from mjmr.geometry import rotate, wrap_angle

Array = NDArray[np.float64]
_NORMALS = np.array([0.0, 0.5, 1.0, -0.5]) * np.pi  # of the walls in the east, north, west, south


def wall_ranges(
    pose: Array, mounts: Array, width: float, bounds: tuple[float, float, float, float]
) -> Array:
    """Ranges (n, k) [m] nearer than which no cone can meet the boundary; inf: it cannot at all.

    Whether a wall met at a slant returns anything is left open.

    Args:
        pose: Of the robots as they know it (n, 3) [m, m, rad]; NaN rows give inf.
        mounts: Of the cones, frame of the robot (k, 3) [m, m, rad].
        width: Full angle of a cone [rad].
        bounds: The boundary (xmin, ymin, xmax, ymax) [m], world frame.
    """
    x0, y0, x1, y1 = bounds
    at = pose[:, None, :2] + rotate(mounts[None, :, :2], pose[:, None, 2])
    x, y = at[..., 0], at[..., 1]
    walls = np.stack([x1 - x, y1 - y, x - x0, y - y0], axis=-1)
    axis = pose[:, None, 2] + mounts[None, :, 2]
    off = np.abs(wrap_angle(axis[..., None] - _NORMALS)) - width / 2.0
    across = np.cos(np.clip(np.nan_to_num(off, nan=np.pi), 0.0, np.pi))
    with np.errstate(divide="ignore", invalid="ignore"):
        ranges = np.where(across > 1e-9, np.maximum(walls, 0.0) / across, np.inf)
    return np.nan_to_num(ranges.min(axis=-1), nan=np.inf, posinf=np.inf)


def kind_in_cones(
    looks: Array, angles: Array, kind: int, at: Array, mounts: Array, width: float, reach: float
) -> Array:
    """Nearest return of one kind of a fan of rays in every cone (n, k) [m], from the cone's tip.

    Args:
        looks: Range [m] and kind of every ray (n, c, 2).
        angles: Of the rays (c,) [rad].
        kind: Which.
        at: Where on the robot the fan begins and its yaw (3,) [m, m, rad].
        mounts: Of the cones, frame of the robot (k, 3) [m, m, rad].
        width: Full angle of a cone [rad].
        reach: Of the fan; further away nothing counts [m].

    Returns:
        inf where there is none.
    """
    good = (looks[..., 1] == kind) & (looks[..., 0] <= reach)
    length = np.where(good, looks[..., 0], np.nan)
    way = angles + at[2]
    points = at[:2] + length[..., None] * np.column_stack([np.cos(way), np.sin(way)])
    off = points[:, None] - mounts[None, :, None, :2]
    bearing = wrap_angle(np.arctan2(off[..., 1], off[..., 0]) - mounts[None, :, None, 2])
    with np.errstate(invalid="ignore"):
        within = np.abs(bearing) <= width / 2.0
    return np.where(within, np.hypot(off[..., 0], off[..., 1]), np.inf).min(axis=2)


def nearest_unexplained(
    ranges: Array, known: Array, mounts: Array, *, margin: float, at: Array, reach: float
) -> Array:
    """Nearest echo that nothing known explains (n, 2) [m], frame of the robot, NaN rows: none.

    Args:
        ranges: Of the sonars (n, k) [m]: inf or NaN where nothing came back, -inf where something
            is too near to be measured, which counts as 0 m.
        known: Nearest of what is known to be in each cone (n, k) [m], inf: nothing is.
        mounts: Of the cones, frame of the robot (k, 3) [m, m, rad].
        margin: By which an echo must be nearer than that [m].
        at: Where on the robot what is known was seen from (2,) [m].
        reach: As far as that from there it is known what there is; echoes from beyond do not
            count [m].
    """
    length = np.where(np.isneginf(ranges), 0.0, ranges)
    with np.errstate(invalid="ignore"):
        odd = np.isfinite(length) & (length < known - margin)
    length = np.where(odd, length, np.nan)
    axes = np.column_stack([np.cos(mounts[:, 2]), np.sin(mounts[:, 2])])
    points = mounts[:, :2] + length[..., None] * axes
    with np.errstate(invalid="ignore"):
        odd &= np.hypot(*(points - at).transpose(2, 0, 1)) <= reach
    apart = np.where(odd, np.hypot(points[..., 0], points[..., 1]), np.inf)
    nearest = np.argmin(apart, axis=1)
    rows = np.arange(len(ranges))
    return np.where(odd[rows, nearest, None], points[rows, nearest], np.nan)
