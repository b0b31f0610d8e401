"""What is claimed, how it is measured, and the bounds that decide it.

The filter is beyond the paper (Qu, Wang and Hull name collision avoidance as future use), so all
bounds are ours. They were fixed before the runs that decide them, those of the swap from a
reference run with other bodies (distance D - 1 mm, home within 40 s, under 1 ms a program).
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.safety_filter.sizes import BARRIER, FIELDS, NOISE, NONE, PLAIN, SEARCH
from mjmr import statistics
from mjmr.claims import Bound, Claim, Evidence, Table
from mjmr.errors import InvalidInputError

Measure = Callable[[Table], Evidence]
_ALL = ("quick", "standard", "full")
_SWAP = {"scene": "swap", "method": "barrier", "right": True, "robots": 10, "sigma_mm": 0.0}
_SYMMETRIC = {**_SWAP, "scene": "symmetric"}
_BEYOND = "not in the paper: "


def claims() -> list[Claim]:
    """Every claim of the study."""
    return [*_swaps(), *_symmetric(), *_without(), *_against_search(), *_fields(), *_timing()]


def largest(metric: str) -> Measure:
    """The largest value of a metric over the trials; None counts as never, infinity."""

    def evaluate(table: Table) -> Evidence:
        values = table.values(metric)
        return Evidence(float(np.where(np.isnan(values), np.inf, values).max()), n=len(values))

    return evaluate


def mean(metric: str) -> Measure:
    """The mean of a metric over the trials, with a bootstrap interval."""
    return lambda table: Evidence.of(statistics.mean(table.values(metric)))


def _claim(id: str, text: str, how: str, bound: Bound, needs: Any, evaluate: Any, **more: Any):
    return Claim(
        id=id, text=_BEYOND + text, how=how, bound=bound, needs=needs, evaluate=evaluate, **more
    )


def _swaps() -> list[Claim]:
    noisy = {**_SWAP, "sigma_mm": NOISE}
    return [
        _claim(
            "swap-no-contact", "ten robots swap places through the barrier without touching",
            "wheels in MuJoCo, exact reports; robot-robot contacts, worst run",
            Bound("<=", 0.0), _SWAP, largest("contacts"),
        ),
        _claim(
            "swap-in-time", "ten robots swap places through the barrier in 40 s",
            "instant at which all hands are within 10 cm of their goals, slowest run",
            Bound("<=", 40.0), _SWAP, largest("all_home_s"), unit="s",
        ),
        _claim(
            "swap-distance", "the distance is kept, where nothing is noisy",
            "least true distance of two hands less D (the discs that hold the bodies; the filter "
            "is told 5 cm more), worst run",
            Bound(">=", -1.0), _SWAP, _least_spare, unit="mm",
        ),
        _claim(
            "swap-feasible", "there is a safe set of velocities in every tick of a swap",
            "ticks whose program was not solved, worst run", Bound("<=", 0.0), _SWAP,
            largest("infeasible_ticks"),
        ),
        _claim(
            "noisy-swap-no-contact", "the same with reports 10 mm and 5 mrad wrong",
            "robot-robot contacts, worst run", Bound("<=", 0.0), noisy,
            largest("contacts"),
        ),
        _claim(
            "noisy-swap-in-time", "the same with reports 10 mm and 5 mrad wrong",
            "all within 10 cm of their goals, slowest run", Bound("<=", 40.0), noisy,
            largest("all_home_s"), unit="s",
        ),
    ]  # fmt: skip


def _symmetric() -> list[Claim]:
    alone = {**_SYMMETRIC, "right": False}
    return [
        _claim(
            "symmetric-no-contact", "the symmetric start, by the rule of keeping right",
            "robot-robot contacts; one run, nothing is random", Bound("<=", 0.0), _SYMMETRIC,
            largest("contacts"), sizes=_ALL,
        ),
        _claim(
            "symmetric-in-time", "the symmetric start, by the rule of keeping right, in 40 s",
            "all within 10 cm of their goals", Bound("<=", 40.0), _SYMMETRIC,
            largest("all_home_s"), unit="s", sizes=_ALL,
        ),
        _claim(
            "symmetric-distance", "the distance is kept from the symmetric start, too",
            "least true distance of two hands less D", Bound(">=", -1.0), _SYMMETRIC,
            _least_spare, unit="mm", sizes=_ALL,
        ),
        _claim(
            "symmetric-deadlocks-without-rule", "the symmetric start deadlocks without the rule",
            "time of 60 s in which nobody moves and somebody is not home", Bound(">=", 10.0),
            alone, largest("deadlock_s"), unit="s",
        ),
    ]  # fmt: skip


def _without() -> list[Claim]:
    told = {
        "none": "ten robots that go straight to their goals touch",
        "consensus": "plain consensus, the goals its formation, makes robots touch",
    }
    return [
        _claim(
            f"{method}-touches", words, "swap; robot-robot contact in 20 s, mean of runs",
            Bound(">", 1.0), {"scene": "swap", "method": method, "robots": 10, **PLAIN},
            mean("contact_s"), unit="s",
        )
        for method, words in told.items()
    ]  # fmt: skip


def _against_search() -> list[Claim]:
    both = {**_SWAP, "method": ("barrier", "search")}
    return [
        _claim(
            "search-swap-no-contact", "the velocity search on the same wheels and swaps",
            "same discs, margin and rule; robot-robot contacts, worst run", Bound("<=", 0.0),
            {**_SWAP, "method": "search"}, largest("contacts"),
        ),
        _claim(
            "swap-sooner-than-search", "robots are home sooner through the barrier",
            "swap; until all are home, 60 s if they are not; ratio of means barrier / search",
            Bound("<=", 0.8), both, _sooner,
        ),
        _claim(
            "swap-deadlocks-less-than-search", "fewer deadlocks than under the velocity search",
            "swap; time in which nobody moves and somebody is not home; mean barrier - search",
            Bound("<", 0.0), both,
            _stands_less,
            unit="s",
        ),
    ]  # fmt: skip


def _fields() -> list[Claim]:
    found = []
    # goals through the barrier / with the search
    least = {"A": 0.7, "cross4": 0.8, "cross10": 1.0}
    for scene in FIELDS:
        through = {"scene": scene, **BARRIER}
        found += [
            _claim(
                f"field-no-contact-{scene}", f"safe-navigation's scene {scene} through the barrier",
                "planar drive in MuJoCo, EKF, sigma 0; time in robot-robot contact, longest run",
                Bound("<=", 0.0), through, largest("contact_s"), unit="s",
            ),
            _claim(
                f"field-goals-{scene}", "goals reached through the barrier / with the search",
                f"scene {scene}; ratio of means (plans avoid what the filter keeps clear)",
                Bound(">=", least[scene]), {"scene": scene, "method": ("barrier", "search")},
                _goals,
            ),
        ]  # fmt: skip
    found += [
        _claim(
            "field-spares-obstacles-A", "the barrier keeps off boxes and walls",
            "scene A; time in contact with walls and boxes, longest run", Bound("<=", 0.1),
            {"scene": "A", **BARRIER}, largest("obstacle_contact_s"), unit="s",
        ),
        _claim(
            "field-waits-less-cross10", "ten robots in the middle wait less than with the search",
            "cross10; share of robots' time spent standing; mean barrier - search",
            Bound("<", 0.0), {"scene": "cross10", "method": ("barrier", "search")},
            _waits_less,
        ),
        _claim(
            "field-none-touches-cross10", "planner and motion control alone have no safety",
            "cross10; robot-robot contact in 30 s, mean of runs", Bound(">", 1.0),
            {"scene": "cross10", **NONE},
            mean("contact_s"), unit="s",
        ),
    ]  # fmt: skip
    return found


def _timing() -> list[Claim]:
    crowd = {"scene": "swap", "method": "barrier", "robots": 20}
    return [
        _claim(
            "program-time", "a program over 10 robots, 45 pairs, takes under 1 ms on one core",
            "swap; CPU time of a call of the filter, walls and limits included, mean",
            Bound("<", 1.0), _SWAP, _call_time, unit="ms", sizes=_ALL, timing=True,
        ),
        _claim(
            "program-time-20", "a program over 20 robots, 190 pairs",
            "the same, 20 robots", Bound("<", 4.0), crowd, _call_time, unit="ms", timing=True,
        ),
    ]  # fmt: skip


def _call_time(table: Table) -> Evidence:
    values = table.values("wall_filter_mean_ms")
    return Evidence(float(values.mean()), n=len(values))


def _least_spare(table: Table) -> Evidence:
    values = table.values("spare_mm")
    return Evidence(float(values.min()), n=len(values))


def _swaps_of_both(table: Table, metric: str) -> tuple[NDArray, NDArray]:
    """A metric of barrier and search, paired (n,) each; the search swaps with fewer seeds.

    Raises:
        InvalidInputError: A seed of the search without one of the barrier.
    """
    barrier, search = (table.where(method=m).by_seed(metric) for m in ("barrier", "search"))
    lost = search.keys() - barrier.keys()
    if lost:
        raise InvalidInputError(f"{len(lost)} runs of the search have no partner of the same seed")
    mine, theirs = (np.array([v[s] for s in search], dtype=float) for v in (barrier, search))
    return mine, theirs


def _sooner(table: Table) -> Evidence:
    pair = _swaps_of_both(table, "all_home_s")
    barrier, search = (np.where(np.isnan(v), 60.0, v) for v in pair)
    return Evidence.of(statistics.paired_ratio(barrier, search))


def _stands_less(table: Table) -> Evidence:
    return Evidence.of(statistics.paired_difference(*_swaps_of_both(table, "deadlock_s")))


def _waits_less(table: Table) -> Evidence:
    pair = table.where(**BARRIER).pair(table.where(**SEARCH), "waiting_share")
    return Evidence.of(statistics.paired_difference(*pair))


def _goals(table: Table) -> Evidence:
    pair = table.where(**BARRIER).pair(table.where(**SEARCH), "goals")
    return Evidence.of(statistics.paired_ratio(*pair))
