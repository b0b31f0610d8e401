"""How much each size runs: the same experiments, with other numbers of seeds.

A table of dwells, B Example 4.1, C random sequences and lemmas, D negatives, E graphs from sight,
F noise, loss, delay and faults; barrier; scale; formations that move; averages by radio.
"""

from typing import Any

from mjmr.conditions import Grid
from mjmr.study import Size

DWELLS = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0)
BODY: dict[str, Any] = {"mode": "physical", "duration": 80.0}
SEEN: dict[str, Any] = {**BODY, "sight": "rays"}
CROSSED: dict[str, Any] = {**BODY, "side": 1.2, "places": "crossed"}
MANY: dict[str, Any] = {"experiment": "graph"}
MOVING: dict[str, Any] = {
    "mode": "physical", "experiment": "moving", "schedule": "case-i", "side": 4.0,
    "duration": 125.0,
}  # fmt: skip
PATHS = ("line", "circle", "rotate", "scale")
AVERAGE: dict[str, Any] = {"mode": "physical", "experiment": "average", "robots": 8}
STANDS: dict[str, Any] = {**AVERAGE, "patrol": False, "duration": 60.0}
PATROLS: dict[str, Any] = {**AVERAGE, "patrol": True, "reach": 3.4, "duration": 160.0}
GRAPHS = ("ring", "path", "star", "complete", "geometric")
COUNTS = (3, 10, 30, 100)
SHORT = ("star", "complete", "geometric")
"""Graphs on which a hundred robots agree within two minutes."""


def _theory(seeds: int) -> tuple[Grid, ...]:
    one: dict[str, Any] = {"seeds": 1}
    return (
        Grid(dwell=DWELLS, **one),
        Grid(schedule=("case-i", "case-ii", "star"), **one),
        Grid(schedule="random-leader", dwell=1.0, seeds=max(1, seeds // 5)),
        Grid(experiment="example-4.1", degree=(1, 2, 3), seeds=max(1, seeds // 10)),
        Grid(experiment="random-sequence", seeds=seeds),
        Grid(experiment="lemmas", seeds=max(1, seeds // 20)),
        Grid(schedule="joint", duration=800.0, anyway=True, **one),
        Grid(schedule=("isolated", "decaying"), dwell=2.0, anyway=True, **one),
        Grid(experiment="mixed-channels", duration=800.0, **one),
        Grid(weight_y=0.5, **one),
        Grid(degrees=("1", "3", "1 2 3", "3 1 2"), duration=800.0, **one),
    )


def _moving(seeds: int) -> tuple[Grid, ...]:
    late: dict[str, Any] = {**MOVING, "path": ("line", "circle"), "seeds": seeds}
    return (
        Grid(**MOVING, path=PATHS, feedforward=("none", "told"), weight=(0.2, 0.8), seeds=seeds),
        Grid(**late, feedforward="told", loss=0.5),
        Grid(**late, feedforward=("none", "told"), delay=0.5),
    )


def _averages(seeds: int) -> tuple[Grid, ...]:
    return (
        Grid(**STANDS, loss=(0.0, 0.5), seeds=seeds),
        Grid(**STANDS, rule="ratio", loss=0.5, seeds=seeds),
        Grid(**PATROLS, loss=(0.0, 0.5), seeds=seeds),
        Grid(**PATROLS, rule="ratio", loss=0.5, seeds=seeds),
    )


def _large(
    *, theory: int, bodies: int, sights: int, scans: int, cameras: int, crowds: int, moving: int,
    averages: int,
) -> tuple[Grid, ...]:  # fmt: skip
    return (
        *_theory(theory),
        Grid(**BODY, dwell=(2.0, 5.0, 20.0), seeds=bodies),
        Grid(**BODY, dwell=(0.5, 1.0, 10.0), seeds=bodies),
        Grid(**BODY, side=0.0, virtual=True, seeds=min(bodies, 3)),
        Grid(**BODY, calibrated=False, seeds=bodies),
        Grid(**BODY, schedule=("case-i", "case-ii"), seeds=bodies),
        # F
        Grid(**BODY, noise=0.05, seeds=bodies),
        Grid(**BODY, loss=0.5, seeds=bodies),
        Grid(**BODY, delay=0.5, seeds=bodies),
        Grid(**BODY, delay=2.0, seeds=2),
        Grid(**BODY, loss=0.9, seeds=bodies),
        Grid(**BODY, noise=0.05, loss=0.5, delay=0.5, seeds=bodies),
        Grid(**BODY, fault=("follower-dies", "leader-freezes"), seeds=bodies),
        # E
        Grid(**SEEN, cone_deg=(60.0, 90.0), scan=False, seeds=sights),
        Grid(**SEEN, cone_deg=120.0, scan=False, seeds=max(sights, scans // 2)),
        Grid(**SEEN, cone_deg=(60.0, 90.0, 120.0), scan=True, seeds=scans),
        Grid(**SEEN, cone_deg=(90.0, 120.0), heading="centroid", seeds=sights),
        Grid(**BODY, sight="camera", cone_deg=(90.0, 120.0), scan=True, seeds=cameras),
        Grid(**BODY, experiment="agreement", cone_deg=(60.0, 90.0, 120.0), scan=True,
             seeds=max(1, cameras // 2)),
        # barrier
        Grid(**BODY, side=1.2, avoid="barrier", seeds=bodies),
        Grid(**CROSSED, avoid=("none", "barrier"), seeds=bodies),
        *_moving(moving),
        *_averages(averages),
        # scale
        Grid(**MANY, duration=20000.0, graph=GRAPHS, robots=COUNTS, seeds=crowds),
        Grid(**MANY, mode="physical", duration=120.0, graph=GRAPHS, robots=10, seeds=crowds),
        Grid(**MANY, mode="physical", duration=120.0, graph=SHORT, robots=(30, 100), seeds=crowds),
    )  # fmt: skip


QUICK = Size(
    "quick",
    grids=(
        *_theory(10),
        Grid(**BODY, seeds=1),
        Grid(**BODY, noise=0.05, seeds=1),
        Grid(**SEEN, scan=True, seeds=1),
        Grid(**MOVING, feedforward="told", seeds=1),
        Grid(**STANDS, seeds=1),
    ),
    default_seeds=1,
    expected_minutes=0.3,
    note="the linear model in full but for 10 random sequences; five runs in MuJoCo",
)
STANDARD = Size(
    "standard",
    grids=_large(
        theory=100, bodies=8, sights=6, scans=30, cameras=4, crowds=3, moving=2, averages=10
    ),
    default_seeds=5,
    expected_minutes=12.0,
    note="cameras rendered in eight runs and compared with rays in six",
)
FULL = Size(
    "full",
    grids=_large(
        theory=400, bodies=20, sights=20, scans=60, cameras=10, crowds=10, moving=5, averages=40
    ),
    default_seeds=20,
    expected_minutes=50.0,
)
