"""Claims about the trap of figures 9 and 10, standing supporters, faults and lost frames."""

import numpy as np

from experiments.helping_navigation.measures import NAMES, POINT, cell, ratio
from experiments.helping_navigation.published import PUBLISHED
from mjmr import statistics
from mjmr.claims import Bound, Claim, Evidence, Table

_ALL = ("quick", "standard", "full")
_TRAP = {"mode": "point", "scene": "trap"}
_CHAIN = {"mode": "point", "scene": "chain"}


def scenes() -> list[Claim]:
    """Every claim of these scenes."""
    return [*_trap(), *_standing(), *_lost()]


def _trap() -> list[Claim]:
    return [
        Claim(
            id="trap-stuck",
            text="R1 gets trapped again in the local minimum (figure 9)",
            how="literal, potential field: share of runs that reach the goal within 5000 steps",
            bound=Bound("<=", 0.0),
            sizes=_ALL,
            needs={**_TRAP, "reading": "literal", "shares_state": False},
            evaluate=lambda table: _mean(table.values("reached")),
        ),
        Claim(
            id="trap-freed",
            text="thanks to the help of R2, R1 finally manages to find a path (figure 10)",
            how="literal, Cr = 20: share of runs that reach the goal within 5000 steps",
            bound=Bound(">=", 1.0),
            sizes=_ALL,
            needs={**_TRAP, "reading": "literal", "shares_state": True, "level": 20},
            evaluate=lambda table: _mean(table.values("reached")),
        ),
        Claim(
            id="trap-freed-all",
            text="thanks to the help of R2, R1 finally manages to find a path (figure 10)",
            how=(
                "literal, Cr = 3, 5 and 20: share of runs that reach the goal within 5000 steps; "
                "trap-follows counts the follows of all three"
            ),
            bound=Bound(">=", 1.0),
            sizes=_ALL,
            needs={**_TRAP, "reading": "literal", "shares_state": True, "level": (3, 5, 20)},
            evaluate=lambda table: _mean(table.values("reached")),
        ),
        Claim(
            id="trap-follows",
            text="after several attempts, it can be seen that R1 finally manages",
            how="literal, Cr = 3, 5 and 20: most follows of the mate before the goal was reached",
            bound=Bound("<=", 10.0),
            sizes=_ALL,
            needs={**_TRAP, "reading": "literal", "shares_state": True},
            evaluate=lambda table: Evidence(
                float(table.values("follows").max()), n=len(table.values("follows"))
            ),
        ),
        Claim(
            id="trap-follows-grow",
            text="this time R1 follows R2 for a longer time",
            how="literal, Cr = 3 and 5: Kendall's tau of the follows' lengths with their order",
            bound=Bound(">", 0.0),
            sizes=_ALL,
            needs={**_TRAP, "reading": "literal", "shares_state": True, "level": (3, 5)},
            evaluate=lambda table: Evidence(
                float(np.min(table.values("growth"))), n=len(table.values("growth")), why="smallest"
            ),
        ),
        Claim(
            id="trap-chain-frees",
            text="not in the paper: one handed-over list of ghosts frees R1 without state-sharing",
            how="chain, goal-sharing only: share of runs that reach the goal within 5000 steps",
            bound=Bound(">=", 1.0),
            sizes=_ALL,
            needs={**_TRAP, "reading": "chain", "shares_state": False},
            evaluate=lambda table: _mean(table.values("reached")),
        ),
    ]


def _mean(values: np.ndarray) -> Evidence:
    return Evidence(float(np.mean(values)), n=len(values))


def _standing() -> list[Claim]:
    def calls(table: Table) -> Evidence:
        values = table.values("calls")
        return Evidence(float(values.sum()), n=int(table.values("targets_run").sum()))

    def reached(table: Table) -> Evidence:
        run = table.values("targets_run").sum()
        return Evidence(float(table.values("reached").sum() / run), n=int(run))

    def length(table: Table) -> Evidence:
        values, along = table.values("steps"), table.values("along")
        if len(values) == 1:
            return Evidence(float(values[0] / along[0]), n=1)
        return Evidence.of(statistics.paired_ratio(values, along))

    found = [
        Claim(
            id=f"standing-no-planner-{reading}",
            text="in a static environment, this will guarantee R1 to finally reach its goal",
            how=f"{reading}, three standing supporters in sight in turn: calls of the planner",
            bound=Bound("<=", 0.0),
            sizes=_ALL,
            needs={**_CHAIN, "reading": reading, "fault": "none"},
            evaluate=calls,
        )
        for reading in ("literal", "chain")
    ]
    found += [
        Claim(
            id=f"standing-straight-{reading}",
            text="reach its goal while following a finite set of straight trajectories (static)",
            how=f"{reading}: steps / the way over all three supporters in steps",
            bound=Bound("<=", 1.02),
            sizes=_ALL,
            needs={**_CHAIN, "reading": reading, "fault": "none"},
            evaluate=length,
        )
        for reading in ("literal", "chain")
    ]
    for fault, text in (
        ("dead", "not in the paper: the middle relay is dead, R1 falls back on its planner"),
        ("radio", "not in the paper: a fifth of all messages is lost"),
    ):
        found += [
            Claim(
                id=f"standing-{fault}-{planner}",
                text=text,
                how="both readings: share of targets reached within 6000 steps",
                bound=Bound(">=", 1.0),
                sizes=_ALL,
                needs={**_CHAIN, "planner": planner, "fault": fault},
                evaluate=reached,
            )
            for planner in ("avoid-past", "visbug")
        ]
    return found


def _lost() -> list[Claim]:
    def measure(table: Table, world: str, planner: str, reading: str) -> Evidence:
        lost = table.where(
            **POINT, noise=False, fault="lost", world=world, planner=planner, robots=4,
            reading=reading,
        )  # fmt: skip
        found = ratio(lost, cell(table, world, planner, 4, reading)).value
        return Evidence(abs(found - 1.0), n=len(lost))

    return [
        Claim(
            id=f"lost-frames-{reading}-{world}-{planner}",
            text="other robots, even if they are completely lost, are still fully functional",
            how=(
                f"{reading}, four robots: supporters' frames anywhere and turned by any angle, "
                "mean steps / with aligned frames, distance from 1"
            ),
            bound=Bound("<", 0.01),
            evaluate=lambda table, w=world, p=planner, r=reading: measure(table, w, p, r),
        )
        for reading in ("chain", "literal")
        for world in PUBLISHED
        for planner in NAMES
    ]
