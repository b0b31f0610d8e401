"""Speed: three robots that agree by radio, rays and cameras, and a hundred in one hall."""

import time
from collections.abc import Callable
from typing import Any

from experiments.consensus import study
from experiments.consensus.physical import Team
from mjmr.bench import conditions, interleave, spread
from mjmr.errors import MissingGLError

_CAMERAS = "3 robots, cameras of 480 x 120 at 10 Hz"


def bench() -> str:
    """Simulated seconds a CPU second, one core; every job in turn."""
    jobs = {
        "3 robots, radio": _run(10.0),
        "3 robots, rays": _run(10.0, sight="rays", scan=True),
        "3 robots, radio, barrier": _run(10.0, avoid="barrier"),
        "100 robots, geometric graph, 10 ms": _run(
            2.0, experiment="graph", robots=100, graph="geometric"
        ),
        _CAMERAS: _run(2.0, sight="camera", scan=True),
    }
    lines = [conditions(), "simulated seconds a CPU second, median [lowest, highest]:"]
    try:
        figures = interleave(jobs, rounds=3)
    except MissingGLError as e:
        lines.append(f"  cameras: {e}")
        del jobs[_CAMERAS]
        figures = interleave(jobs, rounds=3)
    return "\n".join([*lines, *(f"  {name}: {spread(f)} x" for name, f in figures.items())])


def _run(seconds: float, **changes: Any) -> Callable[[], float]:
    def measure() -> float:
        team = Team(study.condition(mode="physical", **changes), 10_000)
        start = time.process_time()
        team.run(seconds)
        return seconds / (time.process_time() - start)

    return measure
