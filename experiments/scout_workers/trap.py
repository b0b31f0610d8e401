"""Beyond the paper: how deep a trap open towards the nest may be.

A wall 0.9 m wide stands across the way, 1 m from the nest, with lips of some depth at its ends,
0.1 m thick: 0.7 m of it lie between them.
The worker knows the exact vector; what defeats it is the shape alone.
"""

import functools
from collections.abc import Mapping
from typing import Any

import numpy as np

from controllers.scouting import UNIT, ScoutTeam
from experiments.scout_workers.field import Setting
from experiments.scout_workers.options import behaviour, compass
from experiments.scout_workers.planar import PlanarField
from experiments.scout_workers.run import Plan, run
from experiments.scout_workers.shortest import shortest
from mjmr.randomness import Streams

SIZE, NEST, GOAL = 2.5, np.array([0.3, 1.25]), np.array([2.2, 1.25])
WIDTH, THICK, FACE = 0.7, 0.1, 1.3  # m, the width between the lips


def blocks(depth: float, width: float = WIDTH) -> np.ndarray:
    """The trap (k, 4) [m]: as wide inside as given, lips ``depth`` long."""
    low, high = 1.25 - width / 2, 1.25 + width / 2
    found = [[FACE, low - THICK, FACE + THICK, high + THICK]]
    if depth > 0:
        found += [
            [FACE - depth, low - THICK, FACE, low],
            [FACE - depth, high, FACE, high + THICK],
        ]
    return np.array(found)


def trap(given: Mapping[str, Any], seed: int) -> dict[str, Any]:
    """One worker that was told the exact vector."""
    field = PlanarField(
        Setting(
            n=1,
            seed=seed,
            size=SIZE,
            blocks=blocks(given["depth"]),
            nest=NEST,
            goal=GOAL,
            compass=compass(given),
            servo_spread=given["servo_pct"] / 100.0,
        )
    )
    team = ScoutTeam(
        1, scouts=0, rng=Streams(seed).generator("controllers"), behaviour=behaviour(given)
    )
    out = run(field, team, Plan(finish="remove", told=(GOAL - NEST) / UNIT))
    arrived = bool(np.isfinite(out.found[0]))
    way = out.way_at[0] / _shortest(given["depth"])
    return {
        "success": arrived,
        "worker_s": float(out.found_after[0]) if arrived else None,
        "path_ratio": float(way) if arrived else None,
        "bumps": int(out.bumps_at[0]),
    }


@functools.cache
def _shortest(depth: float) -> float:
    return shortest(SIZE, blocks(depth), NEST, GOAL)
