"""Claims about what four rendered cameras make of the markers, fixed before the runs."""

import numpy as np

from mjmr import statistics
from mjmr.claims import Bound, Claim, Evidence, Table

_LARGE, _ALL = ("standard", "full"), ("quick", "standard", "full")
_MARKERS = {"mode": "physical", "scene": "markers"}


def markers() -> list[Claim]:
    """Errors, misses and phantoms."""

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
