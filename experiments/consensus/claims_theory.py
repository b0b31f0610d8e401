"""Claims of the theory for any team: Example 4.1, random sequences, stochastic matrices, lemmas."""

from typing import Any

from experiments.consensus import quotes
from experiments.consensus.evidence import largest, least, off_values
from mjmr.claims import Bound, Claim, Evidence, Table

EVERY = ("quick", "standard", "full")
LINEAR: dict[str, Any] = {"mode": "linear"}
SLOW: dict[float, float] = {1: -0.1123, 2: -0.0578, 3: -0.0389}


def claims() -> list[Claim]:
    """Every claim of this module."""
    example = {**LINEAR, "experiment": "example-4.1"}
    sequence = {**LINEAR, "experiment": "random-sequence"}
    lemma = {**LINEAR, "experiment": "lemmas"}
    return [
        Claim(
            id="example-leader",
            text=quotes.ABSENT + "the steady state of Example 4.1 is the first group's",
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
            text=quotes.ABSENT + "rates of Example 4.1 for any relative degree",
            how="slow eigenvalue less that, l = 1, 2, 3, largest",
            bound=Bound("<=", 0.0005),
            unit="1/s",
            sizes=EVERY,
            needs=example,
            evaluate=off_values("slow", "degree", SLOW),
        ),
        Claim(
            id="sequences-admissible",
            text=quotes.ABSENT + "random sequences that meet Assumption 4.2",
            how="random sequences, q = 3 to 12, l = 1 to 3, that the predicate takes; least",
            bound=Bound(">=", 1.0),
            needs=sequence,
            evaluate=least("admissible"),
        ),
        Claim(
            id="sequences-converge",
            text=quotes.CONVERGES,
            how="these sequences, repeated up to 200 times; largest spread",
            bound=Bound("<=", 1e-3),
            unit="m",
            needs=sequence,
            evaluate=largest("spread_m"),
        ),
        Claim(
            id="sequences-hull",
            text=quotes.HULL,
            how="the same, how far a channel is outside of its starts, largest",
            bound=Bound("<=", 1e-3),
            unit="m",
            needs=sequence,
            evaluate=largest("outside_m"),
        ),
        Claim(
            id="stochastic-rows",
            text=quotes.STOCHASTIC,
            how="every transition of these sequences, |row sum - 1|, largest",
            bound=Bound("<=", 1e-9),
            needs=sequence,
            evaluate=largest("row_error"),
        ),
        Claim(
            id="stochastic-entries",
            text=quotes.NONNEGATIVE,
            how="the same, least entry",
            bound=Bound(">=", -1e-9),
            needs=sequence,
            evaluate=least("least"),
        ),
        Claim(
            id="stochastic-rows-robots",
            text=quotes.STOCHASTIC,
            how="written later: the same of every transition of three robots and of Example 4.1",
            bound=Bound("<=", 1e-9),
            needs={**LINEAR, "experiment": ("three", "example-4.1")},
            evaluate=largest("row_error"),
        ),
        Claim(
            id="stochastic-entries-robots",
            text=quotes.NONNEGATIVE,
            how="written later: the same of every transition of three robots and of Example 4.1",
            bound=Bound(">=", -1e-9),
            needs={**LINEAR, "experiment": ("three", "example-4.1")},
            evaluate=least("least"),
        ),
        Claim(
            id="lemma-2.1",
            text=quotes.LEMMA_21,
            how="Lemma 2.1, random cases with mixed l_i that disagree, of 400 a trial",
            bound=Bound("<=", 0.0),
            sizes=EVERY,
            needs=lemma,
            evaluate=_disagreements,
        ),
        Claim(
            id="lemma-2.2",
            text=quotes.LEMMA_22,
            how="Lemma 2.2, products of lower-triangular matrices, delta of 300 factors, largest",
            bound=Bound("<=", 1e-9),
            sizes=EVERY,
            needs=lemma,
            evaluate=largest("delta_22"),
        ),
        Claim(
            id="lemma-2.2-weight",
            text=quotes.LEMMA_22_WEIGHT,
            how="the same products, weight of all groups but the first, largest",
            bound=Bound("<=", 1e-9),
            sizes=EVERY,
            needs=lemma,
            evaluate=largest("weight_22"),
        ),
        Claim(
            id="lemma-2.3",
            text=quotes.LEMMA_23,
            how="Lemma 2.3, the same with as many others between, delta, largest",
            bound=Bound("<=", 1e-9),
            sizes=EVERY,
            needs=lemma,
            evaluate=largest("delta_23"),
        ),
    ]


def _disagreements(table: Table) -> Evidence:
    cases, agree = table.values("cases"), table.values("agree_21")
    return Evidence(float((cases - agree).sum()), n=int(cases.sum()))
