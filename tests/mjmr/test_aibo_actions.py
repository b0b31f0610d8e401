"""The AIBO's actions in contact physics: its ball, getting up, kicks, and their telemetry."""

from itertools import groupby

import mujoco
import numpy as np
import pytest

from controllers.legged.ers7_keyframes import ERS7_KICKS
from controllers.legged.motion import (
    GET_UP,
    GETTING_UP,
    KICK_FORWARD,
    KICK_LEFT,
    KICKING,
    WALK,
    WALKING,
    AiboMotion,
)
from controllers.legged.posture import BACK
from experiments.proving_ground import aibo_trials
from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.robots.aibo_ers7 import AiboERS7
from mjmr.sensors.motion_status import MotionStatus
from mjmr.simulation import Simulation
from mjmr.world import Ball, World

PERIOD = 0.04


def condition(variant="", friction=0.6, dt_ms=4.0):
    return {"variant": variant, "friction": friction, "dt_ms": dt_ms}


def rolling(dt, speed=1.0, seconds=1.0):
    """Way and speed of the league's ball that began to roll at ``speed``, after ``seconds``."""
    world = World(bounds=[-5, -5, 5, 5])
    ball = world.add_ball(0.0, 0.0)
    spec = world.spec()
    spec.option.timestep = dt
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qvel[[0, 4]] = speed, speed / ball.radius
    mujoco.mj_step(model, data, round(seconds / dt))
    return data.qpos[0], data.qvel[0]


@pytest.mark.parametrize("dt", [0.002, 0.004])
def test_the_ball_slows_down_as_rolling_friction_and_a_hollow_sphere_say(dt):
    # force times arm is the rolling moment; a shell's inertia is 2/3 m r^2 about its centre
    slowing = 0.0012 * 9.81 / (0.0425 * (1 + 2 / 3))
    way, speed = rolling(dt)
    assert speed == pytest.approx(1.0 - slowing, abs=0.005)
    assert way == pytest.approx(1.0 - slowing / 2, abs=0.005)
    # 2.5 to 4 m from 1 m/s
    assert 2.5 < 1.0 / (2 * (1.0 - speed)) < 4.0


def test_a_ball_has_its_inertia_and_the_golf_ball_is_as_it_was():
    world = World(bounds=[-2, -2, 2, 2])
    world.add_ball(0.0, 0.0)
    world.add_golf_ball(1.0, 0.0)
    model = world.spec().compile()
    hollow = 2 / 3 * 0.05 * 0.0425**2
    full = 2 / 5 * 0.046 * 0.02135**2
    np.testing.assert_allclose(model.body("ball0").inertia, hollow, rtol=1e-6)
    np.testing.assert_allclose(model.body("ball1").inertia, full, rtol=1e-6)
    golf = model.geom("ball1")
    assert golf.friction.tolist() == [0.5, 0.002, 0.0004]
    assert golf.solref.tolist() == [0.0085, 0.4]
    assert (golf.condim.item(), golf.priority.item()) == (6, 1)


@pytest.mark.parametrize(
    "options", [{"radius": 0.0}, {"mass": -1.0}, {"friction": (0.5, -0.1, 0.0)}, {"solref": (0, 1)}]
)
def test_impossible_balls_are_refused(options):
    with pytest.raises(InvalidInputError, match="ball"):
        Ball(**({"x": 0.0, "y": 0.0, "radius": 0.04, "mass": 0.05} | options))


@pytest.mark.parametrize(
    ("variant", "friction", "within"),
    [("front", 0.6, 3.0), ("left", 1.0, 6.0), ("right", 0.6, 6.0), ("back", 1.0, 6.0)],
)
def test_it_gets_up_from_every_side(variant, friction, within):
    result = aibo_trials.get_up(condition(variant, friction), seed=0)
    assert result["up"]
    assert result["seconds"] <= within


@pytest.mark.parametrize(
    ("variant", "least", "angle"), [("forward", 1.5, 0.0), ("left", 0.6, 90.0), ("right", 0.6, -90)]
)
def test_kicks_send_the_ball_where_they_should(variant, least, angle):
    result = aibo_trials.kick(condition(variant), seed=0)
    assert result["distance_m"] > least
    assert result["angle_deg"] == pytest.approx(angle, abs=25)
    assert not result["fell"]


def test_trials_are_the_same_each_time_and_say_what_there_is():
    assert aibo_trials.get_up(condition("front"), 3) == aibo_trials.get_up(condition("front"), 3)
    with pytest.raises(UnknownNameError, match="valid: left, back, front, right"):
        aibo_trials.get_up(condition("belly"), 0)
    with pytest.raises(UnknownNameError, match="valid: forward, left, right"):
        aibo_trials.kick(condition("back"), 0)


def test_the_status_is_telemetry_and_a_snapshot_has_the_engines_state():
    world = World(bounds=[-2, -2, 2, 2])
    motion = AiboMotion()
    group = world.add_group(AiboERS7(motion), [[-0.5, 0, 0], [0.5, 0, 0], [0, 0.7, 0]])
    group.mount(MotionStatus(rate=25.0, latency=0.08))
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.004)
    seen = []

    def act(seconds, codes):
        for _ in simulation.ticks(seconds):
            group.drive(motion.command([[0, 0, 0]] * 3, action=codes))
            seen.append(group.motion_status.read().copy())

    act(0.4, [0, KICK_FORWARD, GET_UP])
    # the first frame of a kick is at 0; what is read is two samples old
    assert seen[2].tolist() == [WALKING] * 3
    assert seen[3].tolist() == [WALKING, KICKING, GETTING_UP]
    snapshot = simulation.snapshot()
    act(1.0, [0, KICK_FORWARD, GET_UP])
    positions, told = simulation.full_positions(), seen[-25:]
    simulation.restore(snapshot)
    act(1.0, [0, KICK_FORWARD, GET_UP])
    np.testing.assert_array_equal(simulation.full_positions(), positions)
    np.testing.assert_array_equal(seen[-25:], told)


def test_a_team_walks_kicks_and_gets_up_at_the_same_time():
    world = aibo_trials.world_with(0.6)
    ball = world.add_ball(*np.add(ERS7_KICKS[KICK_FORWARD].ball, [0.0, 3.0]))
    motion = AiboMotion()
    faller = world.add_group(AiboERS7(motion), [[0, 0, 0]], name="faller")
    others = world.add_group(AiboERS7(motion), [[0, 3.0, 0], [0, -3.0, 0]], name="others")
    for group in (faller, others):
        group.mount(MotionStatus(rate=25.0))
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.004)
    aibo_trials.fall(simulation, faller, BACK, np.random.default_rng(5))
    seen, places = [], []
    simulation.observe(
        lambda: places.append(np.vstack([simulation.poses_of(g) for g in (faller, others)])[:, :2])
    )
    for t in simulation.ticks(8.0):
        # all are told to walk all the time; one kicks first, the other on its way
        codes = [KICK_FORWARD, KICK_LEFT if 2.0 < t < 2.5 else WALK]
        faller.drive(motion.command([0.3, 0, 0]))
        others.drive(motion.command([0.3, 0, 0], action=codes))
        seen.append([*faller.motion_status.read(), *others.motion_status.read()])
    fell, kicker, walker = (
        [k for k, _ in groupby(np.array(seen)[1:, column].tolist())] for column in range(3)
    )
    assert fell == [WALKING, GETTING_UP, WALKING]
    assert kicker == [KICKING, WALKING]
    assert walker == [WALKING, KICKING, WALKING]
    way = np.linalg.norm(places[-1] - places[-51], axis=1)
    took = PERIOD * np.argmax(np.array(seen)[:, 0] == GETTING_UP)
    assert 0.3 < took < 0.7
    # the last 2 s all of them walk
    np.testing.assert_allclose(way / 2.0, 0.29, atol=0.06)
    assert simulation.mover_poses()[0, 0] - ball.x > 1.5


def test_robots_without_an_engine_have_no_status():
    world = World(bounds=[-2, -2, 2, 2])
    group = world.add_group(AiboERS7, [[0, 0, 0]])
    group.mount(MotionStatus())
    with pytest.raises(InvalidInputError, match="motion engine"):
        Simulation(world, control_period=PERIOD, dt_max=0.004)
