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

from controllers.motion.clearance import TOLERANCE
from controllers.motion.depth import command_depth, overlap_at
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
    now = overlap_at(i, search.braking[i], 0, search)
    stopped = overlap_at(i, search.braking[i], PIECES - 1, search)
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
            end = overlap_at(i, rows, PIECES - 1, search)
            if k == 0 and (end == 0.0 or (still and end < stopped - EQUAL_DEPTH)):
                return 0
        if end < pick_end or (end == pick_end and d2 < pick2):
            pick = k
            pick_end = end
            pick2 = d2
    return pick
