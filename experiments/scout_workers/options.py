"""What a condition tells the robots, and the errors of the compass it gives them."""

import math
from collections.abc import Mapping
from typing import Any

from controllers.scouting import Behaviour
from experiments.scout_workers.field import EXACT, CompassErrors

Given = Mapping[str, Any]


def behaviour(given: Given) -> Behaviour:
    """What the robots are told."""
    step = math.radians(given["compass_deg"])
    finish = given["finish"]
    return Behaviour(
        margin=math.radians(given["margin_deg"]),
        avoid_step=math.radians(given["avoid_deg"]),
        forced=given["forced"],
        # a turn cannot end nearer to its course than the compass can tell
        tolerance=max(math.radians(10.0), 0.6 * step),
        succession=given["succession"],
        release=given["release"],
        scout_after="search" if finish == "search" else "stop",
        after_goal="home" if finish == "home" else "stop",
    )


def compass(given: Given) -> CompassErrors:
    """Errors of the compass."""
    if given["compass"] == "exact":
        return EXACT
    white = given["compass"] == "white"
    return CompassErrors(
        step=math.radians(given["compass_deg"]),
        **({"drift": 0.0, "bias": 0.0} if white else {}),
    )
