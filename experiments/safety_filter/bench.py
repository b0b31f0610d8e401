"""Speed of the filters: a call over ten robots, and whole swaps against real time."""

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from experiments.safety_filter.trial import prepare
from mjmr.bench import conditions, interleave, spread


def bench() -> str:
    """Measure; returns the table."""
    from experiments.safety_filter import study

    prepare()
    trial = study.bound_trial()
    figures: dict[str, list[tuple[float, float]]] = {"barrier": [], "search": []}

    def job(method: str) -> Callable[[], float]:
        condition = study.condition(scene="swap", method=method, duration=15.0)

        def run() -> float:
            start = time.process_time()
            found: dict[str, Any] = trial(condition, 0)
            spent = time.process_time() - start
            mean, worst = (float(found[f"wall_filter_{k}_ms"]) for k in ("mean", "worst"))
            figures[method].append((mean, worst))
            return found["ticks"] / 50 / spent

        return run

    rounds = interleave({method: job(method) for method in figures})
    lines = [conditions(), "swap of ten robots, one core, median [lowest, highest]:"]
    for method, factors in rounds.items():
        mean, worst = np.array(figures[method][1:]).T
        lines.append(
            f"  {method:8s} a call {spread(mean)} ms, worst of a run {spread(worst)} ms; whole "
            f"swap {spread(factors)} x real time of a CPU"
        )
    return "\n".join(lines)
