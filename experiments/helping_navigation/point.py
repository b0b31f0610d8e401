"""Trials of point robots in polygons: tours, the trap, a standing chain."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.helping import PLAN, PLANNERS, RAYS, READINGS, Settings, Walls, patrol, point_team
from controllers.helping.planners import Published
from controllers.helping.visibility import cast, sees
from mjmr.office import Office, load_office
from mjmr.parts import Parts
from mjmr.randomness import Streams

Array = NDArray[np.float64]
Metrics = dict[str, float | int | str | bool]
RADIUS = 0.22  # m, of the robots: a Pioneer's
KEPT = RADIUS + 0.015  # m: motion keeps this far from walls, sight RADIUS
CAP = 6000  # steps after which a target is given up
TRAP_STEPS = 5000
TRAP_START = (8.0, 5.0)  # m: in the dead end, its open side behind
LOSS = 0.2  # of messages, where they get lost
VISION = 3.0  # m: how far a planner of one's own sees
_MIDDLE = 6.0  # m: of world 1's corridor


def trial(condition: Mapping[str, Any], seed: int, parts: Parts | None = None) -> Metrics:
    """Run one condition, checked, with one seed."""
    scene = {"tour": tour, "trap": trap, "chain": chain}[condition["scene"]]
    return scene(condition, seed, parts)


@cache
def office(name: str) -> Office:
    """One of the offices in the folder ``offices``."""
    return load_office(Path(__file__).with_name("offices") / f"{name}.json", clearance=KEPT)


@cache
def walls(name: str) -> Walls:
    """Its edges for point robots."""
    place = office(name)
    path, links = place.edges(KEPT + 0.001)
    after, before = np.ascontiguousarray(links.T)
    sight, kept, motion = (place.edges(c)[0] for c in (RADIUS, RADIUS - 0.03, KEPT))
    return Walls(sight, kept, motion, path, after, before)


def targets(name: str, count: int, seed: int) -> Array:
    """Where the explorer starts and its targets (count + 1, 2) [m].

    Each is uniform in the goal of a room, any but the last one.
    """
    place, rng = office(name), Streams(seed).generator("targets")
    free, room, found = place.free_space(KEPT), -1, []
    for _ in range(count + 1):
        others = [k for k in range(len(place.goals)) if k != room]
        room = int(rng.choice(others))
        found.append(place.goal(room, rng, free))
    return np.array(found)


def settings_of(condition: Mapping[str, Any]) -> Settings:
    """The numbers a condition changes, the rest as they are."""
    return Settings(level=condition["level"])


def options_of(condition: Mapping[str, Any]) -> point_team.Options:
    """What of the method a condition switches."""
    return point_team.Options(
        shares_state=condition["shares_state"],
        noisy=condition["noise"],
        err_max=condition["err_max"],
        robot_size=2 * RADIUS,
        drop=LOSS if condition["fault"] == "radio" else 0.0,
    )


def patrolling(condition: Mapping[str, Any], start: Array, seed: int) -> point_team.Team:
    """The explorer at ``start`` (2,) [m], supporters a third of the route apart.

    A larger team has the smaller one's supporters where that has them, and one more. With the fault
    ``dead`` the last supporter neither hears nor tells.
    """
    place, n = office(condition["world"]), condition["robots"]
    route = place.routes[0]
    length = patrol.length(route)
    phase = Streams(seed).generator("patrol").random()
    places, following = [tuple(start)], [-1]
    for k in range(n - 1):
        x, y, waypoint = patrol.place(route, (phase + k / 3) % 1.0 * length)
        places.append((x, y))
        following.append(waypoint)
    crew = _team(condition, np.array(places), np.array(following), seed)
    crew.dead[1:][n - 2 :] = condition["fault"] == "dead"
    return crew


def _team(
    condition: Mapping[str, Any], places: Array, following: NDArray[np.int64], seed: int
) -> point_team.Team:
    n = len(places)
    frames = np.zeros((n, 3))
    if condition["fault"] == "lost":
        rng = Streams(seed).generator("frames")
        frames[1:] = rng.uniform([-20, -20, -np.pi], [20, 20, np.pi], (n - 1, 3))
    ghosts = READINGS["literal" if condition["reading"] == "none" else condition["reading"]]
    size = office(condition["world"]).size
    return point_team.team(places, frames, following, ghosts, size, settings_of(condition))


def drive(
    condition: Mapping[str, Any],
    crew: point_team.Team,
    goals: Array,
    cap: int,
    seed: int,
    parts: Parts | None = None,
    trace: int = 0,
) -> tuple[NDArray[np.int64], NDArray[np.bool_], Array]:
    """Run a team to goals (k, 2) [m].

    Args:
        condition: What is run.
        crew: At the start; changed in place.
        goals: In sequence.
        cap: Steps after which a goal is given up.
        seed: Of noise and lost messages.
        parts: Whose planner steers, if it is not the published one.
        trace: Steps to record.

    Returns:
        Steps (k,), whether each was reached (k,), and the trace (trace, n + 1, 2), see
        :func:`controllers.helping.point_team.run`.
    """
    k, n = len(goals), len(crew.place)
    steps, reached = np.zeros(k, dtype=np.int64), np.zeros(k, dtype=np.bool_)
    path = np.full((trace, n + 1, 2), np.nan)
    common = (
        walls(condition["world"]), settings_of(condition), options_of(condition),
        office(condition["world"]).routes[0], Streams(seed).generator("noise"),
    )  # fmt: skip
    if parts is None or parts["planner"] is Published:
        code = PLANNERS[condition["planner"]]
        point_team.run(crew, code, goals, cap, *common, steps, reached, path)
    else:
        size = office(condition["world"]).size
        planner = parts["planner"](settings_of(condition), walls(condition["world"]), size)
        _run_with(planner, crew, goals, cap, *common, steps, reached)
    return steps, reached, path


def _run_with(
    planner: Any, crew: point_team.Team, goals: Array, cap: int, edges: Walls, settings: Settings,
    options: point_team.Options, route: Array, rng: np.random.Generator,
    steps: NDArray[np.int64], reached: NDArray[np.bool_],
) -> None:  # fmt: skip
    """:func:`controllers.helping.point_team.run` with a planner in Python."""
    ranges = np.zeros(len(RAYS))
    for k, (gx, gy) in enumerate(goals):
        point_team.begin(crew, gx, gy)
        planner.begin()
        while steps[k] < cap and not point_team.arrived(crew, settings):
            mode, x, y = point_team.before(crew, edges, settings, options, rng)
            position = crew.place[0].copy()
            if mode == PLAN:
                cast(*position, RAYS, VISION, edges.motion, ranges)
                vx, vy = planner.step(position, np.array([x, y]), ranges.copy())
            else:
                planner.pause(position)
                vx, vy = point_team.towards(crew, x, y, settings)
            point_team.after(crew, mode, vx, vy, edges, settings, route)
            steps[k] += 1
        reached[k] = point_team.arrived(crew, settings)


def tour(condition: Mapping[str, Any], seed: int, parts: Parts | None = None) -> Metrics:
    """Targets in random rooms, one after the other: an entry of the paper's tables.

    Metrics: ``steps`` a target reached (mean), ``capped`` targets given up, ``steps_all`` with
    those counted at the cap, ``calls`` of the planner as a share of steps, ``offers`` taken and
    ``vain`` of them, ``follows`` of mates.
    """
    points = targets(condition["world"], condition["targets"], seed)
    if condition["planner"] == "shortest-path":
        from experiments.helping_navigation.shortest import office_graph

        step = Settings().step
        steps = office_graph(condition["world"], KEPT).tour(points) / step
        return {"steps": float(steps.mean()), "steps_all": float(steps.mean()), "capped": 0,
                "targets_run": len(steps)}  # fmt: skip
    crew = patrolling(condition, points[0], seed)
    steps, reached, _ = drive(condition, crew, points[1:], CAP, seed, parts)
    return _counted(crew, steps, reached)


def _counted(
    crew: point_team.Team, steps: NDArray[np.int64], reached: NDArray[np.bool_]
) -> Metrics:
    return {
        "steps": float(steps[reached].mean()) if reached.any() else float("nan"),
        "steps_all": float(steps.mean()),
        "capped": int((~reached).sum()),
        "targets_run": len(steps),
        "calls": float(crew.counts[PLAN] / max(crew.counts.sum(), 1)),
        "offers": int(crew.offered.taken[0]),
        "vain": int(crew.offered.vain[0]),
        "follows": int(crew.state.follows[0]),
    }


def trap(condition: Mapping[str, Any], seed: int, parts: Parts | None = None) -> Metrics:
    """A dead end between the explorer and its goal; see :func:`trap_run`.

    Metrics: ``reached``, ``steps``, ``follows``, ``inside`` (share of steps in the dead end),
    ``growth``: rank correlation of the follows' lengths with their order, nan below three.
    """
    crew, steps, reached, path = trap_run(condition, seed, parts)
    at = path[: int(steps[0]), 0]
    inside = (at[:, 0] > 4.0) & (at[:, 0] < 9.0) & (at[:, 1] > 3.0) & (at[:, 1] < 7.0)
    lengths = crew.follows[: min(int(crew.state.follows[0]), 64)]
    return {
        "reached": bool(reached[0]),
        "steps": int(steps[0]),
        "follows": int(crew.state.follows[0]),
        "offers": int(crew.offered.taken[0]),
        "inside": float(inside.mean()),
        "first_follow": int(lengths[0]) if len(lengths) else 0,
        "longest_follow": int(lengths.max()) if len(lengths) else 0,
        "growth": _growth(lengths),
    }


def _growth(lengths: NDArray[np.int64]) -> float:
    from scipy.stats import kendalltau

    if len(lengths) < 3 or np.ptp(lengths) == 0:
        return float("nan")
    return float(kendalltau(np.arange(len(lengths)), lengths).statistic)  # pyright: ignore


def trap_run(
    condition: Mapping[str, Any], seed: int, parts: Parts | None = None
) -> tuple[point_team.Team, NDArray[np.int64], NDArray[np.bool_], Array]:
    """The trap once: the team at the end, steps (1,), reached (1,) and the trace."""
    rng = Streams(seed).generator("targets")
    place = office("trap")
    goal = place.goal(0, rng, place.free_space(KEPT))
    crew = patrolling(condition, np.array(TRAP_START), seed)
    steps, reached, path = drive(
        condition, crew, goal[None], TRAP_STEPS, seed, parts, trace=TRAP_STEPS
    )
    return crew, steps, reached, path


def chain(condition: Mapping[str, Any], seed: int, parts: Parts | None = None) -> Metrics:
    """Standing supporters in world 1 that relay sight of each target, one journey a target.

    R2 stands in the corridor before the door of the room the explorer starts in, R4 before that
    of the target, R3 half way; R2 and R4 do not see each other. With the fault ``dead``, R3 is.

    Metrics: ``reached`` journeys, ``calls`` of the planner (steps), ``steps`` a journey reached,
    ``along``: the same way over R2, R3 and R4 to the target in straight legs.
    """
    rng = Streams(seed).generator("chain")
    calls, taken, done, along = 0, [], [], []
    for k in range(condition["targets"]):
        start, posts, goal = _chained(rng)
        places = np.vstack([start, posts])
        crew = _team(condition, places, np.full(4, -1), seed)
        crew.dead[2] = condition["fault"] == "dead"
        steps, reached, _ = drive(condition, crew, goal[None], CAP, seed * 1000 + k, parts)
        calls += int(crew.counts[PLAN])
        taken.append(int(steps[0]))
        done.append(bool(reached[0]))
        legs = np.diff(np.vstack([places, goal]), axis=0)
        along.append(float(np.hypot(*legs.T).sum()) / Settings().step)
    ok = np.array(done)
    return {
        "targets_run": len(ok),
        "reached": int(ok.sum()),
        "calls": calls,
        "steps": float(np.mean(np.array(taken)[ok])) if ok.any() else float("nan"),
        "along": float(np.mean(np.array(along)[ok])) if ok.any() else float("nan"),
    }


def _chained(rng: np.random.Generator) -> tuple[Array, Array, Array]:
    """A start (2,), posts of three supporters (3, 2) and a target (2,) [m] in world 1."""
    place, edges, sight = office("world1"), walls("world1"), Settings().sight
    door = {}
    for k, (x0, y0, x1, y1) in enumerate(place.rooms):
        for x, y, _, _ in place.doors:
            if x0 < x < x1 and y in (y0, y1):
                door[k] = x
    far = [(a, b) for a in door for b in door if abs(door[a] - door[b]) > sight + 0.05]
    a, b = far[int(rng.integers(len(far)))]
    xs = np.array([door[a], (door[a] + door[b]) / 2, door[b]])
    posts = np.column_stack([xs, np.full(3, _MIDDLE)])
    ends = []
    for room, post in ((a, posts[0]), (b, posts[2])):
        x0, y0, x1, y1 = place.rooms[room]
        while True:
            point = rng.uniform([x0 + KEPT, y0 + KEPT], [x1 - KEPT, y1 - KEPT])
            if sees(*point, *post, sight, edges.sight):
                ends.append(point)
                break
    return ends[0], posts, ends[1]


def prepare() -> None:
    """Compile, by one target."""
    from experiments.helping_navigation import study

    for given in ({}, {"planner": "visbug", "robots": 2, "reading": "chain"}):
        tour(study.condition(**given, targets=1), 0)
