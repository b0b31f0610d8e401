"""What is claimed about pushing itself, and the bounds that decide it.

The paper simulated no physics and says none of this: bounds come from what the study needs for
"an object of weight w takes w + 1 robots" to be true of bodies that touch, and are ours. They were
fixed before the runs that decide them.
"""

from typing import Any

import numpy as np

from experiments.versatile_pushing.sizes import HEADINGS, TIMESTEPS, WEIGHTS
from mjmr.claims import Bound, Claim, Evidence, Table

_ALL = ("quick", "standard", "full")
_LARGE = ("standard", "full")
_WORDS = "a weight of w takes w + 1 robots"


def claims_pushing() -> list[Claim]:
    """Every claim about pushing itself."""
    return [
        _claim(
            "push-stall", "stall", "error_pct", Bound.within(-2.0, 2.0), "%",
            "one robot against a disc that nothing moves, mean force of 3 s / stated force - 1, "
            "furthest from 0 over directions and timesteps",
        ),
        _claim(
            "push-held", "held", "creep_mm", Bound("<=", 15.0), "mm",
            "w robots abreast push straight at 0, 22, 45, 90 degrees for 60 s, w = 1, 2; way of "
            "the disc, furthest",
        ),
        _claim(
            "push-held-arrival", "held", "arrival_mm", Bound("<=", 50.0), "mm",
            "the same; way of the disc in the 3 s before, in which the robots arrive, furthest",
        ),
        _claim(
            "push-held-pushed", "held", "push_share", Bound(">=", 0.95), "",
            "the same; mean force on the disc in those 60 s / w times the stated force, least",
        ),
        _claim(
            "push-moved", "moved", "way", Bound(">=", 2.0), "m",
            "w + 1 robots abreast drive up from 0.15 m and push parallel, w = 0, 1, 2; way of the "
            "disc in 5 s of contact, shortest",
        ),
        _claim(
            "push-moved-from-rest", "moved-from-rest", "way", Bound(">=", 1.5), "m",
            "the same from rest and in contact; shortest",
        ),
        _claim(
            "push-moved-from-rest-2m", "moved-from-rest", "way", Bound(">=", 2.0), "m",
            "the same with the bound of the run-up; written when its values had been seen",
        ),
        _claim(
            "push-wedged", "wedged", "way", Bound("<=", 0.4), "m",
            "one robot 60, 67.5, 75 degrees off the normal of a weight of 1, 20 s; way of the "
            "disc, furthest: real of wheels that do not slip sideways",
        ),
        _claim(
            "push-wedged-anywhere", "wedged-anywhere", "way", Bound("<=", 0.4), "m",
            "the same at angles drawn from 20 to 85 degrees; written when push-wedged had held",
        ),
        Claim(
            id="push-timestep",
            text=_WORDS,
            how="push-moved: mean way at 5 ms / at 10 ms - 1, furthest from 0 over w and direction",
            bound=Bound.within(-5.0, 5.0),
            bound_source="ours",
            unit="%",
            sizes=_LARGE,
            needs={"task": "moved", "dt_ms": TIMESTEPS},
            evaluate=_timestep,
        ),
    ]  # fmt: skip


def _claim(id: str, task: str, metric: str, bound: Bound, unit: str, how: str) -> Claim:
    return Claim(
        id=id,
        text=_WORDS,
        how=how,
        bound=bound,
        bound_source="ours",
        unit=unit,
        sizes=_ALL,
        needs={"task": task},
        evaluate=lambda table: _worst(table, metric, bound),
    )


def _worst(table: Table, metric: str, bound: Bound) -> Evidence:
    """The value of all trials that is furthest outside the bound, or nearest to it."""
    values = [float(v) for v in table.values(metric)]
    return Evidence(min(values, key=bound.margin), n=len(values))


def _timestep(table: Table) -> Evidence:
    changes = []
    for weight in WEIGHTS:
        for heading in HEADINGS:
            part = table.where(weight=weight, heading_deg=heading)
            coarse, fine = (_mean(part.where(dt_ms=dt)) for dt in TIMESTEPS)
            changes.append(100.0 * (fine / coarse - 1.0))
    return Evidence(max(changes, key=abs), n=len(table))


def _mean(table: Any) -> float:
    return float(np.mean(table.values("way")))
