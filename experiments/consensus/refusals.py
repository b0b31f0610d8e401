"""Parameters that do not go together, told before a world is built."""

import math
from collections.abc import Mapping
from typing import Any

from mjmr.errors import InvalidInputError

ROUNDS = 10.0
"""Of telling and hearing, in experiment average [Hz]."""
_RADIO = ("noise", "loss", "delay")
_LED = ("case-i", "case-ii", "star")


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
    if condition["experiment"] == "moving":
        _refuse_moving(condition)
    if condition["experiment"] == "average":
        _refuse_average(condition)
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


def _refuse_moving(condition: Mapping[str, Any]) -> None:
    if condition["sight"] != "given" or condition["schedule"] not in _LED:
        raise InvalidInputError(
            "experiment=moving is led by one robot whose words are heard: sight=given and "
            f"schedule={', '.join(_LED)} are allowed; got sight={condition['sight']} "
            f"schedule={condition['schedule']}"
        )
    turn = 2.0 * math.pi / condition["turn_rate"]
    if condition["duration"] < turn:
        raise InvalidInputError(
            f"experiment=moving is measured over its last turn, {turn:.4g} s at "
            f"turn_rate={condition['turn_rate']:g}; got duration={condition['duration']:g}"
        )


def _refuse_average(condition: Mapping[str, Any]) -> None:
    if condition["delay"] >= 1.0 / ROUNDS:
        raise InvalidInputError(
            f"experiment=average hears what is told within a round of {1 / ROUNDS:g} s; got "
            f"delay={condition['delay']:g}"
        )
