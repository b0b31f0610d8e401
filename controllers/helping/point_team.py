"""The paper's own simulation: a team of point robots that see and move in polygons.

Robot 0 explores, the others go round a patrol route or stand. Each step everyone senses, talks
and moves by the same length. The whole loop is compiled; :func:`before` and :func:`after` are its
halves, for callers that bring a planner of their own in between.

Sight is in the free space of a disc of the robots' radius; motion keeps 1.5 cm farther from walls,
so that a robot is never on the very edge of what it sees by.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from controllers.helping import potential_field, visbug
from controllers.helping.explorer import (
    AVOID_PAST,
    GOAL,
    MATE,
    PLAN,
    POTENTIAL_FIELD,
    VISBUG,
    Settings,
    decide,
    next_point,
)
from controllers.helping.goal_sharing import (
    Memory,
    Offers,
    check_goal,
    memory,
    new_goal,
    offers,
    reflect,
    share_goals,
)
from controllers.helping.patrol import advance
from controllers.helping.state_sharing import Trouble, calm, untroubled
from controllers.helping.visibility import RAYS, cast, move, sees
from controllers.schemas import visits
from mjmr.jit import njit


class Options(NamedTuple):
    """What a run has of the method and its faults.

    Args:
        shares_state: Whether the explorer goes to mates when in trouble.
        noisy: Whether distances and bearings of mates are misperceived.
        err_max: Largest relative error of a distance.
        robot_size: Diameter that bounds the error of a bearing [m].
        drop: Share of messages lost.
    """

    shares_state: bool = False
    noisy: bool = False
    err_max: float = 0.0
    robot_size: float = 0.44
    drop: float = 0.0


class Team(NamedTuple):
    """Point robots; index 0 explores.

    Args:
        place: True positions (n, 2) [m], world frame.
        frame: Origin [m] and heading [rad] of each F_i in the world (n, 3), which no robot knows.
        own: Positions (n, 2) [m], row i in F_i.
        following: Waypoint each goes to (n,); -1 stands still.
        dead: Whether it neither hears nor tells (n,).
        heard: Whether i hears j (n, n).
        distance: Of j as i perceives it (n, n) [m].
        bearing: Of j in F_i as i perceives it (n, n) [rad].
        known: What robots know of goals.
        offered: What owners were offered.
        state: Who is in trouble.
        past: Avoid Past's memory of robot 0.
        bug: VisBug's path of robot 0.
        ranges: Free way along the rays of the planner in use, and of all (32,) [m].
        mode: Of robot 0 at the last step (1,).
        counts: Since the start (4,): steps in each mode.
        follows: Length of each follow of a mate [steps] (64,).
    """

    place: NDArray[np.float64]
    frame: NDArray[np.float64]
    own: NDArray[np.float64]
    following: NDArray[np.int64]
    dead: NDArray[np.bool_]
    heard: NDArray[np.bool_]
    distance: NDArray[np.float64]
    bearing: NDArray[np.float64]
    known: Memory
    offered: Offers
    state: Trouble
    past: visits.Past
    bug: visbug.Bug
    ranges: NDArray[np.float64]
    mode: NDArray[np.int64]
    counts: NDArray[np.int64]
    follows: NDArray[np.int64]


def team(
    place: NDArray[np.float64],
    frame: NDArray[np.float64],
    following: NDArray[np.int64],
    ghosts: int,
    size: NDArray[np.float64],
    settings: Settings,
) -> Team:
    """A team at the start.

    Args:
        place: True positions (n, 2) [m].
        frame: Frames of the robots (n, 3) [m, m, rad], see :class:`Team`; robot 0's is the world's.
        following: Waypoints (n,) of the patrol; -1 stands still.
        ghosts: A robot remembers, see :mod:`controllers.helping.goal_sharing`.
        size: Of the world (2,) [m].
        settings: See there.
    """
    n = len(place)
    return Team(
        place=np.array(place, dtype=np.float64),
        frame=np.array(frame, dtype=np.float64),
        own=np.zeros((n, 2)),
        following=np.array(following, dtype=np.int64),
        dead=np.zeros(n, dtype=np.bool_),
        heard=np.zeros((n, n), dtype=np.bool_),
        distance=np.zeros((n, n)),
        bearing=np.zeros((n, n)),
        known=memory(n, ghosts),
        offered=offers(n, ghosts),
        state=untroubled(n),
        past=visits.past(np.zeros(2), size, settings.cell),
        bug=visbug.bug(),
        ranges=np.zeros(len(RAYS)),
        mode=np.full(1, PLAN, dtype=np.int64),
        counts=np.zeros(4, dtype=np.int64),
        follows=np.zeros(64, dtype=np.int64),
    )


@njit
def _sense(crew, walls, settings, options, rng):
    """Own positions by odometry, who hears whom, and where each perceives its mates."""
    n = crew.place.shape[0]
    for i in range(n):
        x, y = crew.place[i, 0] - crew.frame[i, 0], crew.place[i, 1] - crew.frame[i, 1]
        c, s = np.cos(crew.frame[i, 2]), np.sin(crew.frame[i, 2])
        crew.own[i, 0], crew.own[i, 1] = c * x + s * y, -s * x + c * y
    for i in range(n):
        for j in range(i + 1, n):
            px, py, qx, qy = (
                crew.place[i, 0], crew.place[i, 1], crew.place[j, 0], crew.place[j, 1],
            )  # fmt: skip
            visible = sees(px, py, qx, qy, settings.sight, walls.sight)
            for a, b in ((i, j), (j, i)):
                crew.heard[a, b] = visible and not crew.dead[a] and not crew.dead[b]
                if options.drop > 0.0 and rng.random() < options.drop:
                    crew.heard[a, b] = False
            if not visible:
                continue
            far = np.hypot(qx - px, qy - py)
            angle = np.arctan2(qy - py, qx - px)
            crew.distance[i, j] = crew.distance[j, i] = far
            crew.bearing[i, j] = angle - crew.frame[i, 2]
            crew.bearing[j, i] = angle + np.pi - crew.frame[j, 2]
            if options.noisy:
                span = np.arctan(options.robot_size / max(2.0 * far, 1e-9))
                for a, b in ((i, j), (j, i)):
                    crew.distance[a, b] = far * (1.0 + rng.uniform(-1.0, 1.0) * options.err_max)
                    crew.bearing[a, b] += span * rng.uniform(-1.0, 1.0)


@njit
def _in_world(crew, i, x, y):
    """A point of F_i in the world: where robot i looks when it checks it."""
    c, s = np.cos(crew.frame[i, 2]), np.sin(crew.frame[i, 2])
    return crew.frame[i, 0] + c * x - s * y, crew.frame[i, 1] + s * x + c * y


@njit
def _looks(crew, i, x, y, walls, settings):
    """Whether robot i sees a point of F_i."""
    px, py = _in_world(crew, i, x, y)
    return sees(crew.place[i, 0], crew.place[i, 1], px, py, settings.sight, walls.sight)


@njit
def begin(crew, x, y):
    """Give robot 0 its next goal, (x, y) [m] in the world, which is its frame."""
    new_goal(crew.known, crew.offered, 0, x, y)
    calm(crew.state, 0)
    crew.mode[0] = PLAN
    visits.fade(crew.past)
    visbug.forget_path(crew.bug)


@njit
def before(crew, walls, settings, options, rng):
    """A step up to the explorer's planner: sense, talk, decide.

    Returns:
        Mode and target (x, y) [m], see :func:`controllers.helping.explorer.decide`.
    """
    n = crew.place.shape[0]
    _sense(crew, walls, settings, options, rng)
    known, offered = crew.known, crew.offered
    if n > 1:
        # talking is fast: within a step, word goes as far as robots see each other
        for _ in range(n - 1):
            share_goals(known, crew.own, crew.heard, crew.distance, crew.bearing)
        for i in range(1, n):
            if known.number[i, 0] == 0:
                continue
            goal = known.goal[i, 0]
            sees_goal = _looks(crew, i, goal[0], goal[1], walls, settings)
            sees_ghost = True
            if not sees_goal and known.ghosts[i, 0] > 0:
                ghost = known.path[i, 0, known.ghosts[i, 0] - 1]
                sees_ghost = _looks(crew, i, ghost[0], ghost[1], walls, settings)
            check_goal(known, crew.own, i, 0, sees_goal, sees_ghost)
        for _ in range(n - 1):
            reflect(
                known, offered, crew.own, crew.heard, crew.distance, crew.bearing,
                settings.keep_promise,
            )  # fmt: skip
        known.last[:] = crew.own
    x, y, more = next_point(offered, 0)
    sees_next = more and _looks(crew, 0, x, y, walls, settings)
    edges = walls.kept if crew.mode[0] == GOAL else walls.sight
    sees_goal = sees(
        crew.place[0, 0], crew.place[0, 1], known.goal[0, 0, 0], known.goal[0, 0, 1],
        settings.sight, edges,
    )  # fmt: skip
    mate = crew.state.mate[0]
    mode, x, y = decide(
        known, offered, crew.state, 0, crew.own, crew.heard, crew.distance, crew.bearing,
        sees_goal, sees_next, settings, options.shares_state,
    )  # fmt: skip
    crew.counts[mode] += 1
    crew.mode[0] = mode
    if mode == MATE and crew.state.mate[0] >= 0:
        if mate < 0:
            crew.follows[min(crew.state.follows[0], 64) - 1] = 0
        crew.follows[min(crew.state.follows[0], 64) - 1] += 1
    return mode, x, y


@njit
def steer(crew, planner, x, y, walls, settings):
    """One of the paper's planners: a vector of length at most 1 step towards (x, y) [m]."""
    px, py = crew.place[0, 0], crew.place[0, 1]
    if planner == VISBUG:
        if not visbug.has_path(crew.bug):
            visbug.plan(
                crew.bug, px, py, x, y, walls.path, walls.after, walls.before,
                settings.left,
            )  # fmt: skip
        tx, ty = visbug.target(crew.bug, px, py, settings.vision, walls.sight)
        far = np.hypot(tx - px, ty - py)
        scale = 1.0 / max(far, settings.step)
        return scale * (tx - px), scale * (ty - py)
    if planner == POTENTIAL_FIELD:
        cast(px, py, RAYS, settings.reach, walls.motion, crew.ranges)
        return potential_field.direction(
            x - px, y - py, RAYS, crew.ranges, settings.reach, settings.gain
        )
    return np.cos(visits.ANGLES[crew.past.heading[0]]), np.sin(visits.ANGLES[crew.past.heading[0]])


@njit
def _look_around(crew, planner, mode, x, y, walls, settings):
    """Avoid Past counts cells whoever steers, and chooses a heading where it steers."""
    px, py = crew.place[0, 0], crew.place[0, 1]
    visits.visit(crew.past, px, py, settings.cell)
    if mode != PLAN:
        crew.past.place[:] = np.inf  # choose afresh when it steers again
    elif visits.due(crew.past, px, py, settings.cell):
        cast(px, py, visits.ANGLES, 2.0, walls.motion, crew.ranges)
        visits.heading(
            crew.past, px, py, x - px, y - py, visits.ANGLES, crew.ranges, settings.cell,
            settings.bias,
        )  # fmt: skip


@njit
def after(crew, mode, vx, vy, walls, settings, route):
    """The rest of a step: everyone moves.

    Args:
        crew: Changed in place.
        mode: Of robot 0.
        vx: Way of robot 0, in steps: a vector of length at most 1.
        vy: Way of robot 0, in steps.
        walls: See there.
        settings: See there.
        route: Waypoints (k, 2) [m] of the patrol.
    """
    size = np.hypot(vx, vy)
    if size > 1e-12:
        way = min(size, 1.0) * settings.step
        crew.place[0, 0], crew.place[0, 1] = move(
            crew.place[0, 0], crew.place[0, 1], vx / size, vy / size, way, walls.motion,
            mode != PLAN,
        )  # fmt: skip
    for i in range(1, crew.place.shape[0]):
        if crew.following[i] >= 0:
            crew.place[i, 0], crew.place[i, 1], crew.following[i] = advance(
                crew.place[i, 0], crew.place[i, 1], crew.following[i], route, settings.step
            )


@njit
def towards(crew, x, y, settings):
    """Way of robot 0 to a point it sees, in steps: no longer than to that point."""
    dx, dy = x - crew.place[0, 0], y - crew.place[0, 1]
    scale = 1.0 / max(np.hypot(dx, dy), settings.step)
    return scale * dx, scale * dy


@njit
def arrived(crew, settings):
    """Whether robot 0 is at its goal."""
    goal = crew.known.goal[0, 0]
    far = np.hypot(goal[0] - crew.place[0, 0], goal[1] - crew.place[0, 1])
    return far < settings.epsilon


@njit
def run(crew, planner, goals, cap, walls, settings, options, route, rng, steps, reached, trace):
    """Goals in sequence.

    Args:
        crew: Changed in place.
        planner: Of robot 0.
        goals: Shape (k, 2) [m], world frame.
        cap: Steps after which a goal is given up; the next one starts where the robot is.
        walls: See there.
        settings: See there.
        options: See there.
        route: Waypoints (k, 2) [m] of the patrol.
        rng: Draws of noise and lost messages.
        steps: Of each goal (k,), written.
        reached: Whether it was reached (k,), written.
        trace: Shape (t, n + 1, 2): places [m] of the first t steps and, in the last row, the mode
            and 0; written. Of length 0, nothing is.
    """
    now = 0
    for k in range(goals.shape[0]):
        begin(crew, goals[k, 0], goals[k, 1])
        count = 0
        while count < cap and not arrived(crew, settings):
            mode, x, y = before(crew, walls, settings, options, rng)
            if planner == AVOID_PAST:
                _look_around(crew, planner, mode, x, y, walls, settings)
            if mode == PLAN:
                vx, vy = steer(crew, planner, x, y, walls, settings)
            else:
                vx, vy = towards(crew, x, y, settings)
                visbug.forget_path(crew.bug)
            if now < trace.shape[0]:
                trace[now, :-1] = crew.place
                trace[now, -1, 0], trace[now, -1, 1] = mode, 0.0
            slides = mode if planner != VISBUG else 0
            after(crew, slides, vx, vy, walls, settings, route)
            count += 1
            now += 1
        steps[k] = count
        reached[k] = arrived(crew, settings)
