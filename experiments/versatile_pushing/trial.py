"""One trial: the task its condition names."""

from collections.abc import Mapping
from typing import Any

from experiments.versatile_pushing.agreement import vision
from experiments.versatile_pushing.pushing import TESTS, scene
from experiments.versatile_pushing.tasks import run
from experiments.versatile_pushing.worlds import TASKS, build
from mjmr.world import World

Metrics = dict[str, Any]


def trial(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Run one trial.

    Args:
        condition: See the study's parameters.
        seed: Of noise and of where robots start; the small discs' places depend on ``map`` alone.
    """
    if condition["task"] in TASKS:
        return run(condition, seed)
    if condition["task"] == "vision":
        return vision(condition, seed)
    return TESTS[condition["task"]](condition, seed)


def world(condition: Mapping[str, Any]) -> World:
    """World of a condition as seed 0 has it; of ``vision``, the first of its three."""
    if condition["task"] in TESTS:
        return scene(condition, 0)[0]
    vision = condition["task"] == "vision"
    return build(
        "foraging" if vision else condition["task"],
        robots=condition["robots"],
        weight=condition["weight"],
        map_seed=condition["map"],
        vision="both" if vision else condition["vision"],
    )[0]


def prepare() -> None:
    """Compile what the trials need, by letting robots work for a moment."""
    from experiments.versatile_pushing import study

    trial(study.condition(duration=0.3), 0)
