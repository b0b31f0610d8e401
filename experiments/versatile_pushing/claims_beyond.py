"""What the paper does not say: both variants of vision agree, and recovery from stagnation."""

from collections.abc import Callable

import numpy as np

from mjmr.claims import Bound, Claim, Evidence, Table

_ALL = ("quick", "standard", "full")
_TEXT_VISION = "not in the paper: rays stand for the turret's camera"
_TEXT_CAMERA = "not in the paper: the same by rendered pictures of the turret's camera"
_TEXT_RECOVERY = (
    "stagnation recovery techniques to eliminate p-sensitivity would be useful (future work)"
)
_RECOVERY = {"task": "transport", "c": 1.0, "recovery": True}
_ALONE = {**_RECOVERY, "weight": 1, "failure": "none"}


def beyond() -> list[Claim]:
    """Claims of ours."""
    return [*_vision(), *_camera(), *_recovery()]


def _vision() -> list[Claim]:
    return [
        _agreement(
            "vision-both", "both_share", Bound(">=", 0.9), "",
            "objects well inside the limits, same poses: twice those found by both / sum of those "
            "found by each; least of trials", np.min,
        ),
        _agreement(
            "vision-bearing", "bearing_rms_deg", Bound("<=", 2.0), "deg",
            "bearing of what both found, camera - rays, RMS; largest of trials", np.max,
        ),
        _agreement(
            "vision-range", "range_median_pct", Bound("<=", 10.0), "%",
            "range of what both found, |camera - rays| / rays, median; largest of trials", np.max,
        ),
        _agreement(
            "vision-near", "near_range_rms_m", Bound("<=", 0.07), "m",
            "range of what both found nearer than 1 m, camera - rays, RMS; largest of trials",
            np.max,
        ),
    ]  # fmt: skip


def _agreement(id: str, metric: str, bound: Bound, unit: str, how: str, which: Callable) -> Claim:
    return Claim(
        id=id,
        text=_TEXT_VISION,
        how=how,
        bound=bound,
        unit=unit,
        sizes=_ALL,
        needs={"task": "vision"},
        evaluate=lambda table: _of(table, metric, which),
    )


def _of(table: Table, metric: str, which: Callable) -> Evidence:
    values = table.values(metric)
    return Evidence(float(which(values)), n=len(values))


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
                evaluate=_success,
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
            evaluate=_least_share,
        ),
        Claim(
            id="recovery-gain",
            text=_TEXT_RECOVERY,
            how="2 robots, p = 0 and 4: share of trials done with recovery, 120 s, - without, "
            "60 s; lesser gain",
            bound=Bound(">=", 50.0),
            unit="points",
            needs={
                "task": "transport", "c": 1.0, "weight": 1, "robots": 2, "p": (0.0, 4.0),
                "failure": "none", "vision": "arcs", "duration": (60.0, 120.0),
            },
            evaluate=_gain,
        ),
        Claim(
            id="recovery-too-few",
            text="not in the paper: recovery moves nothing that is too heavy",
            how="w = 1, 1 robot with recovery, 300 s: share of trials done",
            bound=Bound("<=", 0.0),
            unit="%",
            needs={**_ALONE, "robots": 1},
            evaluate=_success,
        ),
        Claim(
            id="recovery-one-spare",
            text="not in the paper: one robot stops, and as many as the weight takes are left",
            how="as stopped-one-spare, with recovery: share of trials done in 300 s, lesser one; "
            "added after stopped-one-spare failed, bound before its own run",
            bound=Bound(">=", 100.0),
            unit="%",
            needs={**_RECOVERY, "failure": "stopped"},
            evaluate=_spare,
        ),
    ]  # fmt: skip


def _spare(table: Table) -> Evidence:
    table.values("success")  # says so if there are no trials
    shares = [100.0 * float(np.mean(part.values("success"))) for _, part in table.split("weight")]
    return Evidence(min(shares), n=len(table))


def _success(table: Table) -> Evidence:
    values = table.values("success")
    return Evidence(100.0 * float(np.mean(values)), n=len(values))


def _least_share(table: Table) -> Evidence:
    table.values("success")
    shares = [
        100.0 * float(np.mean(part.values("success")))
        for _, team in table.split("robots")
        for _, part in team.split("p")
    ]
    return Evidence(min(shares), n=len(table))


def _gain(table: Table) -> Evidence:
    table.values("success")
    gains = []
    for _, part in table.split("p"):
        with_it = part.where(recovery=True, duration=120.0).values("success")
        without = part.where(recovery=False, duration=60.0).values("success")
        gains.append(100.0 * (float(np.mean(with_it)) - float(np.mean(without))))
    return Evidence(min(gains), n=len(table))
