"""Speed of the testbed itself, measured in interleaved rounds."""

import os
import platform
import tempfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path

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
    """Idle loop (guard on, no sensor due) against bare mj_step, and films, frames a second."""
    lines = [conditions(), "idle loop / bare mj_step, paired rounds, median [lowest, highest]:"]
    for n, seconds in ((4, 2.0), (100, 0.5)):
        loop, bare = _idle(n, seconds)
        figures = interleave({"loop": loop, "bare": bare}, rounds=31)
        ratio = figures["loop"] / figures["bare"]
        factor = seconds / figures["loop"]
        lines.append(f"  {n:3d} soccer robots: {spread(ratio)}; loop {spread(factor)} x real time")
    return "\n".join([*lines, *films()])


def films(seconds: float = 4.0, rounds: int = 3) -> list[str]:
    """Frames a second of short films at 1280 x 720, look draft: render, overlay and encode.

    Args:
        seconds: Length of each film [s], at 30 frames a second.
        rounds: Films counted of each kind, in turn, after one that is not.
    """
    from mjmr.errors import MissingGLError

    try:
        figures = interleave({f"{n} panel(s)": _film(n, seconds) for n in (1, 2)}, rounds)
    except MissingGLError as e:
        return [f"films: {e}"]
    lines = [f"films of 4 soccer robots, 1280 x 720, draft, {round(seconds * 30)} frames:"]
    return lines + [f"  {name}: {spread(f)} frames a second" for name, f in figures.items()]


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


def _film(panels: int, seconds: float) -> Callable[[], float]:
    from mjmr.film import Film
    from mjmr.kinematics import KinematicSimulation
    from mjmr.recording import Recording
    from mjmr.robots.soccer_bot import SoccerBot
    from mjmr.world import World

    world = World.rectangle(4.9, 3.8, border=0.3)
    corners = np.array([[-1.5, -1.0], [1.5, -1.0], [1.5, 1.0], [-1.5, 1.0]])
    robots = world.add_group(SoccerBot, np.column_stack([corners, np.zeros(4)]))
    simulation = KinematicSimulation(world)
    recording = Recording(simulation, lambda: f"t = {simulation.time:.2f} s")
    for _ in simulation.ticks(seconds):
        recording.note(goals=-corners, waypoints=corners / 2, stops=corners)
        robots.drive(np.tile([0.8, 0.0, 1.0], (4, 1)))

    def write() -> float:
        film = Film("benchmark")
        for k in range(panels):
            film.add(recording, f"panel {k}")
        with tempfile.TemporaryDirectory() as folder:
            start = time.perf_counter()
            film.write(Path(folder) / "film.mp4")
            return round(seconds * film.options.fps) / (time.perf_counter() - start)

    return write
