"""Claims about Pioneers in MuJoCo on tours, fixed before the runs that decide them.

The card's demands on four robots against one are checked again with bodies, wheels, scans and
radio; how near the point robots come to them is a claim of our own. Those about the trap and
standing chains are in claims_physical_scenes.py, those about cameras in claims_markers.py.
"""

import itertools

import numpy as np
from numpy.typing import NDArray

from experiments.helping_navigation.claims_markers import markers
from experiments.helping_navigation.claims_physical_scenes import standing, trap
from experiments.helping_navigation.measures import NAMES
from mjmr import statistics
from mjmr.claims import Bound, Claim, Evidence, Table

_LARGE = ("standard", "full")
_TOUR = {"mode": "physical", "scene": "tour", "noise": False, "fault": "none"}


def physical() -> list[Claim]:
    """Every claim of mode physical."""
    return [
        *_teams(), *_bodies(), *_like_points(), *trap(), *standing(), *_faults(), *markers(),
    ]  # fmt: skip


def each(table: Table, metric: str = "each") -> NDArray[np.float64]:
    """Motion steps of every target of every finished trial (k,), seeds in order."""
    found = dict(zip(table.seeds.tolist(), table.values(metric), strict=True))
    return np.array([float(v) for seed in sorted(found) for v in str(found[seed]).split()])


def _team(table: Table, planner: str, robots: int, reading: str) -> Table:
    longest = table.where(**_TOUR, world="world1", planner=planner, robots=robots, reading=reading)
    counts = [int(c) for c in longest.distinct("targets")]  # pyright: ignore
    return longest.where(targets=max(counts)) if counts else longest


def _teams() -> list[Claim]:
    found = []
    for planner, reading in itertools.product(("avoid-past", "visbug"), ("chain", "literal")):

        def ratio(table: Table, planner: str = planner, reading: str = reading) -> Evidence:
            four, one = _team(table, planner, 4, reading), _team(table, planner, 1, "none")
            return Evidence.of(statistics.paired_ratio(each(four), each(one)))

        found.append(
            Claim(
                id=f"physical-four-{planner}-{reading}",
                text="the performance significantly increases as we add more helping robots",
                how=(
                    f"Pioneers, world 1, {NAMES[planner]}, {reading}: metres of R1, four robots / "
                    "one, the same 20 targets; targets are resampled in pairs"
                ),
                bound=Bound("<", 1.0),
                bound_source="ours",
                sizes=_LARGE,
                needs={**_TOUR, "planner": planner, "robots": (1, 4),
                       "reading": ("none", reading)},
                evaluate=ratio,
            )
        )  # fmt: skip

    for reading, least in (("chain", 1.0), ("literal", 0.95)):

        def reached(table: Table, reading: str = reading) -> Evidence:
            lost = each(_team(table, "potential-field", 4, reading), "lost_each")
            return Evidence(float(1.0 - lost.mean()), n=len(lost))

        found.append(
            Claim(
                id=f"physical-potential-field-{reading}",
                text="the potential field, which has no entry alone, finishes with help",
                how=f"Pioneers, world 1, four robots, state-sharing, {reading}: targets reached",
                bound=Bound(">=", least),
                bound_source="ours",
                sizes=_LARGE,
                needs={**_TOUR, "planner": "potential-field", "robots": 4, "reading": reading},
                evaluate=reached,
            )
        )
    return found


def _bodies() -> list[Claim]:
    def lost(table: Table) -> Evidence:
        rows = table.where(**_TOUR, robots=4, planner=("avoid-past", "visbug"))
        return Evidence(float(rows.values("lost").sum()), n=int(rows.values("targets_done").sum()))

    def share(metric: str):
        def measure(table: Table) -> Evidence:
            rows = table.where(**_TOUR, robots=4)
            contact, time = rows.values(metric), rows.values("seconds")
            return Evidence(float(contact.sum() / (4 * time.sum())), n=len(time))

        return measure

    return [
        Claim(
            id="physical-none-lost",
            text="R1 and R2 should implement some sort of coordination strategy (blocked doors)",
            how="Pioneers, world 1, four robots, Avoid Past and VisBug: targets given up",
            bound=Bound("<=", 0.0),
            bound_source="ours",
            sizes=_LARGE,
            needs={**_TOUR, "robots": 4},
            evaluate=lost,
        ),
        Claim(
            id="physical-robot-contact",
            text="not in the paper: bodies keep off each other",
            how="Pioneers, world 1, four robots: time in contact of pairs / robot time",
            bound=Bound("<=", 0.001),
            bound_source="ours",
            sizes=_LARGE,
            needs={**_TOUR, "robots": 4},
            evaluate=share("robot_contact_s"),
        ),
        Claim(
            id="physical-wall-contact",
            text="not in the paper: bodies keep off walls",
            how="Pioneers, world 1, four robots: time in contact with walls / robot time",
            bound=Bound("<=", 0.001),
            bound_source="ours",
            sizes=_LARGE,
            needs={**_TOUR, "robots": 4},
            evaluate=share("office_contact_s"),
        ),
    ]


def _like_points() -> list[Claim]:
    found = []
    for planner, robots, reading, low, high in (
        ("visbug", 1, "none", 0.9, 1.1),
        ("avoid-past", 1, "none", 0.6, 1.6),
        ("visbug", 4, "chain", 0.67, 1.5),
        ("avoid-past", 4, "chain", 0.67, 1.5),
        ("potential-field", 4, "chain", 0.6, 1.6),
    ):

        def ratio(
            table: Table, planner: str = planner, robots: int = robots, reading: str = reading
        ) -> Evidence:
            rows = _team(table, planner, robots, reading)
            return Evidence.of(statistics.paired_ratio(each(rows), each(rows, "point_each")))

        found.append(
            Claim(
                id=f"physical-like-points-{planner}-{robots}",
                text="the number of motion steps is proportional to the length of the path",
                how=(
                    f"{NAMES[planner]}, {robots} robot{'s' if robots > 1 else ''}, {reading}: "
                    "metres of the Pioneer / 0.15 m x steps of the point robot, the same targets"
                ),
                bound=Bound.within(low, high),
                bound_source="ours",
                sizes=_LARGE,
                needs={**_TOUR, "planner": planner, "robots": robots, "reading": reading},
                evaluate=ratio,
            )
        )
    return found


def _faults() -> list[Claim]:
    def measure(table: Table) -> Evidence:
        rows = table.where(
            mode="physical", scene="tour", planner="avoid-past", robots=4, reading="chain",
            fault=("dead", "radio", "lost"),
        )  # fmt: skip
        return Evidence(float(rows.values("lost").sum()), n=int(rows.values("targets_done").sum()))

    def noisy(table: Table) -> Evidence:
        rows = table.where(
            mode="physical", scene="tour", planner="avoid-past", robots=4, reading="chain",
            fault="none", noise=True,
        )  # fmt: skip
        return Evidence(float(rows.values("lost").sum()), n=int(rows.values("targets_done").sum()))

    return [
        Claim(
            id="physical-faults-none-lost",
            text="not in the paper: faults slow R1 down, they do not stop it",
            how=(
                "Pioneers, tours with a dead supporter, lost messages, lost frames; Avoid Past, "
                "chain: targets given up"
            ),
            bound=Bound("<=", 0.0),
            bound_source="ours",
            sizes=_LARGE,
            needs={"mode": "physical", "scene": "tour", "fault": ("dead", "radio", "lost")},
            evaluate=measure,
        ),
        Claim(
            id="physical-noise-none-lost",
            text="not in the paper: errors above those of the rendered cameras",
            how="Pioneers, tours with err_max = 0.1, Avoid Past, chain: targets given up",
            bound=Bound("<=", 0.0),
            bound_source="ours",
            sizes=_LARGE,
            needs={"mode": "physical", "scene": "tour", "noise": True},
            evaluate=noisy,
        ),
    ]
