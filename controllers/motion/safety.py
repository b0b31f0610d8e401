"""Velocity-space safety search: the command nearest to the desired one that cannot end in a hit.

Source: Bruce and Veloso 2005, section 4. In a fixed order each robot takes a command whose
predicted motion (this command for one cycle, then straight braking) stays clear of the obstacles
and of the predicted motions of all others, who have chosen before or are assumed to brake.
If all motions predicted in the last cycle were clear, braking is clear now: exact sensing and
exact execution give no contact.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from controllers.motion.approach import closest_approach
from controllers.motion.clearance import TOLERANCE, point_rectangle, segment_rectangle, to_box
from controllers.motion.moving import drifting_gap
from controllers.motion.prediction import PIECES, fill_prediction
from controllers.motion.streams import next_uniform
from mjmr.jit import njit

# Braking was found clear in the last cycle within TOLERANCE; recomputed, it differs by rounding.
BRAKING_TOLERANCE = 10.0 * TOLERANCE
# Depths within this [m] are equal; the command nearest to the desired one is then taken. Depth is
# a maximum that includes the present, so in contact all commands that lead out of it tie.
EQUAL_DEPTH = 1e-7


class Search(NamedTuple):
    """Parameters, memory and scratch of the search, in the form compiled functions take.

    Attributes:
        bounds: Shape (4,): xmin, ymin, xmax, ymax [m] that the bodies stay within.
        boxes: Shape (k, 10), prepared.
        drift: Shape (k, 2), their velocities [m/s], world frame.
        clearance: Radius of every robot and margin [m].
        fail_safe: Also stay clear of robots that chose before *and brake instead*: one that stops
            obeying in this very cycle is then not hit. Ours, not the paper's.
        stranger: Shape (n,) bool, robots that do not take part: expected to keep their velocity
            for ``foresight`` and to brake then. Ours, not the paper's.
        foresight: See ``stranger``; boxes that move are expected to go on for as long [s].
        previous: Shape (n, 2) [m/s^2], world frame, accelerations chosen in the last cycle.
        streams: uint64, random streams; robot i uses ``first_stream + i``.
        first_stream: See ``streams``.
        chosen: Scratch, shape (n + 1, 4, 7), predictions of the commands chosen so far; the last
            is that of the candidate.
        braking: Scratch, shape (n, 4, 7), predictions of braking.
        reach: Scratch, shape (2, n), greatest distances [m] of both from their starts.
        candidates: Scratch, shape (samples + 3, 3), rows of command [m/s] and depth [m].
    """

    bounds: NDArray[np.float64]
    boxes: NDArray[np.float64]
    drift: NDArray[np.float64]
    clearance: float
    fail_safe: bool
    stranger: NDArray[np.bool_]
    foresight: float
    previous: NDArray[np.float64]
    streams: NDArray[np.uint64]
    first_stream: int
    chosen: NDArray[np.float64]
    braking: NDArray[np.float64]
    reach: NDArray[np.float64]
    candidates: NDArray[np.float64]


def make_search(
    bounds: NDArray[np.float64],
    boxes: NDArray[np.float64],
    clearance: float,
    fail_safe: bool,
    samples: int,
    stranger: NDArray[np.bool_],
    foresight: float,
    streams: NDArray[np.uint64],
    first_stream: int,
) -> Search:
    """Fresh memory for the robots and ``samples`` random accelerations a choice."""
    n = len(stranger)
    return Search(
        bounds,
        boxes,
        np.zeros((len(boxes), 2)),
        float(clearance),
        bool(fail_safe),
        stranger,
        float(foresight),
        np.zeros((n, 2)),
        streams,
        first_stream,
        np.zeros((n + 1, PIECES, 7)),
        np.zeros((n, PIECES, 7)),
        np.zeros((2, n)),
        np.zeros((samples + 3, 3)),
    )


@njit
def braking_command(vx, vy, B, T):
    """Velocity [m/s] after one cycle of braking at B from (vx, vy)."""
    speed = math.sqrt(vx * vx + vy * vy)
    if speed <= B * T:
        return 0.0, 0.0
    scale = 1.0 - B * T / speed
    return vx * scale, vy * scale


@njit
def reachable_box(speed, A, B, T):
    """Reachable change of velocity in one cycle in the velocity-aligned frame.

    Args:
        speed: Present speed [m/s].
        A: Bound while speeding up [m/s^2].
        B: Bound while slowing down [m/s^2].
        T: Command period [s].

    Returns:
        (least along, greatest along, greatest to either side) [m/s]. Across the velocity every
        change speeds up. A slow robot stops within the cycle and speeds up backwards after.
    """
    least = -B * T
    if speed < B * T:
        least = -speed - A * (T - speed / B)
    return least, A * T, A * T


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
def choose_commands(position, velocity, desired, active, dynamics, search, command, sampled):
    """Choose the commands of all robots for this cycle.

    Args:
        position: Shape (n, 2) [m], world frame.
        velocity: Shape (n, 2) [m/s], world frame.
        desired: Shape (n, 2) [m/s], world frame: what motion control wants. It is reachable by
            construction and not tested for that.
        active: Shape (n,) bool; a robot that is not is predicted, and commanded, to brake; a
            stranger is never active and is predicted as :class:`Search` says.
        dynamics: A :class:`controllers.motion.trapezoid.Dynamics`.
        search: A :class:`Search`; its memory is written.
        command: Shape (n, 2) [m/s], world frame; written.
        sampled: Shape (n,) bool, written: the desired command was not clear.

    Source: Bruce and Veloso 2005, section 4. Ours: braking and the desired command are among the
    candidates when none is clear, and ties of depth are broken as in :func:`_least_deep`.
    """
    for i in range(position.shape[0]):
        cx, cy = braking_command(velocity[i, 0], velocity[i, 1], dynamics.B, dynamics.T)
        command[i, 0] = cx
        command[i, 1] = cy
        if search.stranger[i]:
            _expect(i, position, velocity, dynamics, search, search.braking, 1)
            _expect(i, position, velocity, dynamics, search, search.chosen, 0)
            continue
        _settle(i, position, velocity, command, dynamics, search, search.braking, 1)
        _settle(i, position, velocity, command, dynamics, search, search.chosen, 0)
    for i in range(position.shape[0]):
        sampled[i] = False
        if active[i]:
            pick = _valid_candidate(i, position, velocity, desired, command, dynamics, search)
            sampled[i] = pick != 0
            if pick < 0:
                pick = _least_deep(i, position, velocity, desired, dynamics, search)
            command[i, 0] = search.candidates[pick, 0]
            command[i, 1] = search.candidates[pick, 1]
            _settle(i, position, velocity, command, dynamics, search, search.chosen, 0)
        search.previous[i, 0] = (command[i, 0] - velocity[i, 0]) / dynamics.T
        search.previous[i, 1] = (command[i, 1] - velocity[i, 1]) / dynamics.T


@njit
def _settle(i, position, velocity, command, dynamics, search, predictions, kind):
    """Write the prediction of robot ``i``'s command to ``predictions``, its reach to ``kind``."""
    search.reach[kind, i] = fill_prediction(
        position[i, 0],
        position[i, 1],
        velocity[i, 0],
        velocity[i, 1],
        command[i, 0],
        command[i, 1],
        dynamics.B,
        dynamics.T,
        predictions[i],
    )


@njit
def _expect(i, position, velocity, dynamics, search, predictions, kind):
    """Write the prediction of a stranger: it keeps its velocity for a while, then brakes."""
    search.reach[kind, i] = fill_prediction(
        position[i, 0],
        position[i, 1],
        velocity[i, 0],
        velocity[i, 1],
        velocity[i, 0],
        velocity[i, 1],
        dynamics.B,
        search.foresight,
        predictions[i],
    )


@njit
def _valid_candidate(i, position, velocity, desired, command, dynamics, search):
    """Index of the clear candidate nearest to the desired command, or -1.

    Candidates in order: the desired command (taken at once if clear), last cycle's acceleration,
    random accelerations, braking. Depths not computed, because the candidate is out of reach or
    further than one already found clear, are infinite.
    """
    wx = desired[i, 0]
    wy = desired[i, 1]
    vx = velocity[i, 0]
    vy = velocity[i, 1]
    T = dynamics.T
    speed = math.sqrt(vx * vx + vy * vy)
    ex = 1.0
    ey = 0.0
    if speed > 0.0:
        ex = vx / speed
        ey = vy / speed
    least, most, side = reachable_box(speed, dynamics.A, dynamics.B, T)
    slack = 1e-9 * most
    fastest = max(dynamics.V, speed) * (1.0 + 1e-12)
    stream = search.first_stream + i
    last = search.candidates.shape[0] - 1
    pick = -1
    pick2 = math.inf
    for k in range(last + 1):
        reachable = True
        if k == 0:
            cx = wx
            cy = wy
        elif k == last:
            cx = command[i, 0]
            cy = command[i, 1]
        else:
            if k == 1:
                along = T * (search.previous[i, 0] * ex + search.previous[i, 1] * ey)
                across = T * (search.previous[i, 1] * ex - search.previous[i, 0] * ey)
                reachable = least - slack <= along <= most + slack and abs(across) <= side + slack
            else:
                along = least + (most - least) * next_uniform(search.streams, stream)
                across = side * (2.0 * next_uniform(search.streams, stream) - 1.0)
            cx = vx + along * ex - across * ey
            cy = vy + along * ey + across * ex
            reachable = reachable and cx * cx + cy * cy <= fastest * fastest
        search.candidates[k, 0] = cx
        search.candidates[k, 1] = cy
        search.candidates[k, 2] = math.inf
        d2 = (cx - wx) ** 2 + (cy - wy) ** 2
        if not reachable or d2 >= pick2:
            continue
        tolerance = BRAKING_TOLERANCE if k == last else TOLERANCE
        depth = command_depth(i, cx, cy, pick >= 0, tolerance, position, velocity, dynamics, search)
        search.candidates[k, 2] = depth
        if depth == 0.0:
            pick = k
            pick2 = d2
            if k == 0:
                break
    return pick


@njit
def _least_deep(i, position, velocity, desired, dynamics, search):
    """Index of the candidate of least depth; of equal ones, that nearest to the desired command.

    In contact, standing still ties with every way out and is nearest to a desired command that
    leads further in. Unless the desired command leads out, or further out than braking, the equal
    one that ends least deep is therefore taken. Where boxes move it is taken before there is
    contact, too, and unless the desired command leads out altogether: a box does not wait. Ours,
    not the paper's: without it overlapped robots whose goals cross stay overlapped, and one in the
    way of a box that moves stays there.
    """
    candidates = search.candidates
    least = math.inf
    for k in range(candidates.shape[0]):
        least = min(least, candidates[k, 2])
    now = _overlap_at(i, search.braking[i], 0, search)
    stopped = _overlap_at(i, search.braking[i], PIECES - 1, search)
    still = not search.drift.any()
    rows = search.chosen[position.shape[0]]
    pick = 0
    pick_end = math.inf
    pick2 = math.inf
    for k in range(candidates.shape[0]):
        if candidates[k, 2] > least + EQUAL_DEPTH:
            continue
        cx = candidates[k, 0]
        cy = candidates[k, 1]
        d2 = (cx - desired[i, 0]) ** 2 + (cy - desired[i, 1]) ** 2
        end = 0.0
        if now > 0.0 or not still:
            fill_prediction(
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
            end = _overlap_at(i, rows, PIECES - 1, search)
            if k == 0 and (end == 0.0 or (still and end < stopped - EQUAL_DEPTH)):
                return 0
        if end < pick_end or (end == pick_end and d2 < pick2):
            pick = k
            pick_end = end
            pick2 = d2
    return pick


@njit
def _overlap_at(i, rows, piece, search):
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
