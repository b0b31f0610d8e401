"""Claims about Pioneers in the trap and between standing mirrors, fixed before the runs."""

import numpy as np

from mjmr.claims import Bound, Claim, Evidence, Table

_LARGE, _ALL = ("standard", "full"), ("quick", "standard", "full")
_TRAP = {"mode": "physical", "scene": "trap"}
_CHAIN = {"mode": "physical", "scene": "chain"}


def trap() -> list[Claim]:
    """Figures 9 and 10 with bodies."""

    def reached(shares_state: bool):
        def measure(table: Table) -> Evidence:
            lost = table.where(**_TRAP, shares_state=shares_state).values("lost")
            return Evidence(float(1.0 - lost.mean()), n=len(lost))

        return measure

    def follows(table: Table) -> Evidence:
        values = table.where(**_TRAP, shares_state=True).values("follows")
        return Evidence(float(values.max()), n=len(values))

    return [
        Claim(
            id="physical-trap-stuck",
            text="goal-sharing alone: R1 gets trapped again in the local minimum (figure 9)",
            how="two Pioneers, literal, 1500 s (5000 motion steps): share that reach the goal",
            bound=Bound("<=", 0.0),
            bound_source="ours",
            sizes=_LARGE,
            needs={**_TRAP, "shares_state": False},
            evaluate=reached(False),
        ),
        Claim(
            id="physical-trap-freed",
            text="with state-sharing R1 finally manages to find a path to the goal (figure 10)",
            how="two Pioneers, literal, 1500 s: share that reach the goal",
            bound=Bound(">=", 1.0),
            bound_source="ours",
            sizes=_LARGE,
            needs={**_TRAP, "shares_state": True},
            evaluate=reached(True),
        ),
        Claim(
            id="physical-trap-follows",
            text="after several attempts",
            how="two Pioneers, literal: most follows of the mate before the goal was reached",
            bound=Bound("<=", 10.0),
            bound_source="ours",
            sizes=_LARGE,
            needs={**_TRAP, "shares_state": True},
            evaluate=follows,
        ),
    ]


def standing() -> list[Claim]:
    """Mirrors in a row, whole and broken."""

    def plain(table: Table, **more: object) -> Table:
        return table.where(**_CHAIN, planner="avoid-past", **({"fault": "none"} | more))  # pyright: ignore

    def calls(table: Table) -> Evidence:
        values = plain(table).values("calls")
        return Evidence(float(values.max()), n=len(values), why="largest")

    def straight(table: Table) -> Evidence:
        rows = plain(table)
        ratio = rows.values("steps") / rows.values("along")
        return Evidence(float(ratio.max()), n=len(ratio), why="largest")

    def arrive(fault: str):
        def measure(table: Table) -> Evidence:
            lost = table.where(**_CHAIN, fault=fault).values("lost")
            return Evidence(float(1.0 - lost.mean()), n=len(lost))

        return measure

    def lost_frames(table: Table) -> Evidence:
        known, lost = plain(table, reading="literal"), plain(table, reading="literal", fault="lost")
        before, after = known.pair(lost, "steps")
        return Evidence(float(np.abs(after / before - 1.0).max()), n=len(after), why="largest")

    return [
        Claim(
            id="physical-chain-calls",
            text="this strategy will guarantee R1 to finally reach its goal, by suppressing A",
            how=(
                "Pioneers, three standing mirrors: largest share of motion steps at which Avoid "
                "Past leads; news takes a step for each robot it passes"
            ),
            bound=Bound("<=", 0.15),
            bound_source="ours",
            sizes=_ALL,
            needs={**_CHAIN, "fault": "none"},
            evaluate=calls,
        ),
        Claim(
            id="physical-chain-straight",
            text="R1 starts heading towards the reflected image",
            how="Pioneers, three standing mirrors: metres of R1 / straight legs over all posts",
            bound=Bound("<=", 1.15),
            bound_source="ours",
            sizes=_ALL,
            needs={**_CHAIN, "fault": "none"},
            evaluate=straight,
        ),
        Claim(
            id="physical-dead-relay",
            text="not in the paper: without the middle mirror R1 falls back to A, without deadlock",
            how="Pioneers, the middle mirror dead, Avoid Past and VisBug: share that arrive",
            bound=Bound(">=", 1.0),
            bound_source="ours",
            sizes=_LARGE,
            needs={**_CHAIN, "fault": "dead"},
            evaluate=arrive("dead"),
        ),
        Claim(
            id="physical-radio-loss",
            text="not in the paper: dropped messages do not stop R1",
            how="Pioneers, a fifth of messages lost, Avoid Past and VisBug: share that arrive",
            bound=Bound(">=", 1.0),
            bound_source="ours",
            sizes=_LARGE,
            needs={**_CHAIN, "fault": "radio"},
            evaluate=arrive("radio"),
        ),
        Claim(
            id="physical-lost-frames",
            text="robots completely lost in the environment are still fully functional in helping",
            how="Pioneers, chain, supporters' frames anywhere / known: largest change of the way",
            bound=Bound("<", 0.01),
            bound_source="ours",
            sizes=_LARGE,
            needs={**_CHAIN, "reading": "literal", "fault": ("none", "lost")},
            evaluate=lost_frames,
        ),
    ]
