"""Speed of Pioneers in the office, everything included: scans, sight, radio, minds, drives."""

import time
from collections.abc import Callable

from experiments.helping_navigation.journey import Journey
from experiments.helping_navigation.scenes import tour

_SECONDS, _SEED = 30.0, 1000


def cases() -> dict[str, Callable[[], float]]:
    """Jobs that return real-time factors in CPU time, one core."""
    return {
        f"{robots} Pioneer{'s' if robots > 1 else ''}, {planner}": _job(robots, planner)
        for robots, planner in ((1, "avoid-past"), (4, "avoid-past"), (4, "visbug"))
    }


def _job(robots: int, planner: str) -> Callable[[], float]:
    from experiments.helping_navigation import study

    condition = study.condition(
        mode="physical", planner=planner, robots=robots, targets=5,
        reading="chain" if robots > 1 else "none",
    )  # fmt: skip

    def run() -> float:
        journey = Journey(tour(condition, _SEED), _SEED)
        start = time.process_time()
        journey.run(_SECONDS)
        return journey.crew.simulation.time / (time.process_time() - start)

    return run
