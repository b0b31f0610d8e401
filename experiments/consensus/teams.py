"""Which robots a condition in MuJoCo has: one answer for trial, world and film."""

from collections.abc import Callable, Mapping
from typing import Any

from experiments.consensus import agreement, average, moving, physical
from experiments.consensus.roles import PUBLISHED

Metrics = dict[str, float | int | str | bool | None]
_KINDS: Mapping[str, tuple[Callable[..., Any], Callable[[Any], Metrics]]] = {
    "three": (physical.Team, physical.measure),
    "graph": (physical.Team, physical.measure),
    "agreement": (agreement.AgreementTeam, agreement.measure),
    "moving": (moving.MovingTeam, moving.measure),
    "average": (average.AverageTeam, average.measure),
}


def team_of(condition: Mapping[str, Any], seed: int, parts: Mapping[str, Any] = PUBLISHED) -> Any:
    """Robots in their hall, with ``simulation``, ``run(seconds)`` and ``caption()``.

    Args:
        condition: Of mode physical.
        seed: Of the trial.
        parts: Classes of the roles ``gains`` and ``law``.

    Raises:
        InvalidInputError: Parameters that do not go together, or graphs that never meet the
            structure condition and nobody asked for them.
    """
    return _KINDS[condition["experiment"]][0](condition, seed, parts)


def measure(team: Any) -> Metrics:
    """Run a team for its condition's duration, and tell what its experiment measures."""
    return _KINDS[team.condition["experiment"]][1](team)
