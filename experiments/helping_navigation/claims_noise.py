"""Claims about misperceived mates (section 6.1), all three supporters present."""

from experiments.helping_navigation.measures import NAMES, POINT, cell, ratio
from experiments.helping_navigation.published import PUBLISHED
from mjmr.claims import Bound, Claim, Evidence, Table

_MOST = 0.4


def noise() -> list[Claim]:
    """Every claim about noise."""
    return [*_grows(), *_against_alone()]


def _noisy(table: Table, world: str, planner: str, reading: str, err_max: float) -> Table:
    return table.where(
        **POINT, noise=True, fault="none", world=world, planner=planner, robots=4, reading=reading,
        err_max=err_max,
    )  # fmt: skip


def _grows() -> list[Claim]:
    def measure(table: Table, world: str, planner: str, reading: str) -> Evidence:
        most = _noisy(table, world, planner, reading, _MOST)
        return Evidence.of(ratio(most, _noisy(table, world, planner, reading, 0.0)))

    return [
        Claim(
            id=f"noise-grows-{reading}-{world}-{planner}",
            text="when err_max increases, the performance decreases for every algorithm",
            how=f"{reading}, four robots: mean steps at err_max 0.4 / at 0, paired tasks",
            bound=Bound(">", 1.0),
            evaluate=lambda table, w=world, p=planner, r=reading: measure(table, w, p, r),
        )
        for reading in ("chain", "literal")
        for world in PUBLISHED
        for planner in NAMES
    ]


def _against_alone() -> list[Claim]:
    def measure(table: Table, world: str, planner: str, reading: str) -> Evidence:
        alone = cell(table, world, planner, 1, reading)
        return Evidence.of(ratio(_noisy(table, world, planner, reading, _MOST), alone))

    found = []
    for reading in ("chain", "literal"):
        found += [
            Claim(
                id=f"noise-still-helps-{reading}-world1-{planner}",
                text="even when err_max = 0.4 steps are still lower than without supporters",
                how=f"{reading}, world 1: mean steps at err_max 0.4 / alone, paired tasks{remark}",
                bound=Bound("<", 1.0),
                bound_source="paper",
                evaluate=lambda table, p=planner, r=reading: measure(table, "world1", p, r),
            )
            for planner, remark in (
                ("avoid-past", ""),
                ("visbug", "; added after a first run had shown it"),
            )
        ]
        found += [
            Claim(
                id=f"noise-useless-{reading}-world2-{planner}",
                text="in the complex world support robots become very soon almost useless",
                how=f"{reading}, world 2: mean steps at err_max 0.4 / alone, paired tasks",
                bound=Bound(">=", 0.85),
                evaluate=lambda table, p=planner, r=reading: measure(table, "world2", p, r),
            )
            for planner in ("avoid-past", "visbug")
        ]
    return found
