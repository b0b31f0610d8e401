"""Claims of teams with the paper's own senses but for the camera: sonars, odometers, and both.

The paper's trucks have odometers for their pose, a camera for the perimeter and sonars for what
they might hit. The demands are those of the claims on the fan and the localizer, bounds ours. They
were written after trials of seeds from 1000 on had been seen, and before any other of these.
"""

from collections.abc import Mapping
from typing import Any

from experiments.perimeter.conditions import JOIN, PLAIN, STAY
from experiments.perimeter.evidence import (
    both,
    extreme,
    flags,
    joined_and_found,
    share,
    untouched,
)
from mjmr.claims import Bound, Claim

SENSES: dict[str, tuple[Mapping[str, Any], str]] = {
    "sonars": ({"obstacles": "sonars"}, "eight sonars for who is near, poses of the localizer"),
    "odometry": (
        {"localization": "odometry"},
        "poses by the counts of the rear wheels from the known start, the fan for who is near",
    ),
    "suite": (
        {"obstacles": "sonars", "localization": "odometry"},
        "odometers and sonars, as in the paper, with rays in place of its camera",
    ),
    "compass": (
        {"localization": "odometry-compass"},
        "as odometry, headings by a compass of 0.02 rad of noise",
    ),
}
SEARCHED = {
    **PLAIN, "task": "stay", "start": "scattered", "radius": 10.0, "growth": 0.0, "duration": 900.0,
}  # fmt: skip
DRIFTS = {"odometry": 3.0, "suite": 3.0, "compass": 0.5}  # m; 3 m is D_sen


def senses() -> list[Claim]:
    """Every one."""
    found = []
    for name, (given, words) in SENSES.items():
        found += _joining(name, given, words)
        if name != "compass":
            found += _spreading(name, given, words)
    for name in ("sonars", "suite", "odometry"):
        given, words = SENSES[name]
        found.append(
            Claim(
                id=f"even-after-search-{name}",
                text="the swarm will attempt to uniformly distribute around the perimeter",
                how=f"{words}; scattered over the hall, static disc, 900 s: trials that end with "
                "gaps within +-10 %, poses having drifted in the search if by odometers",
                bound=Bound(">=", 100.0),
                unit="%",
                needs={**SEARCHED, **given},
                evaluate=share(flags("even")),
            )
        )
    for name, bound in DRIFTS.items():
        given, words = SENSES[name]
        found.append(
            Claim(
                id=f"drift-{name}",
                text="odometers (pose)",
                how=f"{words}, finding a static disc: how far a truck is off in the end, by dead "
                "reckoning from its wheels, without the bus between; worst truck of all trials",
                bound=Bound("<", bound),
                unit="m",
                needs={**JOIN, **given},
                evaluate=extreme("drift_worst_m"),
            )
        )
    return found


def _joining(name: str, given: Mapping[str, Any], words: str) -> list[Claim]:
    needs = {**JOIN, **given}
    return [
        Claim(
            id=f"all-track-{name}",
            text="all robots are initially searching ... five robots tracking the perimeter",
            how=f"as all-track: {words}",
            bound=Bound(">=", 90.0),
            unit="%",
            needs=needs,
            evaluate=share(flags("all_track")),
        ),
        Claim(
            id=f"relay-and-alone-{name}",
            text="robot 3 is within range and receives the location ... robots 1 and 5 locate the "
            "perimeter on their own",
            how=f"as relay-and-alone: {words}",
            bound=Bound(">=", 90.0),
            unit="%",
            needs=needs,
            evaluate=share(joined_and_found),
        ),
        Claim(
            id=f"rms-{name}",
            text="the robots move slower in this state to accurately track the perimeter",
            how=f"as rms-static: {words}",
            bound=Bound("<", 0.05),
            unit="m",
            needs=needs,
            evaluate=extreme("rms_m"),
        ),
        Claim(
            id=f"contact-{name}",
            text="without collisions",
            how=f"{words}, finding a static disc: trials without any contact of trucks with each "
            "other, walls or the spill",
            bound=Bound(">=", 100.0),
            unit="%",
            needs=needs,
            evaluate=share(untouched),
        ),
    ]


def _spreading(name: str, given: Mapping[str, Any], words: str) -> list[Claim]:
    needs = {**STAY, **given}
    return [
        Claim(
            id=f"even-and-stopped-{name}",
            text="when the swarm is uniformly distributed, it stops",
            how=f"as chord-even-and-stopped: {words}",
            bound=Bound(">=", 100.0),
            unit="%",
            needs=needs,
            evaluate=share(both(flags("even"), flags("stopped"))),
        ),
        Claim(
            id=f"contact-stay-{name}",
            text="without collisions",
            how=f"{words}, 600 s on a static disc from a bunch: trials without any contact",
            bound=Bound(">=", 100.0),
            unit="%",
            needs=needs,
            evaluate=share(untouched),
        ),
    ]
