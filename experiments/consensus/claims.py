"""What is claimed of consensus: the theory here, robots in :mod:`.claims_physical`.

The paper reports one figure without numbers. Bounds are ours; reference values were computed from
the restored linear system.
"""

from typing import Any

from experiments.consensus import (
    claims_beyond,
    claims_moving,
    claims_physical,
    claims_reference,
    claims_theory,
    quotes,
)
from experiments.consensus.claims_theory import EVERY, LINEAR
from experiments.consensus.evidence import largest, least, off, off_point, off_values
from mjmr.claims import Bound, Claim

THREE: dict[str, Any] = {
    **LINEAR, "experiment": "three", "weight": 0.2, "weight_y": 0.0, "degrees": "2",
}  # fmt: skip
REFERENCE = {
    0.5: (4.050, 3.975), 1.0: (4.101, 3.949), 2.0: (4.205, 3.898), 5.0: (4.511, 3.744),
    10.0: (4.964, 3.518), 20.0: (5.567, 3.217),
}  # fmt: skip


def claims() -> list[Claim]:
    """Every claim of the study."""
    return [
        *_table(),
        *claims_theory.claims(),
        *_negatives(),
        *claims_physical.claims(),
        *claims_beyond.claims(),
        *claims_moving.claims(),
        *claims_reference.claims(),
    ]


def _table() -> list[Claim]:
    table = {**THREE, "schedule": "alternate"}
    return [
        Claim(
            id="linear-table",
            text=quotes.ONE_POINT,
            how="linear model, 300 s; consensus point less the table's, six dwells, largest",
            bound=Bound("<=", 0.01),
            unit="m",
            sizes=EVERY,
            needs={**table, "dwell": tuple(REFERENCE)},
            evaluate=off(REFERENCE),
        ),
        Claim(
            id="linear-line",
            text=quotes.SHARED,
            how="the same runs, |x + 2 y - 12|, largest",
            bound=Bound("<=", 1e-6),
            unit="m",
            sizes=EVERY,
            needs={**table, "dwell": tuple(REFERENCE)},
            evaluate=largest("line_m"),
        ),
        Claim(
            id="linear-time",
            text=quotes.ABSENT + "how soon hands are within 1 cm of each other",
            how="the same runs, time to a spread of 1 cm less the table's, largest",
            bound=Bound("<=", 1.0),
            unit="s",
            sizes=EVERY,
            needs={**table, "dwell": tuple(REFERENCE)},
            evaluate=off_values(
                "near_s", "dwell", {d: 65.0 if d == 20.0 else 58.0 for d in REFERENCE}
            ),
        ),
        Claim(
            id="linear-case-i",
            text=quotes.LEADER,
            how="case i for ever, consensus less robot 1's start",
            bound=Bound("<=", 0.01),
            unit="m",
            sizes=EVERY,
            needs={**THREE, "schedule": "case-i"},
            evaluate=off_point(6.0, 3.0),
        ),
        Claim(
            id="linear-case-ii",
            text=quotes.LEADER,
            how="case ii for ever, consensus less robot 2's start",
            bound=Bound("<=", 0.01),
            unit="m",
            sizes=EVERY,
            needs={**THREE, "schedule": "case-ii"},
            evaluate=off_point(2.0, 5.0),
        ),
        Claim(
            id="linear-channels",
            text=quotes.CHANNELS,
            how="six dwells, least difference of x and y",
            bound=Bound(">=", 0.05),
            unit="m",
            sizes=EVERY,
            needs={**table, "dwell": tuple(REFERENCE)},
            evaluate=least("channel_gap_m"),
        ),
        Claim(
            id="linear-hull",
            text=quotes.HULL,
            how="six dwells, how far a channel is outside of its starts, largest",
            bound=Bound("<=", 0.0),
            unit="m",
            sizes=EVERY,
            needs={**table, "dwell": tuple(REFERENCE)},
            evaluate=largest("outside_m"),
        ),
        Claim(
            id="linear-random-leader",
            text=quotes.ABSENT + "leaders may be drawn at random",
            how="another leader of three every second, at random; largest spread after 300 s",
            bound=Bound("<=", 1e-3),
            unit="m",
            sizes=EVERY,
            needs={**THREE, "schedule": "random-leader", "dwell": 1.0},
            evaluate=largest("spread_m"),
        ),
        Claim(
            id="linear-joint",
            text=quotes.ABSENT + "the condition is sufficient, not necessary",
            how="only ever one link, 1-2 and 2-3 in turn, which never meets it: consensus less "
            "robot 1's start",
            bound=Bound("<=", 0.01),
            unit="m",
            sizes=EVERY,
            needs={**THREE, "schedule": "joint"},
            evaluate=off_point(6.0, 3.0),
        ),
    ]


def _negatives() -> list[Claim]:
    return [
        Claim(
            id="isolated-stays",
            text=quotes.HEARS,
            how="robot 3 hears nobody, dwell 2 s, 300 s; spread",
            bound=Bound.within(1.90, 1.92),
            unit="m",
            sizes=EVERY,
            needs={**THREE, "schedule": "isolated", "dwell": 2.0},
            evaluate=largest("spread_m"),
        ),
        Claim(
            id="decaying-stays",
            text=quotes.ABSENT + "gains that fade are nonzero for ever and too weak all the same",
            how="gains 0.2 x 0.5^k, dwell 2 s, 300 s; spread",
            bound=Bound(">=", 2.5),
            unit="m",
            sizes=EVERY,
            needs={**THREE, "schedule": "decaying", "dwell": 2.0},
            evaluate=largest("spread_m"),
        ),
        Claim(
            id="mixed-channels-merge",
            text=quotes.ABSENT + "without the diagonal blocks of Assumption 4.1 channels merge",
            how="a tenth of each own weight goes to the other channel: difference of x and y",
            bound=Bound("<=", 1e-3),
            unit="m",
            sizes=EVERY,
            needs={**LINEAR, "experiment": "mixed-channels"},
            evaluate=largest("channel_gap_m"),
        ),
        Claim(
            id="unequal-gains",
            text=quotes.ABSENT + "channels with gains of their own",
            how="0.2 in x, 0.5 in y, dwell 5 s; consensus point less that",
            bound=Bound("<=", 0.01),
            unit="m",
            sizes=EVERY,
            needs={**LINEAR, "experiment": "three", "schedule": "alternate", "weight_y": 0.5},
            evaluate=off_point(4.511, 3.387),
        ),
        Claim(
            id="unequal-degrees",
            text="beyond the paper: unequal relative degrees",
            how="l_i = 1 2 3 and 3 1 2, dwell 5 s, 800 s; largest spread",
            bound=Bound("<=", 1e-3),
            unit="m",
            sizes=EVERY,
            needs={**LINEAR, "experiment": "three", "degrees": ("1 2 3", "3 1 2")},
            evaluate=largest("spread_m"),
        ),
        Claim(
            id="unequal-degrees-line",
            text="beyond the paper: unequal relative degrees",
            how="the same, |x + 2 y - 12|, largest: robot 3 still has no weight",
            bound=Bound("<=", 1e-6),
            unit="m",
            sizes=EVERY,
            needs={**LINEAR, "experiment": "three", "degrees": ("1 2 3", "3 1 2")},
            evaluate=largest("line_m"),
        ),
    ]
