"""What tests of two-sided bases share: they take (forward, turn)."""

import numpy as np

from mjmr.simulation import Simulation


def drive(simulation, robots, commands):
    """Give one command (2,) a tick; true poses (k + 1, n, 3), twists and largest tilt [deg]."""
    poses, twists, tilts = [], [], [0.0]
    truth = simulation.truth

    def see():
        poses.append(truth.poses(robots))
        twists.append(truth.twists(robots))

    simulation.observe(see)
    if isinstance(simulation, Simulation):
        bases = [simulation.model.body(f"{name}/base").id for name in robots.names]
        simulation.watch_steps(
            lambda: tilts.append(np.arccos(simulation.data.xmat[bases, 8].clip(-1, 1)).max())
        )
    ticks = simulation.ticks(len(commands) * simulation.control_period)
    for command, _ in zip(commands, ticks, strict=True):
        robots.drive(np.broadcast_to(command, (robots.n, 2)))
    return np.array(poses), np.array(twists), np.degrees(np.max(tilts))


def profile(forward, turn, periods, ramps=5):
    """Commands (k, 2) that go up in equal steps, hold, come down: the area is ``periods`` full."""
    share = np.arange(1, ramps + 1) / ramps
    whole = np.concatenate([share, np.ones(periods - ramps), share[::-1][1:], np.zeros(6)])
    return whole[:, None] * [forward, turn]
