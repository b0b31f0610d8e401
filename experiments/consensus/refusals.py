"""Parameters that do not go together, told before a world is built."""

from collections.abc import Mapping
from typing import Any

from mjmr.errors import InvalidInputError

_RADIO = ("noise", "loss", "delay")


def refuse_unfit(condition: Mapping[str, Any]) -> None:
    """Say so if a condition in MuJoCo asks for what its robots could not do or would not notice.

    Raises:
        InvalidInputError: It does; the sentence names what was given and what is allowed.
    """
    sight = condition["sight"]
    if condition["experiment"] == "graph" and sight != "given":
        raise InvalidInputError(
            f"experiment=graph has its graph given and no masts to see; got sight={sight}, "
            "sight=given is allowed"
        )
    if condition["degrees"] != "2" or condition["weight_y"] > 0:
        raise InvalidInputError(
            "hand points are double integrators with one gain for both channels: degrees and "
            f"weight_y are of mode=linear; got degrees={condition['degrees']!r} "
            f"weight_y={condition['weight_y']:g}"
        )
    told = [name for name in _RADIO if condition[name] > 0]
    if sight != "given" and told:
        raise InvalidInputError(
            f"{', '.join(told)} are of what robots tell each other, with sight=given; nobody tells "
            f"anything with sight={sight}"
        )
    if condition["experiment"] != "graph" and condition["side"] == 0 and not condition["virtual"]:
        raise InvalidInputError(
            "bodies cannot stand on one point: side=0 needs virtual=true; got virtual=false"
        )
    if condition["scan"] and condition["avoid"] == "barrier":
        raise InvalidInputError(
            "scan=true turns robots past the barrier, whose hands would move unfiltered; got "
            "avoid=barrier, avoid=none is allowed"
        )
