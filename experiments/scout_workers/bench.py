"""Speed: teams in MuJoCo and on the plane, and the radio of sixty receivers."""

import time
from collections.abc import Callable

import numpy as np

from experiments.scout_workers import study
from experiments.scout_workers.run import run
from experiments.scout_workers.trial import build
from mjmr.bench import conditions, interleave, spread
from mjmr.byte_channel import ByteChannel, ByteTiming

_SEEDS = iter(range(10_000, 20_000))


def bench() -> str:
    """Simulated seconds a CPU second, one core; every job in turn."""
    jobs = {
        "2 robots, planar": _team("planar", 2),
        "60 robots, planar": _team("planar", 60),
        "2 robots, MuJoCo": _team("physical", 2),
        "60 robots, MuJoCo": _team("physical", 60),
        "radio alone, 60 receivers, jitter and errors": _radio,
    }
    figures = interleave(jobs, rounds=3)
    lines = [conditions(), "simulated seconds a CPU second, median [lowest, highest]:"]
    return "\n".join([*lines, *(f"  {name}: {spread(f)} x" for name, f in figures.items())])


def _team(mode: str, n: int) -> Callable[[], float]:
    """Workers that know the vector leave one after the other: nobody waits for a scout."""

    def measure() -> float:
        condition = study.condition(
            mode=mode,
            maze="m3",
            experiment="scaling",
            robots=n,
            forced=4,
            finish="remove",
            vector="exact",
        )
        field, team, plan = build(condition, next(_SEEDS))
        start = time.process_time()
        run(field, team, plan)
        return field.time / (time.process_time() - start)

    return measure


def _radio() -> float:
    sequence = np.random.SeedSequence(next(_SEEDS))
    timing = ByteTiming(jitter=0.0002, bit_error=0.01)
    channel = ByteChannel(60, timing, sequence)
    channel.transmit(0, bytes([1, 2, 3, 4]), 0.0)
    start = time.process_time()
    for k in range(1, 401):
        channel.listen(0.5 * k)
    return 200.0 / (time.process_time() - start)
