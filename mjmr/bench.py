"""Speed of the testbed itself, measured in interleaved rounds on one core."""

import os
import platform
import time
from collections.abc import Callable, Mapping

import numpy as np


def conditions() -> str:
    """The machine and versions a measurement was made on, as one line."""
    from mjmr.provenance import versions

    found = versions()
    kept = ", ".join(f"{k} {found[k]}" for k in ("python", "mujoco", "numpy", "numba"))
    return f"{platform.machine()}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}; {kept}"


def interleave(jobs: Mapping[str, Callable[[], float]], rounds: int = 5) -> dict[str, np.ndarray]:
    """Run every job once a round, in turn, so that a noisy machine hits all alike.

    Args:
        jobs: What to run; each returns its figure.
        rounds: Counted rounds, after one that is not.

    Returns:
        The figures of each job, shape (rounds,).
    """
    found: dict[str, list[float]] = {name: [] for name in jobs}
    for k in range(rounds + 1):
        for name, job in jobs.items():
            figure = job()
            if k:
                found[name].append(figure)
    return {name: np.array(values) for name, values in found.items()}


def spread(values: np.ndarray, digits: int = 3) -> str:
    """Median with the lowest and highest value."""
    low, middle, high = values.min(), np.median(values), values.max()
    return f"{middle:.{digits}g} [{low:.{digits}g}, {high:.{digits}g}]"


def core() -> str:
    """Idle loop (guard on, no sensor due) against bare mj_step, for 4 and 100 robots."""
    lines = [conditions(), "idle loop / bare mj_step, paired rounds, median [lowest, highest]:"]
    for n, seconds in ((4, 2.0), (100, 0.5)):
        loop, bare = _idle(n, seconds)
        figures = interleave({"loop": loop, "bare": bare}, rounds=31)
        ratio = figures["loop"] / figures["bare"]
        factor = seconds / figures["loop"]
        lines.append(f"  {n:3d} soccer robots: {spread(ratio)}; loop {spread(factor)} x real time")
    return "\n".join(lines)


def _idle(n: int, seconds: float) -> tuple[Callable[[], float], Callable[[], float]]:
    import mujoco

    from mjmr.robots.soccer_bot import SoccerBot
    from mjmr.sensors.localizer import Localizer
    from mjmr.simulation import Simulation
    from mjmr.world import World

    side = 1.0 + 0.5 * np.ceil(np.sqrt(n))
    world = World.rectangle(side, side)
    lanes = np.arange(np.ceil(np.sqrt(n))) * 0.5 - side / 2 + 0.75
    grid = np.array([(x, y, 0.0) for x in lanes for y in lanes])[:n]
    robots = world.add_group(SoccerBot, grid)
    robots.mount(Localizer(rate=1e-3, phase=1e3))
    simulation = Simulation(world)
    model = simulation.model
    data = mujoco.MjData(model)
    mujoco.mj_copyData(data, model, simulation.data)
    steps, substeps = round(seconds * 60), simulation.substeps

    def loop() -> float:
        start = time.perf_counter()
        for _ in simulation.ticks(seconds):
            pass
        return time.perf_counter() - start

    def bare() -> float:
        start = time.perf_counter()
        for _ in range(steps):
            mujoco.mj_step(model, data, substeps)
        return time.perf_counter() - start

    return loop, bare
