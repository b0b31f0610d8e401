"""Speed in work W: Pioneers among boxes in a walled square, blind or with lidars."""

import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mjmr.bench import conditions, interleave, spread
from mjmr.errors import UnknownNameError

Array = NDArray[np.float64]
PERIOD = 0.1  # s
SPEED = 0.4  # m/s
BOX = 0.4  # m, side
TURN_AWAY = 1.5  # rad/s
TOO_NEAR = 0.8  # m
_BOXES = 30
_CELL = 0.8  # m; no two starts are nearer


def crowd(seconds: int = 6, sizes: tuple[int, ...] = (1, 10, 50, 200)) -> str:
    """Work W: blind (A) and with lidars (B) against bare mj_step's in A; then B made faster.

    Faster: first by steps of 10 ms, then also light, by pyramidal friction cones and a model
    without what is only drawn. Neither changes what a Pioneer is measured to do by more than 0.01 %
    (assets/pioneer2dx/README.md).

    The simulations advance in turn, a simulated second at a time; figures are of CPU time, so that
    they hold for one core whatever else the machine does.

    Args:
        seconds: Simulated, after one that is not counted.
        sizes: Numbers of robots.
    """
    lines = [
        conditions(),
        f"work W, {seconds} s after the first, real-time factors in CPU time and their ratio to "
        "bare mj_step's, median [lowest, highest] of seconds:",
    ]
    for n in sizes:
        jobs = {
            "bare mj_step, 5 ms": bare(n, 0.005, seconds + 1)[0],
            "A blind, 5 ms": loop(n, 0.005, False),
            "B lidars, 5 ms": loop(n, 0.005, True),
            "B lidars, 10 ms": loop(n, 0.010, True),
            "B lidars, 10 ms, light": loop(n, 0.010, True, light=True),
        }
        figures = interleave(jobs, rounds=seconds)
        base = figures["bare mj_step, 5 ms"]
        for name, cpu in figures.items():
            total = seconds / cpu.sum()
            ratio = spread(base / cpu)
            lines.append(f"  N = {n:3d} {name:22s}: {total:6.4g} x, ratio {ratio}")
    return "\n".join(lines)


SIZES: dict[str, tuple[int, tuple[int, ...]]] = {
    "quick": (2, (10, 50)),
    "standard": (4, (1, 10, 50, 200)),
    "full": (29, (1, 10, 50, 200)),
}


def crowds(size: str = "standard") -> str:
    """:func:`crowd` and :func:`in_the_open`.

    Args:
        size: One of ``SIZES``: 10 s, 1 minute or 5 of wall time.

    Raises:
        UnknownNameError: Another size.
    """
    if size not in SIZES:
        raise UnknownNameError("size", size, SIZES)
    seconds, numbers = SIZES[size]
    return crowd(seconds, numbers) + "\n" + in_the_open((5, 50, 500) if seconds > 2 else (5, 50))


def in_the_open(sizes: tuple[int, ...] = (5, 50, 500)) -> str:
    """CPU time a robot and physics step of Pioneers that meet nobody, at 5 ms."""
    figures = interleave({str(n): loop(n, 0.005, False, wide=True) for n in sizes}, rounds=2)
    lines = ["in the open, microseconds of CPU time a robot and step of 5 ms:"]
    return "\n".join(
        lines + [f"  N = {n:>3s}: {spread(1e6 * f / 200 / int(n))}" for n, f in figures.items()]
    )


def loop(
    n: int, dt: float, sees: bool, *, wide: bool = False, light: bool = False
) -> Callable[[], float]:
    """A simulation of work W; each call advances it by a second and returns the CPU time [s]."""
    return _advance(*build(n, dt, sees, wide=wide, light=light))


def bare(n: int, dt: float, seconds: int) -> tuple[Callable[[], float], Any]:
    """The physics of the blind variant alone: mj_step's under the same set points.

    Returns:
        What advances it by a second, at most ``seconds`` times, and MuJoCo's data.
    """
    import mujoco

    simulation, robots = build(n, dt, False)
    model = simulation.model
    data = mujoco.MjData(model)
    mujoco.mj_copyData(data, model, simulation.data)
    inputs: list[tuple[Array, Array]] = []
    begin = simulation._begin_period

    def record() -> None:
        begin()
        inputs.append((simulation.data.act.copy(), simulation.data.ctrl.copy()))

    simulation._begin_period = record
    advance = _advance(simulation, robots)
    for _ in range(seconds):
        advance()
    periods = iter(inputs)

    def run() -> float:
        start = time.process_time()
        for _ in range(round(1 / PERIOD)):
            data.act[:], data.ctrl[:] = next(periods)
            mujoco.mj_step(model, data, simulation.substeps)
        return time.process_time() - start

    return run, data


def build(
    n: int, dt: float, sees: bool, *, wide: bool = False, light: bool = False
) -> tuple[Any, Any]:
    """Work W: simulation and robots.

    Args:
        n: Number of robots.
        dt: Timestep [s].
        sees: Whether they have lidars.
        wide: 4 m apart and no boxes, so that nobody is met.
        light: Pyramidal friction cones, and nothing that is only drawn.
    """
    from mjmr.robots.pioneer2dx import Pioneer2DX
    from mjmr.sensors.lidar import Lidar
    from mjmr.simulation import Simulation
    from mjmr.world import World

    rng = np.random.default_rng(7)
    boxes = 0 if wide else _BOXES
    side = 4.0 * (np.ceil(np.sqrt(n)) + 1) if wide else max(8.0, 1.5 * np.sqrt(n))
    world = World.rectangle(side, side, wall_height=BOX)
    cells = int(np.ceil(np.sqrt(n))) if wide else int(side / _CELL)
    axis = (np.arange(cells) - (cells - 1) / 2) * (4.0 if wide else side / cells)
    grid = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    grid = grid[rng.permutation(len(grid))[: n + boxes]]
    for x, y in grid[n:]:
        world.add_box(x, y, BOX, BOX, height=BOX)
    robots = world.add_group(Pioneer2DX, np.column_stack([grid[:n], rng.uniform(-np.pi, np.pi, n)]))
    if sees:
        # in the bumper, where it sees other robots' hulls
        robots.mount(Lidar(position=(0.22, 0.0, 0.18)))
    if light:
        world.edit(_lighten)
    return Simulation(world, control_period=PERIOD, dt_max=dt), robots


def _lighten(spec: Any) -> None:
    import mujoco

    from mjmr.world_spec import leave_out_drawn

    spec.option.cone = mujoco.mjtCone.mjCONE_PYRAMIDAL
    leave_out_drawn(spec)


def _advance(simulation: Any, robots: Any) -> Callable[[], float]:
    arcs, n = np.random.default_rng(11), robots.n
    sees = "lidar" in robots.sensors
    command = np.zeros((n, 2))
    command[:, 0] = SPEED

    def run() -> float:
        start = time.process_time()
        turn = arcs.uniform(-1.0, 1.0, n)
        for _ in simulation.ticks(1.0):
            command[:, 1] = turn
            if sees:
                ranges = robots.lidar.read()
                nearest = ranges.argmin(axis=1)
                near = ranges[np.arange(n), nearest] < TOO_NEAR
                side = robots.lidar.angles[nearest[near]]
                command[near, 1] = np.where(side > 0, -TURN_AWAY, TURN_AWAY)
            robots.drive(command)
        return time.process_time() - start

    return run
