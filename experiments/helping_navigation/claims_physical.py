"""Claims about Pioneers in MuJoCo, fixed before the runs that decide them.

The card's demands on four robots against one, on the trap and on the standing chain are checked
again with bodies, wheels, scans and radio; how near the point robots come to them, and what the
marker vision errs, are claims of our own.
"""

import itertools

import numpy as np
from numpy.typing import NDArray

from experiments.helping_navigation.measures import NAMES
from mjmr import statistics
from mjmr.claims import Bound, Claim, Evidence, Table

_LARGE, _ALL = ("standard", "full"), ("quick", "standard", "full")
_TOUR = {"mode": "physical", "scene": "tour", "noise": False, "fault": "none"}
_TRAP = {"mode": "physical", "scene": "trap"}
_CHAIN = {"mode": "physical", "scene": "chain"}
_MARKERS = {"mode": "physical", "scene": "markers"}
_LONG = 20  # targets of the tours that compare teams; those with faults may be shorter


def physical() -> list[Claim]:
    """Every claim of mode physical."""
    return [*_teams(), *_bodies(), *_like_points(), *_trap(), *_standing(), *_faults(), *_vision()]


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


def _trap() -> list[Claim]:
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


def _standing() -> list[Claim]:
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


def _vision() -> list[Claim]:
    def mean(metric: str):
        return lambda table: Evidence.of(
            statistics.mean(table.where(**_MARKERS).values(metric)), why="mean of runs"
        )

    def total(part: str, whole: str):
        def measure(table: Table) -> Evidence:
            rows = table.where(**_MARKERS)
            n = int(rows.values(whole).sum())
            return Evidence(float(rows.values(part).sum() / max(n, 1)), n=n)

        return measure

    def worst(table: Table) -> Evidence:
        rows = table.where(**_MARKERS)
        n = int(rows.values("markers_in_sight").sum())
        return Evidence(float(rows.values("bearing_worst").max()), n=n, why="largest")

    def grows(table: Table) -> Evidence:
        rows = table.where(**_MARKERS)
        far = np.nanmean(rows.values("distance_rms_6_8m_m"))
        near = np.nanmean(rows.values("distance_rms_2_4m_m"))
        return Evidence(float(far / near), n=len(rows))

    return [
        Claim(
            id="markers-err-max",
            text="d_noise is uniform in [-err_max, err_max]",
            how=(
                "four rendered cameras, marker's height: err_max whose errors have the mean square "
                "of those seen within 8 m; below the least the paper's figures show above 0"
            ),
            bound=Bound("<=", 0.1),
            bound_source="ours",
            sizes=_LARGE,
            needs=_MARKERS,
            evaluate=mean("err_max"),
        ),
        Claim(
            id="markers-farther-worse",
            text="the farther is the robot, the bigger is the error",
            how="rms error of the distance in metres, 6 to 8 m / 2 to 4 m",
            bound=Bound(">", 1.5),
            bound_source="ours",
            sizes=_LARGE,
            needs=_MARKERS,
            evaluate=grows,
        ),
        Claim(
            id="markers-bearing",
            text="partial occlusions put an upper bound on the error of the angle (equation 2)",
            how="largest error of a bearing as a share of atan(robotsize / 2 d)",
            bound=Bound("<=", 1.0),
            bound_source="ours",
            sizes=_ALL,
            needs=_MARKERS,
            evaluate=worst,
        ),
        Claim(
            id="markers-found",
            text="one could put a well identifiable marker on each robot",
            how="robots in sight within 8 m whose marker was not found",
            bound=Bound("<=", 0.02),
            bound_source="ours",
            sizes=_LARGE,
            needs=_MARKERS,
            evaluate=total("markers_missed", "markers_in_sight"),
        ),
        Claim(
            id="markers-no-phantoms",
            text="not in the paper: nothing is taken for a marker that is none",
            how="markers found of which neither middle nor side is in sight, for each in sight",
            bound=Bound("<=", 0.005),
            bound_source="ours",
            sizes=_LARGE,
            needs=_MARKERS,
            evaluate=total("markers_phantom", "markers_in_sight"),
        ),
    ]
