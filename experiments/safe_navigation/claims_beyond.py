"""Claims beyond the paper: strangers, carts, latency on bodies, omni-wheels, overhead vision.

The paper has no number for any of them; every bound is ours, fixed before the runs that decide it.
"""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from experiments.safe_navigation.sizes import CARTS, OMNI_MARGIN, VISION_MARGIN, VISION_SIGMA
from mjmr import statistics
from mjmr.claims import Bound, Claim, Evidence, Table

_ALL = ("quick", "standard", "full")
_LARGE = ("standard", "full")
_PHYSICAL = {"mode": "physical", "search": True, "failure": "none", "latency": 0,
             "drive": "planar", "sensing": "report"}  # fmt: skip


def beyond() -> list[Claim]:
    """Every claim of what the paper did not try."""
    return [*_stranger(), *_carts(), *_latency(), *_omni(), *_vision()]


def maximum(metric: str) -> Callable[[Table], Evidence]:
    """The largest value of a metric over all runs."""

    def evaluate(table: Table) -> Evidence:
        values = table.values(metric)
        return Evidence(float(values.max()), n=len(values))

    return evaluate


def _mean(metric: str) -> Callable[[Table], Evidence]:
    return lambda table: Evidence.of(statistics.mean(table.values(metric)))


def _ratio(metric: str, over: Mapping[str, Any], under: Mapping[str, Any]):
    def evaluate(table: Table) -> Evidence:
        pairs = table.where(**over).pair(table.where(**under), metric)
        if not pairs[1].any():
            return Evidence.untestable(f"{metric} is 0 in every run that is compared with")
        return Evidence.of(statistics.paired_ratio(*pairs))

    return evaluate


def _stranger() -> list[Claim]:
    needs = {"mode": "metric", "scene": "stranger10", "sigma_mm": 0.0, "margin_mm": 0.0}
    foreseen, believed = {"search": True, "foresee": True}, {"search": True, "foresee": False}
    return [
        Claim(
            id="stranger-breaks-the-chain",
            text=(
                "it depends on the chance that the other robots involved can choose commands to "
                "avoid the collision"
            ),
            how=(
                "cross10, one robot goes straight at 1 m/s and minds nobody, the search believes "
                "that it obeys; pairs with it, depth x time; mean of runs"
            ),
            bound=Bound(">", 1.0),
            unit="mm s",
            needs={**needs, **believed},
            evaluate=_mean("stranger_overlap_mm_s"),
        ),
        Claim(
            id="stranger-foreseen",
            text="not in the paper: the search expects the stranger to keep its velocity",
            how="pairs with the stranger, depth x time; ratio of means foreseen / believed",
            bound=Bound("<=", 0.5),
            needs=needs,
            evaluate=_ratio("stranger_overlap_mm_s", foreseen, believed),
        ),
        Claim(
            id="stranger-spares-the-others",
            text="not in the paper: a stranger does not undo the safety of the others",
            how="pairs without the stranger, depth x time; ratio of means foreseen / search off",
            bound=Bound("<=", 0.05),
            needs=needs,
            evaluate=_ratio("overlap_mm_s", foreseen, {"search": False, "foresee": True}),
        ),
    ]


def _carts() -> list[Claim]:
    found = []
    for scene in CARTS:
        needs = {"scene": scene, "sigma_mm": 0.0}
        suffix = scene.removeprefix("carts")
        where = "" if not suffix else "; carts that leave room for a robot"
        found += [
            Claim(
                id=f"carts{suffix}-search-reduces-overlap",
                text="not in the paper: boxes that move, tested in their own frame",
                how=f"robots and carts or walls, depth x time; ratio of means on / off{where}",
                bound=Bound("<=", 0.05),
                needs={**needs, "mode": "metric"},
                evaluate=_ratio("obstacle_overlap_mm_s", {"search": True}, {"search": False}),
            ),
            Claim(
                id=f"carts{suffix}-physical-contact",
                text="not in the paper: the same on bodies, planar drive, margin 1 mm",
                how=f"time in contact with carts, walls and robots, longest run{where}",
                bound=Bound("<=", 0.1),
                unit="s",
                needs={**needs, **_PHYSICAL},
                evaluate=_longest_contact,
            ),
        ]
    return found


def _longest_contact(table: Table) -> Evidence:
    total = table.values("contact_s") + table.values("obstacle_contact_s")
    return Evidence(float(total.max()), n=len(total))


def _latency() -> list[Claim]:
    found = []
    for cycles, word in ((1, "one cycle"), (2, "two cycles")):
        needs = {**_PHYSICAL, "scene": "cross4", "margin_mm": 1.0, "latency": cycles,
                 "sigma_mm": 0.0}  # fmt: skip
        found += [
            Claim(
                id=f"latency-{cycles}-predicted-no-contact",
                text=f"not in the paper: {word} of command latency on bodies, predicted forward",
                how="planar drive, cross4, margin 1 mm; robot-robot contact, longest run",
                bound=Bound("<=", 0.0),
                unit="s",
                needs={**needs, "predict": True},
                evaluate=maximum("contact_s"),
            ),
            Claim(
                id=f"latency-{cycles}-ignored-collides",
                text=f"not in the paper: {word} of command latency on bodies, ignored",
                how="planar drive, cross4, margin 1 mm; robot-robot contact, mean of runs",
                bound=Bound(">", 0.005),
                unit="s",
                needs={**needs, "predict": False},
                evaluate=_mean("contact_s"),
            ),
        ]
    return found


def _omni() -> list[Claim]:
    straight = {"mode": "physical", "scene": "straight", "drive": "omni"}
    asked = {**straight, "limits": "paper", "dt_ms": 5.0}
    found = [
        Claim(
            id="omni-acceleration",
            text="the robots' acceleration, on four omni-wheels",
            published="3 m/s^2",
            how=(
                "one robot shuttling 4.2 m on wheel contact alone, in any direction of its own, "
                "asked for 3 and 6 m/s^2; slope of its true speed, the run furthest from 3"
            ),
            bound=Bound.within(2.82, 3.18),
            unit="m/s^2",
            sizes=_ALL,
            needs=asked,
            evaluate=_furthest_from(3.0, "acceleration"),
        ),
        Claim(
            id="omni-braking-covers-the-plan",
            text="the robots' braking, on four omni-wheels",
            published="6 m/s^2",
            how=(
                "the same runs, the least of them; bound: what the navigator plans with on this "
                "drive"
            ),
            bound=Bound(">=", 3.0),
            unit="m/s^2",
            sizes=_ALL,
            needs=asked,
            evaluate=lambda table: _least(table, "braking"),
        ),
        Claim(
            id="omni-goes-straight",
            text="not in the paper: heading on straight runs within the measured limits",
            how="the same, asked for 3 and 3 m/s^2; largest change of heading in a run, worst run",
            bound=Bound("<=", 0.5),
            unit="deg",
            sizes=_ALL,
            needs={**straight, "limits": "measured", "dt_ms": 5.0},
            evaluate=maximum("yaw_deg"),
        ),
    ]
    found += [
        Claim(
            id=f"omni-{metric}-of-timestep",
            text="not in the paper: the timestep does not decide what the wheels can do",
            how=(
                f"asked for 3 and 6 m/s^2; {metric} at a timestep of 4.2 ms / at 1.9 ms, the "
                "direction with the largest difference"
            ),
            bound=Bound.within(0.95, 1.05),
            needs={**straight, "limits": "paper"},
            evaluate=_same(metric),
        )
        for metric in ("acceleration", "braking")
    ]
    for scene in ("A", "cross4"):
        needs = {"mode": "physical", "scene": scene, "drive": "omni", "limits": "measured",
                 "search": True, "margin_mm": OMNI_MARGIN, "sigma_mm": 0.0}  # fmt: skip
        found += [
            Claim(
                id=f"omni-no-contact-{scene}",
                text="robots should always be able to stop safely, on four omni-wheels",
                how=(
                    f"planned from the measured limits, EKF, sigma 0, margin {OMNI_MARGIN:g} mm; "
                    "time in robot-robot contact, longest run"
                ),
                bound=Bound("<=", 0.0),
                unit="s",
                sizes=_ALL if scene == "cross4" else _LARGE,
                needs=needs,
                evaluate=maximum("contact_s"),
            ),
            Claim(
                id=f"omni-spares-obstacles-{scene}",
                text="satisfies both obstacle and dynamics constraints, on four omni-wheels",
                how="the same runs; time in contact with walls and boxes, longest run",
                bound=Bound("<=", 0.1),
                unit="s",
                sizes=_ALL if scene == "cross4" else _LARGE,
                needs=needs,
                evaluate=maximum("obstacle_contact_s"),
            ),
        ]
    return found


def _furthest_from(target: float, metric: str) -> Callable[[Table], Evidence]:
    def evaluate(table: Table) -> Evidence:
        values = table.values(metric)
        return Evidence(float(values[np.argmax(np.abs(values - target))]), n=len(values))

    return evaluate


def _least(table: Table, metric: str) -> Evidence:
    values = table.values(metric)
    return Evidence(float(values.min()), n=len(values))


def _same(metric: str) -> Callable[[Table], Evidence]:
    def evaluate(table: Table) -> Evidence:
        coarse, fine = table.where(dt_ms=5.0).pair(table.where(dt_ms=2.0), metric)
        ratio = coarse / fine
        return Evidence(float(ratio[np.argmax(np.abs(ratio - 1.0))]), n=len(ratio))

    return evaluate


def _vision() -> list[Claim]:
    gallery = {"scene": "gallery", "sensing": "vision"}
    words = "not in the paper: overhead camera, uneven light, noise; single images, ten robots"
    found = [
        Claim(
            id=id,
            text=words,
            how=f"images of ten robots at random poses; {what}",
            bound=Bound("<=", bound),
            unit=unit,
            sizes=_LARGE,
            needs=gallery,
            evaluate=evaluate,
        )
        for id, what, bound, unit, evaluate in (
            ("vision-position", "root mean square over all", 4.0, "mm", _rms("position_rms_mm")),
            ("vision-heading", "root mean square over all", 2.0, "deg", _rms("heading_rms_deg")),
            ("vision-identity", "robots missed or mistaken", 0.1, "%", _lost),
        )
    ]
    for sensing, what in (
        ("vision", "by rendered images at 30 Hz, two cycles late"),
        ("late-report", "by a Gaussian report of the same error, rate and latency"),
    ):
        for scene in ("A", "cross4"):
            found.append(
                Claim(
                    id=f"{sensing}-no-contact-{scene}",
                    text=f"not in the paper: navigation {what}",
                    how=(
                        f"planar drive, EKF, margin {VISION_MARGIN:g} mm; time in robot-robot "
                        "contact, longest run"
                    ),
                    bound=Bound("<=", 0.0),
                    unit="s",
                    sizes=_LARGE,
                    needs={**_PHYSICAL, "scene": scene, "sensing": sensing,
                           "margin_mm": VISION_MARGIN, "sigma_mm": VISION_SIGMA},
                    evaluate=maximum("contact_s"),
                )
            )  # fmt: skip
    found.append(
        Claim(
            id="vision-gets-there",
            text="not in the paper: navigation by images is not slower than by reports",
            how="goals reached in both scenes; ratio of means images / Gaussian report",
            bound=Bound.within(0.9, 1.1),
            needs={**_PHYSICAL, "sensing": ("vision", "late-report"), "scene": ("A", "cross4"),
                   "margin_mm": VISION_MARGIN, "sigma_mm": VISION_SIGMA},
            evaluate=_ratio("goals", {"sensing": "vision"}, {"sensing": "late-report"}),
        )
    )  # fmt: skip
    return found


def _rms(metric: str) -> Callable[[Table], Evidence]:
    def evaluate(table: Table) -> Evidence:
        squares = statistics.mean(table.values(metric) ** 2)
        low, high = max(squares.low, 0.0), squares.high
        return Evidence(squares.value**0.5, (low**0.5, high**0.5), squares.n)

    return evaluate


def _lost(table: Table) -> Evidence:
    seen, lost = table.values("robots_shown").sum(), table.values("robots_lost").sum()
    share = statistics.proportion(int(lost), int(seen))
    return Evidence(100 * share.value, (100 * share.low, 100 * share.high), share.n)
