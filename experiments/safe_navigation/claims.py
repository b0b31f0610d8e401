"""What is claimed, how it is measured, and the bounds that decide it.

The curves of the paper's Figures 8 and 9 survive in words only; every bound marked ``ours`` was
fixed before the runs that decide it.
"""

import numpy as np

from experiments.safe_navigation.claims_beyond import beyond, maximum
from mjmr import statistics
from mjmr.claims import Bound, Claim, Evidence, Table

_EXACT = 1e-9  # mm s
_ALL = ("quick", "standard", "full")
_LARGE = ("standard", "full")
_PLANAR = {"mode": "physical", "drive": "planar", "sensing": "report", "latency": 0}
_SIGMAS = (1.0, 2.0, 3.0, 4.0, 5.0)


def claims() -> list[Claim]:
    """Every claim of the study."""
    return [
        *_search_reduces(),
        *_exactly_zero(),
        _off_is_flat(),
        _small_margins_suffice(),
        _larger_margins_help(),
        _overlap_separates(),
        *_latency(),
        *_price(),
        _bisection(),
        *_physical(),
        *beyond(),
        *_timing(),
    ]


def _search_reduces() -> list[Claim]:
    found = []
    for scene in ("A", "cross4", "cross10"):
        found.append(
            Claim(
                id=f"search-reduces-overlap-{scene}",
                text="the safety search significantly decreases the total interpenetration time",
                how=(
                    "robot pairs, depth x time, exact commands; ratio of means on / off, largest "
                    "over sigma"
                ),
                bound=Bound("<=", 0.05),
                sizes=_ALL if scene == "cross4" else _LARGE,
                needs={"mode": "metric", "scene": scene, "margin_mm": 0.0, "failure": "none",
                       "latency": 0, "motion": "paper"},
                evaluate=_worst_ratio,
            )
        )  # fmt: skip
    found.append(
        Claim(
            id="search-spares-obstacles",
            text="satisfies both obstacle and dynamics constraints",
            how="robots and boxes or walls, A, depth x time; mean on - off, largest over sigma",
            bound=Bound("<=", 0.0),
            unit="mm s",
            needs={"mode": "metric", "scene": "A", "margin_mm": 0.0, "failure": "none",
                   "latency": 0, "motion": "paper"},
            evaluate=_obstacles,
        )
    )  # fmt: skip
    found.append(
        Claim(
            id="margin-reduces-overlap-cross10",
            text="not in the paper: a margin of 4 mm in the densest scene",
            how=(
                "robot pairs, depth x time, exact commands; ratio of means on with margin 4 mm / "
                "off, largest over sigma"
            ),
            bound=Bound("<=", 0.05),
            needs={"mode": "metric", "scene": "cross10", "failure": "none", "latency": 0},
            evaluate=lambda table: _worst_ratio(table, margin=4.0),
        )
    )
    return found


def _worst_ratio(table: Table, margin: float = 0.0) -> Evidence:
    estimates = []
    for _, rows in table.split("sigma_mm"):
        on = rows.where(search=True, margin_mm=margin)
        off = rows.where(search=False, margin_mm=0.0)
        if not len(on) or not len(off):
            continue
        a, b = on.pair(off, "overlap_mm_s")
        if b.mean() == 0.0:
            return Evidence.untestable("nothing overlapped without the search either")
        estimates.append(statistics.paired_ratio(a, b))
    if not estimates:
        return Evidence.untestable("no runs with and without the search")
    return _largest(estimates)


def _obstacles(table: Table) -> Evidence:
    estimates = []
    for _, rows in table.split("sigma_mm"):
        a, b = rows.where(search=True).pair(rows.where(search=False), "obstacle_overlap_mm_s")
        estimates.append(statistics.paired_difference(a, b))
    return _largest(estimates)


def _largest(estimates: list[statistics.Estimate]) -> Evidence:
    """The estimate that reaches highest; every other interval lies below its upper end."""
    return Evidence.of(max(estimates, key=lambda e: (e.high, e.value)))


# suffix: failure, fail-safe search, decided at quick (cross4), the paper's words or ours
_CASES = {
    "": (
        "none",
        False,
        True,
        "in the next cycle the robots should be safe to default to their maximum deceleration",
    ),
    "-stopped": (
        "stopped",
        False,
        True,
        "not in the paper: one robot announces that it stops, and stops dead",
    ),
    "-dead": (
        "dead",
        False,
        False,
        "not in the paper: one robot stops dead without a word; the others learn it a cycle later",
    ),
    "-dead-fail-safe": (
        "dead",
        True,
        True,
        "not in the paper: the same, the search also clear of robots that brake instead of obeying",
    ),
    "-reports-lost": (
        "reports-lost",
        False,
        True,
        "not in the paper: 5 % of reports lost, dead reckoning and braking",
    ),
    "-commands-lost": (
        "commands-lost",
        False,
        False,
        "not in the paper: one robot's radio fails for a third of the time",
    ),
    "-commands-lost-fail-safe": (
        "commands-lost",
        True,
        False,
        "not in the paper: the same, the search also clear of robots that brake instead of obeying",
    ),
}


def _exactly_zero() -> list[Claim]:
    return [
        Claim(
            id=f"zero-{scene}{suffix}",
            text=text,
            how="robot pairs, depth x time, exact reports and commands; largest of all runs",
            bound=Bound("<=", _EXACT),
            unit="mm s",
            sizes=_ALL if quick and (scene == "cross4" or failure == "none") else _LARGE,
            needs={"mode": "metric", "scene": scene, "sigma_mm": 0.0, "margin_mm": 0.0,
                   "search": True, "failure": failure, "fail_safe": fail_safe, "latency": 0,
                   "motion": "paper"},
            evaluate=maximum("overlap_mm_s"),
        )
        for scene in ("A", "cross4", "cross10")
        for suffix, (failure, fail_safe, quick, text) in _CASES.items()
    ]  # fmt: skip


def _off_is_flat() -> Claim:
    def evaluate(table: Table) -> Evidence:
        exact = table.where(sigma_mm=0.0)
        estimates = []
        for sigma in _SIGMAS:
            noisy, base = table.where(sigma_mm=sigma).pair(exact, "overlap_mm_s")
            estimates.append(statistics.paired_ratio(noisy, base))
        worst = max(estimates, key=lambda e: max(abs(e.low - 1.0), abs(e.high - 1.0)))
        return Evidence.of(
            worst, why="ratio to sigma = 0 at the sigma whose interval reaches furthest from 1"
        )

    return Claim(
        id="off-is-flat",
        text="without the safety search, increasing the vision error makes little difference",
        how="robot pairs, depth x time, cross4, search off; mean at sigma / mean at 0, worst sigma",
        bound=Bound.within(0.85, 1.15),
        needs={"mode": "metric", "scene": "cross4", "search": False, "failure": "none",
               "latency": 0},
        evaluate=evaluate,
    )  # fmt: skip


def _small_margins_suffice() -> Claim:
    def evaluate(table: Table) -> Evidence:
        off = table.where(search=False, sigma_mm=0.0, margin_mm=0.0).values("overlap_mm_s").mean()
        estimates = []
        for margin in (1.0, 2.0, 3.0, 4.0):
            rows = table.where(search=True, margin_mm=margin, sigma_mm=(0.0, 1.0))
            values = rows.values("overlap_mm_s")
            estimates.append(statistics.mean(values / off))
        return _largest(estimates)

    return Claim(
        id="small-margins-suffice",
        text="with little or no vision error even small margins suffice for no collisions",
        how=(
            "robot pairs, depth x time, cross4, sigma 0 and 1 mm, margins 1 to 4 mm; mean relative "
            "to search off, largest over margins"
        ),
        bound=Bound("<=", 0.001),
        needs={"mode": "metric", "scene": "cross4", "failure": "none", "latency": 0},
        evaluate=evaluate,
    )


def _larger_margins_help() -> Claim:
    def evaluate(table: Table) -> Evidence:
        def total(margin: float) -> np.ndarray:
            rows = [table.where(margin_mm=margin, sigma_mm=s) for s in (3.0, 4.0, 5.0)]
            by_seed = [r.by_seed("overlap_mm_s") for r in rows]
            return np.array([sum(b[seed] for b in by_seed) for seed in by_seed[0]])

        return Evidence.of(statistics.paired_ratio(total(4.0), total(1.0)))

    return Claim(
        id="larger-margins-help",
        text="as the error increases there is a benefit to higher margins",
        how=(
            "robot pairs, depth x time, cross4, sum over sigma 3 to 5 mm; margin 4 mm / margin 1 mm"
        ),
        bound=Bound("<=", 1 / 3),
        needs={"mode": "metric", "scene": "cross4", "search": True, "failure": "none",
               "latency": 0},
        evaluate=evaluate,
    )  # fmt: skip


def _overlap_separates() -> Claim:
    return Claim(
        id="overlap-separates",
        text="the velocity chosen is the one which minimizes the interpenetration depth",
        how="two pairs start 60 and 80 mm deep in each other; last instant of overlap, worst run",
        bound=Bound("<=", 1.0),
        unit="s",
        sizes=_ALL,
        needs={"mode": "metric", "scene": "overlap"},
        evaluate=maximum("last_overlap_s"),
    )


def _latency() -> list[Claim]:
    needs = {"mode": "metric", "scene": "cross4", "latency": 1, "search": True, "sigma_mm": 0.0}
    return [
        Claim(
            id="latency-predicted",
            text="not in the paper: one cycle of command latency, predicted forward",
            how="robot pairs, depth x time, cross4; largest of all runs",
            bound=Bound("<=", _EXACT),
            unit="mm s",
            sizes=_ALL,
            needs={**needs, "predict": True},
            evaluate=maximum("overlap_mm_s"),
        ),
        Claim(
            id="latency-unpredicted",
            text="not in the paper: one cycle of command latency breaks safety if ignored",
            how="robot pairs, depth x time, cross4; mean of runs",
            bound=Bound(">", 0.1),
            unit="mm s",
            sizes=_ALL,
            needs={**needs, "predict": False},
            evaluate=lambda table: Evidence.of(statistics.mean(table.values("overlap_mm_s"))),
        ),
    ]


def _price() -> list[Claim]:
    def evaluate(table: Table) -> Evidence:
        on, off = table.where(search=True).pair(table.where(search=False), "goals")
        return Evidence.of(statistics.paired_ratio(on, off))

    return [
        Claim(
            id=f"price-of-safety-{scene}",
            text="not in the paper: goals reached with the search / without it",
            how="goals reached in a run, exact commands, sigma 0; ratio of means on / off",
            bound=Bound(">=", bound),
            sizes=_LARGE if scene == "cross10" else _ALL,
            needs={"mode": "metric", "scene": scene, "sigma_mm": 0.0, "margin_mm": 0.0,
                   "failure": "none", "latency": 0, "motion": "paper"},
            evaluate=evaluate,
        )
        for scene, bound in (("A", 0.5), ("cross4", 0.5), ("cross10", 0.25))
    ]  # fmt: skip


def _bisection() -> Claim:
    def evaluate(table: Table) -> Evidence:
        found = table.where(motion="bisection").pair(table.where(motion="paper"), "goals")
        return Evidence.of(statistics.paired_ratio(*found))

    return Claim(
        id="bisection-ablation",
        text="not in the paper: axes that arrive together, against along and across",
        how="goals reached in 30 s, scene A, sigma 0, search on; bisection / the paper's rule",
        bound=Bound.within(0.9, 1.1),
        needs={"mode": "metric", "scene": "A", "sigma_mm": 0.0, "margin_mm": 0.0, "search": True,
               "failure": "none", "latency": 0},
        evaluate=evaluate,
    )  # fmt: skip


def _physical() -> list[Claim]:
    found = [
        Claim(
            id=f"physical-no-contact-{scene}",
            text="robots should always be able to stop safely",
            how=(
                "planar drive in MuJoCo, EKF, sigma 0, margin 1 mm; time in robot-robot contact, "
                "longest run"
            ),
            bound=Bound("<=", 0.0),
            unit="s",
            sizes=_LARGE if scene == "cross10" else _ALL,
            needs={**_PLANAR, "scene": scene, "search": True, "margin_mm": 1.0},
            evaluate=maximum("contact_s"),
        )
        for scene in ("A", "cross4", "cross10")
    ]
    found.append(
        Claim(
            id="physical-off-collides",
            text="planner and motion control alone have no safety guarantees",
            how="planar drive in MuJoCo, EKF, cross4, search off; mean contact time of a run",
            bound=Bound(">", 1.0),
            unit="s",
            sizes=_ALL,
            needs={**_PLANAR, "scene": "cross4", "search": False},
            evaluate=lambda table: Evidence.of(statistics.mean(table.values("contact_s"))),
        )
    )
    for metric, published, bound, unit in (
        ("acceleration", "3 m/s^2", Bound.within(2.85, 3.15), "m/s^2"),
        ("braking", "6 m/s^2", Bound.within(5.7, 6.3), "m/s^2"),
        ("top_speed", "2 m/s", Bound.within(1.98, 2.02), "m/s"),
    ):
        found.append(
            Claim(
                id=f"physical-{metric.replace('_', '-')}",
                text=f"the robots' {metric.replace('_', ' ')}",
                published=published,
                how="one robot shuttling 4.2 m in MuJoCo; slope of its true speed",
                bound=bound,
                unit=unit,
                sizes=_ALL,
                needs={**_PLANAR, "scene": "straight"},
                evaluate=maximum(metric),
            )
        )
    return found


def _timing() -> list[Claim]:
    needs = {"mode": "metric", "scene": "A", "margin_mm": 0.0, "failure": "none", "latency": 0,
             "motion": "paper"}  # fmt: skip

    def added(table: Table) -> Evidence:
        on, off = table.where(search=True).pair(table.where(search=False), "wall_step_mean_us")
        return Evidence.of(statistics.difference_of_means(on / off.mean(), off / off.mean()))

    def slowest(table: Table) -> Evidence:
        values = table.where(search=True).values("wall_step_p95_us") * 4 / 1000
        return Evidence(float(values.max()), n=len(values))

    return [
        Claim(
            id="search-is-cheap",
            text="mean time of execution 0.70 ms without the velocity safety search, 0.76 ms with",
            published="+9 % (0.06 of 0.70 ms)",
            how="scene A, added mean wall time of plan and search / mean without search",
            bound=Bound("<=", 0.10),
            needs=needs,
            evaluate=added,
            timing=True,
        ),
        Claim(
            id="real-time",
            text="the 95 % percentiles are 1.96 ms and 2.04 ms",
            published="2.04 ms with search",
            how="scene A, four robots, 95th percentile of a cycle's plan and search, slowest run",
            bound=Bound("<=", 1000 / 60),
            unit="ms",
            needs=needs,
            evaluate=slowest,
            timing=True,
        ),
    ]
