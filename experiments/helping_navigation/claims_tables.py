"""Claims about tables 1 and 2: steps against the number of supporters, in both readings."""

from experiments.helping_navigation.measures import NAMES, PLAIN, cell, ratio, rise, steps
from experiments.helping_navigation.published import PUBLISHED
from mjmr import statistics
from mjmr.claims import Bound, Claim, Evidence, Table

_PLANNERS = tuple(NAMES)
_IN_ALL = "in all cases, the performance significantly increases as we add more helping robots"


def tables() -> list[Claim]:
    """Every claim of the tables."""
    return [
        *_never_rise(),
        *_four_against_one(),
        *_less_gain(),
        *_spread(),
        *_literal(),
        *_potential_field(),
    ]


def _published_ratio(world: str, planner: str) -> str:
    row = PUBLISHED[world][planner]
    return f"{row[4][0]:g} / {row[1][0]:g} = {row[4][0] / row[1][0]:.2f}"


def _never_rise() -> list[Claim]:
    return [
        Claim(
            id=f"chain-never-rises-{world}-{planner}",
            text=_IN_ALL,
            how=(
                "chain: largest relative rise of mean steps with one supporter more, less one "
                "standard error of the tasks' differences"
            ),
            bound=Bound("<=", 0.05),
            evaluate=lambda table, w=world, p=planner: rise(table, w, p, "chain"),
        )
        for world in PUBLISHED
        for planner in _PLANNERS
    ]


def _four_against_one() -> list[Claim]:
    return [
        Claim(
            id=f"chain-four-against-one-{planner}",
            text=_IN_ALL,
            published=_published_ratio("world1", planner),
            how="chain, world 1: mean steps of four robots / alone, paired tasks",
            bound=Bound.within(*ends),
            sizes=("quick", "standard", "full"),
            evaluate=lambda table, p=planner: Evidence.of(_four_alone(table, "world1", p, "chain")),
        )
        for planner, ends in (("avoid-past", (0.25, 0.70)), ("visbug", (0.15, 0.60)))
    ]


def _four_alone(table: Table, world: str, planner: str, reading: str) -> statistics.Estimate:
    return ratio(cell(table, world, planner, 4, reading), cell(table, world, planner, 1, reading))


def _less_gain() -> list[Claim]:
    def measure(table: Table, planner: str) -> Evidence:
        found = []
        for world in ("world1", "world2"):
            four = steps(cell(table, world, planner, 4, "chain"))
            fewest = 2 if planner == "potential-field" else 1
            found.append(four / steps(cell(table, world, planner, fewest, "chain")))
        return Evidence.of(statistics.paired_difference(found[1], found[0]))

    return [
        Claim(
            id=f"chain-less-gain-in-world2-{planner}",
            text=(
                "even when three helping robots are present, the influence of the navigation "
                "algorithm A is still important (world 2)"
            ),
            published=(
                "ratios to the smallest team 0.46, 0.24, 0.38 in world 1 and 0.60, 0.73, 0.73 in "
                "world 2 (Avoid Past, VisBug, potential field)"
            ),
            how=(
                "chain: ratio of four robots to the smallest team, world 2 - world 1, mean of tasks"
            ),
            bound=Bound(">", 0.0),
            evaluate=lambda table, p=planner: measure(table, p),
        )
        for planner in _PLANNERS
    ]


def _means(table: Table, world: str, reading: str) -> dict[str, float]:
    return {p: float(steps(cell(table, world, p, 4, reading)).mean()) for p in _PLANNERS}


def _spread() -> list[Claim]:
    def spread(table: Table, world: str) -> Evidence:
        found = _means(table, world, "chain")
        return Evidence(max(found.values()) / min(found.values()), n=len(found))

    def lowest(table: Table) -> Evidence:
        found = _means(table, "world2", "chain")
        visbug = found.pop("visbug")
        return Evidence(visbug / min(found.values()), n=3)

    return [
        Claim(
            id="chain-spread-world1",
            text=(
                "the performance of the system seems not to depend on the particular algorithm "
                "adopted when we add more than two robots (world 1)"
            ),
            published="257.2 / 201.2 = 1.28",
            how="chain, four robots: largest / smallest mean of the planners",
            bound=Bound("<=", 1.5),
            evaluate=lambda table: spread(table, "world1"),
        ),
        Claim(
            id="chain-spread-world2",
            text=(
                "even when three helping robots are present, the influence of the navigation "
                "algorithm A is still important (world 2)"
            ),
            published="913.6 / 373.4 = 2.45",
            how="chain, four robots: largest / smallest mean of the planners",
            bound=Bound(">=", 1.25),
            evaluate=lambda table: spread(table, "world2"),
        ),
        Claim(
            id="chain-visbug-lowest-world2",
            text=(
                "VisBug is more efficient: the corresponding curve stays always below the two "
                "other curves (world 2)"
            ),
            published="373.4 against 682.6 and 913.6",
            how="chain, four robots: VisBug's mean / the smaller of the two others",
            bound=Bound("<", 1.0),
            evaluate=lowest,
        ),
    ]


def _literal() -> list[Claim]:
    def falls(table: Table, world: str) -> Evidence:
        means = [
            steps(cell(table, world, "potential-field", robots, "literal")).mean()
            for robots in (2, 3, 4)
        ]
        return Evidence(float(max(means[1] / means[0], means[2] / means[1])), n=3)

    found = []
    for world in PUBLISHED:
        found += [
            Claim(
                id=f"literal-falls-{world}-potential-field",
                text=_IN_ALL,
                how="literal: largest ratio of means with one supporter more, from one on",
                bound=Bound("<", 1.0),
                evaluate=lambda table, w=world: falls(table, w),
            ),
            Claim(
                id=f"literal-four-against-one-{world}-avoid-past",
                text=_IN_ALL,
                published=_published_ratio(world, "avoid-past"),
                how="literal: mean steps of four robots / alone, paired tasks",
                bound=Bound("<", 1.0),
                evaluate=lambda table, w=world: Evidence.of(
                    _four_alone(table, w, "avoid-past", "literal")
                ),
            ),
            Claim(
                id=f"literal-four-against-one-{world}-visbug",
                text=_IN_ALL,
                published=_published_ratio(world, "visbug"),
                how=(
                    "literal: mean steps of four robots / alone, paired tasks; the paper's words, "
                    "which a reference run did not bear out in this reading"
                ),
                bound=Bound("<", 1.0),
                bound_source="paper",
                evaluate=lambda table, w=world: Evidence.of(
                    _four_alone(table, w, "visbug", "literal")
                ),
            ),
        ]
    return found


def _potential_field() -> list[Claim]:
    def failed(table: Table) -> Evidence:
        capped, run = table.values("capped").sum(), table.values("targets_run").sum()
        return Evidence.of(statistics.proportion(int(capped), int(run)))

    found = []
    for world in PUBLISHED:
        common = {**PLAIN, "world": world, "planner": "potential-field"}
        found.append(
            Claim(
                id=f"alone-fails-{world}",
                text=(
                    "1) does not guarantee the robot to reach its target without the help of other "
                    "robots"
                ),
                how="potential field alone: share of targets given up after 6000 steps",
                bound=Bound(">", 0.5),
                needs={**common, "robots": 1},
                evaluate=failed,
            )
        )
        for reading, least in (("chain", 1.0), ("literal", 0.97)):
            found.append(
                Claim(
                    id=f"{reading}-one-supporter-{world}",
                    text="tables 1 and 2 have entries of the potential field from one supporter on",
                    how=f"{reading}, two robots: share of targets reached within 6000 steps",
                    bound=Bound(">=", least),
                    needs={**common, "robots": 2, "reading": reading},
                    evaluate=_share_reached,
                )
            )
    return found


def _share_reached(table: Table) -> Evidence:
    capped, run = table.values("capped").sum(), table.values("targets_run").sum()
    return Evidence(float(1.0 - capped / run), n=int(run))
