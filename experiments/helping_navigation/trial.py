"""One trial of the study, by its mode."""

from collections.abc import Mapping
from typing import Any

from experiments.helping_navigation.allowed import check
from mjmr.parts import Parts

Metrics = dict[str, float | int | str | bool]


def trial(condition: Mapping[str, Any], seed: int, parts: Parts | None = None) -> Metrics:
    """Run one condition; see the study's parameters.

    Args:
        condition: What is run.
        seed: The task.
        parts: What takes a role; None: the published planners.

    Raises:
        InvalidInputError: See :func:`experiments.helping_navigation.allowed.check`.
    """
    check(condition)
    if condition["mode"] == "physical":
        from experiments.helping_navigation import physical

        return physical.trial(condition, seed, parts)
    from experiments.helping_navigation import point

    return point.trial(condition, seed, parts)


def prepare() -> None:
    """Compile what the trials need."""
    from experiments.helping_navigation import physical, point

    point.prepare()
    physical.prepare()
