"""The study's roles: what gives weights to those who are heard, and the law that uses them."""

from collections.abc import Mapping
from typing import Any

from controllers.consensus import EqualGains, NeighbourGains, RelativeForm, check_gains

PUBLISHED: Mapping[str, Any] = {"gains": NeighbourGains, "law": RelativeForm}
"""Classes by role, for who runs a condition without a choice of parts."""


def gains_rule(parts: Mapping[str, Any], n: int, many: bool = False) -> Any:
    """What gives weights to n robots.

    Args:
        parts: Classes by role.
        n: Robots.
        many: Whether it is experiment graph, whose robots weight all they hear alike unless
            somebody takes the role.
    """
    chosen = parts["gains"]
    return EqualGains(n) if many and chosen is NeighbourGains else chosen(n)


def refuse_gains(gains: Any, heard: Any, weight: float) -> None:
    """Say what is wrong with the weights somebody's rule gave.

    Raises:
        InvalidInputError: A row that does not sum to one, a negative weight, or one of somebody
            who is not heard; says which.
    """
    check_gains(gains, len(gains), heard)
