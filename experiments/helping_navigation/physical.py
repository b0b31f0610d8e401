"""The physical trials: the same controllers on Pioneers in MuJoCo, for the checks."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.helping.planners import Published
from experiments.helping_navigation import markers, point
from experiments.helping_navigation.allowed import check
from experiments.helping_navigation.journey import Journey, JourneySetup
from experiments.helping_navigation.physical_world import add_team, office_world
from experiments.helping_navigation.scenes import office, standing_chain, tour, trap
from mjmr.parts import Parts
from mjmr.world import World

Array = NDArray[np.float64]
Metrics = dict[str, float | int | str | bool]
STEP = 0.15  # m: a motion step of the point robots
SIGHT = 8.0  # m


def trial(condition: Mapping[str, Any], seed: int, parts: Parts | None = None) -> Metrics:
    """Run one physical condition, checked, with one seed.

    ``targets`` are looks round of each robot in the scene ``markers``.

    Args:
        condition: See the study's parameters.
        seed: Of the trial.
        parts: Whose planner leads, if it is not the published one; it is given no walls.

    Returns:
        Metrics; see :func:`measure` and, for markers, :func:`markers.compare`. Tours without
        faults have those of the point robots on the same targets besides: ``point_steps`` and
        ``point_each``.
    """
    if condition["scene"] == "markers":
        return {**markers.run(office(condition["world"]), condition["targets"], SIGHT, seed)}
    setups = {"tour": tour, "trap": trap, "chain": standing_chain}
    setup = setups[condition["scene"]](condition, seed)
    own = None if parts is None or parts["planner"] is Published else parts["planner"]
    journey = Journey(setup, seed, own)
    journey.run()
    found = measure(journey)
    if condition["scene"] == "chain":
        found["along"] = _along(setup)
    if condition["scene"] == "tour" and condition["fault"] == "none":
        goals = point.targets(condition["world"], condition["targets"], seed)
        crew = point.patrolling(condition, goals[0], seed)
        steps, _, _ = point.drive(condition, crew, goals[1:], point.CAP, seed)
        found["point_steps"], found["point_each"] = float(steps.mean()), _told(steps)
    return found


def world(condition: Mapping[str, Any]) -> World:
    """World of a physical condition with its robots at their starts, seed 0."""
    check(condition)
    setups = {"trap": trap, "chain": standing_chain}
    setup = setups.get(condition["scene"], tour)(condition, 0)
    place = office_world(setup.crew.office["size"], setup.crew.office["walls"])
    add_team(place, setup.crew.starts)
    return place


def _along(setup: JourneySetup) -> float:
    """Motion steps of the way over all posts to the target, in straight legs."""
    corners = np.vstack([setup.crew.starts[:, :2], setup.targets])
    return float(np.hypot(*np.diff(corners, axis=0).T).sum() / STEP)


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
        "office_contact_s": meter.obstacles,
        "robot_contacts": meter.episodes,
        "offers": int(me.offered.taken[0]),
        "offers_vain": int(me.offered.vain[0]),
        "follows": int(me.state.follows[0]),
        **{f"follow_{k + 1}": n for k, n in enumerate(journey.follows[:3])},
        "skipped": journey.skipped,
        "messages": int(radio.messages_sent.sum()),
        "kilobytes": float(radio.bytes_sent.sum() / 1000),
    }


def _told(steps: NDArray[Any]) -> str:
    return " ".join(f"{s:.1f}" for s in steps)


def prepare() -> None:
    """Compile what the trials call, by short ones."""
    from experiments.helping_navigation import study

    for planner in ("avoid-past", "visbug", "potential-field"):
        condition = study.condition(
            mode="physical", planner=planner, robots=2, reading="chain", targets=1,
            shares_state=planner == "potential-field",
        )  # fmt: skip
        Journey(tour(condition, 1000), 1000).run(1.0)
