"""How much each size runs: the same experiments, with other numbers of tasks and targets."""

from experiments.helping_navigation.physical_sizes import PHYSICAL
from mjmr.conditions import Grid
from mjmr.study import Size

PLANNERS = ("avoid-past", "visbug", "potential-field")
WORLDS = ("world1", "world2")
READINGS = ("literal", "chain")
ERRORS = (0.0, 0.1, 0.2, 0.3, 0.4)
_EXPLORING = ("avoid-past", "visbug")  # with goal-sharing alone, as in the paper
_STATE = {"planner": "potential-field", "shares_state": True}


def _tables(targets: int) -> tuple[Grid, ...]:
    return (
        Grid(world=WORLDS, planner=PLANNERS, targets=targets),
        Grid(world=WORLDS, planner=_EXPLORING, robots=(2, 3, 4), reading=READINGS, targets=targets),
        Grid(world=WORLDS, **_STATE, robots=(2, 3, 4), reading=READINGS, targets=targets),
        Grid(world=WORLDS, planner="shortest-path", targets=targets),
    )


def _noise(targets: int) -> tuple[Grid, ...]:
    common = {
        "world": WORLDS, "robots": 4, "reading": READINGS, "noise": True, "err_max": ERRORS,
        "targets": targets,
    }  # fmt: skip
    return Grid(planner=_EXPLORING, **common), Grid(**_STATE, **common)


def _lost(targets: int) -> tuple[Grid, ...]:
    common = {
        "world": WORLDS, "robots": 4, "reading": READINGS, "fault": "lost", "targets": targets,
    }  # fmt: skip
    return Grid(planner=_EXPLORING, **common), Grid(**_STATE, **common)


def _trap(seeds: int) -> tuple[Grid, ...]:
    common = {
        "scene": "trap", "world": "trap", "planner": "potential-field", "robots": 2, "targets": 1,
        "seeds": seeds,
    }  # fmt: skip
    return (
        Grid(reading=READINGS, **common),
        Grid(reading=READINGS, shares_state=True, level=(3, 5, 20), **common),
    )


def _chain(targets: int, seeds: int) -> tuple[Grid, ...]:
    common = {
        "scene": "chain", "robots": 4, "reading": READINGS, "fault": ("none", "dead", "radio"),
        "targets": targets, "seeds": seeds,
    }  # fmt: skip
    return Grid(planner=_EXPLORING, **common), Grid(**_STATE, **common)


QUICK = Size(
    "quick",
    (
        *PHYSICAL["quick"],
        Grid(planner=_EXPLORING, targets=20),
        Grid(planner=_EXPLORING, robots=4, reading=READINGS, targets=20),
        *_trap(3),
        *_chain(10, 1),
    ),
    default_seeds=2,
    expected_minutes=0.4,
    note="world 1 alone, no potential field on tours, no noise",
)
STANDARD = Size(
    "standard",
    (*PHYSICAL["standard"], *_tables(60), *_noise(60), *_lost(60), *_trap(10), *_chain(20, 3)),
    default_seeds=3,
    expected_minutes=8.0,
    note="3 tasks of 60 targets; the paper's tables are 5 of 200",
)
FULL = Size(
    "full",
    (*PHYSICAL["full"], *_tables(200), *_noise(200), *_lost(200), *_trap(30), *_chain(20, 5)),
    default_seeds=5,
    expected_minutes=30.0,
)
