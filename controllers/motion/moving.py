"""Clearance of a predicted motion from a box that moves: tested in the box's own frame.

Not in the paper, whose obstacles stand still. A box that moves comes to a robot at rest, so the
test looks a stated time ahead, beyond the robot's own stop.
"""

from controllers.motion.clearance import segment_rectangle
from mjmr.jit import njit


@njit
def drifting_gap(rows, horizon, boxes, k, vx, vy):
    """Distance [m] that a prediction keeps from box ``k``, which keeps its velocity.

    Args:
        rows: Shape (4, 7), from :func:`controllers.motion.prediction.fill_prediction`.
        horizon: How far to look at least [s].
        boxes: Shape (m, 10), prepared, where they are now.
        k: Which.
        vx: Its velocity [m/s], world frame; likewise ``vy``.
        vy: See ``vx``.

    Each piece of constant acceleration is a parabola in the box's frame and lies in the triangle
    of its control points, whose sides stand for it: conservative.
    """
    c = boxes[k, 2]
    s = boxes[k, 3]
    hx = boxes[k, 4]
    hy = boxes[k, 5]
    gap = 1e300
    ax, ay = _relative(rows, 0, 0.0, boxes, k, vx, vy)
    for piece in range(4):
        start = rows[piece, 0]
        end = rows[piece + 1, 0] if piece < 3 else max(horizon, start)
        lasts = end - start
        ux = rows[piece, 3] - vx
        uy = rows[piece, 4] - vy
        qx = ax + 0.5 * lasts * (c * ux + s * uy)
        qy = ay + 0.5 * lasts * (c * uy - s * ux)
        bx, by = _relative(rows, piece, lasts, boxes, k, vx, vy)
        if lasts > 0.0 or piece == 0:
            gap = min(gap, segment_rectangle(ax, ay, qx, qy, hx, hy))
            gap = min(gap, segment_rectangle(qx, qy, bx, by, hx, hy))
            gap = min(gap, segment_rectangle(ax, ay, bx, by, hx, hy))
        ax = bx
        ay = by
    return gap


@njit
def _relative(rows, piece, lasts, boxes, k, vx, vy):
    """Place in the frame of the moving box, ``lasts`` [s] after the piece's start."""
    t = rows[piece, 0] + lasts
    x = rows[piece, 1] + (rows[piece, 3] + 0.5 * rows[piece, 5] * lasts) * lasts
    y = rows[piece, 2] + (rows[piece, 4] + 0.5 * rows[piece, 6] * lasts) * lasts
    dx = x - boxes[k, 0] - vx * t
    dy = y - boxes[k, 1] - vy * t
    return (
        boxes[k, 2] * dx + boxes[k, 3] * dy,
        boxes[k, 2] * dy - boxes[k, 3] * dx,
    )
