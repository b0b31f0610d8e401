"""How far rays and rendered pictures agree about what there is to be seen."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.perception.arc_objects import MOVER, ROBOT, Objects
from experiments.versatile_pushing.sight import ArcSight, CameraSight
from experiments.versatile_pushing.tasks import make_pusher, take_in
from experiments.versatile_pushing.worlds import PERIOD, RANGE, TASKS, build
from mjmr.errors import InvalidInputError
from mjmr.simulation import Simulation

Array = NDArray[np.float64]
EVERY = 5  # looks are compared at every so many steps: in between they are much alike
EDGE = np.radians(3.0)  # rad, off the edges of the field: what is nearer to them is not counted
FAR = 0.9  # of the range: what is further away is not counted
NEAR_BEARING, NEAR_RANGE = np.radians(6.0), 0.4  # rad, share: what may be the same thing


def vision(condition: Mapping[str, Any], seed: int) -> dict[str, float | int]:
    """Let robots work by rays, and ask the camera the same at the same poses.

    All three worlds in turn, a third of the duration each. An object counts if it is well inside
    the limits of range and field in either variant; two are the same if kind, bearing and range
    are near.

    Returns:
        Counts of looks and objects, the share found by both (twice the common ones over the sum of
        those of each), and differences camera - rays of the common ones.
    """
    found = _Found()
    for task, b in (("foraging", False), ("construction", True), ("transport", False)):
        _compare({**condition, "task": task, "b": b, "failure": "none"}, seed, found)
    return found.metrics()


def _compare(condition: Mapping[str, Any], seed: int, found: "_Found") -> None:
    task = condition["task"]
    radius = TASKS[task].disc_radius
    world, robots = build(
        task, robots=condition["robots"], map_seed=condition["map"], vision="both", jitter=seed
    )
    simulation = Simulation(
        world, seed=seed, control_period=PERIOD, dt_max=condition["dt_ms"] / 1000
    )
    arcs, camera = ArcSight(robots, radius), CameraSight(robots, radius)
    pusher = make_pusher(condition, simulation, robots)
    turret: Any = robots.sensors["turret"]
    for step, t in enumerate(simulation.ticks(condition["duration"] / 3.0)):
        seen = arcs.look()
        if step % EVERY == 0:
            found.add(seen, camera.look())
        command, pan = pusher.step(take_in(robots, seen), t)
        robots.drive(command)
        turret.aim(pan)
    simulation.close()


class _Found:
    """Tallies of what both saw."""

    def __init__(self):
        self.looks = 0
        self.counts = {ROBOT: np.zeros(3, dtype=int), MOVER: np.zeros(3, dtype=int)}
        self.bearing: list[float] = []
        self.range: list[float] = []
        self.near: list[float] = []

    def add(self, arcs: Objects, camera: Objects) -> None:
        """Compare one look of all robots."""
        self.looks += len(arcs.kind)
        for i in range(len(arcs.kind)):
            for kind, count in self.counts.items():
                a, b = _rows(arcs, i, kind), _rows(camera, i, kind)
                pairs = _match(a, b)
                inside_a, inside_b = _inside(a), _inside(b)
                common = {(j, k) for j, k in pairs if inside_a[j] or inside_b[k]}
                # one just inside and its partner just outside are no disagreement
                count += (
                    int(inside_a.sum()) + sum(not inside_a[j] for j, _ in common),
                    int(inside_b.sum()) + sum(not inside_b[k] for _, k in common),
                    len(common),
                )
                for j, k in common:
                    self.bearing.append(np.degrees(b[k, 0] - a[j, 0]))
                    self.range.append((b[k, 1] - a[j, 1]) / a[j, 1])
                    if a[j, 1] < 1.0:
                        self.near.append(b[k, 1] - a[j, 1])

    def metrics(self) -> dict[str, float | int]:
        """The study's numbers."""
        if not self.near:
            raise InvalidInputError(
                "nothing near was seen by both variants of vision; task=vision takes a duration of "
                "5 s or more"
            )
        total = np.sum(list(self.counts.values()), axis=0)
        bearing, away = np.array(self.bearing), np.array(self.range)
        return {
            "looks": self.looks,
            "objects": int(total[0]),
            "both_share": _share(total),
            "both_share_discs": _share(self.counts[MOVER]),
            "both_share_robots": _share(self.counts[ROBOT]),
            "bearing_rms_deg": float(np.sqrt((bearing**2).mean())),
            "bearing_p95_deg": float(np.percentile(np.abs(bearing), 95)),
            "range_median_pct": 100 * float(np.median(np.abs(away))),
            "range_p95_pct": 100 * float(np.percentile(np.abs(away), 95)),
            "near_range_rms_m": float(np.sqrt((np.array(self.near) ** 2).mean())),
        }


def _share(counts: NDArray[np.int64]) -> float:
    return float(2 * counts[2] / max(counts[0] + counts[1], 1))


def _rows(seen: Objects, robot: int, kind: int) -> Array:
    """Bearings [rad] and gaps [m] of one robot's objects of a kind (k, 2)."""
    of = seen.kind[robot] == kind
    centre = seen.centre[robot, of]
    return np.column_stack([np.arctan2(centre[:, 1], centre[:, 0]), seen.gap[robot, of]])


def _inside(rows: Array) -> NDArray[np.bool_]:
    return (np.abs(rows[:, 0]) < np.pi / 4 - EDGE) & (rows[:, 1] < FAR * RANGE)


def _match(a: Array, b: Array) -> list[tuple[int, int]]:
    """Pairs of rows that may be the same thing, nearest in bearing first."""
    if not len(a) or not len(b):
        return []
    off = np.abs(b[None, :, 0] - a[:, None, 0])
    away = np.abs(b[None, :, 1] - a[:, None, 1]) / np.maximum(a[:, None, 1], 0.1)
    cost = np.where((off < NEAR_BEARING) & (away < NEAR_RANGE), off / NEAR_BEARING + away, np.inf)
    pairs = []
    for _ in range(min(len(a), len(b))):
        j, k = np.unravel_index(int(cost.argmin()), cost.shape)
        if not np.isfinite(cost[j, k]):
            break
        pairs.append((int(j), int(k)))
        cost[j], cost[:, k] = np.inf, np.inf
    return pairs
