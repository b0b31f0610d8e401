"""What is claimed of consensus: the theory here, robots in :mod:`.claims_physical`.

The paper reports one figure without numbers. Bounds are ours, those of the reproduction's
specification; so are the reference values, which were computed from the restored system.
"""

from typing import Any

from experiments.consensus import claims_beyond, claims_physical
from experiments.consensus.evidence import largest, least, off, off_point, off_values
from mjmr.claims import Bound, Claim

EVERY = ("quick", "standard", "full")
LINEAR: dict[str, Any] = {"mode": "linear"}
THREE: dict[str, Any] = {
    **LINEAR, "experiment": "three", "weight": 0.2, "weight_y": 0.0, "degrees": "2",
}  # fmt: skip
REFERENCE = {
    0.5: (4.050, 3.975), 1.0: (4.101, 3.949), 2.0: (4.205, 3.898), 5.0: (4.511, 3.744),
    10.0: (4.964, 3.518), 20.0: (5.567, 3.217),
}  # fmt: skip
SLOW: dict[float, float] = {1: -0.1123, 2: -0.0578, 3: -0.0389}
AGREE = "x(t) -> 1 kron (c x(0)) (Theorem 4.1)"


def claims() -> list[Claim]:
    """Every claim of the study."""
    return [
        *_table(),
        *_theory(),
        *_negatives(),
        *claims_physical.claims(),
        *claims_beyond.claims(),
    ]


def _table() -> list[Claim]:
    table = {**THREE, "schedule": "alternate"}
    return [
        Claim(
            id="linear-table",
            text="all three hands converge to one point (Figure 1)",
            how="linear model, 300 s; consensus point less the table's, six dwells, largest",
            bound=Bound("<=", 0.01),
            unit="m",
            sizes=EVERY,
            needs={**table, "dwell": tuple(REFERENCE)},
            evaluate=off(REFERENCE),
        ),
        Claim(
            id="linear-line",
            text="if T_1 changes, the weight is shared by those who lead",
            how="the same runs, |x + 2 y - 12|, largest",
            bound=Bound("<=", 1e-6),
            unit="m",
            sizes=EVERY,
            needs={**table, "dwell": tuple(REFERENCE)},
            evaluate=largest("line_m"),
        ),
        Claim(
            id="linear-time",
            text="all three hands converge to one point (Figure 1)",
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
            text="if T_1 never changes, only the first group has weight",
            how="case i for ever, consensus less robot 1's start",
            bound=Bound("<=", 0.01),
            unit="m",
            sizes=EVERY,
            needs={**THREE, "schedule": "case-i"},
            evaluate=off_point(6.0, 3.0),
        ),
        Claim(
            id="linear-case-ii",
            text="if T_1 never changes, only the first group has weight",
            how="case ii for ever, consensus less robot 2's start",
            bound=Bound("<=", 0.01),
            unit="m",
            sizes=EVERY,
            needs={**THREE, "schedule": "case-ii"},
            evaluate=off_point(2.0, 5.0),
        ),
        Claim(
            id="linear-channels",
            text="each output channel converges to its own common value",
            how="six dwells, least difference of x and y",
            bound=Bound(">=", 0.05),
            unit="m",
            sizes=EVERY,
            needs={**table, "dwell": tuple(REFERENCE)},
            evaluate=least("channel_gap_m"),
        ),
        Claim(
            id="linear-hull",
            text="c_s is nonnegative and sums to one",
            how="six dwells, how far a channel is outside of its starts, largest",
            bound=Bound("<=", 0.0),
            unit="m",
            sizes=EVERY,
            needs={**table, "dwell": tuple(REFERENCE)},
            evaluate=largest("outside_m"),
        ),
        Claim(
            id="linear-random-leader",
            text="the topology may vary arbitrarily",
            how="another leader of three every second, at random; largest spread after 300 s",
            bound=Bound("<=", 1e-3),
            unit="m",
            sizes=EVERY,
            needs={**THREE, "schedule": "random-leader", "dwell": 1.0},
            evaluate=largest("spread_m"),
        ),
        Claim(
            id="linear-joint",
            text="the condition is sufficient",
            how="only ever one link, 1-2 and 2-3 in turn, which never meets it: consensus less "
            "robot 1's start",
            bound=Bound("<=", 0.01),
            unit="m",
            sizes=EVERY,
            needs={**THREE, "schedule": "joint"},
            evaluate=off_point(6.0, 3.0),
        ),
    ]


def _theory() -> list[Claim]:
    example = {**LINEAR, "experiment": "example-4.1"}
    sequence = {**LINEAR, "experiment": "random-sequence"}
    lemma = {**LINEAR, "experiment": "lemmas"}
    return [
        Claim(
            id="example-leader",
            text="Example 4.1: the steady state is the first group's",
            how="four robots from random places, l = 1, 2, 3; consensus less robot 2's start, "
            "largest",
            bound=Bound("<=", 1e-6),
            unit="m",
            sizes=EVERY,
            needs=example,
            evaluate=largest("off_leader_m"),
        ),
        Claim(
            id="example-rates",
            text="Example 4.1 for any relative degree",
            how="slow eigenvalue less that, l = 1, 2, 3, largest",
            bound=Bound("<=", 0.0005),
            unit="1/s",
            sizes=EVERY,
            needs=example,
            evaluate=off_values("slow", "degree", SLOW),
        ),
        Claim(
            id="sequences-admissible",
            text="Assumption 4.2",
            how="random sequences, q = 3 to 12, l = 1 to 3, that the predicate takes; least",
            bound=Bound(">=", 1.0),
            needs=sequence,
            evaluate=least("admissible"),
        ),
        Claim(
            id="sequences-converge",
            text=AGREE,
            how="these sequences, repeated up to 200 times; largest spread",
            bound=Bound("<=", 1e-3),
            unit="m",
            needs=sequence,
            evaluate=largest("spread_m"),
        ),
        Claim(
            id="sequences-hull",
            text="c_s is nonnegative and sums to one",
            how="the same, how far a channel is outside of its starts, largest",
            bound=Bound("<=", 1e-3),
            unit="m",
            needs=sequence,
            evaluate=largest("outside_m"),
        ),
        Claim(
            id="stochastic-rows",
            text="P is row-stochastic",
            how="every transition of these sequences, |row sum - 1|, largest",
            bound=Bound("<=", 1e-9),
            needs=sequence,
            evaluate=largest("row_error"),
        ),
        Claim(
            id="stochastic-entries",
            text="P is nonnegative",
            how="the same, least entry",
            bound=Bound(">=", -1e-9),
            needs=sequence,
            evaluate=least("least"),
        ),
        Claim(
            id="lemma-2.1",
            text="the expanded matrix is irreducible iff E is (Lemma 2.1)",
            how="random cases with mixed l_i that disagree, of 400 a trial",
            bound=Bound("<=", 0.0),
            sizes=EVERY,
            needs=lemma,
            evaluate=_disagreements,
        ),
        Claim(
            id="lemma-2.2",
            text="products of lower-triangular matrices converge to 1 c, c = [c_1, 0 .. 0] "
            "(Lemma 2.2)",
            how="delta of 300 factors, largest",
            bound=Bound("<=", 1e-9),
            sizes=EVERY,
            needs=lemma,
            evaluate=largest("delta_22"),
        ),
        Claim(
            id="lemma-2.2-weight",
            text="the same",
            how="weight of all groups but the first, largest",
            bound=Bound("<=", 1e-9),
            sizes=EVERY,
            needs=lemma,
            evaluate=largest("weight_22"),
        ),
        Claim(
            id="lemma-2.3",
            text="interleaving matrices with positive diagonals keeps convergence (Lemma 2.3)",
            how="delta of 300 factors with as many others between, largest",
            bound=Bound("<=", 1e-9),
            sizes=EVERY,
            needs=lemma,
            evaluate=largest("delta_23"),
        ),
    ]


def _disagreements(table: Any) -> Any:
    from mjmr.claims import Evidence

    cases, agree = table.values("cases"), table.values("agree_21")
    return Evidence(float((cases - agree).sum()), n=int(cases.sum()))


def _negatives() -> list[Claim]:
    return [
        Claim(
            id="isolated-stays",
            text="each later group hears an earlier one (condition ii)",
            how="robot 3 hears nobody, dwell 2 s, 300 s; spread",
            bound=Bound.within(1.90, 1.92),
            unit="m",
            sizes=EVERY,
            needs={**THREE, "schedule": "isolated", "dwell": 2.0},
            evaluate=largest("spread_m"),
        ),
        Claim(
            id="decaying-stays",
            text="gains are nonzero infinitely often",
            how="gains 0.2 x 0.5^k, dwell 2 s, 300 s; spread",
            bound=Bound(">=", 2.5),
            unit="m",
            sizes=EVERY,
            needs={**THREE, "schedule": "decaying", "dwell": 2.0},
            evaluate=largest("spread_m"),
        ),
        Claim(
            id="mixed-channels-merge",
            text="diagonal blocks keep channels apart (Assumption 4.1)",
            how="a tenth of each own weight goes to the other channel: difference of x and y",
            bound=Bound("<=", 1e-3),
            unit="m",
            sizes=EVERY,
            needs={**LINEAR, "experiment": "mixed-channels"},
            evaluate=largest("channel_gap_m"),
        ),
        Claim(
            id="unequal-gains",
            text="multi-objective: channels with gains of their own",
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
