"""The physical trials: the same controllers on Pioneers in MuJoCo, for the checks."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.helping import PLANNERS, READINGS, Settings, Walls, point_team
from experiments.helping_navigation import markers
from experiments.helping_navigation.journey import Journey, JourneySetup
from experiments.helping_navigation.scenes import office, standing_chain, tour, trap
from mjmr.office import Office

Array = NDArray[np.float64]
Metrics = dict[str, float | int | str]
STEP = 0.15  # m: a motion step of the abstract trials
_CAP = 6000  # motion steps after which the point robot gives a target up
_POINT_CLEARANCE = 0.32  # m: of the point robot that is compared with a Pioneer
LOSS = 0.2  # of messages, where they get lost


def trial(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Run one physical condition with one seed.

    Args:
        condition: ``scene`` (``tour``, ``trap``, ``chain`` or ``markers``), ``world``,
            ``planner``, ``reading``, ``robots``, ``targets``, ``err_max`` and ``fault``
            (``none``, ``dead``, ``radio``, ``lost``); see the study.
        seed: Of the trial.

    Returns:
        Metrics; see :func:`measure` and, for markers, :func:`markers.compare`.
    """
    c, place = condition, office(condition["world"])
    if c["scene"] == "markers":
        return {**markers.run(place, c["targets"], 8.0, seed)}
    fault, chain = c["fault"], c["reading"] == "chain"
    loss = LOSS if fault == "radio" else 0.0
    if c["scene"] == "trap":
        setup = trap(
            place, shares_state=c["shares_state"], robots=c["robots"], chain=chain, seed=seed,
            leg_time=c["leg_time"],
        )  # fmt: skip
    elif c["scene"] == "chain":
        setup = standing_chain(
            place, planner=c["planner"], chain=chain, seed=seed, dead=fault == "dead",
            radio_loss=loss, lost=fault == "lost", leg_time=c["leg_time"],
        )  # fmt: skip
    else:
        goals = room_targets(place, c["targets"], seed)
        setup = tour(
            place, goals, planner=c["planner"], robots=c["robots"], chain=chain, seed=seed,
            err_max=c["err_max"], radio_loss=loss, lost=fault == "lost",
            dead_after=0.0 if fault == "dead" else np.inf, leg_time=c["leg_time"],
        )  # fmt: skip
    journey = Journey(setup, seed)
    journey.run()
    found = measure(journey)
    if c["scene"] == "tour" and fault == "none":
        steps = point_steps(place, setup, c["planner"], c["reading"], seed)
        found["point_steps"] = float(steps.mean())
        found["point_each"] = _told(steps)
    return found


def measure(journey: Journey) -> Metrics:
    """What came of a journey.

    ``steps`` are metres of R1's way over 0.15; ``lost`` counts targets given up, ``each`` lists
    steps and ``lost_each`` 0 or 1 of every target; ``calls`` is the share of motion steps at which
    the planner led; contacts are seconds; ``follow_1`` and so on are the lengths of the follows of
    mates in motion steps.
    """
    legs, me = journey.legs, journey.minds[0]
    steps = np.array([leg.metres for leg in legs]) / STEP
    meter, radio = journey.crew.meter, journey.crew.radio
    decisions = max(journey.decisions, 1)
    seconds = journey.crew.simulation.time
    return {
        "targets_done": len(legs),
        "lost": sum(not leg.reached for leg in legs),
        "steps": float(steps.mean()),
        "each": _told(steps),
        "lost_each": " ".join(str(int(not leg.reached)) for leg in legs),
        "seconds": seconds,
        "speed": float(sum(leg.metres for leg in legs) / seconds),
        "calls": sum(leg.calls for leg in legs) / decisions,
        "call_steps": sum(leg.calls for leg in legs),
        "worst_miss_m": max(leg.miss for leg in legs if leg.reached or len(legs) == 1),
        "robot_contact_s": meter.robots,
        "wall_contact_s": meter.obstacles,
        "robot_contacts": meter.episodes,
        "offers": int(me.offered.taken[0]),
        "offers_vain": int(me.offered.vain[0]),
        "follows": int(me.state.follows[0]),
        **{f"follow_{k + 1}": n for k, n in enumerate(journey.follows[:3])},
        "skipped": journey.skipped,
        "messages": int(radio.messages_sent.sum()),
        "kilobytes": float(radio.bytes_sent.sum() / 1000),
    }


def room_targets(place: Office, count: int, seed: int) -> Array:
    """Targets (count, 2) [m], uniform in the goals of rooms, never twice in a row in one room."""
    rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(27, 0)))
    free, room, found = place.free_space(0.34), -1, []
    for _ in range(count):
        others = [k for k in range(len(place.goals)) if k != room]
        room = int(rng.choice(others)) if others else 0
        found.append(place.goal(room, rng, free))
    return np.array(found)


def point_steps(
    place: Office, setup: JourneySetup, planner: str, reading: str, seed: int
) -> NDArray[np.int64]:
    """Motion steps (k,) of the abstract trial's point robot to the same targets.

    It starts where R1 does, its supporters where R1's do, going to the same waypoints.
    """
    settings, starts = Settings(), setup.crew.starts
    sight = place.edges(_POINT_CLEARANCE)[0]
    motion = place.edges(_POINT_CLEARANCE + 0.015)[0]
    path, links = place.edges(_POINT_CLEARANCE + 0.016)
    walls = Walls(
        sight, motion, path, np.ascontiguousarray(links[:, 0]), np.ascontiguousarray(links[:, 1])
    )
    following = np.array([-1, *(setup.phase or [])], dtype=np.int64)
    team = point_team.team(
        starts[:, :2].copy(), np.zeros((len(starts), 3)), following, READINGS[reading],
        place.size, settings,
    )  # fmt: skip
    count = len(setup.targets)
    steps, reached = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.bool_)
    point_team.run(
        team, PLANNERS[planner], setup.targets, _CAP, walls, settings,
        point_team.Options(shares_state=setup.shares_state), place.routes[0],
        np.random.default_rng(seed), steps, reached, np.zeros((0, len(starts) + 1, 2)),
    )  # fmt: skip
    return steps


def _told(steps: NDArray[Any]) -> str:
    return " ".join(f"{s:.1f}" for s in steps)


def prepare() -> None:
    """Compile what the trials call, by short ones."""
    for planner in PLANNERS:
        setup = tour(
            office("world1"), [[2.5, 9.0]], planner=planner, robots=2, chain=True, seed=0,
            err_max=0.1,
        )  # fmt: skip
        Journey(setup, 0).run(1.0)
        point_steps(office("world1"), setup, planner, "chain", 0)
