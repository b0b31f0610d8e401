"""What a truck can do: the bounds of speed and turn, and its circle at 1 m/s."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from controllers.perimeter.estimate import circle
from mjmr.kinematics import KinematicSimulation
from mjmr.robots.tamiya_txt1 import TamiyaTXT1
from mjmr.simulation import Simulation
from mjmr.world import World

PERIOD = 0.1
WINDOW = 5  # periods: 0.5 s
CIRCLE = 40.0  # s
CHANGING = 120.0  # s


def envelope(condition: Mapping[str, Any], seed: int) -> dict[str, Any]:
    """A circle at 1 m/s and 0.3 rad/s, then commands drawn at random every 2 s, in the open."""
    rng = np.random.default_rng(np.random.SeedSequence([seed, 15]))
    world = World(bounds=[-250, -250, 250, 250], wall_height=0.6, floor="concrete")
    trucks = world.add_group(TamiyaTXT1, [[0.0, 0.0, rng.uniform(-np.pi, np.pi)]])
    options: dict[str, Any] = {"seed": seed, "control_period": PERIOD}
    simulation: Any
    if condition["mode"] == "unicycle":
        simulation = KinematicSimulation(world, **options)
    else:
        simulation = Simulation(world, dt_max=condition["dt_ms"] / 1000.0, bound=260.0, **options)
    track: list[np.ndarray] = []
    simulation.observe(lambda: track.append(simulation.truth.poses(trucks)[0]))
    command = np.array([[1.0, 0.3]])
    for now in simulation.ticks(CIRCLE + CHANGING):
        if now >= CIRCLE and abs(now % 2.0) < 1e-6 + PERIOD / 2:
            command = np.array([[rng.uniform(0.0, 2.5), rng.uniform(-0.5, 0.5)]])
        trucks.drive(command)
    poses = np.array(track)
    yaw = np.unwrap(poses[:, 2])
    turn = np.abs(yaw[WINDOW:] - yaw[:-WINDOW]) / (WINDOW * PERIOD)
    speed = np.hypot(*(poses[WINDOW:, :2] - poses[:-WINDOW, :2]).T) / (WINDOW * PERIOD)
    steady = poses[round(10 / PERIOD) : round(CIRCLE / PERIOD)]
    return {
        "time_s": CIRCLE + CHANGING,
        "radius_m": circle(steady[:, :2]),
        "top_turn": float(turn.max()),
        "top_speed": float(speed.max()),
    }
