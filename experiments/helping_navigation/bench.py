"""Speed of the study: targets a CPU second, one core."""

import time
from collections.abc import Callable
from typing import Any

from experiments.helping_navigation import physical_bench
from experiments.helping_navigation.measures import NAMES
from experiments.helping_navigation.trial import prepare
from mjmr.bench import conditions, interleave, spread

_TARGETS = 20


def bench() -> str:
    """Measure; returns the table."""
    from experiments.helping_navigation import study

    prepare()
    trial = study.bound_trial()

    def job(**values: Any) -> Callable[[], float]:
        condition = study.condition(**values, targets=_TARGETS)

        def run() -> float:
            start = time.process_time()
            trial(condition, 0)
            return _TARGETS / max(time.process_time() - start, 1e-9)

        return run

    cases = {}
    for world in ("world1", "world2"):
        for planner, name in NAMES.items():
            state = planner == "potential-field"
            for reading in ("literal", "chain"):
                cases[f"{world}, {name}, four, {reading}"] = job(
                    world=world, planner=planner, robots=4, reading=reading, shares_state=state
                )
        cases[f"{world}, potential field alone (capped)"] = job(
            world=world, planner="potential-field"
        )
    rounds = interleave(cases, rounds=5)
    lines = [
        conditions(),
        f"targets a CPU second, tasks of {_TARGETS}, one core, median [lowest, highest]:",
    ]
    lines += [f"  {name:40s} {spread(figure)}" for name, figure in rounds.items()]
    lines.append("mode physical, world 1, real-time factors in CPU time, median [lowest, highest]:")
    factors = interleave(physical_bench.cases(), rounds=5)
    return "\n".join(lines + [f"  {name:40s} {spread(f)} x" for name, f in factors.items()])
