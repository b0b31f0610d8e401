"""The omni drive: a free body on four wheels that only their contact with the floor moves."""

import mujoco
import numpy as np
import pytest
from scipy.stats import qmc

from mjmr.assets import model_path
from mjmr.errors import InvalidInputError
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.simulation import Simulation
from mjmr.world import World
from tests.mjmr.worlds import drive, ramp

PERIOD = 1 / 60
# asked for at 60 Hz: the default timestep, 4 ms and 2 ms, as whole parts of the period
TIMESTEPS = (0.005, 0.004, 0.002)


def omni(poses, **options):
    """A field without boxes; returns (world, robots)."""
    world = World(bounds=[-4, -4, 4, 4])
    return world, world.add_group(SoccerBot(drive="omni"), poses, **options)


def straight(angle, up, down, dt_max=0.005, edit=None):
    """Drive 2 m/s and back to rest at ``angle`` in the body frame; true poses, twists, commands."""
    world, robots = omni([[0.0, 0.0, 0.0]])
    if edit:
        world.edit(edit)
    speed = ramp(2.0, up=up, down=down, cruise=0.8)[:, :1]
    commands = speed * [np.cos(angle), np.sin(angle), 0.0]
    simulation = Simulation(world, dt_max=dt_max)
    poses, twists = drive(simulation, robots, commands)
    return poses[:, 0], twists[:, 0], np.concatenate([np.zeros((1, 3)), commands])


def slopes(twists):
    """Acceleration and braking [m/s^2] between 20 % and 80 % of 2 m/s."""
    speed = np.hypot(twists[:, 0], twists[:, 1])
    change = np.diff(speed) / PERIOD
    inside = (np.minimum(speed[1:], speed[:-1]) > 0.4) & (np.maximum(speed[1:], speed[:-1]) < 1.6)
    return change[inside & (change > 0)].mean(), -change[inside & (change < 0)].mean()


def test_the_model_weighs_what_the_planar_one_does():
    model = mujoco.MjModel.from_xml_path(str(model_path("soccer_bot", "omni")))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("home").id)
    mujoco.mj_forward(model, data)
    base = model.body("base").id
    assert model.body_subtreemass[base] == pytest.approx(2.5)
    np.testing.assert_allclose(data.subtree_com[base], [0, 0, 0.06], atol=1e-4)
    inertia = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, inertia)
    shift = 2.5 * 0.06**2
    # of everything about the centre of mass, wheels included
    about = np.diag(inertia)[3:6] - [shift, shift, 0.0]
    np.testing.assert_allclose(about, [0.0098, 0.0098, 0.0101], rtol=0.01)


def test_it_survives_halton_noise_without_a_warning():
    """1 s of quasi-random control on all wheels, beside a wall, a ball, a box and each other."""
    world, _ = omni([[-3.8, 0.0, 0.3], [0.0, 0.0, -2.0], [0.25, 0.1, 1.0]])
    world.add_golf_ball(0.0, 0.3)
    world.add_box(0.6, 0.1, 0.3, 0.2, mass=1.0)
    simulation = Simulation(world)
    model, data = simulation.model, simulation.data
    steps = round(1.0 / model.opt.timestep)
    noise = qmc.Halton(model.nu, rng=np.random.default_rng(0)).random(steps)
    for row in noise:
        # set points reach 70 rad/s, 1.8 m/s at the rim, within a few steps
        data.ctrl[:] = 4000.0 * (row - 0.5)
        mujoco.mj_step(model, data)
    assert data.warning.number.sum() == 0
    assert np.isfinite(data.qpos).all()
    upright = simulation.data.xmat.reshape(-1, 3, 3)[
        [model.body(f"soccer_bot{i}/base").id for i in range(3)], 2, 2
    ]
    assert upright.min() > np.cos(np.radians(5.0))


def test_it_starts_at_rest_and_stands_still():
    """Heights, wheels and poses of the first instant are those of equilibrium."""
    poses = [[1.0, 0.5, 0.3], [-1.0, -0.5, -2.0]]
    world, robots = omni(poses)
    simulation = Simulation(world)
    np.testing.assert_allclose(simulation.truth.poses(robots), poses, atol=1e-12)
    height = simulation.data.qpos[2]
    assert -1e-3 < height < -1e-6
    seen, twists = drive(simulation, robots, np.zeros((60, 3)))
    assert np.abs(seen - seen[0]).max() < 1e-6
    assert np.abs(twists).max() < 1e-5
    assert simulation.data.qpos[2] == pytest.approx(height, abs=1e-6)


@pytest.mark.parametrize("dt_max", TIMESTEPS)
@pytest.mark.parametrize("degrees", [0, 20, 45, 90])
def test_it_follows_the_limits_in_every_direction(degrees, dt_max):
    """2 m/s and back at what ``limits`` promises: slopes, heading, way and velocity."""
    limits = SoccerBot(drive="omni").limits
    poses, twists, commands = straight(
        np.radians(degrees), limits.acceleration, limits.deceleration, dt_max
    )
    up, down = slopes(twists)
    assert up == pytest.approx(limits.acceleration, rel=0.05)
    assert down == pytest.approx(limits.deceleration, rel=0.05)
    assert np.degrees(np.abs(poses[:, 2]).max()) < 0.1
    way = np.cumsum(commands[1:] + commands[:-1], axis=0)[:, :2] * PERIOD / 2
    assert np.hypot(*(poses[1:, :2] - way).T).max() < 0.008
    assert np.abs(twists[:, :2] - commands[:, :2]).max() < 0.03


def test_friction_bounds_its_braking():
    """12 m/s^2 is beyond what friction 1 gives: g / sqrt 2 = 6.94 at most along x."""
    _, twists, _ = straight(0.0, 2.0, 12.0)
    assert 4.0 < slopes(twists)[1] < 9.81 / np.sqrt(2) * 1.02


def test_less_friction_pulls_less():
    """At 45 degrees two wheels pull; friction 0.4 gives 0.2 g at equal loads, 0.4 g at the most.

    MuJoCo's convex friction loads wheels that slip more than the others.
    """

    def slippery(spec):
        for pair in spec.pairs:
            pair.friction[1] = 0.4

    _, twists, _ = straight(np.pi / 4, 6.0, 6.0, edit=slippery)
    speed = np.hypot(*twists[:10, :2].T)
    assert 0.2 * 9.81 < (speed[9] - speed[3]) / (6 * PERIOD) < 0.4 * 9.81


def test_only_contact_moves_it():
    """Wheels on ice spin and the robot stays."""

    def ice(spec):
        for pair in spec.pairs:
            pair.friction[:2] = 1e-5

    world, robots = omni([[0.0, 0.0, 0.0]])
    world.edit(ice)
    simulation = Simulation(world)
    poses, _ = drive(simulation, robots, ramp(1.0))
    assert np.abs(poses[:, 0, :2]).max() < 5e-3
    # a quarter of a turn at the least: they did turn
    angles = [simulation.data.joint(f"soccer_bot0/wheel{k}").qpos[0] for k in range(4)]
    assert np.abs(angles).min() > 1.5


def test_wheels_roll_without_slip():
    """Against an omni base's kinematics in numbers: wheels at 45 degrees, 26 mm and 80.5 mm."""
    twist = np.array([0.3, -0.2, 0.8])
    world, robots = omni([[0.0, 0.0, 0.0]])
    simulation = Simulation(world)
    commands = np.minimum(np.arange(1, 61) / 40, 1.0)[:, None] * twist
    drive(simulation, robots, commands)
    found = [simulation.data.joint(f"soccer_bot0/wheel{k}").qvel[0] for k in range(4)]
    around = np.radians([45, 135, 225, 315])
    # (tyres sink in by 0.2 mm, which makes them 0.4 % smaller)
    # forward along the tangent, anticlockwise, turns a wheel against its outward axle
    tangent = -np.sin(around) * twist[0] + np.cos(around) * twist[1] + 0.0805 * twist[2]
    np.testing.assert_allclose(found, tangent / -0.026, rtol=0.006, atol=0.02)


def test_it_turns_in_place():
    """Half a second at 4 rad/s, ramps beside it: 2.0 + 2 x 0.4 rad, and no way."""
    up = np.linspace(4.0 / 24, 4.0, 24)
    rate = np.concatenate([up, np.full(30, 4.0), up[::-1][1:], [0.0] * 20])
    world, robots = omni([[0.5, -0.5, 0.2]])
    commands = np.column_stack([0 * rate, 0 * rate, rate])
    poses, twists = drive(Simulation(world), robots, commands)
    turned = np.sum(rate) * PERIOD
    assert np.unwrap(poses[:, 0, 2])[-1] - 0.2 == pytest.approx(turned, rel=0.01)
    assert np.hypot(*(poses[-1, 0, :2] - [0.5, -0.5])) < 1e-3
    assert twists[40, 0, 2] == pytest.approx(4.0, rel=0.01)


def test_a_circle_closes():
    """1 m/s forward at 1 rad/s, a circle of 1 m: the torque that turns the velocity is given."""
    world, robots = omni([[0.0, -1.0, 0.0]])
    turns = round(2 * np.pi * 60)
    up = np.linspace(1 / 40, 1, 40)
    commands = np.concatenate(
        [np.column_stack([up, 0 * up, up]), np.tile([1.0, 0.0, 1.0], (turns + 20, 1))]
    )
    poses, twists = drive(Simulation(world), robots, commands)
    a, b = poses[50, 0], poses[50 + turns, 0]
    assert np.hypot(*(a - b)[:2]) < 0.03
    assert np.abs(twists[60:, 0] - [1.0, 0.0, 1.0]).max() < 0.02


def test_same_bits_and_a_snapshot_goes_on():
    def build():
        world, robots = omni([[-2.0, 0.5, 0.3], [-1.7, 0.5, -2.0]])
        return Simulation(world, seed=3), robots

    def go(simulation, robots, offset):
        angle = 0.1 * (np.arange(30) + offset)
        commands = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle + 0.4])
        return drive(simulation, robots, commands[:, None])[0]

    simulation, robots = build()
    first = go(simulation, robots, 0)
    snapshot = simulation.snapshot()
    once = go(simulation, robots, 30)
    simulation.restore(snapshot)
    again = go(simulation, robots, 30)
    fresh, others = build()
    assert go(fresh, others, 0).tobytes() == first.tobytes()
    assert once.tobytes() == again.tobytes()


def test_wheels_touch_the_floor_alone_and_the_hull_what_stands_on_it():
    world, robots = omni([[3.0, 0.0, 0.7]])
    simulation = Simulation(world)
    model, data = simulation.model, simulation.data
    touched = set()

    def look():
        for a, b in data.contact.geom:
            touched.add((model.geom(a).name, model.geom(b).name))

    simulation.watch_steps(look)
    # a glancing run into the wall at 1 m/s
    commands = np.minimum(np.arange(1, 91) * 0.05, 1.0)[:, None] * [1.0, 0.0, 0.0]
    poses, _ = drive(simulation, robots, commands)
    names = {name for pair in touched for name in pair}
    assert {f"soccer_bot0/tread{k}" for k in range(4)} < names
    for pair in touched:
        if any("tread" in name for name in pair):
            assert "floor" in pair
        elif any("hull" in name for name in pair):
            assert "floor" not in pair
    assert any("wall_east" in pair for pair in touched)
    # the wall gives way by what 1 m/s covers in two steps, not more
    assert poses[:, 0, 0].max() < 4.0 - 0.09 + 2.0 * simulation.timestep


def test_both_drives_share_a_world():
    world, omnis = omni([[1.0, 0.0, 0.0]])
    planars = world.add_group(SoccerBot, [[-1.0, 0.0, 0.0]], team="blue")
    simulation = Simulation(world)
    for _ in simulation.ticks(0.5):
        omnis.drive([[0.0, 0.5, 0.0]])
        planars.drive([[0.0, 0.5, 0.0]])
    a, b = simulation.truth.poses(omnis)[0], simulation.truth.poses(planars)[0]
    assert a[1] == pytest.approx(b[1], abs=0.05)
    assert a[0] == pytest.approx(1.0, abs=0.01)


def test_an_emergency_stop_stays_within_the_limits():
    platform = SoccerBot(drive="omni")
    assert platform.braking == platform.limits.deceleration
    assert SoccerBot().braking == 6.0
    with pytest.raises(InvalidInputError, match="valid: planar, omni"):
        SoccerBot(drive="legs")


def test_exported_mjcf_stands_where_it_starts():
    """Pairs, heights and limits survive MJCF text: in MuJoCo alone the robot does not move."""
    pose = [1.0, 0.5, 0.3]
    world, _ = omni([pose])
    model = mujoco.MjModel.from_xml_string(world.to_xml())
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    assert model.npair == 4
    for _ in range(240):
        mujoco.mj_step(model, data)
    np.testing.assert_allclose(data.body("soccer_bot0/base").xpos[:2], pose[:2], atol=1e-4)
    assert abs(data.body("soccer_bot0/base").xpos[2]) < 1e-3


def test_a_crash_does_not_turn_it_over():
    """Head on at 2 m/s each, off the centre line: it rocks, and stands on its wheels again."""
    world, robots = omni([[-1.2, 0.03, 0.0], [1.2, -0.03, np.pi]])
    simulation = Simulation(world)
    tilts = []
    bases = [simulation.data.body(f"soccer_bot{i}/base") for i in range(2)]
    simulation.observe(lambda: tilts.append([np.arccos(min(1.0, b.xmat[8])) for b in bases]))
    speed = np.concatenate([np.minimum(np.arange(1, 61) * 0.05, 2.0), np.zeros(60)])
    drive(simulation, robots, speed[:, None] * [1.0, 0.0, 0.0])
    tilted = np.degrees(tilts)
    assert 0.5 < tilted.max() < 15.0
    assert tilted[-1].max() < 0.1
