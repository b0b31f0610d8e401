"""Claims of ours beyond the paper: shortest paths as yardstick, and what a chain guarantees."""

from experiments.helping_navigation.measures import NAMES, PLAIN, cell, ratio
from experiments.helping_navigation.published import PUBLISHED
from mjmr.claims import Bound, Claim, Evidence, Table


def beyond() -> list[Claim]:
    """Every claim beyond the paper."""
    return [*_guaranteed(), *_in_vain(), *_in_vain_mostly(), *_shortest(), *_caps()]


def _guaranteed() -> list[Claim]:
    return [
        Claim(
            id=f"chain-never-in-vain-{world}",
            text="not in the paper: in a static world a list of ghosts is a way to the goal",
            how="chain, all planners and teams, no noise: offers that led to nothing",
            bound=Bound("<=", 0.0),
            needs={**PLAIN, "reading": "chain", "world": world},
            evaluate=lambda table: Evidence(
                float(table.values("vain").sum()), n=int(table.values("offers").sum())
            ),
        )
        for world in PUBLISHED
    ]


def _share_in_vain(table: Table) -> Evidence:
    offers = table.values("offers").sum()
    return Evidence(float(table.values("vain").sum() / offers), n=int(offers))


def _in_vain() -> list[Claim]:
    return [
        Claim(
            id=f"literal-in-vain-{world}",
            text="in most cases, it will have to start again to explore",
            how="literal, VisBug, all teams: share of offers taken that led to nothing",
            bound=Bound(">", 0.1),
            needs={**PLAIN, "reading": "literal", "world": world, "planner": "visbug"},
            evaluate=_share_in_vain,
        )
        for world in PUBLISHED
    ]


def _in_vain_mostly() -> list[Claim]:
    return [
        Claim(
            id=f"literal-in-vain-most-{world}",
            text="in most cases, it will have to start again to explore",
            how=(
                "literal, VisBug, all teams: share of offers taken that led to nothing; the "
                "paper's words as they stand, beside our lower bound, whose runs were known"
            ),
            bound=Bound(">", 0.5),
            bound_source="paper",
            needs={**PLAIN, "reading": "literal", "world": world, "planner": "visbug"},
            evaluate=_share_in_vain,
        )
        for world in PUBLISHED
    ]


def _shortest() -> list[Claim]:
    def measure(table: Table, world: str, planner: str) -> Evidence:
        best = table.where(**PLAIN, world=world, planner="shortest-path")
        return Evidence.of(ratio(cell(table, world, planner, 4, "chain"), best))

    return [
        Claim(
            id=f"chain-against-shortest-{world}-{planner}",
            text="not in the paper: how far from a robot with a map",
            how=(
                "chain, four robots: mean steps / shortest ways over the visibility graph, "
                "paired tasks"
            ),
            bound=Bound("<=", {"world1": 2.5, "world2": 8.0}[world]),
            evaluate=lambda table, w=world, p=planner: measure(table, w, p),
        )
        for world in PUBLISHED
        for planner in NAMES
    ]


def _caps() -> list[Claim]:
    def capped(table: Table) -> Evidence:
        runs = table.where(planner=("avoid-past", "visbug"))
        return Evidence(
            float(runs.values("capped").sum() / runs.values("targets_run").sum()),
            n=int(runs.values("targets_run").sum()),
        )

    return [
        Claim(
            id=f"few-capped-{world}",
            text=(
                "Avoid Past proves to be effective, VisBug is guaranteed to find a path, even when "
                "no helping robots are present"
            ),
            how="Avoid Past and VisBug, all teams, no noise: share of targets given up at 6000",
            bound=Bound("<=", 0.005),
            needs={**PLAIN, "world": world},
            evaluate=capped,
        )
        for world in PUBLISHED
    ]
