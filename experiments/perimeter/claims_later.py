"""Claims that stand beside others, written after quick's seed 0 and half a standard run were seen.

What they ask for is what the first ones left out: an interval, the states in the end, contacts in
other experiments, a sixth truck. Their bounds are those of the claims they stand beside.
"""

import dataclasses

import numpy as np

from experiments.perimeter.conditions import DRIVEN, JOIN, PLAIN, STAY
from experiments.perimeter.evidence import (
    both,
    extreme,
    flags,
    joined_and_found,
    share,
    share_interval,
    untouched,
)
from experiments.perimeter.sizes import AFTERWARDS, GROWTH, LATER, SIXTH
from mjmr.claims import Bound, Claim
from mjmr.table import Table


def later() -> list[Claim]:
    """Every one; each says when it was written."""
    found = [
        *_envelope(),
        *_joining(),
        *_contacts(),
        *_changes(),
        *_failures(),
    ]
    return [dataclasses.replace(c, how=f"{c.how}; written {AFTERWARDS}") for c in found]


def _envelope() -> list[Claim]:
    """What quick shows of a truck's limits, decided by one seed that had been seen."""
    told = (
        ("turn", "-0.3 <= w <= 0.3 rad/s, measured on the platform", "0.3 rad/s",
         "largest turn rate over 0.5 s", Bound("<=", 0.305), "rad/s", "top_turn"),
        ("speed", "0 <= v <= 2 m/s", "2 m/s",
         "largest speed over 0.5 s", Bound("<=", 2.0), "m/s", "top_speed"),
        ("radius", "turn rate 0.3 rad/s at 1 m/s", "3.33 m",
         "radius of the circle at 1 m/s and 0.3 rad/s", Bound.within(3.0, 3.67), "m", "radius_m"),
    )  # fmt: skip
    return [
        Claim(
            id=f"envelope-{name}-quick",
            text=text,
            published=published,
            how=f"as envelope-{name}: {words}, one seed",
            bound=bound,
            unit=unit,
            sizes=("quick",),
            needs=DRIVEN,
            evaluate=extreme(metric),
        )
        for name, text, published, words, bound, unit, metric in told
    ]


def _joining() -> list[Claim]:
    found = []
    for name, test in (("all-track", flags("all_track")), ("relay-and-alone", joined_and_found)):
        found.append(
            Claim(
                id=f"{name}-interval",
                text="all robots are initially searching ... five robots tracking the perimeter",
                how=f"as {name}, with Wilson's interval of the share, which decides",
                bound=Bound(">=", 90.0),
                unit="%",
                needs=JOIN,
                evaluate=share_interval(test),
            )
        )
    return [
        *found,
        Claim(
            id="odometry-drifts",
            text="odometers (pose)",
            how="the counts of the rear wheels integrated from start to end, by which nobody "
            "steers: mean distance from where the trucks are in the end; largest of trials",
            bound=Bound.within(0.001, 50.0),
            unit="m",
            needs=JOIN,
            evaluate=extreme("drift_m"),
        ),
        Claim(
            id="all-track-stiff",
            text="(ours) the gain of the approach does not matter",
            how="as all-track with k = 0.3 in place of 0.3 / 2 pi; few seeds, of one of which it "
            "had been seen that a truck never joined",
            bound=Bound(">=", 90.0),
            unit="%",
            needs={**JOIN, "gain": "stiff"},
            evaluate=share(flags("all_track")),
        ),
    ]


def _contacts() -> list[Claim]:
    found = []
    for name, words, needs in (
        ("join-growing", "finding a disc that grows", {**JOIN, "growth": GROWTH}),
        ("stay", "600 s on a static disc from a bunch", STAY),
        ("camera", "tracking by pictures", {**STAY, "sensing": "camera", "duration": 120.0}),
        ("lobes", "finding and following three discs that overlap", {**JOIN, "edge": "lobes"}),
    ):
        found.append(
            Claim(
                id=f"contact-{name}",
                text="without collisions",
                how=f"{words}: trials without any contact of trucks with each other, walls or the "
                "spill",
                bound=Bound(">=", 100.0),
                unit="%",
                needs=needs,
                evaluate=share(untouched),
            )
        )
    return found


def _changes() -> list[Claim]:
    return [
        Claim(
            id="reconfigures-sixth",
            text="if robots are added or deleted, then the swarm will reconfigure until the "
            "perimeter is uniformly surrounded",
            how="a sixth, 15 m off, is switched on after 60 s beside five that stand evenly, d_des "
            "given as the even chord of six: trials even again (+-10 %) 600 s later",
            bound=Bound(">=", 100.0),
            unit="%",
            needs={**PLAIN, "task": "stay", "start": "even", "robots": 6, "factor": SIXTH,
                   "failure": "added", "duration": LATER},
            evaluate=share(flags("even")),
        )
    ]  # fmt: skip


def _failures() -> list[Claim]:
    end = flags("all_track_end")
    return [
        Claim(
            id="plugged-goes-on-end",
            text="sensors and actuators can be added with no reconfiguration required",
            how="the camera plugged in again: trials in which its truck moves on after the manager "
            "reported that, and all five are in TRACKING at the last tick",
            bound=Bound(">=", 100.0),
            unit="%",
            needs={**JOIN, "failure": "camera"},
            evaluate=share(both(flags("again"), end)),
        ),
        Claim(
            id="false-location-end",
            text="(ours) a told location that shows nothing is given up",
            how="one truck is told a corner: trials in which it goes from there back to SEARCHING, "
            "and all five are in TRACKING at the last tick",
            bound=Bound(">=", 100.0),
            unit="%",
            needs={**JOIN, "failure": "lie"},
            evaluate=share(both(_gave_up, end)),
        ),
    ]


def _gave_up(table: Table) -> np.ndarray:
    return np.asarray(table.values("gave_up_s")) > 0
