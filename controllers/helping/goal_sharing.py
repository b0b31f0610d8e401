"""Goal-sharing: robots in sight tell each other where goals are and who sees, or saw, them.

State is a :class:`Memory`, arrays over (robot, owner of the goal); what an owner makes of what it
is offered is an :class:`Offers`. Both are plain named tuples of arrays that compiled functions
fill in place.

Two readings, told apart by ``Memory.path.shape[2]``, the ghosts a robot remembers:

* *literal* (1): a robot knows its last ghost and the length D from there. Its offer is D and the
  place where it stands; memory is O(M) a robot for M robots.
* *chain* (more than 1, an extension): a robot remembers every ghost on the way back to the goal
  and hands the whole list over, so that the offer is a path, not a place.

Source: Sgorbissa and Arkin, sections 3 and 4.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from controllers.helping.frames import to_mine
from mjmr.jit import njit

LITERAL, CHAIN = 1, 96
READINGS = {"literal": LITERAL, "chain": CHAIN}
_LESS = 1e-9  # m: a promise must be shorter by this


class Memory(NamedTuple):
    """What n robots know of each other's goals; axes (robot i, owner o), all in frame F_i.

    Args:
        number: Id, int (n, n): k * n for the owner's k-th goal heard from itself, one less a
            relay; 0 where i knows no goal of o.
        goal: Position (n, n, 2) [m].
        distance: D, the length of the way to the goal that i can offer now (n, n) [m]; inf: none.
        ghost_distance: D from i's ghost (n, n) [m].
        ghosts: How many are remembered (n, n); the last one is in use.
        path: Ghosts (n, n, k, 2) [m], from the goal's end.
        last: Own position a step ago (n, 2) [m].
    """

    number: NDArray[np.int64]
    goal: NDArray[np.float64]
    distance: NDArray[np.float64]
    ghost_distance: NDArray[np.float64]
    ghosts: NDArray[np.int64]
    path: NDArray[np.float64]
    last: NDArray[np.float64]


class Offers(NamedTuple):
    """The best offer each owner got for its present goal, in its own frame.

    Args:
        active: Whether it follows one (n,).
        giver: Who gave it (n,); -1 none.
        promise: Length promised (n,) [m]; no offer that is not shorter is taken.
        length: Points of the offer (n,).
        at: The point it goes to now (n,).
        points: Places (n, k, 2) [m]: where the giver stood, and in the chain reading its ghosts.
        rest: Length from each point to the goal (n, k) [m].
        best: Smallest distance to the present point so far (n,) [m].
        idle: Steps in a row without getting nearer (n,).
        taken: Offers taken (n,) since the start.
        vain: Of those, how many led to nothing (n,).
    """

    active: NDArray[np.bool_]
    giver: NDArray[np.int64]
    promise: NDArray[np.float64]
    length: NDArray[np.int64]
    at: NDArray[np.int64]
    points: NDArray[np.float64]
    rest: NDArray[np.float64]
    best: NDArray[np.float64]
    idle: NDArray[np.int64]
    taken: NDArray[np.int64]
    vain: NDArray[np.int64]


def memory(n: int, ghosts: int) -> Memory:
    """Empty memory of ``n`` robots that remember ``ghosts`` ghosts a goal."""
    return Memory(
        number=np.zeros((n, n), dtype=np.int64),
        goal=np.zeros((n, n, 2)),
        distance=np.full((n, n), np.inf),
        ghost_distance=np.full((n, n), np.inf),
        ghosts=np.zeros((n, n), dtype=np.int64),
        path=np.zeros((n, n, ghosts, 2)),
        last=np.zeros((n, 2)),
    )


def offers(n: int, ghosts: int) -> Offers:
    """No offers yet, to ``n`` robots."""
    return Offers(
        active=np.zeros(n, dtype=np.bool_),
        giver=np.full(n, -1, dtype=np.int64),
        promise=np.full(n, np.inf),
        length=np.zeros(n, dtype=np.int64),
        at=np.zeros(n, dtype=np.int64),
        points=np.zeros((n, ghosts + 1, 2)),
        rest=np.zeros((n, ghosts + 1)),
        best=np.full(n, np.inf),
        idle=np.zeros(n, dtype=np.int64),
        taken=np.zeros(n, dtype=np.int64),
        vain=np.zeros(n, dtype=np.int64),
    )


@njit
def goal_number(identifier, n):
    """Which goal k = 1, 2, ... of its owner an Id speaks of; 0 for none."""
    return (identifier + n - 1) // n


@njit
def new_goal(known, offered, owner, x, y):
    """The owner's next goal, at (x, y) [m] in its frame: a higher Id, and no offer yet."""
    n = known.number.shape[0]
    known.number[owner, owner] = (goal_number(known.number[owner, owner], n) + 1) * n
    known.goal[owner, owner, 0], known.goal[owner, owner, 1] = x, y
    offered.active[owner], offered.giver[owner] = False, -1
    offered.promise[owner] = np.inf
    offered.length[owner] = offered.at[owner] = 0


@njit
def share_goals(known, position, heard, distance, bearing):
    """Rules 1 and 2: everyone tells everyone in sight the goals it knows.

    A receiver accepts an Id that is not below what it has: newer goals beat older ones, and fewer
    transforms beat more. A goal that is new to it makes it forget the ghosts of the old one.

    Args:
        known: Changed in place.
        position: Own positions (n, 2) [m], row i in F_i.
        heard: Shape (n, n): whether i hears j; only robots in sight of each other do.
        distance: Shape (n, n) [m]: of j as i perceives it.
        bearing: Shape (n, n) [rad]: of j in F_i as i perceives it.
    """
    n = known.number.shape[0]
    for i in range(n):
        for j in range(n):
            if i == j or not heard[i, j]:
                continue
            for owner in range(n):
                told = known.number[j, owner]
                if owner == i or told == 0:
                    continue
                told -= 0 if j == owner else 1
                mine = known.number[i, owner]
                if told < mine or goal_number(told, n) != goal_number(known.number[j, owner], n):
                    continue
                if goal_number(told, n) > goal_number(mine, n):
                    forget(known, i, owner)
                known.number[i, owner] = told
                known.goal[i, owner, 0], known.goal[i, owner, 1] = to_mine(
                    known.goal[j, owner, 0], known.goal[j, owner, 1],
                    position[j, 0], position[j, 1], position[i, 0], position[i, 1],
                    distance[i, j], bearing[i, j], bearing[j, i],
                )  # fmt: skip


@njit
def forget(known, i, owner):
    """Robot i has nothing to offer to the owner any more."""
    known.distance[i, owner] = known.ghost_distance[i, owner] = np.inf
    known.ghosts[i, owner] = 0


@njit
def check_goal(known, position, i, owner, sees_goal, sees_ghost):
    """Rule 3 with delayed visibility: what robot i can offer to the owner from where it stands.

    While it sees the goal, its ghost is itself. When it loses the goal, the ghost stays where the
    goal was last seen from; when it loses the ghost, another one is left where that was last seen
    from: a polyline back to the goal.

    Args:
        known: Changed in place.
        position: Own positions (n, 2) [m], row i in F_i.
        i: The robot.
        owner: Whose goal.
        sees_goal: Whether ``known.goal[i, owner]`` is in its sight.
        sees_ghost: Whether its ghost, ``known.path[i, owner, known.ghosts[i, owner] - 1]``, is;
            anything if it has none.
    """
    x, y = position[i, 0], position[i, 1]
    if sees_goal:
        far = np.hypot(known.goal[i, owner, 0] - x, known.goal[i, owner, 1] - y)
        known.path[i, owner, 0, 0], known.path[i, owner, 0, 1] = x, y
        known.ghosts[i, owner] = 1
        known.distance[i, owner] = known.ghost_distance[i, owner] = far
        return
    count = known.ghosts[i, owner]
    if count == 0:
        return
    if not sees_ghost:
        old = known.path[i, owner, count - 1]
        step = np.hypot(known.last[i, 0] - old[0], known.last[i, 1] - old[1])
        depth = known.path.shape[2]
        if depth == 1:
            count = 0  # the literal reading remembers one
        elif count == depth:
            forget(known, i, owner)
            return
        known.path[i, owner, count, 0] = known.last[i, 0]
        known.path[i, owner, count, 1] = known.last[i, 1]
        known.ghosts[i, owner] = count = count + 1
        known.ghost_distance[i, owner] += step
    ghost = known.path[i, owner, count - 1]
    known.distance[i, owner] = known.ghost_distance[i, owner] + np.hypot(ghost[0] - x, ghost[1] - y)


@njit
def reflect(known, offered, position, heard, distance, bearing, keep_promise):
    """Rules 4 and 5: everyone tells everyone in sight (Id, D); the shortest sum is kept.

    A supporter takes the place of the giver for its ghost; the owner takes what it is given for
    its offer, if it promises a shorter way than it has been promised.

    Args:
        known: Changed in place.
        offered: Changed in place.
        position: Own positions (n, 2) [m], row i in F_i.
        heard: Shape (n, n): whether i hears j.
        distance: Shape (n, n) [m]: of j as i perceives it.
        bearing: Shape (n, n) [rad]: of j in F_i as i perceives it.
        keep_promise: The owner compares with the length it was promised when it took its offer;
            otherwise with what is left of that way.
    """
    n, depth = known.number.shape[0], known.path.shape[2]
    for i in range(n):
        if not keep_promise and offered.active[i]:
            offered.promise[i] = min(offered.promise[i], remaining(offered, position, i))
        for j in range(n):
            if i == j or not heard[i, j]:
                continue
            for owner in range(n):
                if owner == j or known.ghosts[j, owner] == 0:
                    continue
                if goal_number(known.number[i, owner], n) != goal_number(known.number[j, owner], n):
                    continue
                sum_ = distance[i, j] + known.distance[j, owner]
                if i == owner:
                    if sum_ < offered.promise[i] - _LESS:
                        _take(known, offered, position, i, j, sum_, distance, bearing)
                elif sum_ < known.distance[i, owner] - _LESS and known.ghosts[j, owner] < max(
                    depth, 2
                ):
                    _adopt(known, position, i, j, owner, sum_, distance, bearing)


@njit
def _adopt(known, position, i, j, owner, sum_, distance, bearing):
    """Robot i takes the place of j for its ghost."""
    count = 0
    if known.path.shape[2] > 1:
        count = known.ghosts[j, owner]
        for k in range(count):
            known.path[i, owner, k, 0], known.path[i, owner, k, 1] = to_mine(
                known.path[j, owner, k, 0], known.path[j, owner, k, 1],
                position[j, 0], position[j, 1], position[i, 0], position[i, 1],
                distance[i, j], bearing[i, j], bearing[j, i],
            )  # fmt: skip
    known.path[i, owner, count, 0] = position[i, 0] + distance[i, j] * np.cos(bearing[i, j])
    known.path[i, owner, count, 1] = position[i, 1] + distance[i, j] * np.sin(bearing[i, j])
    known.ghosts[i, owner] = count + 1
    known.ghost_distance[i, owner] = known.distance[j, owner]
    known.distance[i, owner] = sum_


@njit
def _take(known, offered, position, i, j, sum_, distance, bearing):
    """Owner i takes the offer of j."""
    # the same giver in sight makes a slightly better offer at every step: one offer, not many
    if not (offered.active[i] and offered.giver[i] == j):
        offered.taken[i] += 1
    offered.active[i], offered.giver[i], offered.promise[i] = True, j, sum_
    offered.points[i, 0, 0] = position[i, 0] + distance[i, j] * np.cos(bearing[i, j])
    offered.points[i, 0, 1] = position[i, 1] + distance[i, j] * np.sin(bearing[i, j])
    offered.rest[i, 0] = known.distance[j, i]
    count = 1
    if known.path.shape[2] > 1:
        for k in range(known.ghosts[j, i] - 1, -1, -1):
            px, py = to_mine(
                known.path[j, i, k, 0], known.path[j, i, k, 1],
                position[j, 0], position[j, 1], position[i, 0], position[i, 1],
                distance[i, j], bearing[i, j], bearing[j, i],
            )  # fmt: skip
            offered.points[i, count, 0], offered.points[i, count, 1] = px, py
            count += 1
        after = np.hypot(
            known.goal[i, i, 0] - offered.points[i, count - 1, 0],
            known.goal[i, i, 1] - offered.points[i, count - 1, 1],
        )
        for k in range(count - 1, 0, -1):
            offered.rest[i, k] = after
            after += np.hypot(
                offered.points[i, k, 0] - offered.points[i, k - 1, 0],
                offered.points[i, k, 1] - offered.points[i, k - 1, 1],
            )
    offered.length[i] = count
    aim(offered, i, 0)


@njit
def aim(offered, i, index):
    """Owner i goes to point ``index`` of its offer."""
    offered.at[i] = index
    offered.best[i], offered.idle[i] = np.inf, 0


@njit
def remaining(offered, position, i):
    """Length [m] of what is left of the way owner i was offered."""
    at = offered.at[i]
    return offered.rest[i, at] + np.hypot(
        offered.points[i, at, 0] - position[i, 0], offered.points[i, at, 1] - position[i, 1]
    )


@njit
def follow(offered, position, i, sees_next, arrive, closer, patience):
    """One step of owner i along its offer: on to the next point, or give up.

    Args:
        offered: Changed in place.
        position: Own positions (n, 2) [m], row i in F_i.
        i: The owner, whose offer is active.
        sees_next: Whether it sees the point after the one it goes to, if there is one.
        arrive: At a point when nearer than this [m].
        closer: Getting nearer means by at least this [m].
        patience: Steps without getting nearer after which the offer is dropped: a ghost that was
            misperceived may be behind a wall.

    Returns:
        Whether it still follows. If not, its planner takes over, and the promise stays the
        threshold for other offers until the next goal.
    """
    at = offered.at[i]
    far = np.hypot(
        offered.points[i, at, 0] - position[i, 0], offered.points[i, at, 1] - position[i, 1]
    )
    last = at + 1 >= offered.length[i]
    if far < arrive and last:
        offered.active[i] = False
        offered.vain[i] += 1
        return False
    if far < arrive or (sees_next and not last):
        aim(offered, i, at + 1)
        return True
    if far <= offered.best[i] - closer:
        offered.best[i], offered.idle[i] = far, 0
    else:
        offered.idle[i] += 1
    if offered.idle[i] > patience:
        offered.active[i] = False
        offered.vain[i] += 1
        return False
    return True
