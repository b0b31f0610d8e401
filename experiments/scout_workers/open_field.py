"""The open field: a scout wanders where nothing is in its way; its vector against the truth."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from controllers.scouting import UNIT, ScoutTeam
from controllers.scouting.coding import FARTHEST, from_code, to_code
from experiments.scout_workers.field import Setting
from experiments.scout_workers.options import behaviour, compass
from experiments.scout_workers.planar import PlanarField
from mjmr.randomness import Streams

LOOPS = 400
_SIZE = 80.0  # m: 400 units are 30


def open_field(given: Mapping[str, Any], seed: int) -> dict[str, Any]:
    """Wander for 400 loops.

    Returns:
        Error of the vector before coding [units] and as a share of the path, and how far the
        coded vector is off the uncoded one over what coding allows: half a unit along, half a
        step of direction across; the same while the displacement fits into its byte.
    """
    middle = np.full(2, _SIZE / 2)
    field = PlanarField(
        Setting(
            n=1,
            seed=seed,
            size=_SIZE,
            blocks=np.empty((0, 4)),
            nest=middle,
            goal=np.zeros(2),
            compass=compass(given),
            servo_spread=given["servo_pct"] / 100.0,
        )
    )
    team = ScoutTeam(1, rng=Streams(seed).generator("controllers"), behaviour=behaviour(given))
    field.put_down(0)
    coding = in_range = 0.0
    for _ in range(LOOPS):
        field.advance(team.step(field.time, *field.sense()))
        vector = team.travelled[0]
        d = float(np.hypot(*vector))
        off = float(np.hypot(*(from_code(*to_code(vector)) - vector)))
        excess = off - math.hypot(0.5, 0.0245 * d)
        coding = max(coding, excess)
        if d <= FARTHEST:
            in_range = max(in_range, excess)
    true = (field.pose[0, :2] - middle) / UNIT
    error = float(np.hypot(*(team.travelled[0] - true)))
    way = float(field.tally().way[0]) / UNIT
    return {
        "error_units": error,
        "error_pct": 100 * error / way,
        "coding_excess_units": coding,
        "coding_excess_in_range_units": in_range,
    }
