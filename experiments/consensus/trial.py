"""One trial: the experiment its condition names."""

from collections.abc import Mapping
from typing import Any

from experiments.consensus import linear
from experiments.consensus.refusals import refuse
from experiments.consensus.roles import PUBLISHED
from mjmr.randomness import Streams

Metrics = dict[str, float | int | str | bool | None]


def trial(condition: Mapping[str, Any], seed: int, parts: Mapping[str, Any] = PUBLISHED) -> Metrics:
    """Run one experiment.

    Args:
        condition: See the study's parameters.
        seed: Of the trial.
        parts: Classes of the roles ``gains`` and ``law``.

    Raises:
        InvalidInputError: The mode has no such experiment, parameters that do not go together or
            are not read, or graphs that never meet the structure condition and nobody asked for
            them.
    """
    refuse(condition)
    if condition["mode"] == "linear":
        return linear.trial(condition, seed, parts)
    # MuJoCo, OpenCV and OSQP are loaded by the trials that use them
    from experiments.consensus.teams import measure, team_of

    return measure(team_of(condition, seed, parts))


def world(condition: Mapping[str, Any]) -> Any:
    """The hall with its robots, seed 0, for ``mjmr mjcf``.

    The linear model has no bodies: the hall is the one in which robots would do the like of it.

    Raises:
        InvalidInputError: As :func:`trial`; ``mjmr trial`` asks here whether a condition can be.
    """
    from experiments.consensus import study
    from experiments.consensus.teams import team_of

    refuse(condition)
    if condition["mode"] == "linear":
        if condition["experiment"] == "three":
            linear.planned(condition, Streams(0))
        kept = {name: condition[name] for name in ("experiment", "robots", "graph")}
        kept["experiment"] = "graph" if kept["experiment"] == "graph" else "three"
        condition = study.condition(**kept, mode="physical")
    return team_of(condition, 0).simulation.world


def prepare() -> None:
    """Compile what trials call, by a short one."""
    from experiments.consensus import study
    from experiments.consensus.teams import team_of

    for sight in ("given", "rays"):
        condition = study.condition(mode="physical", sight=sight, duration=0.2)
        team_of(condition, 1000).run(0.2)
