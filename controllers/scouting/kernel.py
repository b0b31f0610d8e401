"""One program loop of every robot, compiled: cues, transitions, reckoning, actions.

The transitions are tables (:func:`controllers.scouting.machine.table`); here are only the cues and
what is done in each state. Eqs. refer to MacKunis and Raviv 2003.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mjmr.jit import njit

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

# numbers of controllers/scouting/machine.py, equal by test; compiled code takes constants from
# files that compile
WAIT, SEARCH, TRANSMIT, ALIGN, SEEK, SPIRAL, AVOID, BACK, TURN, REPORT, DONE = range(11)
CUE_COUNT = 13
VIAS = 4
TRAIL = 1024


class Memory(NamedTuple):
    """What the robots remember, arrays over the team; the kernel writes to them.

    Attributes:
        role: 0 scout, 1 worker (n,).
        state: (n,), numbers of ``machine.STATES``.
        travelled: Sum of nominal unit steps since the nest (n, 2) [units], compass axes: Eqs. 3-4.
        length: Units driven forward or back (n,).
        goal: Vector a worker drives by (n, 2) [units].
        vias: Points it drives through before (n, 4, 2) [units], of which ``via_count`` (n,) are
            meant and the first ``via_at`` (n,) passed.
        since: Forward units since the last turn away (n,).
        side: Which way it turns away, +1 left or -1 right (n,).
        hit: The same for the turn after a bump (n,).
        told: Whether the scout has reported (n,).
        homing: Whether it drives to the nest (n,).
        corner: Heading the spiral's first side has (n,) [rad].
        leg: Side of the spiral (n,); -1 while there is none.
        left: Units left of that side (n,).
        trail: Where it was after each unit (n, TRAIL, 2) [units], ``marks`` (n,) of them.
        marks: See ``trail``.
    """

    role: Ints
    state: Ints
    travelled: Array
    length: Array
    goal: Array
    vias: Array
    via_count: Ints
    via_at: Ints
    since: Ints
    side: Ints
    hit: Ints
    told: Flags
    homing: Flags
    corner: Array
    leg: Ints
    left: Array
    trail: Array
    marks: Ints


class Rules(NamedTuple):
    """The numbers of a :class:`Behaviour` the kernel needs; radians and units."""

    margin: float
    avoid_step: float
    bump_turn: float
    forced: int
    tolerance: float
    turn_limit: float
    wander_chance: float
    wander_turn: float
    arrive: float
    spiral_pitch: float
    spiral_legs: int


def new_memory(role: Ints) -> Memory:
    """Robots that have not moved, waiting or, as scouts, about to search."""
    n = len(role)
    ints, flags = np.zeros(n, dtype=np.int64), np.zeros(n, dtype=bool)
    return Memory(
        role.astype(np.int64), np.where(role == 0, SEARCH, WAIT).astype(np.int64),
        np.zeros((n, 2)), np.zeros(n), np.zeros((n, 2)), np.zeros((n, VIAS, 2)), ints.copy(),
        ints.copy(), ints + 1_000_000, ints + 1, ints + 1, flags.copy(), flags.copy(), np.zeros(n),
        ints - 1, np.zeros(n), np.zeros((n, TRAIL, 2)), ints.copy(),
    )  # fmt: skip


@njit
def _wrap(angle: float) -> float:
    return np.pi - (np.pi - angle) % (2.0 * np.pi)


@njit
def _remaining(m: Memory, i: int) -> tuple[float, float]:
    """Vector from robot i to where it drives, by its own reckoning [units]: Eq. 6."""
    if m.homing[i]:
        return -m.travelled[i, 0], -m.travelled[i, 1]
    if m.via_at[i] < m.via_count[i]:
        k = m.via_at[i]
        return m.vias[i, k, 0] - m.travelled[i, 0], m.vias[i, k, 1] - m.travelled[i, 1]
    return m.goal[i, 0] - m.travelled[i, 0], m.goal[i, 1] - m.travelled[i, 1]


@njit
def _drive_unit(m: Memory, i: int, heading: float, sign: float) -> None:
    """Count a unit forward or back: Eqs. 3-4; backing subtracts (section 3.2)."""
    m.travelled[i, 0] += sign * np.cos(heading)
    m.travelled[i, 1] += sign * np.sin(heading)
    m.length[i] += 1.0
    if m.marks[i] < TRAIL:
        m.trail[i, m.marks[i]] = m.travelled[i]
        m.marks[i] += 1


@njit
def step(
    m: Memory,
    rules: Rules,
    tables: Ints,
    may_leave: Flags,
    active: Flags,
    heading: Array,
    ir: Flags,
    bump: Flags,
    goal_seen: Flags,
    random: Array,
    action: Array,
    reports: Flags,
    told: Flags,
) -> None:
    """Run one loop of every active robot.

    Args:
        m: Memory; changed.
        rules: Of the behaviour.
        tables: Transitions by role (2, states, 8, 2).
        may_leave: Who knows a goal and whose turn it is (n,).
        active: Who is on the field and runs (n,).
        heading: Compass readings (n,) [rad].
        ir: Left and right detector see something (n, 2).
        bump: Left and right front bumper were pressed since the last loop (n, 2).
        goal_seen: (n,).
        random: Uniform numbers, three a robot (n, 3).
        action: Written: units forward (-1, 0, 1) and turn [rad] of the coming loop (n, 2).
        reports: Written: who begins to send in this loop (n,).
        told: Written: the cues each robot went by (n, CUE_COUNT).
    """
    for i in range(len(heading)):
        action[i, 0], action[i, 1] = 0.0, 0.0
        reports[i] = False
        told[i] = False
        if not active[i]:
            continue
        cues = told[i]
        role = m.role[i]
        ahead = heading[i]
        x, y = _remaining(m, i)
        while (
            not m.homing[i] and m.via_at[i] < m.via_count[i]
            and np.sqrt(x * x + y * y) < rules.arrive
        ):  # fmt: skip
            m.via_at[i] += 1
            x, y = _remaining(m, i)
        near = np.sqrt(x * x + y * y) < rules.arrive
        error = _wrap(np.arctan2(y, x) - ahead)
        blocked = ir[i, 0] or ir[i, 1]
        seen = goal_seen[i] and not m.homing[i] and not m.told[i]
        cues[0] = True
        cues[1] = bump[i, 0] or bump[i, 1]
        cues[2] = seen
        cues[3] = blocked
        cues[4] = not blocked
        cues[5] = not blocked and m.since[i] >= rules.forced and abs(error) > rules.margin
        aligned = abs(error) <= min(rules.tolerance, rules.margin)
        cues[6] = aligned and not blocked
        cues[7] = near and not m.homing[i]
        cues[8] = near and m.homing[i]
        cues[9] = may_leave[i]
        cues[10] = m.leg[i] >= rules.spiral_legs
        cues[11] = not blocked and 0 <= m.leg[i] < rules.spiral_legs
        cues[12] = aligned and blocked

        before = m.state[i]
        for k in range(tables.shape[2]):
            cue = tables[role, before, k, 0]
            if cue < 0:
                break
            if cues[cue]:
                m.state[i] = tables[role, before, k, 1]
                break
        state = m.state[i]
        entered = state != before

        if entered:
            if state == AVOID:
                if ir[i, 0] != ir[i, 1]:
                    m.side[i] = -1 if ir[i, 0] else 1
                elif m.since[i] > 2:  # nothing to keep to: either way, by lot
                    m.side[i] = 1 if random[i, 2] < 0.5 else -1
                m.since[i] = 0
            elif state == BACK:
                if bump[i, 0] != bump[i, 1]:
                    m.hit[i] = -1 if bump[i, 0] else 1
                else:
                    m.hit[i] = 1 if random[i, 2] < 0.5 else -1
            elif state == TURN:
                m.since[i] = 0
                m.side[i] = m.hit[i]
            elif state == SPIRAL:
                if m.leg[i] < 0:
                    m.corner[i] = ahead
                m.leg[i] += 1  # of a spiral that was blocked: round the next corner
                m.left[i] = rules.spiral_pitch * (m.leg[i] // 2 + 1)
            elif before == SPIRAL and state == ALIGN:
                m.leg[i] = -1
            elif state in (TRANSMIT, REPORT):
                reports[i] = True
                m.told[i] = True
            elif before == REPORT and state == ALIGN:
                m.homing[i] = True
                x, y = _remaining(m, i)
                error = _wrap(np.arctan2(y, x) - ahead)
            elif before == WAIT:
                m.since[i] = rules.forced

        if state == SEARCH:
            if random[i, 0] < rules.wander_chance:
                action[i, 1] = (2.0 * random[i, 1] - 1.0) * rules.wander_turn
            else:
                action[i, 0] = 1.0
        elif state == ALIGN:
            action[i, 1] = min(max(error, -rules.turn_limit), rules.turn_limit)
        elif state == SEEK:
            action[i, 0] = 1.0
        elif state == AVOID:
            action[i, 1] = m.side[i] * rules.avoid_step
        elif state == BACK:
            action[i, 0] = -1.0
        elif state == TURN:
            action[i, 1] = m.hit[i] * rules.bump_turn
        elif state == SPIRAL:
            off = _wrap(m.corner[i] + m.leg[i] * (np.pi / 2.0) - ahead)
            if abs(off) > min(rules.tolerance, rules.margin):
                action[i, 1] = min(max(off, -rules.turn_limit), rules.turn_limit)
            else:
                action[i, 0] = 1.0
                m.left[i] -= 1.0
                if m.left[i] <= 0.0:  # sides 1 1 2 2 3 3 ... pitches long
                    m.leg[i] += 1
                    m.left[i] = rules.spiral_pitch * (m.leg[i] // 2 + 1)
        if action[i, 0] != 0.0:
            _drive_unit(m, i, ahead, action[i, 0])
            if action[i, 0] > 0.0:
                m.since[i] += 1
