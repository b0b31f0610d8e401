"""Speed of the study: closed loops with rays and with rendered pictures, controllers included."""

import time
from collections.abc import Callable
from typing import Any

from experiments.versatile_pushing.bench_pushing import bench_pushing
from experiments.versatile_pushing.trial import prepare
from mjmr.bench import conditions, interleave, spread

_CASES = {
    "foraging, 10 discs, arcs": {"task": "foraging", "duration": 60.0},
    "the same, 120 s": {"task": "foraging", "duration": 120.0},
    "construction, 30 discs, arcs": {"task": "construction", "b": True, "duration": 60.0},
    "transport, 1 disc, arcs": {
        "task": "transport", "c": 1.0, "weight": 2, "robots": 2, "duration": 60.0,
    },
    "foraging, 10 discs, camera": {"task": "foraging", "vision": "camera", "duration": 10.0},
}  # fmt: skip
_TARGETS = (80, 80, 40, 0, 3)


def bench() -> str:
    """Measure; returns the table."""
    from experiments.versatile_pushing import study

    prepare()
    trial = study.bound_trial()

    def job(values: dict[str, Any]) -> Callable[[], float]:
        condition = study.condition(**values)

        def run() -> float:
            start = time.process_time()
            metrics = trial(condition, 0)
            return float(metrics["time_s"]) / (time.process_time() - start)

        return run

    rounds = interleave({name: job(values) for name, values in _CASES.items()}, rounds=5)
    lines = [
        conditions(),
        "simulated s per CPU s, four robots, compiling the world included, median "
        "[lowest, highest]:",
    ]
    for (name, figure), target in zip(rounds.items(), _TARGETS, strict=True):
        aim = f" (at least {target} is wanted)" if target else ""
        lines.append(f"  {name:29s} {spread(figure)}{aim}")
    return "\n".join([*lines, bench_pushing()])
