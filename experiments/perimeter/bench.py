"""Speed of the study: closed loops with rays and with rendered pictures, controllers included."""

import time
from collections.abc import Callable
from typing import Any

from experiments.perimeter.trial import prepare, trial
from mjmr.bench import conditions, interleave, spread

_BUNCH = {"task": "stay", "start": "bunch"}
_CASES = {
    "searching, rays": ({"task": "stay", "duration": 60.0}, 15.0),
    "on a growing edge, rays": ({**_BUNCH, "growth": 0.0125, "duration": 60.0}, 15.0),
    "on a growing edge, five cameras at 5 Hz": (
        {**_BUNCH, "growth": 0.0125, "sensing": "camera", "duration": 10.0},
        1.5,
    ),
    "unicycle bodies, rays": ({**_BUNCH, "mode": "unicycle", "duration": 60.0}, 0.0),
}


def bench() -> str:
    """Measure; returns the table."""
    from experiments.perimeter import study

    prepare()

    def job(values: dict[str, Any]) -> Callable[[], float]:
        condition = study.condition(**values)

        def run() -> float:
            start = time.process_time()
            metrics = trial(condition, 0)
            return float(metrics["time_s"]) / (time.process_time() - start)

        return run

    rounds = interleave({name: job(values) for name, (values, _) in _CASES.items()}, rounds=5)
    lines = [
        conditions(),
        "simulated s per CPU s, five trucks, compiling the world included, median "
        "[lowest, highest]:",
    ]
    for name, figure in rounds.items():
        least = _CASES[name][1]
        aim = f" (at least {least:g} is wanted)" if least else ""
        lines.append(f"  {name:40s} {spread(figure)}{aim}")
    return "\n".join(lines)
