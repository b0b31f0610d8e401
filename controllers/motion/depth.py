"""How deep a predicted motion goes into boxes, sides and other robots; see safety.py."""

import math

from controllers.motion.approach import closest_approach
from controllers.motion.clearance import point_rectangle, segment_rectangle, to_box
from controllers.motion.moving import drifting_gap
from controllers.motion.prediction import PIECES, fill_prediction
from mjmr.jit import njit


@njit
def static_depth(rows, reach, required, tolerance, bounds, boxes, drift, foresight):
    """How much too near a prediction comes to boxes and sides, summed over them [m].

    Args:
        rows: Shape (4, 7), the prediction.
        reach: Greatest distance [m] from its start.
        required: Distance [m] that the centre keeps.
        tolerance: Shortfall [m] that counts as none.
        bounds: Shape (4,), sides of the field.
        boxes: Shape (k, 10), prepared.
        drift: Shape (k, 2), their velocities [m/s].
        foresight: How far boxes that move are looked at ahead, at least [s].

    The curved ramp lies in the triangle of its control points; the sides of that triangle stand
    for it, which is conservative by at most |c - v| T / 8. The rest is one straight segment.
    """
    ax = rows[0, 1]
    ay = rows[0, 2]
    half = 0.5 * rows[1, 0]
    qx = ax + half * rows[0, 3]
    qy = ay + half * rows[0, 4]
    bx = rows[1, 1]
    by = rows[1, 2]
    ex = rows[3, 1]
    ey = rows[3, 2]
    depth = 0.0
    for side in range(4):
        if side == 0:
            gap = min(min(ax, qx), min(bx, ex)) - bounds[0]
        elif side == 1:
            gap = min(min(ay, qy), min(by, ey)) - bounds[1]
        elif side == 2:
            gap = bounds[2] - max(max(ax, qx), max(bx, ex))
        else:
            gap = bounds[3] - max(max(ay, qy), max(by, ey))
        if required - gap > tolerance:
            depth += required - gap
    for k in range(boxes.shape[0]):
        hx = boxes[k, 4]
        hy = boxes[k, 5]
        ux, uy = to_box(ax, ay, boxes, k)
        vx = drift[k, 0]
        vy = drift[k, 1]
        if vx != 0.0 or vy != 0.0:
            way = math.sqrt(vx * vx + vy * vy) * max(foresight, rows[3, 0])
            if point_rectangle(ux, uy, hx, hy) - reach - way > required:
                continue
            gap = drifting_gap(rows, foresight, boxes, k, vx, vy)
            if required - gap > tolerance:
                depth += required - gap
            continue
        if point_rectangle(ux, uy, hx, hy) - reach > required:
            continue
        wx, wy = to_box(qx, qy, boxes, k)
        sx, sy = to_box(bx, by, boxes, k)
        tx, ty = to_box(ex, ey, boxes, k)
        gap = segment_rectangle(ux, uy, wx, wy, hx, hy)
        gap = min(gap, segment_rectangle(wx, wy, sx, sy, hx, hy))
        gap = min(gap, segment_rectangle(ux, uy, sx, sy, hx, hy))
        gap = min(gap, segment_rectangle(sx, sy, tx, ty, hx, hy))
        if required - gap > tolerance:
            depth += required - gap
    return depth


@njit
def _pair_depth(one, one_reach, two, two_reach, required, tolerance):
    """How much too near two predictions come [m]; far ones are told by their reach alone."""
    dx = one[0, 1] - two[0, 1]
    dy = one[0, 2] - two[0, 2]
    apart = required + one_reach + two_reach
    if dx * dx + dy * dy >= apart * apart:
        return 0.0
    depth = required - closest_approach(one, two, required)
    return depth if depth > tolerance else 0.0


@njit
def command_depth(i, cx, cy, first_only, tolerance, position, velocity, dynamics, search):
    """Total depth [m] of command (cx, cy) [m/s] for robot ``i``.

    With ``first_only`` the sum stops at the first violation: only zero or not is wanted. The
    other arguments are those of :func:`choose_commands`.
    """
    n = position.shape[0]
    rows = search.chosen[n]
    reach = fill_prediction(
        position[i, 0],
        position[i, 1],
        velocity[i, 0],
        velocity[i, 1],
        cx,
        cy,
        dynamics.B,
        dynamics.T,
        rows,
    )
    depth = static_depth(
        rows,
        reach,
        search.clearance,
        tolerance,
        search.bounds,
        search.boxes,
        search.drift,
        search.foresight,
    )
    apart = 2.0 * search.clearance
    for j in range(n):
        if first_only and depth > 0.0:
            break
        if j == i:
            continue
        depth += _pair_depth(rows, reach, search.chosen[j], search.reach[0, j], apart, tolerance)
        if search.fail_safe and j < i:
            other = search.braking[j]
            depth += _pair_depth(rows, reach, other, search.reach[1, j], apart, tolerance)
    return depth


@njit
def overlap_at(i, rows, piece, search):
    """Depth [m] in others, boxes and sides, summed, at the start of ``piece`` of predictions.

    Unlike the depth of a way, that of a point inside a box grows towards the box's middle.
    """
    x = rows[piece, 1]
    y = rows[piece, 2]
    side = min(
        min(x - search.bounds[0], search.bounds[2] - x),
        min(y - search.bounds[1], search.bounds[3] - y),
    )
    total = max(0.0, search.clearance - side)
    for k in range(search.boxes.shape[0]):
        t = rows[piece, 0]
        if piece == PIECES - 1:
            t = max(t, search.foresight)
        ux, uy = to_box(x - search.drift[k, 0] * t, y - search.drift[k, 1] * t, search.boxes, k)
        hx = search.boxes[k, 4]
        hy = search.boxes[k, 5]
        gap = point_rectangle(ux, uy, hx, hy)
        if gap == 0.0:
            gap = max(abs(ux) - hx, abs(uy) - hy)
        total += max(0.0, search.clearance - gap)
    for j in range(search.chosen.shape[0] - 1):
        if j != i:
            dx = rows[piece, 1] - search.chosen[j, piece, 1]
            dy = rows[piece, 2] - search.chosen[j, piece, 2]
            total += max(0.0, 2.0 * search.clearance - math.sqrt(dx * dx + dy * dy))
    return total
