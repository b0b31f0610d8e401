"""Claims beyond the paper: the formation law, d_des on line, other edges, wrong readings."""

from typing import Any

from experiments.perimeter.evidence import both, extreme, flags, gain_of_radio, share, total
from experiments.perimeter.sizes import AFTERWARDS, GROWTH, PATHS
from mjmr.claims import Bound, Claim

LAW = "(not in the paper) leader and two followers, separation-bearing law"
_SENSES = {"obstacles": "fan", "localization": "localizer"}
_BUNCH = {"task": "stay", "start": "bunch", "mode": "physical", "failure": "none", **_SENSES}
_DISC = {**_BUNCH, "radius": 10.0, "spacing": "repaired", "factor": 0.0, "sensing": "rays",
         "wrong": 0.0}  # fmt: skip


def beyond() -> list[Claim]:
    """Every one."""
    return [*_formation(), *_estimated(), *_senses(), *_edges()]


def _formation() -> list[Claim]:
    found = []
    for path, bound in (("straight", 0.1), ("circle", 0.1), ("eight", 0.3)):
        for heard, prefix, words in (
            ("extrapolated", "formation", ""),
            # the law as it was when the bounds were set; since then followers extrapolate
            ("plain", "formation-plain", ", what is heard of the leader taken as it is; written"
             f" {AFTERWARDS}"),
        ):  # fmt: skip
            found.append(
                Claim(
                    id=f"{prefix}-{path}",
                    text=LAW,
                    how=f"{path}, leader at 0.8 m/s, followers 2 m off at +-150 degrees: distance "
                    "of each follower's point from its place, rms from 30 s on; worst trial"
                    f"{words}",
                    bound=Bound("<=", bound),
                    unit="m",
                    needs=led(heard, path),
                    evaluate=extreme("place_rms_m"),
                )
            )
    return [
        *found,
        Claim(
            id="formation-eight-smooth",
            text=LAW,
            how="the eight without jumps of curvature, else as formation-eight; written "
            f"{AFTERWARDS}",
            bound=Bound("<=", 0.3),
            unit="m",
            needs=led("extrapolated", "eight-smooth"),
            evaluate=extreme("place_rms_m"),
        ),
        Claim(
            id="formation-contacts",
            text="(not in the paper) the same",
            how="contacts of trucks, all paths together",
            bound=Bound("<=", 0.0),
            needs=led("extrapolated", *PATHS),
            evaluate=total("contacts"),
        ),
        Claim(
            id="formation-plain-contacts",
            text="(not in the paper) the same",
            how="contacts of trucks, all paths together, what is heard taken as it is; written "
            f"{AFTERWARDS}",
            bound=Bound("<=", 0.0),
            needs=led("plain", *PATHS),
            evaluate=total("contacts"),
        ),
    ]


def led(heard: str, *paths: str) -> dict[str, Any]:
    """What claims on these paths of the leader need."""
    return {"task": "formation", "path": paths, "mode": "physical", "heard": heard}


def _estimated() -> list[Claim]:
    return [
        Claim(
            id="estimated-even-and-stopped",
            text="ideally, the swarm could dynamically change d_des depending on the perimeter",
            how="static disc of 10 m, 600 s from a bunch, d_des from who tracks and the circle "
            "tracked: trials that end evenly and stopped",
            bound=Bound(">=", 100.0),
            unit="%",
            needs={**_DISC, "estimated": True, "growth": 0.0, "duration": 600.0},
            evaluate=share(both(flags("even"), flags("stopped"))),
        ),
        Claim(
            id="estimated-growing-even",
            text="this should allow the swarm to uniformly distribute around most perimeters, "
            "static or dynamic",
            how="the disc growing by 0.0125 m/s: largest gap over the mean gap in the end; worst "
            "trial",
            bound=Bound("<=", 1.3),
            needs={**_DISC, "estimated": True, "growth": GROWTH, "duration": 600.0},
            evaluate=extreme("gap_ratio"),
        ),
        Claim(
            id="radio-helps",
            text="robot 3 is within range and receives the location",
            how="unicycle bodies, static disc: time until all five track without a radio less that "
            "with one of 25 m, paired by seed",
            bound=Bound(">", 0.0),
            unit="s",
            needs={
                "task": "join",
                "mode": "unicycle",
                "growth": 0.0,
                "failure": "none",
                **_SENSES,
            },
            evaluate=gain_of_radio,
        ),
    ]


def _senses() -> list[Claim]:
    return [
        Claim(
            id="rays-and-pictures-agree",
            text="the camera is used for tracking the perimeter",
            how="inside or outside by the ray and by the picture of the same instant, while "
            "tracking: share that agrees",
            bound=Bound(">=", 0.95),
            needs={**_BUNCH, "sensing": "both"},
            evaluate=extreme("agree"),
        ),
        Claim(
            id="wrong-readings",
            text="(ours) noisy plume edges",
            how="20 % of the ray's readings wrong, static disc of 10 m: rms from 30 s after "
            "joining; worst trial",
            bound=Bound("<", 0.05),
            unit="m",
            needs={**_BUNCH, "radius": 10.0, "growth": 0.0, "wrong": 0.2, "duration": 200.0},
            evaluate=extreme("rms_m"),
        ),
    ]


def _edges() -> list[Claim]:
    return [
        Claim(
            id="shrinking",
            text="(ours) shrinking edges",
            how="disc of 15 m that shrinks by 0.0125 m/s: rms from 30 s after joining; worst trial",
            bound=Bound("<", 0.15),
            unit="m",
            needs={
                **_BUNCH,
                "radius": 15.0,
                "growth": -GROWTH,
                "wrong": 0.0,
                "duration": 300.0,
            },
            evaluate=extreme("rms_m"),
        ),
        Claim(
            id="lobes",
            text="(ours) non-circular edges",
            how="three discs that overlap, of 6.5 to 7.5 m, two of the bays sharper than a truck "
            "turns: rms from 30 s after joining; worst trial",
            bound=Bound("<", 0.25),
            unit="m",
            needs={
                "task": "join",
                "edge": "lobes",
                "mode": "physical",
                "failure": "none",
                **_SENSES,
            },
            evaluate=extreme("rms_m"),
        ),
    ]
