"""Claims about one scout and one worker: faster, by a short way, with worse compass and margins."""

from typing import Any

import numpy as np

from experiments.scout_workers.evidence import (
    PLAIN,
    extreme,
    mean_of,
    median_of,
    points_lost,
    ratio_of_medians,
    successes,
)
from experiments.scout_workers.sizes import CHOSEN, FRESH, MARGINS
from mjmr import statistics
from mjmr.claims import Bound, Claim, Evidence
from mjmr.table import Table

_ALL = ("quick", "standard", "full")
_MAZE: dict[str, Any] = {"experiment": "maze", "robots": 2, **PLAIN}


def mazes() -> list[Claim]:
    """Claims of E1, E4 and E5 and of the open field."""
    found: list[Claim] = []
    for mode, names in (("planar", CHOSEN + FRESH), ("physical", CHOSEN + FRESH)):
        for maze in names:
            fresh = ", fresh maze" if maze in FRESH else ""
            found.append(_faster(mode, maze, fresh))
        for maze in names:
            fresh = ", fresh maze" if maze in FRESH else ""
            found.append(_arrives(mode, maze, fresh))
        found += [_arrives_over(mode, CHOSEN, ""), _arrives_over(mode, FRESH, "-fresh")]
        found += [_short(mode, maze) for maze in names]
    return [*found, *_open_field(), *_compass(), *_margins(), *_errors()]


def _needs(mode: str, maze: str | tuple[str, ...]) -> dict[str, Any]:
    return {**_MAZE, "mode": mode, "maze": maze}


def _faster(mode: str, maze: str, fresh: str) -> Claim:
    return Claim(
        id=f"faster-{maze}-{mode}",
        text=(
            "the path to the goal chosen by the worker robot was much more efficient than that of "
            "the scout robot in every case"
        ),
        published="every case; times lost",
        how=f"maze {maze}{fresh}: median time of workers that arrive / median of their scouts",
        bound=Bound("<=", 0.5),
        needs=_needs(mode, maze),
        evaluate=ratio_of_medians,
    )


def _arrives(mode: str, maze: str, fresh: str) -> Claim:
    return Claim(
        id=f"arrives-{maze}-{mode}",
        text="a multi-agent robot group successfully navigated various unknown environments",
        how=f"maze {maze}{fresh}: share of workers at the goal within 300 s",
        bound=Bound(">=", 0.8),
        needs=_needs(mode, maze),
        evaluate=successes,
    )


def _arrives_over(mode: str, names: tuple[str, ...], suffix: str) -> Claim:
    return Claim(
        id=f"arrives{suffix}-{mode}",
        text="a multi-agent robot group successfully navigated various unknown environments",
        how=f"mazes {', '.join(names)}: share of workers at the goal within 300 s",
        bound=Bound(">=", 0.9),
        needs=_needs(mode, names),
        evaluate=successes,
    )


def _short(mode: str, maze: str) -> Claim:
    return Claim(
        id=f"short-{maze}-{mode}",
        text=(
            "a near optimal (shortest) path emerges through the environment without mapping the "
            "environment"
        ),
        how=f"maze {maze}: path of workers that arrive / shortest of a robot's middle; median",
        bound=Bound("<=", 1.5),
        needs=_needs(mode, maze),
        evaluate=median_of("path_ratio"),
    )


def _open_field() -> list[Claim]:
    field: dict[str, Any] = {"experiment": "open", "servo_pct": 0.0}
    return [
        Claim(
            id="vector-exact",
            text="ours, of Eqs. 3 and 4: they give the direction and displacement travelled",
            how="400 loops of wandering, exact compass and servos: vector against truth, worst run",
            bound=Bound("<=", 1e-9),
            unit="units",
            sizes=_ALL,
            needs={**field, "compass": "exact"},
            evaluate=extreme("error_units"),
        ),
        Claim(
            id="vector-coded",
            text="approximately 2.8 degrees, which was sufficient for the experiment",
            published="2.8 deg, whole units",
            how=(
                "the same, every loop: how far the coded vector is off, beyond "
                "sqrt(0.25 + (0.0245 D)^2); worst run"
            ),
            bound=Bound("<=", 0.01),
            unit="units",
            sizes=_ALL,
            needs={**field, "compass": "exact"},
            evaluate=extreme("coding_excess_units"),
        ),
        Claim(
            id="vector-coded-in-range",
            text="approximately 2.8 degrees, which was sufficient for the experiment",
            published="2.8 deg, whole units",
            how=(
                "the same, while the displacement fits into its byte (255 units); written when "
                "vector-coded had failed"
            ),
            bound=Bound("<=", 0.01),
            unit="units",
            sizes=_ALL,
            needs={**field, "compass": "exact"},
            evaluate=extreme("coding_excess_in_range_units"),
        ),
        Claim(
            id="vector-noisy",
            text=(
                "errors fluctuated between positive and negative discrepancies, their combined "
                "effect was minimal"
            ),
            how="400 loops of wandering, compass of 2 deg noise and steps: error / path, worst run",
            bound=Bound("<=", 5.0),
            unit="%",
            sizes=_ALL,
            needs={**field, "compass": "white"},
            evaluate=extreme("error_pct"),
        ),
        Claim(
            id="vector-all-errors",
            text="not in the paper: with drift, bias by place and servos 5 % apart",
            how="the same with every error there is: error / path, mean",
            bound=Bound("<=", 5.0),
            unit="%",
            sizes=_ALL,
            needs={"experiment": "open", "servo_pct": 5.0, "compass": "card"},
            evaluate=mean_of("error_pct"),
        ),
    ]


def _without(*names: str) -> dict[str, Any]:
    return {k: v for k, v in _needs("planar", CHOSEN).items() if k not in names}


def _compass() -> list[Claim]:
    needs = _without("compass_deg")

    def lost(step: float):
        return lambda table: points_lost(table, {"compass_deg": 2.0}, {"compass_deg": step})

    return [
        Claim(
            id="compass-15",
            text=(
                "reduced numerical accuracy of directional data does not compromise the system's "
                "overall performance"
            ),
            how="m1 to m4, compass in steps of 15 instead of 2 deg: share of successes lost",
            bound=Bound("<=", 0.10),
            needs={**needs, "compass_deg": (2.0, 15.0)},
            evaluate=lost(15.0),
        ),
        Claim(
            id="compass-45",
            text=(
                "a resolution of approximately 45 degrees; the reduced numerical accuracy will not "
                "compromise the scheme's overall performance"
            ),
            how="m1 to m4, compass in steps of 45 deg: share of workers that arrive",
            bound=Bound(">=", 0.70),
            needs={**needs, "compass_deg": 45.0},
            evaluate=successes,
        ),
    ]


def _margins() -> list[Claim]:
    needs = {k: v for k, v in _needs("planar", "m3").items() if k not in ("margin_deg", "forced")}

    def spread(table: Table) -> Evidence:
        shares = [successes(table.where(margin_deg=m)) for m in MARGINS]
        worst = min(shares, key=lambda e: (e.interval or (0.0, 0.0))[0])
        return Evidence(worst.measured, worst.interval, worst.n)

    def compared(margin: float, bound: Bound, sizes: tuple[str, ...]) -> Claim:
        return Claim(
            id=f"margin-{margin:.0f}-compared",
            text=(
                "is what enabled the (worker) robot to successfully seek the location of a goal in "
                "the presence of unknown obstacles"
            ),
            how=(
                f"m3, heading compared in every loop, margin {margin:.0f} deg: share of workers "
                "that arrive"
            ),
            bound=bound,
            sizes=sizes,
            needs={**needs, "forced": 0, "margin_deg": margin},
            evaluate=successes,
        )

    large = ("standard", "full")
    return [
        compared(5.0, Bound("<=", 0.1), large),
        compared(35.0, Bound("<=", 0.5), large),
        compared(90.0, Bound(">=", 0.7), large),
        Claim(
            id="margin-forced",
            text="not in the paper: with one unit forward before comparing, any margin will do",
            how="m3, margins of 5 to 90 deg: share of workers that arrive, the lowest",
            bound=Bound(">=", 0.8),
            needs={**needs, "forced": 1, "margin_deg": MARGINS},
            evaluate=spread,
        ),
    ]


def _errors() -> list[Claim]:
    servo = {k: v for k, v in _needs("planar", "m3").items() if k != "servo_pct"}
    bits = {k: v for k, v in _needs("planar", "m3").items() if k != "bit_error"}

    def misled(table: Table) -> Evidence:
        values = table.values("groups_undetected") > 0
        return Evidence(float(np.mean(values)), n=len(values))

    def misled_at_most(table: Table) -> Evidence:
        return Evidence.of(statistics.proportion(table.values("groups_undetected") > 0))

    return [
        Claim(
            id="servos",
            text=(
                "The difference in the speeds of the robots; did not compromise the success of the "
                "control scheme"
            ),
            how="m3, servos up to 10 % fast or slow instead of none: share of successes lost",
            bound=Bound("<=", 0.10),
            needs={**servo, "servo_pct": (0.0, 10.0)},
            evaluate=lambda t: points_lost(t, {"servo_pct": 0.0}, {"servo_pct": 10.0}),
        ),
        Claim(
            id="bit-errors",
            text="regain control after erroneous data reception",
            how="m3, 5 % of bits read wrong, groups checked: share of successes lost",
            bound=Bound("<=", 0.10),
            needs={**bits, "bit_error": (0.0, 0.05)},
            evaluate=lambda t: points_lost(t, {"bit_error": 0.0}, {"bit_error": 0.05}),
        ),
        Claim(
            id="bit-errors-misled",
            text="ours: erroneous reception, a problem in the paper, is caught by the checks",
            how="m3, 2 to 10 % of bits read wrong: share of runs in which a wrong group passed",
            bound=Bound("<=", 0.05),
            needs={**bits, "bit_error": (0.02, 0.05, 0.1)},
            evaluate=misled,
        ),
        Claim(
            id="bit-errors-misled-interval",
            text="ours: erroneous reception, a problem in the paper, is caught by the checks",
            how=(
                "the same with Wilson's interval: its upper end decides, not the share alone; "
                "written when bit-errors-misled had been measured"
            ),
            bound=Bound("<=", 0.05),
            needs={**bits, "bit_error": (0.02, 0.05, 0.1)},
            evaluate=misled_at_most,
        ),
    ]
