"""What the paper does not say: both variants of vision agree, and recovery from stagnation."""

from experiments.versatile_pushing.evidence import (
    Pick,
    extreme,
    extreme_share,
    gain_of_firsts,
    lesser_gain,
    share,
    share_with_interval,
)
from mjmr.claims import Bound, Claim

_ALL = ("quick", "standard", "full")
_TEXT_VISION = "not in the paper: rays stand for the turret's camera"
_TEXT_CAMERA = "not in the paper: the same by rendered pictures of the turret's camera"
_TEXT_RECOVERY = (
    "stagnation recovery techniques to eliminate p-sensitivity would be useful (future work)"
)
_RECOVERY = {"task": "transport", "c": 1.0, "recovery": True}
_ALONE = {**_RECOVERY, "weight": 1, "failure": "none"}
_TWO = {
    "task": "transport", "c": 1.0, "weight": 1, "robots": 2, "p": (0.0, 4.0), "failure": "none",
    "vision": "arcs", "duration": (60.0, 120.0),
}  # fmt: skip


def beyond() -> list[Claim]:
    """Claims of ours."""
    return [*_vision(), *_camera(), *_recovery()]


def _vision() -> list[Claim]:
    return [
        _agreement(
            "vision-both", "both_share", Bound(">=", 0.85), "",
            "objects well inside the limits, same poses: twice those found by both / sum of those "
            "found by each; least of trials", min,
        ),
        _agreement(
            "vision-both-90", "both_share", Bound(">=", 0.9), "",
            "the same; a bound set a few minutes after the first", min,
        ),
        _agreement(
            "vision-bearing", "bearing_rms_deg", Bound("<=", 2.0), "deg",
            "bearing of what both found, camera - rays, RMS; largest of trials", max,
        ),
        _agreement(
            "vision-range", "range_median_pct", Bound("<=", 10.0), "%",
            "range of what both found, |camera - rays| / rays, median; largest of trials", max,
        ),
        _agreement(
            "vision-near", "near_range_rms_m", Bound("<=", 0.07), "m",
            "range of what both found nearer than 1 m, camera - rays, RMS; largest of trials",
            max,
        ),
    ]  # fmt: skip


def _agreement(id: str, metric: str, bound: Bound, unit: str, how: str, which: Pick) -> Claim:
    return Claim(
        id=id,
        text=_TEXT_VISION,
        how=how,
        bound=bound,
        unit=unit,
        sizes=_ALL,
        needs={"task": "vision"},
        evaluate=extreme(metric, which),
    )


def _camera() -> list[Claim]:
    found = []
    for task, how in (
        ("foraging", "c = 0, 3 maps, 2,620 s"),
        ("construction", "1 map, 2,620 s"),
        ("transport", "w = 1, 2 robots, p = 2, 60 s"),
    ):
        found.append(
            Claim(
                id=f"camera-{task}",
                text=_TEXT_CAMERA,
                how=f"{how}: share of trials done",
                bound=Bound(">=", 100.0),
                unit="%",
                needs={"task": task, "vision": "camera", "failure": "none"},
                evaluate=share,
            )
        )
    return found


def _recovery() -> list[Claim]:
    return [
        Claim(
            id="recovery-any-p",
            text=_TEXT_RECOVERY,
            how="w = 1, 2 to 4 robots, p = 0 to 4 to begin with, robots change their own p when "
            "their target stays: share of trials done within 120 s, least over p and teams",
            bound=Bound(">=", 80.0),
            unit="%",
            needs={**_ALONE, "robots": (2, 3, 4)},
            evaluate=extreme_share(min, "robots", "p"),
        ),
        Claim(
            id="recovery-all",
            text=_TEXT_RECOVERY,
            how="the same, all p and teams together, with Wilson's interval; written when "
            "recovery-any-p had held",
            bound=Bound(">=", 80.0),
            unit="%",
            needs={**_ALONE, "robots": (2, 3, 4)},
            evaluate=share_with_interval,
        ),
        Claim(
            id="recovery-gain",
            text=_TEXT_RECOVERY,
            how="2 robots, p = 0 and 4: share of the first six trials of each done with recovery, "
            "120 s, - without, 60 s",
            bound=Bound(">=", 50.0),
            unit="points",
            needs=_TWO,
            evaluate=gain_of_firsts,
        ),
        Claim(
            id="recovery-gain-lesser",
            text=_TEXT_RECOVERY,
            how="the same with every trial, the lesser gain; written when quick trials had been "
            "seen",
            bound=Bound(">=", 50.0),
            unit="points",
            needs=_TWO,
            evaluate=lesser_gain,
        ),
        Claim(
            id="recovery-too-few",
            text="not in the paper: recovery moves nothing that is too heavy",
            how="w = 1, 1 robot with recovery, 300 s: share of trials done",
            bound=Bound("<=", 0.0),
            unit="%",
            needs={**_ALONE, "robots": 1},
            evaluate=share,
        ),
        Claim(
            id="recovery-one-spare",
            text="not in the paper: one robot stops, and as many as the weight takes are left",
            how="as stopped-one-spare, with recovery: share of trials done in 300 s, lesser one; "
            "added after stopped-one-spare failed, bound before its own run",
            bound=Bound(">=", 100.0),
            unit="%",
            needs={**_RECOVERY, "failure": "stopped"},
            evaluate=extreme_share(min, "weight"),
        ),
    ]  # fmt: skip
