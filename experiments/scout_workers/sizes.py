"""How much each size runs: the same experiments, with other numbers of seeds.

E1 mazes, E2 succession, E3 scaling, E4 degraded compass, servos and radio, E5 margins; failures;
the open field and the radio by themselves. Beyond the paper: traps, by the depth of their lips.
"""

from typing import Any

from mjmr.conditions import Grid
from mjmr.study import Size

CHOSEN, FRESH = ("m1", "m2", "m3", "m4"), ("f1", "f2", "f3")
BEST: dict[str, Any] = {"forced": 4, "avoid_deg": 45.0}
MARGINS = (5.0, 15.0, 35.0, 60.0, 90.0)
DEPTHS = (0.0, 0.05, 0.1, 0.2, 0.4)
TEAMS = (2, 5, 10, 20, 60)
CROWD: dict[str, Any] = {"experiment": "scaling", "forced": 4}
E2: dict[str, Any] = {
    "experiment": "succession", "robots": 11, "release": 60.0, "finish": "remove",
}  # fmt: skip
CLOCKS = ((5.0, 20.0), (5.0, 15.0), (5.0, 10.0), (6.0, 16.0))
"""Read spacing and pause [ms]: receive cycles of 35, 30, 25 and 34 ms."""


def _radio(seeds: int) -> tuple[Grid, ...]:
    radio: dict[str, Any] = {"mode": "radio"}
    return (
        *(
            Grid(**radio, experiment="phase", spacing_ms=s, pause_ms=p, seeds=seeds)
            for s, p in CLOCKS
        ),
        Grid(**radio, experiment="phase", jitter_ms=(0.1, 0.2, 0.5, 1.0), seeds=seeds),
        Grid(**radio, experiment="errors", byte_error=0.01, check=("crc8", "two-bit"), seeds=seeds),
        Grid(**radio, experiment="codes", check=("crc8", "crc8-one-seed"), seeds=1),
    )


def _open(seeds: int) -> tuple[Grid, ...]:
    field: dict[str, Any] = {"experiment": "open"}
    return (
        Grid(**field, compass="exact", servo_pct=0.0, seeds=seeds),
        Grid(**field, compass="white", servo_pct=0.0, seeds=seeds),
        Grid(**field, seeds=seeds),
    )


def _large(
    planar: int, extra: int, scouts: int, teams: int, physical: int, fresh: int, crowds: int
) -> tuple[Grid, ...]:
    return (
        *_radio(5),
        *_open(scouts),
        # E1
        Grid(maze=(*CHOSEN, *FRESH), seeds=planar),
        Grid(maze=(*CHOSEN, *FRESH), **BEST, seeds=planar),
        Grid(maze=CHOSEN, vector="exact", seeds=extra),
        # E2
        Grid(maze=CHOSEN, **E2, succession=("none", "average"), seeds=scouts),
        Grid(maze=("m1", "m3"), **E2, succession=("via", "both"), seeds=scouts),
        # E3
        Grid(maze="m3", **CROWD, finish="remove", robots=TEAMS[:-1], seeds=teams),
        Grid(maze=CHOSEN, **CROWD, finish="remove", robots=60, seeds=teams),
        Grid(maze="m3", **CROWD, finish=("park", "home"), robots=60, seeds=teams),
        # E4
        Grid(maze=CHOSEN, compass_deg=(5.0, 15.0, 45.0), seeds=planar),
        Grid(maze="m3", servo_pct=(0.0, 10.0, 20.0), seeds=planar),
        Grid(maze="m3", bit_error=(0.02, 0.05, 0.1), seeds=extra),
        # E5
        Grid(maze="m3", margin_deg=MARGINS, forced=(0, 1), seeds=extra),
        # failures
        Grid(maze=CHOSEN, failure="ir-dead", seeds=extra),
        Grid(maze="m3", failure=("scout-killed", "bad-checksum"), seeds=teams),
        Grid(
            maze="corridor", robots=3, failure="worker-dead", finish="remove", release=20.0,
            seeds=scouts,
        ),
        # beyond the paper
        Grid(experiment="trap", depth=DEPTHS, seeds=extra),
        Grid(experiment="trap", depth=DEPTHS, **BEST, seeds=extra),
        # in MuJoCo
        Grid(mode="physical", maze=CHOSEN, seeds=physical),
        Grid(mode="physical", maze=FRESH, seeds=fresh),
        Grid(mode="physical", maze="m3", failure=("ir-dead", "scout-killed"), seeds=fresh),
        Grid(mode="physical", maze="corridor", robots=3, failure="worker-dead", finish="remove",
             release=20.0, seeds=fresh),
        Grid(mode="physical", maze=CHOSEN, **CROWD, finish="remove", robots=60, seeds=crowds),
    )  # fmt: skip


QUICK = Size(
    "quick",
    grids=(
        *_radio(1),
        *_open(4),
        Grid(maze=CHOSEN, seeds=6),
        Grid(maze="m3", vector="exact", seeds=10),
        Grid(maze="m3", **E2, succession=("none", "average"), seeds=4),
        Grid(maze="m3", **CROWD, finish="remove", robots=60, seeds=2),
        Grid(maze="m3", margin_deg=(5.0, 90.0), forced=0, seeds=6),
        Grid(maze="m3", failure=("ir-dead", "scout-killed", "bad-checksum"), seeds=4),
        Grid(experiment="trap", depth=(0.0, 0.4), seeds=5),
        Grid(mode="physical", maze="m3", seeds=2),
    ),
    default_seeds=4,
    expected_minutes=0.4,
    note="few seeds; shows the values, decides what does not take many",
)
STANDARD = Size(
    "standard",
    grids=_large(planar=60, extra=40, scouts=40, teams=20, physical=30, fresh=15, crowds=5),
    default_seeds=60,
    expected_minutes=16.0,
    note="60 robots in MuJoCo: 5 scouts in each of four mazes",
)
FULL = Size(
    "full",
    grids=_large(planar=200, extra=200, scouts=100, teams=50, physical=100, fresh=60, crowds=20),
    default_seeds=200,
    expected_minutes=45.0,
    note="20 scouts of 60 robots in each maze in MuJoCo",
)
