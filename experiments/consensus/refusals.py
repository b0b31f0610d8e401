"""Parameters that do not go together, told before a world is built."""

import math
from collections.abc import Mapping
from typing import Any

from mjmr.conditions import format_value
from mjmr.errors import InvalidInputError

ROUNDS = 10.0
"""Of telling and hearing, in experiment average [Hz]."""
TOP_SPEED = 0.8
"""Of the leader of a moving formation [m/s]; less than bodies drive."""
_RADIO = ("noise", "loss", "delay")
_LED = ("case-i", "case-ii", "star")
_GRAPH = {"graph", "robots", "weight", "duration"}
_SEQUENCE = {"schedule", "dwell", "duration", "weight"}
_BODIES = {"duration", "weight", "avoid", "calibrated", "fault", "heading", "virtual"}
_TRIANGLE = {"places", "side"}
READS: Mapping[tuple[str, str], set[str]] = {
    ("three", "linear"): _SEQUENCE | {"weight_y", "degrees", "anyway"},
    ("graph", "linear"): _GRAPH,
    ("example-4.1", "linear"): {"degree"},
    ("random-sequence", "linear"): set(),
    ("mixed-channels", "linear"): _SEQUENCE,
    ("lemmas", "linear"): set(),
    ("three", "physical"): {
        *_SEQUENCE, *_BODIES, *_TRIANGLE, *_RADIO, "anyway", "sight", "cone_deg", "scan",
    },
    ("graph", "physical"): {*_GRAPH, *_BODIES, *_RADIO, "anyway"},
    ("agreement", "physical"): {*_BODIES, *_TRIANGLE, "cone_deg", "scan"},
    ("moving", "physical"): {
        *_BODIES, *_TRIANGLE, *_RADIO, "anyway", "schedule", "path", "speed", "turn_rate",
        "feedforward",
    },
    ("average", "physical"): {"robots", "patrol", "reach", "rule", "loss", "delay", "duration"},
}  # fmt: skip
"""What each experiment reads of the parameters, by its mode; the rest must be left as it is."""
_GIVEN_ONLY = {"schedule", "dwell", "anyway"}
_SEEN_ONLY = {"cone_deg", "scan"}


def refuse(condition: Mapping[str, Any]) -> None:
    """Say so if a condition of either mode cannot be, or sets what its experiment does not read.

    Raises:
        InvalidInputError: It does, or the mode has no such experiment; the sentence names what
            was given and what is allowed.
    """
    experiment, mode = condition["experiment"], condition["mode"]
    modes = [m for e, m in READS if e == experiment]
    if mode not in modes:
        raise InvalidInputError(
            f"experiment {experiment} is of mode {' or '.join(modes)}; got {mode}"
        )
    if mode == "physical":
        refuse_unfit(condition)
    told = f"experiment={experiment}" + (f" with mode={mode}" if len(modes) > 1 else "")
    _refuse_others(condition, READS[experiment, mode], told)
    if (experiment, mode) == ("three", "physical"):
        blind = condition["sight"] == "given"
        unread = _SEEN_ONLY if blind else _GIVEN_ONLY
        _refuse_others(
            condition, READS[experiment, mode] - unread, f"{told} and sight={condition['sight']}"
        )
    if experiment == "moving" and condition["path"] in ("rotate", "scale"):
        _refuse_others(
            condition, READS[experiment, mode] - {"speed"}, f"{told} with path={condition['path']}"
        )


def _refuse_others(condition: Mapping[str, Any], reads: set[str], told: str) -> None:
    from experiments.consensus import study

    for parameter in study.parameters:
        name, usual = parameter.name, parameter.default
        if name not in {"experiment", "mode", *reads} and condition[name] != usual:
            raise InvalidInputError(
                f"{told} does not read {name}: leave it at {format_value(usual)}; got "
                f"{name}={format_value(condition[name])}"
            )


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
    placed = "side" in READS.get((condition["experiment"], "physical"), ())
    if placed and condition["side"] == 0 and not condition["virtual"]:
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
    if condition["speed"] > TOP_SPEED:
        raise InvalidInputError(
            f"bodies drive 1 m/s, and who follows catches up: speed is at most {TOP_SPEED:g} m/s; "
            f"got {condition['speed']:g}"
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
