"""The round pusher: as its README says, drives straight, pushes as hard as its wheels' torque."""

import re
from typing import Any

import mujoco
import numpy as np
import pytest
from scipy.stats import qmc

from mjmr.assets import asset_folder, model_path
from mjmr.errors import InvalidInputError
from mjmr.robots.diff_drive import DiffDrive
from mjmr.robots.round_pusher import RoundPusher
from mjmr.sensors.bumper import Bumper
from mjmr.simulation import Simulation
from mjmr.world import World
from mjmr.world_spec import leave_out_drawn
from tests.mjmr.bases import drive, profile
from tests.mjmr.worlds import BOTH

PERIOD = 0.1
TIMESTEPS = (0.01, 0.005)


def pushers(poses: Any = ((0.0, 0.0, 0.0),), platform: Any = RoundPusher, half=8.0):
    """A hall; returns (world, robots)."""
    world = World(bounds=[-half, -half, half, half], wall_height=0.3)
    return world, world.add_group(platform, poses)


def test_the_compiled_model_has_the_stated_numbers():
    model = mujoco.MjModel.from_xml_path(str(model_path("round_pusher")))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("home").id)
    mujoco.mj_forward(model, data)
    base = model.body("base").id
    assert model.body_subtreemass[base] == pytest.approx(6.0)
    np.testing.assert_allclose(data.subtree_com[base], [-0.015, 0.0, 0.0928], atol=1e-4)
    hull, rim = model.geom("hull"), model.geom("rim")
    assert hull.size[0] == rim.size[0] == RoundPusher.radius
    assert hull.pos[2] + hull.size[1] == pytest.approx(RoundPusher.height)
    servo, tread = model.actuator("wheel_left"), model.geom("tread_left")
    assert 2 * servo.forcerange[1] / tread.size[0] == pytest.approx(RoundPusher.push_force)
    # gain times timestep below the wheel's inertia
    wheel = model.joint("wheel_left").armature[0] + model.body("wheel_left").inertia[1]
    assert servo.gainprm[0] * max(TIMESTEPS) < wheel
    # grip is not what limits it
    assert tread.friction[0] * 0.85 * 6.0 * 9.81 > 1.2 * RoundPusher.push_force
    # across the picture, of 4 by 3
    fovy = np.radians(model.camera("camera").fovy[0])
    assert np.degrees(2 * np.arctan(np.tan(fovy / 2) * 4 / 3)) == pytest.approx(90.0)
    lens = data.camera("camera").xpos
    np.testing.assert_allclose(lens[:2], data.joint("pan").xanchor[:2], atol=1e-12)
    text = (asset_folder() / "round_pusher" / "README.md").read_text()
    stated = {"radius": 240, "mass": 6, "pushing force": RoundPusher.push_force, "track": 320,
              "top speed": RoundPusher.max_twist[0], "lens": 1e3 * lens[2],
              "rolling radius": 1e3 * RoundPusher.rolling_radius}  # fmt: skip
    for name, value in stated.items():
        row = re.search(rf"^\| {name} \| ([\d.]+|on)", text, re.MULTILINE)
        assert row is not None
        if name != "lens":
            assert float(row[1]) == pytest.approx(value)
    assert f"{1e3 * lens[2]:.0f} mm up" in text


def test_the_rolling_radius_is_that_of_the_model():
    world, _ = pushers()
    bound = RoundPusher().bind(Simulation(world).model, ["round_pusher0/"])
    assert isinstance(bound, DiffDrive)
    assert bound.rolling_radius == pytest.approx(RoundPusher.rolling_radius, abs=1e-5)
    assert bound.track == pytest.approx(RoundPusher.track)


@pytest.mark.parametrize("start", range(5))
def test_it_survives_halton_noise_without_a_warning(start):
    """1 s of quasi-random control on all motors, beside a wall, discs, boxes and each other."""
    rng = np.random.default_rng(start)
    poses = np.array([[-7.74, 0.0, 0.0], [0.0, 0.0, 0.0], [0.5, 0.05, 0.0], [3.0, 3.0, 0.0]])
    poses[:, 2] = rng.uniform(-np.pi, np.pi, 4)
    world, _ = pushers(poses)
    world.add_disc(-0.45, 0.1, 0.2, 5.0)
    world.add_box(1.0, 0.1, 0.4, 0.4, mass=5.0)
    world.add_box(3.0, 2.5, 0.4, 0.4)
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
    model, data = simulation.model, simulation.data
    for row in qmc.Halton(model.nu, rng=rng).random(round(1.0 / model.opt.timestep)):
        data.ctrl[:] = 400.0 * (row - 0.5)
        mujoco.mj_step(model, data)
    assert data.warning.number.sum() == 0
    assert np.isfinite(data.qpos).all()
    bases = [model.body(f"round_pusher{i}/base").id for i in range(4)]
    assert data.xmat[bases, 8].min() > np.cos(np.radians(5.0))
    assert np.abs(data.qvel).max() > 0.5


def test_it_starts_at_rest_and_stands_still():
    poses = [[1.0, 0.5, 0.3], [-1.0, -0.5, -2.0]]
    world, robots = pushers(poses)
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
    seen, twists, _ = drive(simulation, robots, np.zeros((20, 2)))
    assert np.abs(seen - poses).max() < 1e-6
    assert np.abs(twists).max() < 1e-5


@pytest.mark.parametrize("dt_max", TIMESTEPS)
def test_straight_in_place_and_along_an_arc(dt_max):
    world, robots = pushers([[-3.0, 0.0, 0.0]])
    simulation = Simulation(world, control_period=PERIOD, dt_max=dt_max)
    poses, twists, tilt = drive(simulation, robots, profile(0.5, 0.0, 100, ramps=7))
    np.testing.assert_allclose(poses[-1, 0], [2.0, 0.0, 0.0], atol=0.002)
    assert twists[50, 0, 0] == pytest.approx(0.5, rel=0.001)
    assert tilt < 1.0
    poses, _, _ = drive(simulation, robots, profile(0.0, 2.0, 50, ramps=7))
    assert np.unwrap(poses[:, 0, 2])[-1] == pytest.approx(10.0, abs=0.02)
    poses, _, _ = drive(simulation, robots, profile(0.3, 0.6, 100))
    ways = np.hypot(*np.diff(poses[:, 0, :2], axis=0).T).sum()
    assert ways == pytest.approx(3.0, rel=0.005)


@pytest.mark.parametrize("dt_max", TIMESTEPS)
@pytest.mark.parametrize("heading", [0.0, 0.03])
def test_it_pushes_a_wall_as_hard_as_stated_and_does_not_tip(heading, dt_max):
    world, robots = pushers([[7.7, 0.0, heading]])
    simulation = Simulation(world, control_period=PERIOD, dt_max=dt_max)
    poses, _, tilt = drive(simulation, robots, np.full((30, 2), [0.5, 0.0]))
    force, total = np.zeros(6), 0.0
    model, data = simulation.model, simulation.data
    for k in range(data.ncon):
        if model.geom("round_pusher0/rim").id in data.contact[k].geom:
            mujoco.mj_contactForce(model, data, k, force)
            total += force[0]
    assert total == pytest.approx(RoundPusher.push_force, rel=0.02)
    assert tilt < 0.5
    # its wheels are held, they do not spin
    assert np.abs(data.joint("round_pusher0/wheel_left").qvel).max() < 0.01
    assert poses[-1, 0, 0] + RoundPusher.radius == pytest.approx(8.0, abs=0.002)


def test_a_load_slows_it_as_much_as_its_servo_lags():
    """A disc of 0.6 of its push: v = 0.5 - R^2 F / 2 k."""
    world, robots = pushers([[-3.0, 0.0, 0.0]])
    world.add_disc(-2.5, 0.0, 0.2, 0.6 * RoundPusher.push_force)
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
    _, twists, _ = drive(simulation, robots, np.full((60, 2), [0.5, 0.0]))
    lag = RoundPusher.rolling_radius**2 * 0.6 * RoundPusher.push_force / 2 / 0.5
    assert twists[-1, 0, 0] == pytest.approx(0.5 - lag, rel=0.01)


def test_reversing_as_hard_as_it_can_does_not_tip_it():
    world, robots = pushers(platform=RoundPusher(acceleration=50.0, turn_acceleration=50.0))
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
    speeds = np.repeat([0.5, -0.5, 0.5, -0.5], 15)
    assert drive(simulation, robots, np.column_stack([speeds, 0 * speeds]))[2] < 2.0


def test_nobody_tips_or_climbs_in_a_crowd():
    rng = np.random.default_rng(5)
    grid = np.stack(np.meshgrid(np.arange(4), np.arange(4)), axis=-1).reshape(-1, 2) * 0.6 - 0.9
    yaws = rng.uniform(-np.pi, np.pi, 16)
    world, robots = pushers(np.column_stack([grid, yaws]), half=1.3)
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
    rates = rng.uniform(-2.0, 2.0, (5, 16)).repeat(10, axis=0)
    commands = np.stack([np.full((50, 16), 0.5), rates], axis=-1)
    poses, _, tilt = drive(simulation, robots, commands)
    assert tilt < 2.0
    assert np.abs(poses[:, :, :2]).max() < 1.3 - RoundPusher.radius + 0.005
    assert np.abs(poses[-1] - poses[0]).max() > 0.1


def test_a_bumper_feels_the_rim():
    world, robots = pushers([[7.7, 0.0, 0.0]])
    bumper = robots.mount(Bumper(sectors=4))
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
    drive(simulation, robots, np.full((20, 2), [0.3, 0.0]))
    np.testing.assert_array_equal(bumper.read(), [[True, False, False, False]])


def test_both_simulations_agree():
    commands = profile(0.3, 0.5, 60)
    ends = []
    for kind in BOTH:
        world, robots = pushers([[0.0, -1.0, 0.4]])
        simulation = kind(world, control_period=PERIOD, dt_max=0.01)
        poses, _, _ = drive(simulation, robots, commands)
        ends.append((poses[-1, 0], simulation.wheel_angles_of(robots)[0]))
    np.testing.assert_allclose(ends[0][0], ends[1][0], atol=0.01)
    np.testing.assert_allclose(ends[0][1], ends[1][1], rtol=0.002)


def test_same_bits_and_without_what_is_drawn():
    """What is only seen changes nothing, and a snapshot goes on with the same bits."""

    def build(drawn):
        world, robots = pushers([[-1.0, 0.0, 0.1], [0.6, 0.0, 3.0]])
        world.add_disc(-0.3, 0.05, 0.3, 8.0)
        if not drawn:
            world.edit(leave_out_drawn)
        return Simulation(world, seed=3, control_period=PERIOD, dt_max=0.01), robots

    def go(simulation, robots, offset):
        angle = 0.3 * (np.arange(20) + offset)
        commands = np.column_stack([np.full(20, 0.4), np.sin(2 * angle)])
        return drive(simulation, robots, commands)[0].tobytes()

    simulation, robots = build(True)
    first = go(simulation, robots, 0)
    snapshot = simulation.snapshot()
    once = go(simulation, robots, 20)
    simulation.restore(snapshot)
    assert go(simulation, robots, 20) == once
    assert go(*build(True), 0) == first
    assert go(*build(False), 0) == first


def test_commands_are_cut_and_bad_ones_refused():
    world, robots = pushers([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
    assert simulation.timestep == 0.01
    robots.drive([[0.9, -4.0], [0.3, 1.0]])
    np.testing.assert_allclose(robots.command, [[0.5, -2.5], [0.3, 1.0]])
    np.testing.assert_array_equal(robots.clamped, [1, 0])
    with pytest.raises(InvalidInputError, match="round_pusher1"):
        robots.drive([[0.0, 0.0], [np.nan, 0.0]])
    with pytest.raises(InvalidInputError, match="accelerations of RoundPusher"):
        RoundPusher(acceleration=0.0)
