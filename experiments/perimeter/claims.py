"""What is claimed of the team, how it is measured, and the bounds that decide it.

The paper has no tables: its statements are words about figures whose numbers are lost. Bounds are
ours, those of a reference run where there is one, and were fixed before the runs that decide them.
"""

import numpy as np

from experiments.perimeter.claims_all import everywhere
from experiments.perimeter.claims_beyond import beyond
from experiments.perimeter.claims_later import later
from experiments.perimeter.claims_room import in_the_middle
from experiments.perimeter.claims_seen import seen
from experiments.perimeter.claims_senses import senses
from experiments.perimeter.claims_sweep import swept
from experiments.perimeter.conditions import DRIVEN, JOIN, LITERAL, N1, STAY
from experiments.perimeter.evidence import (
    both,
    extreme,
    flags,
    joined_and_found,
    share,
    total,
)
from experiments.perimeter.sizes import GROWTH
from mjmr.claims import Bound, Claim

_BUNCH = "five trucks on the edge of a static disc of 10 m, 3.6 to 4.5 m apart, 600 s"


def claims() -> list[Claim]:
    """Every claim of the study."""
    return [
        *_envelope(),
        *_joining(),
        *_tracking(),
        *_spreading(),
        *_contacts(),
        *_changes(),
        *_failures(),
        *beyond(),
        *later(),
        *swept(),
        *in_the_middle(),
        *seen(),
        *everywhere(),
        *senses(),
    ]


def _envelope() -> list[Claim]:
    return [
        Claim(
            id="envelope-turn",
            text="-0.3 <= w <= 0.3 rad/s, measured on the platform",
            published="0.3 rad/s",
            how="commands drawn at random, up to 2.5 m/s and 0.5 rad/s: largest turn rate over "
            "0.5 s; trials with the largest",
            bound=Bound("<=", 0.305),
            unit="rad/s",
            needs=DRIVEN,
            evaluate=extreme("top_turn"),
        ),
        Claim(
            id="envelope-speed",
            text="0 <= v <= 2 m/s",
            published="2 m/s",
            how="the same: largest speed of the rear axle's middle over 0.5 s",
            bound=Bound("<=", 2.0),
            unit="m/s",
            needs=DRIVEN,
            evaluate=extreme("top_speed"),
        ),
        Claim(
            id="envelope-radius",
            text="turn rate 0.3 rad/s at 1 m/s",
            published="3.33 m",
            how="radius of the circle at 1 m/s and 0.3 rad/s; largest of trials",
            bound=Bound.within(3.0, 3.67),
            unit="m",
            needs=DRIVEN,
            evaluate=extreme("radius_m"),
        ),
        Claim(
            id="team-turn",
            text="-0.3 <= w <= 0.3 rad/s",
            published="0.3 rad/s",
            how="the same in every trial in which a team finds a static disc",
            bound=Bound("<=", 0.305),
            unit="rad/s",
            needs=JOIN,
            evaluate=extreme("top_turn"),
        ),
        Claim(
            id="team-speed",
            text="0 <= v <= 2 m/s",
            published="2 m/s",
            how="the same",
            bound=Bound("<=", 2.0),
            unit="m/s",
            needs=JOIN,
            evaluate=extreme("top_speed"),
        ),
    ]


def _joining() -> list[Claim]:
    return [
        Claim(
            id="all-track",
            text="all robots are initially searching ... five robots tracking the perimeter",
            how="seeds in which all five go from SEARCHING to TRACKING within 900 s",
            bound=Bound(">=", 90.0),
            unit="%",
            needs=JOIN,
            evaluate=share(flags("all_track")),
        ),
        Claim(
            id="relay-and-alone",
            text="robot 3 is within range and receives the location ... robots 1 and 5 locate the "
            "perimeter on their own",
            how="seeds in which all five track, at least one was told by radio and at least one "
            "was not",
            bound=Bound(">=", 90.0),
            unit="%",
            needs=JOIN,
            evaluate=share(joined_and_found),
        ),
        Claim(
            id="finder-first",
            text="robot 4 locates the perimeter first",
            how="seeds in which every robot that was told tracks later than the first one sensed",
            bound=Bound(">=", 100.0),
            unit="%",
            needs=JOIN,
            evaluate=share(flags("finder_first")),
        ),
        Claim(
            id="all-track-growing",
            text="five robots tracking a dynamic perimeter that is expanding at 0.0125 m/s",
            how="as all-track, the disc growing from 10 m",
            bound=Bound(">=", 90.0),
            unit="%",
            needs={**JOIN, "growth": GROWTH},
            evaluate=share(flags("all_track")),
        ),
    ]


def _tracking() -> list[Claim]:
    rms = "distance of the look-ahead point from the edge, rms from 30 s after joining; worst trial"
    found = []
    for name, needs, bound, words in (
        ("static", JOIN, 0.05, "disc of 10 m"),
        ("static-20m", {**JOIN, "radius": 20.0}, 0.05, "disc of 20 m"),
        ("growing", {**JOIN, "growth": GROWTH}, 0.15, "disc that grows by 0.0125 m/s"),
        (
            "camera",
            {**STAY, "sensing": "camera", "duration": 120.0},
            0.05,
            "rendered pictures of 160 x 120 at 5 Hz and a red mask, disc of 10 m",
        ),
    ):
        found.append(
            Claim(
                id=f"rms-{name}",
                text="the robots move slower in this state to accurately track the perimeter",
                how=f"{words}: {rms}",
                bound=Bound("<", bound),
                unit="m",
                needs=needs,
                evaluate=extreme("rms_m"),
            )
        )
    return [
        *found,
        Claim(
            id="rms-with-joining",
            text="track the perimeter",
            how="disc of 10 m: the same from the moment of joining; worst trial",
            bound=Bound("<", 0.25),
            unit="m",
            needs=JOIN,
            evaluate=extreme("rms_join_m"),
        ),
        Claim(
            id="anticlockwise",
            text="track the perimeter counterclockwise",
            how="angle about the disc's centre that all trucks together advance while they track, "
            "least of trials",
            bound=Bound(">", 0.0),
            unit="rad",
            needs=JOIN,
            evaluate=extreme("anticlockwise_rad", min),
        ),
    ]


def _spreading() -> list[Claim]:
    even, stopped = flags("even"), flags("stopped")
    return [
        Claim(
            id="chord-even-and-stopped",
            text="when the swarm is uniformly distributed, it stops",
            how=f"{_BUNCH}; d_des = (1 - .05 / 4) x the even chord: trials that end with gaps "
            "within +-10 % and nobody moving for 30 s",
            bound=Bound(">=", 100.0),
            unit="%",
            needs=STAY,
            evaluate=share(both(even, stopped)),
        ),
        Claim(
            id="too-high-surrounds-and-moves",
            text="if d_des is too high, the swarm will surround the perimeter, but continue moving",
            how="the same with d_des = 1.2 x the chord: even, and not stopped",
            bound=Bound(">=", 100.0),
            unit="%",
            needs={**STAY, "factor": 1.2},
            evaluate=share(both(even, flags("stopped", False))),
        ),
        Claim(
            id="too-low-does-not-surround",
            text="if d_des is too low, the swarm will not surround the perimeter",
            how="the same with d_des = 0.8 x the chord: uneven, and stopped",
            bound=Bound(">=", 100.0),
            unit="%",
            needs={**STAY, "factor": 0.8},
            evaluate=share(both(flags("even", False), stopped)),
        ),
        Claim(
            id="literal-spreads",
            text="the swarm will attempt to uniformly distribute around the perimeter (equation 8 "
            "as printed)",
            how=f"{_BUNCH}; the literal rule, d_des = (1 - .05 / 4) x the chord: trials that end "
            "evenly; the reference run expects none",
            bound=Bound(">=", 100.0),
            unit="%",
            needs=LITERAL,
            evaluate=share(even),
        ),
        Claim(
            id="growing-never-stops",
            text="the swarm does not stop because the expanding perimeter is never uniformly "
            "surrounded",
            how="the disc growing, d_des that of 10 m, 600 s: longest time in which nobody moves",
            bound=Bound("<", 30.0),
            unit="s",
            needs={**STAY, "growth": GROWTH},
            evaluate=extreme("longest_stop_s"),
        ),
        Claim(
            id="growing-subgroups",
            text="subgroups are formed in this case because there are not enough robots",
            how="the same: largest gap over the mean gap in the end; least of trials",
            bound=Bound(">", 1.3),
            needs={**STAY, "growth": GROWTH},
            evaluate=extreme("gap_ratio", min),
        ),
    ]


def _contacts() -> list[Claim]:
    return [
        Claim(
            id="no-contact-trucks",
            text="since the robots can communicate, they should never get close enough to collide",
            how="contacts between trucks, all seeds on the static disc together",
            bound=Bound("<=", 0.0),
            needs=JOIN,
            evaluate=total("contacts"),
        ),
        Claim(
            id="no-contact-walls-spill",
            text="this way, they never drive into the perimeter",
            how="time that trucks touch walls or the spill, all seeds on the static disc together",
            bound=Bound("<=", 0.0),
            unit="s",
            needs=JOIN,
            evaluate=total("obstacle_contact_s"),
        ),
        Claim(
            id="no-contact-growing",
            text="without collisions",
            how="time that trucks touch walls or the spill that grows, 600 s from a bunch; all "
            "trials together",
            bound=Bound("<=", 0.0),
            unit="s",
            needs={**STAY, "growth": GROWTH},
            evaluate=total("obstacle_contact_s"),
        ),
    ]


def _changes() -> list[Claim]:
    found = []
    for kind, words in (
        ("removed", "one of five is lifted out after 60 s"),
        ("added", "a fifth, 15 m off, is switched on after 60 s beside four"),
    ):
        found.append(
            Claim(
                id=f"reconfigures-{kind}",
                text="if robots are added or deleted, then the swarm will reconfigure until the "
                "perimeter is uniformly surrounded",
                how=f"{words}, d_des estimated on line: trials even again (+-10 %) 600 s later",
                bound=Bound(">=", 100.0),
                unit="%",
                needs={**N1, "failure": kind},
                evaluate=share(flags("even")),
            )
        )
    return found


def _failures() -> list[Claim]:
    camera = {**JOIN, "failure": "camera"}
    return [
        Claim(
            id="unplugged-reported",
            text="the DMM checks the bus continuously to see if a sensor has been disconnected",
            how="the camera is unplugged while its truck tracks: until the manager reports it; "
            "longest",
            bound=Bound("<=", 1.0),
            unit="s",
            needs=camera,
            evaluate=extreme("reported_s"),
        ),
        Claim(
            id="unplugged-stops",
            text="all components are working properly",
            how="the same: way of that truck from 3 to 20 s after; longest",
            bound=Bound("<=", 0.01),
            unit="m",
            needs=camera,
            evaluate=extreme("stop_way_m"),
        ),
        Claim(
            id="plugged-goes-on",
            text="sensors and actuators can be added with no reconfiguration required",
            how="the same, plugged in again after 20 s: trials in which all five "
            "have joined by the end; plugged-goes-on-end asks for more",
            bound=Bound(">=", 100.0),
            unit="%",
            needs=camera,
            evaluate=share(flags("all_track")),
        ),
        Claim(
            id="radio-off-still-finds",
            text="robots 1 and 5 locate the perimeter on their own",
            how="all radios off: least number of the five that track within 900 s, of trials",
            bound=Bound(">=", 1.0),
            needs={**JOIN, "failure": "radio"},
            evaluate=extreme("tracking", min),
        ),
        Claim(
            id="false-location-given-up",
            text="(ours) a told location that shows nothing is given up",
            how="one truck is told a corner: trials in which it goes from there back to "
            "SEARCHING, and all five have joined by the end",
            bound=Bound(">=", 100.0),
            unit="%",
            needs={**JOIN, "failure": "lie"},
            evaluate=share(
                both(lambda table: np.asarray(table.values("gave_up_s")) > 0, flags("all_track"))
            ),
        ),
    ]
