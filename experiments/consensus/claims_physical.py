"""Claims of three four-wheelers in MuJoCo; formation offsets are removed from every figure."""

from typing import Any

from experiments.consensus import quotes
from experiments.consensus.evidence import Measure, largest, least, mean, total
from mjmr.claims import Bound, Claim

BODY: dict[str, Any] = {
    "mode": "physical", "experiment": "three", "sight": "given", "side": 2.0, "avoid": "none",
    "places": "outward",
}  # fmt: skip
WELL: dict[str, Any] = {
    **BODY, "calibrated": True, "noise": 0.0, "loss": 0.0, "delay": 0.0, "fault": "none",
}  # fmt: skip
TURNS: dict[str, Any] = {**WELL, "schedule": "alternate"}
ALL: dict[str, Any] = {**BODY, "calibrated": True, "fault": "none"}
LITERAL: dict[str, Any] = {**TURNS, "side": 0.0, "virtual": True}
FIVE: dict[str, Any] = {**TURNS, "dwell": 5.0}
ABSENT = quotes.ABSENT


def claim(
    name: str, how: str, bound: Bound, needs: dict[str, Any], measure: Measure, unit: str = "m",
    text: str = quotes.ONE_POINT, **more: Any,
) -> Claim:  # fmt: skip
    """A claim of runs in MuJoCo: its id, how it is measured, and what decides it."""
    return Claim(
        id=name, text=text, how=how, bound=bound, unit=unit, needs=needs, evaluate=measure, **more
    )


def claims() -> list[Claim]:
    """Every claim of this module."""
    every = ("quick", "standard", "full")
    noisy = {**FIVE, "noise": 0.05}
    return [
        claim("body-spread", "dwell 5 s, 80 s; spread at the end, largest", Bound("<=", 0.02),
               FIVE, largest("spread_m"), sizes=every),
        claim("body-error", "the same, mean of the outputs less the linear model's, largest",
               Bound("<=", 0.05), FIVE, largest("error_m"), sizes=every),
        claim("body-line", "the same, distance from the line x + 2 y = 12, largest",
               Bound("<=", 0.05), FIVE, largest("line_m"), sizes=every, text=quotes.SHARED),
        claim("body-dwells-spread", "dwell 2 and 20 s, the same", Bound("<=", 0.02),
               {**TURNS, "dwell": (2.0, 20.0)}, largest("spread_m")),
        claim("body-dwells-error", "dwell 2 and 20 s, the same", Bound("<=", 0.05),
               {**TURNS, "dwell": (2.0, 20.0)}, largest("error_m")),
        claim("body-contacts", "contacts of two robots, all runs of leaders in turn, calibrated, "
               "without noise, loss, delay and faults, sum",
               Bound("<=", 0.0), TURNS, total("contacts"), "", ABSENT + "no robot touches another",
               sizes=every),
        claim("body-distance", "least distance of two middles, the same runs",
               Bound(">=", 1.0), TURNS, least("least_distance_m"), sizes=every,
               text=ABSENT + "a triangle of 2.0 m keeps robots apart"),
        claim("body-contacts-all", "written later: the same of all calibrated runs without faults, "
               "cases i and ii, noise, loss and delay among them, sum", Bound("<=", 0.0), ALL,
               total("contacts"), "", ABSENT + "no robot touches another"),
        claim("body-distance-all", "written later: least distance of two middles, all these runs",
               Bound(">=", 1.0), ALL, least("least_distance_m"),
               text=ABSENT + "a triangle of 2.0 m keeps robots apart"),
        claim("body-other-dwells-spread", "written later: dwell 0.5, 1 and 10 s, the same spread",
               Bound("<=", 0.02), {**TURNS, "dwell": (0.5, 1.0, 10.0)}, largest("spread_m")),
        claim("body-other-dwells-error", "written later: dwell 0.5, 1 and 10 s, mean of the "
               "outputs less the linear model's, largest", Bound("<=", 0.05),
               {**TURNS, "dwell": (0.5, 1.0, 10.0)}, largest("error_m")),
        claim("literal-meets", "written later: no offsets, robots that pass through each other; "
               "spread at 80 s, largest", Bound("<=", 0.10), LITERAL, largest("spread_m")),
        claim("literal-point", "the same, mean of the hands less the linear model's, largest",
               Bound("<=", 0.25), LITERAL, largest("error_m")),
        claim("literal-line", "the same, distance from the line x + 2 y = 12, largest",
               Bound("<=", 0.15), LITERAL, largest("line_m"), text=quotes.SHARED),
        claim("body-case-i", "case i alone: mean of the outputs less robot 1's start, largest",
               Bound("<=", 0.02), {**WELL, "schedule": "case-i"}, largest("error_m"),
               text=quotes.LEADER),
        claim("body-case-ii", "case ii alone: mean of the outputs less robot 2's start, largest",
               Bound("<=", 0.02), {**WELL, "schedule": "case-ii"}, largest("error_m"),
               text=quotes.LEADER),
        claim("body-cases-spread", "case i or ii alone, spread at 80 s, largest",
               Bound("<=", 0.02), {**WELL, "schedule": ("case-i", "case-ii")},
               largest("spread_m")),
        claim("body-channels", "dwell 5 s; least difference of x and y", Bound(">=", 0.05),
               FIVE, least("channel_gap_m"), sizes=every,
               text=quotes.CHANNELS),
        claim("body-hull", "the same, how far a channel is outside of its starts, largest",
               Bound("<=", 0.0), FIVE, largest("outside_m"), sizes=every,
               text=quotes.HULL),
        claim("body-uncalibrated", "servos reckon with the track itself; spread, largest",
               Bound("<=", 0.02), {**FIVE, "calibrated": False}, largest("spread_m"),
               text=ABSENT + "hand control forgives scrubbing wheels"),
        claim("body-uncalibrated-error", "the same, less the linear model's, mean",
               Bound("<=", 0.25), {**FIVE, "calibrated": False}, mean("error_m"),
               text=ABSENT + "hand control forgives scrubbing wheels"),
        claim("noise", "5 cm of noise on every told position; spread, largest",
               Bound("<=", 0.05), noisy, largest("spread_m"), sizes=every,
               text=ABSENT + "noisy communication"),
        claim("loss", "half of all messages lost, the last held; spread, largest",
               Bound("<=", 0.05), {**FIVE, "loss": 0.5}, largest("spread_m"),
               text=ABSENT + "intermittent communication"),
        claim("delay", "messages 0.5 s late; spread, largest", Bound("<=", 0.05),
               {**FIVE, "delay": 0.5}, largest("spread_m"), text=ABSENT + "communication delay"),
        claim("all-three", "noise, loss and delay together; spread, largest",
               Bound("<=", 0.05), {**noisy, "loss": 0.5, "delay": 0.5}, largest("spread_m"),
               text=ABSENT + "noise, loss and delay"),
        claim("dead-follower", "robot 3 dies at 10 s; spread of the others, largest",
               Bound("<=", 0.05), {**FIVE, "fault": "follower-dies"}, largest("pair_spread_m"),
               text=ABSENT + "a robot without weight can fail"),
        claim("dead-follower-error", "the same, the others' mean less the linear model's, largest",
               Bound("<=", 0.05), {**FIVE, "fault": "follower-dies"}, largest("pair_error_m"),
               text=ABSENT + "a robot without weight can fail"),
        claim("frozen-leader", "robot 1 stops at 10 s and goes on talking; the others' distance "
               "from it at 80 s, largest", Bound("<=", 0.10),
               {**FIVE, "fault": "leader-freezes"}, largest("leader_error_m"),
               text=ABSENT + "a frozen leader becomes the rendezvous"),
        claim("peak-speed", "fastest robot, all runs of leaders in turn, calibrated, without "
               "noise, loss, delay and faults", Bound("<=", 1.0),
               TURNS, largest("peak_speed"), "m/s", ABSENT + "1 m/s and 2 rad/s are enough",
               sizes=every),
        claim("peak-turn", "fastest turn, the same", Bound("<=", 2.0), TURNS,
               largest("peak_turn"), "rad/s", ABSENT + "1 m/s and 2 rad/s are enough", sizes=every),
    ]  # fmt: skip
