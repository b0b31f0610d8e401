"""What the physical trials run: the point robots' tours, trap and chains, on Pioneers."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from shapely.geometry import LineString

from experiments.helping_navigation import point
from experiments.helping_navigation.crew import CrewSetup
from experiments.helping_navigation.journey import ARRIVE, JourneySetup
from mjmr.faults import Fault
from mjmr.office import Office, load_office
from mjmr.randomness import Streams

Array = NDArray[np.float64]
ROOM = 0.36  # m: what Pioneers need on each side of the way they take
APART = 0.9  # m: robots start no nearer to each other
# s after which a target is given up: the point robots' 6000 steps, in the trap 5000
TOUR_TIME, TRAP_TIME, CHAIN_TIME = 1800.0, 1500.0, 1800.0
_LANE = 0.40  # m: free on each side of the straight legs of a chain
_DEAD_AT = (15.45, 6.0)  # m: where it is in nobody's way
_ASIDE = 0.35  # m: the middle relay stands so far off the corridor's middle: dead, it blocks nobody


@cache
def office(name: str) -> Office:
    """One of the offices in the folder ``offices``, whose doors Pioneers fit through."""
    return load_office(Path(__file__).with_name("offices") / f"{name}.json", clearance=ROOM)


def tour(condition: Mapping[str, Any], seed: int) -> JourneySetup:
    """The point robots' tour: the same targets, starts and patrols.

    With the fault ``dead`` the last supporter stands dead at the end of world 1's corridor: what
    is missing is its help; in a door it would lock a room.
    """
    goals = point.targets(condition["world"], condition["targets"], seed)
    helpers = condition["robots"] - 1
    route = office(condition["world"]).routes[0]
    crew = point.patrolling(condition, goals[0], seed)
    rng = Streams(seed).generator("headings")
    starts = [(*goals[0], float(rng.uniform(-np.pi, np.pi)))]
    for k in range(1, len(crew.place)):
        starts.append(_clear_start(crew.place[k], route[crew.following[k]], starts))
    dead = condition["fault"] == "dead" and helpers > 0
    if dead:
        starts[-1] = (*_DEAD_AT, 0.0)
    return JourneySetup(
        crew=_crew(condition, starts, seed),
        targets=goals[1:],
        planner=condition["planner"],
        chain=condition["reading"] == "chain",
        shares_state=condition["shares_state"],
        routes=[route] * helpers,
        phase=[int(f) for f in crew.following[1:]],
        leg_time=TOUR_TIME,
        faults=[Fault(kind="dead", robot=helpers, start=0.0)] if dead else [],
        settings=_settings(condition),
    )


def trap(condition: Mapping[str, Any], seed: int, seconds: float = TRAP_TIME) -> JourneySetup:
    """R1 in a dead end, its goal behind the wall (figures 9 and 10), for ``seconds`` at most."""
    place, helpers = office("trap"), condition["robots"] - 1
    goal = place.goal(0, Streams(seed).generator("targets"), place.free_space(ROOM))
    crew = point.patrolling(condition, np.array(point.TRAP_START), seed)
    route = place.routes[0]
    starts = [(*point.TRAP_START, 0.0)]
    for k in range(1, len(crew.place)):
        starts.append(_clear_start(crew.place[k], route[crew.following[k]], starts))
    return JourneySetup(
        crew=_crew(condition, starts, seed, marks=goal[None]),
        targets=goal[None],
        planner=condition["planner"],
        chain=condition["reading"] == "chain",
        shares_state=condition["shares_state"],
        routes=[route] * helpers,
        phase=[int(f) for f in crew.following[1:]],
        leg_time=seconds,
        settings=_settings(condition),
    )


def standing_chain(condition: Mapping[str, Any], seed: int) -> JourneySetup:
    """Standing supporters in world 1 that relay sight of one target.

    They stand where the point robots' do, the middle one aside. With the fault ``dead``, that one
    is. Of the point robots' starts and targets those are taken that a Pioneer can go from and to
    in straight legs.
    """
    draws, free = Streams(seed).generator("chain"), office("world1").free_space(_LANE)
    while True:
        start, posts, goal = point._chained(draws)
        legs = LineString([start, posts[0]]), LineString([posts[2], goal])
        if all(free.covers(leg) for leg in legs):
            break
    posts = posts.copy()
    posts[1, 1] += _ASIDE
    rng = Streams(seed).generator("headings")
    starts = [(*p, float(rng.uniform(-np.pi, np.pi))) for p in (start, *posts)]
    return JourneySetup(
        crew=_crew(condition, starts, seed),
        targets=goal[None],
        planner=condition["planner"],
        chain=condition["reading"] == "chain",
        shares_state=condition["shares_state"],
        routes=[post[None] for post in posts],
        leg_time=CHAIN_TIME,
        faults=[Fault(kind="dead", robot=2, start=0.0)] if condition["fault"] == "dead" else [],
        settings=_settings(condition),
    )


def _settings(condition: Mapping[str, Any]) -> Any:
    return point.settings_of(condition)._replace(arrive=ARRIVE)


def _crew(
    condition: Mapping[str, Any], starts: list[tuple[float, ...]], seed: int,
    marks: Array | None = None,
) -> CrewSetup:  # fmt: skip
    """Robots at ``starts``; R1 alone knows where it is, as it must to know where its goals are."""
    place = office(condition["world"])
    frames = np.zeros((len(starts), 3))
    if condition["fault"] == "lost":
        rng = Streams(seed).generator("frames")
        frames[1:] = rng.uniform([-20, -20, -np.pi], [20, 20, np.pi], (len(starts) - 1, 3))
    frames[0] = starts[0]
    return CrewSetup(
        office={"size": place.size, "walls": place.walls},
        starts=np.array(starts),
        frames=frames,
        noisy=condition["noise"],
        err_max=condition["err_max"],
        radio_loss=point.LOSS if condition["fault"] == "radio" else 0.0,
        marks=np.empty((0, 2)) if marks is None else marks,
    )


def _clear_start(
    place: Array, ahead: Array, taken: list[tuple[float, ...]]
) -> tuple[float, float, float]:
    """A pose on the way to the next waypoint, from ``place`` on, clear of those that start."""
    way = ahead - place
    length = max(float(np.hypot(*way)), 1e-9)
    unit = way / length
    # first towards the waypoint, then back along the same line
    for along in (*np.arange(0.0, length, 0.1), *np.arange(-0.1, -3.0, -0.1)):
        x, y = place + along * unit
        if all(np.hypot(x - q[0], y - q[1]) >= APART for q in taken):
            return float(x), float(y), float(np.arctan2(way[1], way[0]))
    return float(place[0]), float(place[1]), float(np.arctan2(way[1], way[0]))
