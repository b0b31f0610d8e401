import numpy as np
import pytest

from mjmr.geometry import rotate
from mjmr.kinematics import KinematicSimulation
from mjmr.metrics import ContactMeter, OverlapMeter
from mjmr.overlap import overlap
from mjmr.simulation import Simulation
from tests.mjmr.worlds import soccer


def test_standing_overlap_is_depth_times_time():
    world, _ = soccer([[0.0, 0.0, 0.0], [0.12, 0.0, 0.0], [1.0, 1.0, 0.0]])
    simulation = KinematicSimulation(world)
    meter = OverlapMeter(simulation)
    for _ in simulation.ticks(0.5):
        pass
    assert meter.robots == pytest.approx(0.06 * 0.5, rel=1e-9)
    assert meter.deepest == pytest.approx(0.06, rel=1e-9)
    assert meter.last_overlap == pytest.approx(0.5)
    assert meter.obstacles == 0.0


def test_driving_through_each_other_against_the_integral():
    """Head on at 1 m/s each: depth 2r - |d|, so the integral is (2r)^2 / 2 s for 2 m/s closing."""
    world, robots = soccer([[-1.0, 0.0, 0.0], [1.0, 0.0, np.pi]])
    simulation = KinematicSimulation(world)
    meter = OverlapMeter(simulation)
    up = np.minimum(np.arange(1, 100) * 0.05, 1.0)
    for speed, _ in zip(up, simulation.ticks(99 / 60), strict=True):
        robots.drive([[speed, 0, 0], [speed, 0, 0]])
    # depth falls linearly on both sides over 0.18 m at 2 m/s: 2 * 0.18^2 / 2 / 2
    assert meter.robots == pytest.approx(0.18**2 / 2, rel=0.002)
    assert meter.deepest == pytest.approx(0.18, abs=1e-6)


def test_a_miss_by_a_hair_is_exactly_zero():
    world, robots = soccer([[-1.0, 0.0, 0.0], [0.0, 0.1800001, 0.0]])
    simulation = KinematicSimulation(world)
    meter = OverlapMeter(simulation)
    for _ in simulation.ticks(2.0):
        robots.drive([[1.0, 0, 0], [0, 0, 0]])
    assert meter.robots == 0.0
    assert np.isnan(meter.last_overlap)


def test_a_touch_too_brief_for_the_samples_is_not_missed():
    """Passing at 4 m/s, 0.01 mm deep: about 0.5 ms, four times less than between two samples."""
    reach, deep = 0.18, 1e-5
    zero = np.zeros((2, 3))
    for offset in np.linspace(0.0, 1 / 60, 50):
        pose = zero.copy()
        pose[0] = [-2.0 * offset, reach - deep, 0.0]
        pose[1, 0] = 2.0 * offset
        start = np.array([[2.0, 0, 0], [-2.0, 0, 0]])
        none = np.zeros((0, 5))
        pairs, deepest, _, _ = overlap(
            pose, start, start, np.array([0.09, 0.09]), np.zeros(2, dtype=bool), none, none,
            np.array([-9.0, -9, 9, 9]), 1 / 60, 8,
        )  # fmt: skip
        assert deepest == pytest.approx(deep, rel=1e-6)
        assert pairs > 0.0


def test_overlap_with_a_turned_box_and_the_wall():
    world, _ = soccer([[0.0, 0.0, 0.0], [2.0, 1.0, 0.0]])
    direction = rotate([1.0, 0.0], 0.5)
    centre = direction * (0.2 + 0.09 - 0.03)
    world.add_box(*centre, 0.4, 0.6, yaw=0.5)
    simulation = KinematicSimulation(world)
    meter = OverlapMeter(simulation)
    for _ in simulation.ticks(1.0):
        pass
    assert meter.obstacles == pytest.approx(0.03, rel=1e-6)
    world, robots = soccer([[2.5, 0.0, 0.0]])
    simulation = KinematicSimulation(world)
    meter = OverlapMeter(simulation)
    for t in simulation.ticks(2.0):
        robots.drive([[0.36 if t < 0.5 else 0.0, 0, 0]])
    past = simulation.truth.poses(robots)[0, 0] + 0.09 - 2.75
    assert past > 0.01
    assert past * 1.4 < meter.obstacles < past * 2.0


def test_contact_time_of_a_push_against_another_robot():
    """Robot 0 pushes robot 1, which holds its place: they touch from arrival to the end."""
    world, robots = soccer([[-0.5, 0.0, 0.0], [0.0, 0.0, 0.0], [2.0, 1.0, 0.0]])
    simulation = Simulation(world)
    meter = ContactMeter(simulation)
    for _ in simulation.ticks(2.0):
        robots.drive([[0.3, 0, 0], [0, 0, 0], [0, 0, 0]])
    # 0.32 m at 0.3 m/s after half a cycle of ramp: first touch at 1.075 s
    assert meter.robots == pytest.approx(2.0 - 1.075, abs=0.08)
    assert meter.episodes >= 1
    assert meter.robot_impulse > 1.0
    assert meter.obstacles == 0.0
    assert meter.obstacle_impulse == 0.0


def test_contact_with_wall_and_box_is_apart_and_a_ball_is_neither():
    world, robots = soccer([[2.5, 0.0, 0.0], [-1.0, 0.0, 0.0], [-1.0, 1.0, 0.0]])
    world.add_box(-0.6, 0.0, 0.2, 0.2)
    world.add_golf_ball(-0.7, 1.0)
    simulation = Simulation(world)
    meter = ContactMeter(simulation)
    for _ in simulation.ticks(1.0):
        robots.drive(np.tile([0.4, 0, 0], (3, 1)))
    assert meter.robots == 0.0
    # arrivals after 0.16 m and 0.21 m at 0.4 m/s
    assert meter.obstacles == pytest.approx((1 - 0.41) + (1 - 0.53), abs=0.1)


def test_meters_see_every_physics_step_not_only_ticks():
    """A touch that begins and ends inside a control period is counted."""
    world, robots = soccer([[-1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    simulation = Simulation(world, control_period=0.5)
    meter = ContactMeter(simulation)
    speed = 2.0 * (1.0 - 0.18 + 0.002) / 0.5
    for k, _ in enumerate(simulation.ticks(1.5)):
        robots.drive([[speed if k == 0 else -speed, 0, 0], [0, 0, 0]])
    assert 0.0 < meter.robots < 0.2
