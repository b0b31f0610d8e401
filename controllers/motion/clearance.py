"""Exact distances between segments and obstacles, and the swept-disc test built on them.

Obstacles are boxes, prepared as rows (x, y, cos yaw, sin yaw, half-length, half-width), discs
(x, y, radius) and the four sides of the field (xmin, ymin, xmax, ymax) that a body stays within.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.finite import finite
from mjmr.jit import njit

# Lengths that agree within this [m] are equal: rounding must not turn touching into hitting.
TOLERANCE = 1e-12


class Scene(NamedTuple):
    """What a moving disc must keep clear of, in the form compiled functions take.

    Attributes:
        bounds: Shape (4,): xmin, ymin, xmax, ymax [m] that the body stays within.
        radius: Radius of the moving disc [m].
        boxes: Shape (k, 10), from :func:`prepare_boxes`.
        box_clearance: Distance kept between the disc's centre and any box [m].
        discs: Shape (m, 3): x, y, radius [m].
        disc_clearance: Distance kept between the disc's centre and any other disc's rim [m].
    """

    bounds: NDArray[np.float64]
    radius: float
    boxes: NDArray[np.float64]
    box_clearance: float
    discs: NDArray[np.float64]
    disc_clearance: float


def prepare_boxes(boxes: ArrayLike | None) -> NDArray[np.float64]:
    """Check boxes and bring them into the form the compiled functions take.

    Args:
        boxes: Shape (k, 5): centre x, y [m], yaw [rad], half-length, half-width [m], world
            frame; None or empty for none.

    Returns:
        Shape (k, 10): x, y, cos yaw, sin yaw, half-length, half-width, and the sides xmin, ymin,
        xmax, ymax of the upright rectangle around the box.

    Raises:
        InvalidInputError: Wrong shape, a number that is not finite, or a half-size not above 0.
    """
    b = np.asarray([] if boxes is None else boxes, dtype=np.float64)
    if b.size == 0:
        return np.zeros((0, 10))
    if b.ndim != 2 or b.shape[1] != 5:
        raise InvalidInputError(
            f"boxes has shape {b.shape}; it must be (k, 5): x, y, yaw, half-length, half-width"
        )
    for i, row in enumerate(b):
        if not np.isfinite(row).all() or row[3] <= 0.0 or row[4] <= 0.0:
            raise InvalidInputError(
                f"box {i} is {row.tolist()}; numbers must be finite and half-sizes above 0"
            )
    c, s = np.cos(b[:, 2]), np.sin(b[:, 2])
    turn = np.abs(np.array([[c, s], [s, c]]))
    around = np.einsum("ijk,kj->ki", turn, b[:, 3:])
    return np.column_stack([b[:, :2], c, s, b[:, 3:], b[:, :2] - around, b[:, :2] + around])


def check_bounds(bounds: ArrayLike, radius: float) -> NDArray[np.float64]:
    """Check the field's sides, shape (4,): xmin, ymin, xmax, ymax [m]; a disc must fit.

    Raises:
        InvalidInputError: Wrong shape, not finite, or no room for a disc of ``radius`` [m].
    """
    b = finite(bounds, (4,))
    if b is None:
        raise InvalidInputError(f"bounds must be 4 finite numbers, not {bounds!r}")
    if b[2] - b[0] <= 2.0 * radius or b[3] - b[1] <= 2.0 * radius:
        raise InvalidInputError(f"bounds {b.tolist()} leave no room for radius {radius} m")
    return b


@njit
def point_segment(px, py, ax, ay, bx, by):
    """Distance [m] from point p to the segment a-b."""
    dx = bx - ax
    dy = by - ay
    length2 = dx * dx + dy * dy
    s = 0.0
    if length2 > 0.0:
        s = min(1.0, max(0.0, ((px - ax) * dx + (py - ay) * dy) / length2))
    ex = ax + s * dx - px
    ey = ay + s * dy - py
    return math.sqrt(ex * ex + ey * ey)


@njit
def point_rectangle(px, py, hx, hy):
    """Distance [m] from p to the rectangle of half-sizes hx, hy about the origin; 0 inside."""
    ex = max(0.0, abs(px) - hx)
    ey = max(0.0, abs(py) - hy)
    return math.sqrt(ex * ex + ey * ey)


@njit
def _crosses(ax, ay, bx, by, hx, hy):
    """True if the segment a-b meets the rectangle about the origin (slab test)."""
    enter = 0.0
    leave = 1.0
    for axis in range(2):
        start = ax if axis == 0 else ay
        step = (bx - ax) if axis == 0 else (by - ay)
        half = hx if axis == 0 else hy
        if step == 0.0:
            if abs(start) > half:
                return False
            continue
        t0 = (-half - start) / step
        t1 = (half - start) / step
        if t0 > t1:
            t0, t1 = t1, t0
        enter = max(enter, t0)
        leave = min(leave, t1)
        if enter > leave:
            return False
    return True


@njit
def segment_rectangle(ax, ay, bx, by, hx, hy):
    """Distance [m] from segment a-b to the rectangle of half-sizes hx, hy about the origin.

    Exact: two convex shapes that do not meet are nearest at a corner of one of them.
    """
    if _crosses(ax, ay, bx, by, hx, hy):
        return 0.0
    d = min(point_rectangle(ax, ay, hx, hy), point_rectangle(bx, by, hx, hy))
    d = min(d, point_segment(hx, hy, ax, ay, bx, by))
    d = min(d, point_segment(-hx, hy, ax, ay, bx, by))
    d = min(d, point_segment(hx, -hy, ax, ay, bx, by))
    return min(d, point_segment(-hx, -hy, ax, ay, bx, by))


@njit
def to_box(px, py, boxes, k):
    """Point p of the world frame in the frame of prepared box ``k``."""
    dx = px - boxes[k, 0]
    dy = py - boxes[k, 1]
    c = boxes[k, 2]
    s = boxes[k, 3]
    return c * dx + s * dy, c * dy - s * dx


@njit
def segment_free(ax, ay, bx, by, skip, bounds, radius, boxes, box_clearance, discs, disc_clearance):
    """True if the disc of a :class:`Scene` may move with its centre straight from a to b.

    Args:
        ax: Start [m], world frame; likewise ``ay``.
        ay: See ``ax``.
        bx: End [m], world frame; likewise ``by``.
        by: See ``bx``.
        skip: Row of ``discs`` that is the mover itself; -1 for none.
        bounds: This and the rest as in :class:`Scene`, unpacked: taking arrays out of a tuple
            counts references, which takes longer than the test.
        radius: See there.
        boxes: See there.
        box_clearance: See there.
        discs: See there.
        disc_clearance: See there.

    The start is not tested: where it is already too near, the segment must come no nearer to
    that obstacle than the start is, so that there is always a way out and never one further in.
    """
    inset = radius - TOLERANCE
    if (
        bx < min(ax, bounds[0] + inset)
        or by < min(ay, bounds[1] + inset)
        or bx > max(ax, bounds[2] - inset)
        or by > max(ay, bounds[3] - inset)
    ):
        return False
    for m in range(discs.shape[0]):
        if m == skip:
            continue
        cx = discs[m, 0]
        cy = discs[m, 1]
        need = disc_clearance + discs[m, 2]
        if (
            min(ax, bx) - cx > need
            or cx - max(ax, bx) > need
            or min(ay, by) - cy > need
            or cy - max(ay, by) > need
        ):
            continue
        start = math.sqrt((ax - cx) ** 2 + (ay - cy) ** 2)
        if point_segment(cx, cy, ax, ay, bx, by) < min(need, start) - TOLERANCE:
            return False
    left = min(ax, bx) - box_clearance
    low = min(ay, by) - box_clearance
    right = max(ax, bx) + box_clearance
    high = max(ay, by) + box_clearance
    for k in range(boxes.shape[0]):
        if left > boxes[k, 8] or right < boxes[k, 6] or low > boxes[k, 9] or high < boxes[k, 7]:
            continue
        if not _clear_of_box(ax, ay, bx, by, boxes, k, box_clearance):
            return False
    return True


@njit
def _clear_of_box(ax, ay, bx, by, boxes, k, clearance):
    hx = boxes[k, 4]
    hy = boxes[k, 5]
    ux, uy = to_box(ax, ay, boxes, k)
    wx, wy = to_box(bx, by, boxes, k)
    if (
        min(ux, wx) > hx + clearance
        or max(ux, wx) < -hx - clearance
        or min(uy, wy) > hy + clearance
        or max(uy, wy) < -hy - clearance
    ):
        return True
    need = min(clearance, point_rectangle(ux, uy, hx, hy)) - TOLERANCE
    if point_rectangle(wx, wy, hx, hy) < need:
        return False
    # All corners on one side of the segment's line and far from it: the usual case nearby.
    dx = wx - ux
    dy = wy - uy
    reach = hx * abs(dy) + hy * abs(dx) + clearance * math.sqrt(dx * dx + dy * dy)
    if abs(ux * dy - uy * dx) > reach:
        return True
    return segment_rectangle(ux, uy, wx, wy, hx, hy) >= need
