"""Speed of pushing itself: robots that chase discs and push them, without vision or controllers.

Of four robots one or two push at a time, which is what they do in foraging.
"""

import time
from collections.abc import Callable

import numpy as np

from experiments.versatile_pushing.pushing import PERIOD, friction_force
from mjmr.bench import conditions, interleave, spread
from mjmr.disc import let_discs_sleep
from mjmr.errors import MissingGLError
from mjmr.group import Group
from mjmr.robots.round_pusher import RoundPusher
from mjmr.sensors.camera import Camera
from mjmr.simulation import Simulation
from mjmr.world import World

HALF = 5.0  # m, of the field
RADIUS = 0.1  # m, of a small disc
_HOME = np.array([[-0.7, 0.0, np.pi], [0.7, 0.0, 0.0], [0.0, 0.7, 1.57], [0.0, -0.7, -1.57]])


def bench_pushing() -> str:
    """Real-time factors in CPU time, one core; every job in turn."""
    jobs = {
        f"4 robots, {count} discs, {1e3 * dt:g} ms{', discs sleep' * sleep}": chase(
            count, dt, sleep=sleep
        )
        for dt, sleep in ((0.01, True), (0.01, False), (0.005, False))
        for count in (10, 30)
    }
    lines = [
        conditions(),
        "pushing alone, real-time factors in CPU time, median [lowest, highest]:",
    ]
    figures = interleave(jobs, rounds=5)
    try:
        seen = {"the same, 10 discs, a 160 x 120 picture each at 10 Hz": chase(10, 0.01, True, 3.0)}
        figures |= interleave(seen, rounds=3)
    except MissingGLError as e:
        lines.append(f"  cameras: {e}")
    return "\n".join([*lines, *(f"  {name}: {spread(f)} x" for name, f in figures.items())])


def scene(count: int, dt: float, sleep: bool = False, seed: int = 0) -> tuple[Simulation, Group]:
    """Four robots at home and ``count`` small discs of weight 0 in a field of 10 m."""
    rng = np.random.default_rng(seed)
    world = World(bounds=[-HALF, -HALF, HALF, HALF], wall_height=0.3, floor="concrete")
    if sleep:
        world.edit(let_discs_sleep)
    places = np.empty((0, 2))
    while len(places) < count:
        place = rng.uniform(-HALF + 0.7, HALF - 0.7, 2)
        if np.hypot(*place) > 1.3 and (np.hypot(*(places - place).T) > 3 * RADIUS).all():
            places = np.vstack([places, place])
    for x, y in places:
        world.add_disc(x, y, RADIUS, friction_force(0))
    robots = world.add_group(RoundPusher, _HOME)
    return Simulation(world, control_period=PERIOD, dt_max=dt), robots


def chase(
    count: int, dt: float, pictures: bool = False, seconds: float = 10.0, sleep: bool = False
) -> Callable[[], float]:
    """A job: every robot heads for a disc of its own for a while, then for the next one.

    What it does is told from truth, between the ticks: no sensor, no controller is measured.
    """
    simulation, robots = scene(count, dt, sleep)
    camera = None
    if pictures:
        camera = robots.mount(Camera(at="camera", width=160, height=120, rate=1 / PERIOD), "eye")
        simulation = Simulation(simulation.world, control_period=PERIOD, dt_max=dt)
    command = np.zeros((robots.n, 2))
    rows = np.arange(robots.n)

    def decide() -> None:
        poses, discs = simulation.poses_of(robots), simulation.mover_poses()[:, :2]
        goals = (rows + int(simulation.time / 5.0) * robots.n) * 7 % count
        to = discs[goals] - poses[:, :2]
        off = np.remainder(np.arctan2(to[:, 1], to[:, 0]) - poses[:, 2] + np.pi, 2 * np.pi) - np.pi
        command[:, 0] = np.where(np.abs(off) < 1.2, 0.5, -0.2)
        command[:, 1] = np.clip(3.0 * off, -2.5, 2.5)

    simulation.observe(decide)

    def run() -> float:
        start = time.process_time()
        for _ in simulation.ticks(seconds):
            robots.drive(command)
            if camera is not None:
                camera.read()
        return seconds / (time.process_time() - start)

    return run
