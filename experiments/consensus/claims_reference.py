"""Claims on the numbers that the restored system gave beside its table, and on seeds unseen before.

Written after the verdicts of the others at size standard were known. Of runs with a delay of 2 s
and with nine of ten messages lost seeds 1000 to 1002 had been seen; the metrics of the linear model
that these claims ask for had not been looked at.
"""

from typing import Any

from experiments.consensus import quotes
from experiments.consensus.claims_beyond import AGREED, ALONE, SCAN, SIGHT
from experiments.consensus.claims_physical import ALL, FIVE, WELL, claim
from experiments.consensus.claims_theory import EVERY, LINEAR
from experiments.consensus.evidence import (
    SEEN_BEFORE,
    largest,
    off_point,
    off_values,
    outside,
    share,
    unseen,
)
from mjmr.claims import Bound, Claim

_THREE: dict[str, Any] = {
    **LINEAR, "experiment": "three", "weight": 0.2, "weight_y": 0.0, "degrees": "2",
}  # fmt: skip
_SOON = quotes.ABSENT + "how soon hands are within 1 cm of each other"
_MEET = quotes.ABSENT + "how soon hands are within 0.1 m of each other"
_ENOUGH = quotes.ABSENT + "1 m/s and 2 rad/s are enough"


def claims() -> list[Claim]:
    """Every claim of this module; later than the others, as each says."""
    return [*_times(), *_bad_radio(), *_peaks(), *_unseen()]


def _times() -> list[Claim]:
    fixed = {"case-i": 79.0, "case-ii": 80.0, "star": 58.0}
    return [
        claim("linear-time-fixed", "written later: cases i, ii and the star for ever, time to a "
              "spread of 1 cm less 79, 80 and 58 s, largest", Bound("<=", 1.0),
              {**_THREE, "schedule": tuple(fixed)}, off_values("near_s", "schedule", fixed), "s",
              _SOON, sizes=EVERY),
        claim("linear-time-joint", "written later: one link at a time, how far that time is "
              "outside of 157 to 160 s, largest", Bound("<=", 1.0), {**_THREE, "schedule": "joint"},
              outside("near_s", 157.0, 160.0), "s", _SOON, sizes=EVERY),
        claim("linear-time-random", "written later: another leader every second, at random: how "
              "far that time is outside of 56 to 64 s, largest", Bound("<=", 1.0),
              {**_THREE, "schedule": "random-leader", "dwell": 1.0}, outside("near_s", 56.0, 64.0),
              "s", _SOON, sizes=EVERY),
        claim("body-time", "written later: dwell 5 s, time to a spread of 0.1 m less 37 s, largest",
              Bound("<=", 3.0), FIVE, outside("near_s", 37.0, 37.0), "s", _MEET),
        claim("body-time-cases", "written later: case i or ii alone, how far that time is outside "
              "of 52 to 55 s, largest", Bound("<=", 3.0),
              {**WELL, "schedule": ("case-i", "case-ii")}, outside("near_s", 52.0, 55.0), "s",
              _MEET),
    ]  # fmt: skip


def _bad_radio() -> list[Claim]:
    late, lossy = {**FIVE, "delay": 2.0}, {**FIVE, "loss": 0.9}
    return [
        claim("late-point", "messages 2 s late: mean of the outputs less (4.134, 3.933), the "
              "linear model's if nothing is known before the first message; if starts are, it is "
              "(4.49, 3.76); largest", Bound("<=", 0.05), late, off_point(4.134, 3.933),
              text=quotes.ABSENT + "late messages"),
        claim("late-spread", "the same runs: spread at 80 s, largest", Bound("<=", 0.05), late,
              largest("spread_m"), text=quotes.ABSENT + "late messages"),
        claim("lossy-point", "nine of ten messages lost, the last held: mean of the outputs less "
              "(4.54, 3.73), which is one draw, largest", Bound("<=", 0.25), lossy,
              off_point(4.54, 3.73), text=quotes.ABSENT + "lost messages"),
        claim("lossy-spread", "the same runs: spread at 80 s, largest", Bound("<=", 0.05), lossy,
              largest("spread_m"), text=quotes.ABSENT + "lost messages"),
    ]  # fmt: skip


def _peaks() -> list[Claim]:
    how = "written later: {}, all calibrated runs without faults, noise, loss and delay among them"
    return [
        claim("peak-speed-all", how.format("fastest robot"), Bound("<=", 1.0), ALL,
              largest("peak_speed"), "m/s", _ENOUGH),
        claim("peak-turn-all", how.format("fastest turn"), Bound("<=", 2.0), ALL,
              largest("peak_turn"), "rad/s", _ENOUGH),
    ]  # fmt: skip


def _unseen() -> list[Claim]:
    """Shares by sight again, over seeds from 6 on alone: more were run after the first six."""
    agreed = unseen(share("spread_m", AGREED))
    how = f"written later: as {{}}, seeds from {SEEN_BEFORE} on alone, which had not been seen"
    told = {
        f"scan-{cone:g}": ({**SCAN, "cone_deg": cone}, Bound(">=", 0.7))
        for cone in (60.0, 90.0, 120.0)
    }
    told["cone-120-alone"] = ({**ALONE, "cone_deg": 120.0}, Bound.within(0.1, 0.9))
    return [
        claim(f"{name}-unseen", how.format(name), bound, needs, agreed, "", SIGHT)
        for name, (needs, bound) in told.items()
    ]
