"""Which conditions mean something: what goes with what, said in one sentence each."""

from collections.abc import Mapping
from typing import Any

from mjmr.errors import InvalidInputError

_SCENES: dict[str, dict[str, tuple[Any, ...]]] = {
    "tour": {"world": ("world1", "world2")},
    "trap": {"world": ("trap",)},
    "chain": {"world": ("world1",), "robots": (4,)},
    "markers": {
        "mode": ("physical",), "world": ("world1", "world2"), "robots": (4,), "fault": ("none",),
        "noise": (False,),
    },
}  # fmt: skip
_MAPPED = {"mode": ("point",), "scene": ("tour",), "robots": (1,)}


def check(condition: Mapping[str, Any]) -> None:
    """Refuse a condition that cannot be run, or of which a part would be without effect.

    Raises:
        InvalidInputError: Says what was given and what is allowed with it.
    """
    _goes_with(condition, "scene", _SCENES[condition["scene"]])
    if condition["planner"] == "shortest-path":
        _goes_with(condition, "planner", _MAPPED, "it knows the map, which no robot does")
    alone = condition["robots"] == 1
    if alone == (condition["reading"] != "none"):
        raise InvalidInputError(
            f"robots={condition['robots']} does not go with reading={condition['reading']}: "
            "one robot has none, several have literal or chain"
        )
    if alone and (condition["fault"] != "none" or condition["noise"]):
        given = "noise" if condition["noise"] else f"fault={condition['fault']}"
        raise InvalidInputError(
            f"{given} is of supporters, and robots=1 has none; allowed with robots=2, 3 or 4"
        )
    if condition["err_max"] > 0.0 and not condition["noise"]:
        raise InvalidInputError(
            f"err_max={condition['err_max']:g} is of no effect without noise; allowed with "
            "noise=true"
        )
    if condition["fault"] == "dead" and condition["mode"] == "physical":
        if condition["scene"] == "trap":
            raise InvalidInputError(
                "fault=dead does not go with mode=physical scene=trap: it would leave nobody to "
                "follow; allowed with scene=tour or chain"
            )
        # where the dead one stands so that it locks no room
        _goes_with(condition, "fault", {"world": ("world1",)})


def _goes_with(
    condition: Mapping[str, Any], name: str, allowed: Mapping[str, tuple[Any, ...]], why: str = ""
) -> None:
    for other, values in allowed.items():
        if condition[other] not in values:
            words = " or ".join(_word(value) for value in values)
            raise InvalidInputError(
                f"{name}={condition[name]} does not go with {other}={_word(condition[other])}; "
                f"allowed with {other}={words}{': ' if why else ''}{why}"
            )


def _word(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
