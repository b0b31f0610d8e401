"""Drives with a frame rate of their own, and starts that cannot be."""

import copy

import numpy as np
import pytest

from mjmr import Pioneer2DX, Simulation, SoccerBot, WheelEncoders, World
from mjmr.errors import InvalidInputError
from mjmr.robots.diff_drive import DiffDrive


class FramedDiffDrive(DiffDrive):
    """Notes when its firmware runs."""

    frame = 0.008
    made: "list[FramedDiffDrive]"

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.called: list[float] = []
        self.count = 0

    def servo(self, data, time):
        self.called.append(time)
        self.count += 1

    def state(self):
        return self.count

    def set_state(self, state):
        self.count = state


class Framed(Pioneer2DX):
    def bind(self, model, prefixes):
        self.drive = FramedDiffDrive(model, prefixes)
        return self.drive


def framed(control_period, dt_max):
    platform = Framed()
    world = World(bounds=[-2, -2, 2, 2])
    robots = world.add_group(platform, [[0.0, 0.0, 0.0]])
    # a sensor that is due in the middle of everything
    robots.mount(WheelEncoders(rate=70.0), "fast")
    return Simulation(world, control_period=control_period, dt_max=dt_max), platform.drive


@pytest.mark.parametrize(("period", "dt"), [(0.032, 0.004), (1 / 60, 0.005), (0.02, 0.002)])
def test_firmware_runs_at_its_frames_and_a_snapshot_goes_on(period, dt):
    simulation, drive = framed(period, dt)
    for _ in simulation.ticks(20 * period):
        pass
    frames = np.arange(0.0, 20 * period - 1e-9, 0.008)
    steps = np.ceil(frames / simulation.timestep - 1e-9)
    # a frame due after the last step of the run is not begun
    expected = (steps * simulation.timestep)[steps < simulation.step]
    np.testing.assert_allclose(drive.called, expected, atol=1e-12)
    snapshot, count = simulation.snapshot(), drive.count
    drive.called.clear()
    for _ in simulation.ticks(10 * period):
        pass
    first = list(drive.called)
    simulation.restore(snapshot)
    assert drive.count == count
    drive.called.clear()
    for _ in simulation.ticks(10 * period):
        pass
    assert drive.called == first
    assert first


def test_a_frame_shorter_than_a_timestep_is_refused():
    with pytest.raises(InvalidInputError, match=r"frame of 0\.008 s is shorter"):
        framed(0.02, 0.02)


def test_robots_that_start_inside_something_are_named_with_depth():
    world = World(bounds=[-2, -2, 2, 2])
    world.add_box(1.0, 0.0, 0.4, 0.4)
    world.add_group(SoccerBot, [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.9, 0.0, 0.0], [-1, 0, 0]])
    with pytest.raises(InvalidInputError) as caught:
        Simulation(world)
    text = str(caught.value)
    assert "soccer_bot0 and soccer_bot1 by 80 mm" in text
    assert "box0 and soccer_bot2" in text
    assert "soccer_bot3" not in text


def test_robots_outside_are_named_with_depth():
    world = World(bounds=[-2, -2, 2, 2])
    with pytest.raises(InvalidInputError, match="soccer_bot1 by 590 mm"):
        world.add_group(SoccerBot, [[0.0, 0.0, 0.0], [2.5, 0.0, 0.0]])


def test_an_unknown_sensor_lists_the_mounted_ones():
    world = World(bounds=[-2, -2, 2, 2])
    robots = world.add_group(Pioneer2DX, [[0.0, 0.0, 0.0]])
    with pytest.raises(InvalidInputError, match="unknown sensor of pioneer2dx 'lidar'; valid: enc"):
        robots.lidar.read()
    assert not hasattr(robots, "lidar")
    assert copy.copy(robots).names == robots.names


def test_a_name_is_mounted_once():
    world = World(bounds=[-2, -2, 2, 2])
    robots = world.add_group(Pioneer2DX, [[0.0, 0.0, 0.0]])
    robots.mount(WheelEncoders(rate=20.0))  # in place of the platform's own
    with pytest.raises(InvalidInputError, match="'encoders' already"):
        robots.mount(WheelEncoders(rate=30.0))
