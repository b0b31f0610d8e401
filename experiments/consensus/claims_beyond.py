"""Claims beyond the paper: graphs from sight, the barrier, and how time grows with the team."""

from typing import Any

from experiments.consensus.claims_physical import BODY, claim
from experiments.consensus.evidence import first, largest, least, mean, share, total
from mjmr.claims import Bound, Claim

AGREED = 0.1
"""Spread that counts as agreement [m]."""
RAYS: dict[str, Any] = {**BODY, "sight": "rays"}
ALONE: dict[str, Any] = {**RAYS, "scan": False, "heading": "random"}
SCAN: dict[str, Any] = {**RAYS, "scan": True, "heading": "random"}
CENTROID: dict[str, Any] = {**RAYS, "heading": "centroid"}
TIGHT: dict[str, Any] = {**BODY, "side": 1.2}
CROSSED: dict[str, Any] = {**TIGHT, "places": "crossed"}
SIGHT = "beyond the paper: graphs from cones of sight"


def claims() -> list[Claim]:
    """Every claim of this module."""
    return [*_sight(), *_cameras(), *_barrier(), *_scale()]


def _sight() -> list[Claim]:
    agreed = first(share("spread_m", AGREED))
    return [
        claim("cone-60-alone", "60 degrees, random headings, no scan; share of runs that agree "
               "to 0.1 m by 80 s", Bound("<=", 0.5), {**ALONE, "cone_deg": 60.0}, agreed, "",
               SIGHT),
        claim("cone-120-alone", "120 degrees, random headings, no scan; the same",
               Bound.within(0.1, 0.9), {**ALONE, "cone_deg": 120.0}, agreed, "", SIGHT),
        claim("cone-centroid", "90 and 120 degrees, facing the centroid within 0.3 rad; the same",
               Bound(">=", 0.7), {**CENTROID, "cone_deg": (90.0, 120.0)}, agreed, "", SIGHT),
        claim("cone-reducible", "90 degrees, facing the centroid: share of looks whose graph is "
               "reducible, mean", Bound.within(0.5, 1.0), {**CENTROID, "cone_deg": 90.0},
               mean("reducible"), "", SIGHT),
        claim("cone-rooted", "the same runs: share of looks with somebody seen by all, least",
               Bound(">=", 0.99), {**CENTROID, "cone_deg": 90.0}, least("rooted"), "", SIGHT),
        claim("cone-off-line", "the same runs: distance of the agreed point from the given "
               "graphs' line, least", Bound(">=", 0.05), {**CENTROID, "cone_deg": 90.0},
               least("line_m"), "m", SIGHT),
        claim("scan-60", "60 degrees, random headings, who sees nobody turns; share that agree",
               Bound(">=", 0.7), {**SCAN, "cone_deg": 60.0}, agreed, "", SIGHT),
        claim("scan-90", "90 degrees, the same", Bound(">=", 0.7), {**SCAN, "cone_deg": 90.0},
               agreed, "", SIGHT),
        claim("scan-120", "120 degrees, the same", Bound(">=", 0.7), {**SCAN, "cone_deg": 120.0},
               agreed, "", SIGHT),
        claim("cone-contacts", "contacts of two robots, all runs by rays, sum",
               Bound("<=", 0.0), RAYS, total("contacts"), "", SIGHT),
    ]  # fmt: skip


def _cameras() -> list[Claim]:
    camera = {**BODY, "sight": "camera"}
    both = {"mode": "physical", "experiment": "agreement"}
    return [
        claim("camera-spread", "rendered cameras, 90 and 120 degrees, OpenCV, scan; spread at "
               "80 s, largest", Bound("<=", 0.1), camera, largest("spread_m"), "m", SIGHT),
        claim("camera-contacts", "contacts of two robots, the same runs, sum", Bound("<=", 0.0),
               camera, total("contacts"), "", SIGHT),
        claim("rays-same", "rays and cameras at the same instants, 60, 90, 120 degrees: share of "
               "pairs on which both say the same, least", Bound(">=", 0.85), both, least("same"),
               "", SIGHT),
        claim("rays-same-inside", "the same but for marks within 2 degrees of the cone's edge or "
               "0.2 m of the range", Bound(">=", 0.98), both, least("inside_same"), "", SIGHT),
        claim("rays-bearing", "rms difference of bearings, largest", Bound("<=", 1.0), both,
               largest("bearing_rms_deg"), "deg", SIGHT),
        claim("rays-distance", "rms difference of distances, a share, largest",
               Bound("<=", 0.05), both, largest("distance_rms"), "", SIGHT),
    ]  # fmt: skip


def _barrier() -> list[Claim]:
    text = "beyond the paper: collision avoidance by a control-barrier QP"
    return [
        claim("barrier-needed", "places crossed, side 1.2 m, no barrier: share of runs without "
               "contact", Bound("<=", 0.5), {**CROSSED, "avoid": "none"}, share("contacts", 0.0),
               "", text),
        claim("barrier-contacts", "the same with the barrier: contacts, sum", Bound("<=", 0.0),
               {**CROSSED, "avoid": "barrier"}, total("contacts"), "", text),
        claim("barrier-distance", "the same: least distance of two middles; 0.702 m is two "
               "radii", Bound(">=", 0.70), {**CROSSED, "avoid": "barrier"},
               least("least_distance_m"), "m", text),
        claim("barrier-feasible", "ticks whose program had no solution, side 1.2 m, places "
               "outward, sum", Bound("<=", 0.0), {**TIGHT, "avoid": "barrier"},
               total("infeasible"), "", text),
        claim("barrier-feasible-crossed", "written later: the same, places crossed",
               Bound("<=", 0.0), {**CROSSED, "avoid": "barrier"}, total("infeasible"), "", text),
        claim("barrier-spread", "side 1.2 m, places outward, barrier: spread at 80 s, largest",
               Bound("<=", 0.02), {**TIGHT, "places": "outward", "avoid": "barrier"},
               largest("spread_m"), "m", text),
        claim("barrier-agrees-crossed", "places crossed, barrier: share that agree to 0.1 m by "
               "80 s", Bound(">=", 0.5), {**CROSSED, "avoid": "barrier"},
               share("spread_m", AGREED), "", text),
    ]  # fmt: skip


def _scale() -> list[Claim]:
    text = "beyond the paper: how time to agreement grows with the team and its graph"
    crowd = {"mode": "physical", "experiment": "graph", "robots": 100}
    model = {"mode": "linear", "experiment": "graph"}
    return [
        claim("crowd-agrees", "100 robots in one hall, star, complete and geometric graphs: time "
               "to a spread of 0.1 m, largest", Bound("<=", 120.0), crowd, largest("agree_s"), "s",
               text),
        claim("crowd-contacts", "the same: contacts of two robots, sum", Bound("<=", 0.0), crowd,
               total("contacts"), "", text),
        claim("ring-rate", "ring of 100, linear: slow rate over -(1 - cos(2 pi / n)) / 3, which "
               "-1 + sqrt(lambda) tends to", Bound.within(0.95, 1.05),
               {**model, "graph": "ring", "robots": 100}, _ring_rate, "", text),
        claim("path-slower", "path of 100 over ring of 100, linear: ratio of mean times",
               Bound(">=", 1.5), {**model, "graph": ("ring", "path"), "robots": 100}, _path_ratio,
               "", text),
        claim("complete-flat", "complete graph, linear: mean time at 100 over that at 10",
               Bound("<=", 1.5), {**model, "graph": "complete", "robots": (10, 100)}, _flat, "",
               text),
    ]  # fmt: skip


def _ring_rate(table: Any) -> Any:
    import numpy as np

    from mjmr.claims import Evidence

    rates = table.values("slow")
    wanted = -(1.0 - np.cos(2.0 * np.pi / 100)) / 3.0
    return Evidence(float((rates / wanted).mean()), n=len(rates))


def _path_ratio(table: Any) -> Any:
    from mjmr import statistics
    from mjmr.claims import Evidence

    path = table.where(graph="path").values("agree_s")
    ring = table.where(graph="ring").values("agree_s")
    return Evidence.of(statistics.ratio_of_means(path, ring))


def _flat(table: Any) -> Any:
    from mjmr import statistics
    from mjmr.claims import Evidence

    many = table.where(robots=100).values("agree_s")
    few = table.where(robots=10).values("agree_s")
    return Evidence.of(statistics.ratio_of_means(many, few))
