"""Speed of the study's runs: everything included, one core, by CPU time."""

import time
from collections.abc import Callable

from controllers.scouting import UNIT, Behaviour, ScoutTeam
from experiments.scout_workers.mazes import maze
from experiments.scout_workers.physical import PhysicalField
from experiments.scout_workers.planar import PlanarField
from experiments.scout_workers.run import Plan, run
from mjmr.bench import conditions, interleave, spread
from mjmr.randomness import Streams

_SEED = 1001


def bench() -> str:
    """Measure; returns the table."""
    cases = {
        "physical, scout and worker": (PhysicalField, 2),
        "physical, 60 workers in turn": (PhysicalField, 60),
        "planar, scout and worker": (PlanarField, 2),
        "planar, 60 workers in turn": (PlanarField, 60),
    }
    jobs = {name: _job(*case) for name, case in cases.items()}
    found = interleave(jobs, rounds=3)
    lines = [
        conditions(),
        "simulated s per s of CPU time, all included, one core, median [lowest, highest]:",
    ]
    return "\n".join(lines + [f"  {name:29s} {spread(f)}" for name, f in found.items()])


def _job(kind: type[PhysicalField] | type[PlanarField], n: int) -> Callable[[], float]:
    """A run in maze m3; more than two robots are all workers that were told where the goal is."""
    m = maze("m3")
    scouts = 1 if n == 2 else 0

    def job() -> float:
        before = time.process_time()
        field = kind(n, seed=_SEED, size=m.size, blocks=m.blocks, nest=m.nest, goal=m.goal)
        team = ScoutTeam(
            n, scouts=scouts, rng=Streams(_SEED).generator("team"), behaviour=Behaviour(forced=4)
        )
        told = None if scouts else (m.goal - m.nest) / UNIT
        ended = run(field, team, Plan(told=told)).ended
        return ended / (time.process_time() - before)

    return job
