"""Speed of every platform, of a football match of AIBOs, and of Pioneers with cameras."""

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from experiments.proving_ground.aibo import engine
from experiments.proving_ground.course import hall
from mjmr.bench import conditions, interleave, spread
from mjmr.errors import MissingGLError
from mjmr.robots import platform_class
from mjmr.robots.aibo_ers7 import AiboERS7
from mjmr.robots.pioneer2dx import Pioneer2DX
from mjmr.sensors.camera import Camera
from mjmr.simulation import Simulation
from mjmr.world import World

# what each platform is told, and its control period and timestep [s]
_TOLD: dict[str, tuple[list[float], float, float]] = {
    "pioneer2dx": ([0.4, 0.3], 0.1, 0.005),
    "koala": ([0.3, 0.5], 0.1, 0.005),
    "tamiya_txt1": ([1.0, 0.2], 0.1, 0.005),
    "round_pusher": ([0.3, 0.5], 0.1, 0.010),
    "nims": ([0.1, 0.0], 0.1, 0.010),
    "four_wheeler": ([0.5, 0.5], 0.1, 0.010),
    "tj_pro": ([0.15, 0.5], 0.1, 0.010),
    "soccer_bot": ([0.5, 0.2, 0.5], 1 / 60, 0.005),
}


def bench() -> str:
    """Real-time factors in CPU time, one core; every job in turn."""
    seconds = 2.0
    jobs = {f"1 {name}": _alone(name, seconds) for name in _TOLD}
    jobs["1 aibo_ers7, trotting"] = _match(1, seconds)
    jobs["4 v 4 aibo_ers7, ball, walls, 4 ms"] = _match(8, seconds)
    lines = [conditions(), "real-time factors in CPU time, median [lowest, highest]:"]
    try:
        jobs["4 pioneer2dx, 320 x 240 camera each, 10 Hz"] = _eyes(seconds)
        figures = interleave(jobs, rounds=5)
    except MissingGLError as e:
        lines.append(f"  cameras: {e}")
        jobs.pop("4 pioneer2dx, 320 x 240 camera each, 10 Hz", None)
        figures = interleave(jobs, rounds=5)
    return "\n".join([*lines, *(f"  {name}: {spread(f)} x" for name, f in figures.items())])


def _factor(simulation: Any, seconds: float, act: Callable[[float], None]) -> Callable[[], float]:
    def run() -> float:
        start = time.process_time()
        for now in simulation.ticks(seconds):
            act(now)
        return seconds / (time.process_time() - start)

    return run


def _alone(name: str, seconds: float) -> Callable[[], float]:
    command, period, dt = _TOLD[name]
    world = hall(12.0)
    group = world.add_group(platform_class(name), [[0.0, 0.0, 0.0]])
    simulation = Simulation(world, control_period=period, dt_max=dt)
    return _factor(simulation, seconds, lambda now: group.drive([command]))


def _match(n: int, seconds: float) -> Callable[[], float]:
    """Dogs that trot about a 6 x 4 m pitch with a ball, half of them in each team's colour."""
    world = World.rectangle(6.0, 4.0, wall_height=0.3)
    rng = np.random.default_rng(1)
    spots = np.stack(np.meshgrid([-2.2, -0.9, 0.9, 2.2], [-1.0, 1.0]), axis=-1).reshape(-1, 2)
    poses = np.column_stack([spots[:n], rng.uniform(-np.pi, np.pi, n)])
    motion = engine()
    half = max(1, n // 2)
    groups = [world.add_group(AiboERS7(motion), poses[:half])]
    if n > half:
        groups.append(world.add_group(AiboERS7(motion), poses[half:], team="blue"))
    world.add_ball(0.0, 0.0)
    simulation = Simulation(world, control_period=0.032, dt_max=0.004)

    def act(now: float) -> None:
        for group in groups:
            turn = 0.5 * np.sin(now + np.arange(group.n))
            group.drive(motion.command(np.column_stack([0.3 + 0 * turn, 0 * turn, turn])))

    return _factor(simulation, seconds, act)


def _eyes(seconds: float) -> Callable[[], float]:
    world = hall(4.0)
    for k in range(8):
        world.add_box(3 * np.cos(k), 3 * np.sin(k), 0.4, 0.4, height=0.4)
    group = world.add_group(Pioneer2DX, [[x, y, 0.0] for x in (-1, 1) for y in (-1, 1)])
    camera = group.mount(
        Camera(
            width=320, height=240, rate=10.0, fovy=0.8,
            position=(0.1, 0.0, 0.3), look_at=(2.0, 0.0, 0.1),
        )
    )  # fmt: skip
    simulation = Simulation(world, control_period=0.1)

    def act(now: float) -> None:
        camera.read()
        group.drive(np.tile([0.2, 0.4], (4, 1)))

    return _factor(simulation, seconds, act)
