"""What a robot with a goal does at a step: its goal, an offer, a mate, or its own planner.

In this order: it goes straight to its goal if it sees it; along the offer it took; to a mate if it
is in trouble; and else where its planner says.

Source: Sgorbissa and Arkin, sections 2, 3 and 5.
"""

from typing import NamedTuple

import numpy as np

from controllers.helping.goal_sharing import follow
from controllers.helping.state_sharing import find_mate, leave_mate, measure
from mjmr.jit import njit

GOAL, OFFER, MATE, PLAN = 0, 1, 2, 3
AVOID_PAST, VISBUG, POTENTIAL_FIELD = 0, 1, 2
PLANNERS = {"avoid-past": AVOID_PAST, "visbug": VISBUG, "potential-field": POTENTIAL_FIELD}


class Settings(NamedTuple):
    """Numbers the paper does not give; all are ours.

    Args:
        step: Way of one motion step [m].
        sight: How far robots and goals are seen [m].
        epsilon: A goal is reached when nearer than this [m].
        arrive: A ghost is reached when nearer than this [m]. For points hardly more than they keep
            from walls: a corner may hide from a millimetre short of a ghost what is seen from it.
        closer: Progress is a distance smaller by this [m].
        patience: Steps without progress after which an offer is dropped.
        level: Cr.
        vision: How far VisBug-21 sees [m].
        left: VisBug keeps walls on its left; else on its right.
        reach: Of the potential field's push [m].
        gain: Of the potential field's push.
        cell: Of Avoid Past's grid [m].
        bias: Of Avoid Past towards the target, in visits.
        keep_promise: Whether an owner compares offers with the length it was promised when it took
            the one it follows; else with what is left of that way.
    """

    step: float = 0.15
    sight: float = 8.0
    epsilon: float = 0.3
    arrive: float = 1e-5
    closer: float = 0.075
    patience: int = 10
    level: int = 20
    vision: float = 3.0
    left: bool = True
    reach: float = 1.0
    gain: float = 2.0
    cell: float = 0.4
    bias: float = 4.0
    keep_promise: bool = False


@njit
def decide(
    known, offered, state, i, position, heard, distance, bearing, sees_goal, sees_next, settings,
    shares_state,
):  # fmt: skip
    """What robot i goes to.

    Args:
        known: :class:`controllers.helping.goal_sharing.Memory`.
        offered: :class:`controllers.helping.goal_sharing.Offers`, changed in place.
        state: :class:`controllers.helping.state_sharing.Trouble`, changed in place.
        i: The robot.
        position: Own positions (n, 2) [m], row i in F_i.
        heard: Shape (n, n): whether i hears j.
        distance: Shape (n, n) [m]: of j as i perceives it.
        bearing: Shape (n, n) [rad]: of j in F_i as i perceives it.
        sees_goal: Whether it sees its goal.
        sees_next: Whether it sees the point of its offer after the one it goes to; anything if
            there is none.
        settings: :class:`Settings`.
        shares_state: Whether it follows mates when in trouble.

    Returns:
        Mode (``GOAL``, ``OFFER``, ``MATE`` or ``PLAN``) and the target (x, y) [m] in F_i. The
        planner's target is the goal.
    """
    x, y = known.goal[i, i, 0], known.goal[i, i, 1]
    mode, key = PLAN, 0
    if sees_goal:
        mode = GOAL
        offered.active[i] = False
        leave_mate(state, i)
    elif offered.active[i] and follow(
        offered, position, i, sees_next, settings.arrive, settings.closer, settings.patience
    ):
        mode = OFFER
        at = offered.at[i]
        x, y = offered.points[i, at, 0], offered.points[i, at, 1]
        key = 1 + offered.taken[i] * offered.points.shape[1] + at
        leave_mate(state, i)
    elif shares_state and find_mate(state, i, position, heard, distance, bearing, settings.arrive):
        mode = MATE
        x, y = state.place[i, 0], state.place[i, 1]
        key = -2 - state.mate[i]
    if shares_state:
        far = np.hypot(x - position[i, 0], y - position[i, 1])
        measure(state, i, key, far, settings.closer, settings.level)
    return mode, x, y


@njit
def next_point(offered, i):
    """The point of robot i's offer after the one it goes to, and whether there is one."""
    at = offered.at[i] + 1
    if not offered.active[i] or at >= offered.length[i]:
        return 0.0, 0.0, False
    return offered.points[i, at, 0], offered.points[i, at, 1], True
