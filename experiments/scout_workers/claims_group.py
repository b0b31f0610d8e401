"""Claims about many workers, and about what fails."""

from typing import Any

import numpy as np

from experiments.scout_workers.evidence import (
    PLAIN,
    mean_of,
    points_lost,
    successes,
    total,
)
from experiments.scout_workers.sizes import CHOSEN
from mjmr import statistics
from mjmr.claims import Bound, Claim, Evidence
from mjmr.table import Table

_LINE: dict[str, Any] = {
    **{k: v for k, v in PLAIN.items() if k != "succession"},
    "mode": "planar", "experiment": "succession", "maze": CHOSEN,
}  # fmt: skip
_CROWD: dict[str, Any] = {
    **PLAIN, "experiment": "scaling", "maze": CHOSEN, "forced": 4, "robots": 60,
    "finish": "remove",
}  # fmt: skip


def group() -> list[Claim]:
    """Claims of E2, E3 and the failures."""
    return [*_succession(), *_scaling(), *_failures()]


def _late_over_early(table: Table) -> Evidence:
    late, early = table.values("path_late"), table.values("path_early")
    both = np.isfinite(late) & np.isfinite(early)
    return Evidence.of(statistics.paired_ratio(late[both], early[both]))


def _slopes(table: Table) -> Evidence:
    """Mean slope and two standard errors either side."""
    slope = table.values("slope")
    slope = slope[np.isfinite(slope)]
    mean, error = float(slope.mean()), float(slope.std(ddof=1) / np.sqrt(len(slope)))
    return Evidence(mean, (mean - 2 * error, mean + 2 * error), len(slope))


def _slope_in_errors(table: Table) -> Evidence:
    """Mean slope over its standard error."""
    slope = table.values("slope")
    slope = slope[np.isfinite(slope)]
    error = float(slope.std(ddof=1) / np.sqrt(len(slope)))
    return Evidence(float(slope.mean()) / error, n=len(slope))


def _succession() -> list[Claim]:
    words = (
        "an improvement in the path from the nest to the goal each time a worker robot "
        "locates the goal"
    )
    average = {**_LINE, "succession": "average"}
    return [
        Claim(
            id="succession-ratio",
            text=words,
            how="m1 to m4, mean vector told on: paths of workers 8-10 / of 1-3, 40 scouts a maze",
            bound=Bound("<=", 0.95),
            needs=average,
            evaluate=_late_over_early,
        ),
        Claim(
            id="succession-slope",
            text=words,
            how="the same: slope of path / shortest over the worker's number, two standard errors",
            bound=Bound("<", 0.0),
            unit="1/worker",
            needs=average,
            evaluate=_slopes,
        ),
        Claim(
            id="succession-none-slope",
            text="not in the paper: nobody tells anything, nothing improves",
            how="finishers silent: mean slope over its standard error",
            bound=Bound.within(-2.0, 2.0),
            needs={**_LINE, "succession": "none"},
            evaluate=_slope_in_errors,
        ),
        Claim(
            id="succession-via-slope",
            text="location of obstacles, shorter path to the goal",
            how="m1, m3: via-points told on, the vector is the scout's: slope, two standard errors",
            bound=Bound("<", 0.0),
            unit="1/worker",
            needs={**_LINE, "succession": "via"},
            evaluate=_slopes,
        ),
        Claim(
            id="succession-near-optimal",
            text="a near optimal (shortest) path emerges",
            how="m1 to m4, mean vector told on: path of workers 8-10 / shortest, mean",
            bound=Bound("<=", 1.15),
            needs=average,
            evaluate=mean_of("path_late"),
        ),
        Claim(
            id="succession-near-optimal-both",
            text="a near optimal (shortest) path emerges",
            how="m1, m3: the same with mean vector and via-points",
            bound=Bound("<=", 1.15),
            needs={**_LINE, "succession": "both"},
            evaluate=mean_of("path_late"),
        ),
    ]


def _scaling() -> list[Claim]:
    def speed(table: Table) -> Evidence:
        values = table.values("wall_real_time")
        return Evidence(float(values.mean()), n=len(values))

    found = [
        Claim(
            id=f"sixty-{mode}",
            text=(
                "groups consisting of over sixty agents; can be scaled up to control groups "
                "consisting of many robots while still retaining its robustness"
            ),
            how=(
                f"60 robots, {mode}, one every 5 s, four forced units, picked up at the goal: "
                "share that arrives within 300 s, mean over 20 scouts or more"
            ),
            bound=Bound(">=", 0.85),
            needs={**_CROWD, "mode": mode},
            evaluate=mean_of("success"),
        )
        for mode in ("planar", "physical")
    ]
    for finish in ("home", "park"):
        found.append(
            Claim(
                id=f"sixty-{finish}",
                text="the worker would return to the nest",
                how=f"the same in m3, finishers {finish}: share that arrives, mean",
                bound=Bound(">=", 0.85),
                needs={**_CROWD, "mode": "planar", "maze": "m3", "finish": finish},
                evaluate=mean_of("success"),
            )
        )
    found.append(
        Claim(
            id="sixty-speed",
            text="not in the paper: 60 scouts and workers in MuJoCo, simulated s a CPU second",
            how="60 robots, physical, mean over runs",
            bound=Bound(">=", 5.0),
            needs={**_CROWD, "mode": "physical"},
            evaluate=speed,
            timing=True,
        )
    )
    return found


def _failures() -> list[Claim]:
    found: list[Claim] = []
    for mode, mazes in (("planar", CHOSEN), ("physical", "m3")):
        plain: dict[str, Any] = {
            **{k: v for k, v in PLAIN.items() if k != "failure"},
            "experiment": "maze", "robots": 2, "mode": mode, "maze": mazes,
        }  # fmt: skip
        pair = {**plain, "failure": ("none", "ir-dead")}
        where = "m1 to m4" if mode == "planar" else "m3"
        found += [
            Claim(
                id=f"ir-dead-{mode}",
                text=(
                    "sensory and equipment failures occurred that did not significantly diminish "
                    "the overall success"
                ),
                how=f"{where}, the worker's detectors dead: share of successes lost",
                bound=Bound("<=", 0.25),
                needs=pair,
                evaluate=_ir_lost,
            ),
            Claim(
                id=f"ir-dead-bumps-{mode}",
                text=(
                    "If the infrared detectors failed to sense an imminent obstacle, the bumper "
                    "sensors would detect an impact"
                ),
                how=f"{where}: bumps of workers that arrive, detectors dead / alive, means",
                bound=Bound(">=", 3.0),
                needs=pair,
                evaluate=_bumps,
            ),
            Claim(
                id=f"scout-killed-{mode}",
                text=(
                    "minimizes the risk to the robot group as a whole by deploying only a single "
                    "robot initially"
                ),
                how="m3, the scout dies at the goal before it sends: workers that leave",
                bound=Bound("<=", 0.0),
                needs={**plain, "maze": "m3", "failure": "scout-killed"},
                evaluate=total("left"),
            ),
            Claim(
                id=f"worker-dead-{mode}",
                text=(
                    "each of them would simply view the others in the group as obstacles and avoid "
                    "them as necessary"
                ),
                how=(
                    "corridor 0.8 m wide, the first worker dies in it: share of seconds that "
                    "arrive within 300 s"
                ),
                bound=Bound(">=", 0.8),
                needs={**plain, "robots": 3, "maze": "corridor", "failure": "worker-dead"},
                evaluate=successes,
            ),
        ]
    found.append(
        Claim(
            id="bad-checksum",
            text="Error detection was enhanced by using the division form of this method",
            how="m3, the scout's check byte is wrong: workers that leave",
            bound=Bound("<=", 0.0),
            sizes=("quick", "standard", "full"),
            needs={"experiment": "maze", "maze": "m3", "failure": "bad-checksum"},
            evaluate=total("left"),
        )
    )
    return found


def _ir_lost(table: Table) -> Evidence:
    return points_lost(table, {"failure": "none"}, {"failure": "ir-dead"})


def _bumps(table: Table) -> Evidence:
    dead, alive = (table.where(failure=f) for f in ("ir-dead", "none"))
    a = dead.values("bumps")[dead.values("success")]
    b = alive.values("bumps")[alive.values("success")]
    return Evidence.of(statistics.ratio_of_means(a, b))
