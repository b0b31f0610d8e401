"""Small worlds the tests share."""

import numpy as np

from mjmr.kinematics import KinematicSimulation
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.simulation import Simulation
from mjmr.world import World

BOTH = (Simulation, KinematicSimulation)


def soccer(poses, **options):
    """A field with robots at poses; returns (world, robots)."""
    world = World.rectangle(4.9, 3.8, border=0.3)
    return world, world.add_group(SoccerBot, poses, **options)


def drive(simulation, robots, commands):
    """Give one command (n, 3) a tick; returns true poses (k + 1, n, 3) and twists."""
    poses, twists = [], []
    truth = simulation.truth

    def see():
        poses.append(truth.poses(robots))
        twists.append(truth.twists(robots))

    simulation.observe(see)
    period = simulation.control_period
    for command, _ in zip(commands, simulation.ticks(len(commands) * period), strict=True):
        robots.drive(np.broadcast_to(command, (robots.n, 3)))
    return np.array(poses), np.array(twists)


def ramp(top, up=3.0, down=6.0, cruise=0.3, period=1 / 60):
    """Forward speeds (k, 3): up, cruise, down to rest."""
    rising = np.arange(up * period, top, up * period)
    falling = np.arange(top, 0.0, -down * period)
    speed = np.concatenate([rising, np.full(round(cruise / period), top), falling, [0.0, 0.0]])
    return np.column_stack([speed, np.zeros_like(speed), np.zeros_like(speed)])
