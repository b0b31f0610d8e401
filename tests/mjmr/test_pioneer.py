"""The Pioneer 2-DX: a free body on two driven wheels, a caster and a skid."""

import re

import mujoco
import numpy as np
import pytest
from scipy.stats import qmc

from controllers.estimation.odometry import Odometry
from mjmr.assets import asset_folder, model_path
from mjmr.errors import InvalidInputError
from mjmr.faults import Fault
from mjmr.kinematics import KinematicSimulation
from mjmr.robots.diff_drive import DiffDrive
from mjmr.robots.pioneer2dx import Pioneer2DX
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.sensors.encoders import WheelEncoders
from mjmr.simulation import Simulation
from mjmr.world import World
from tests.mjmr.bases import drive, profile
from tests.mjmr.worlds import BOTH

PERIOD = 0.1
TIMESTEPS = (0.005, 0.002)


def pioneers(poses, platform=Pioneer2DX, **options):
    """A large hall; returns (world, robots)."""
    world = World(bounds=[-8, -8, 8, 8], wall_height=0.5)
    return world, world.add_group(platform, poses, **options)


def run(commands, dt_max=0.005, pose=(0.0, 0.0, 0.0), **platform):
    world, robots = pioneers([pose], Pioneer2DX(**platform))
    simulation = Simulation(world, control_period=PERIOD, dt_max=dt_max)
    poses, twists, tilt = drive(simulation, robots, commands)
    assert simulation.data.warning.number.sum() == 0
    return poses[:, 0], twists[:, 0], tilt


def test_the_compiled_model_has_the_stated_numbers():
    model = mujoco.MjModel.from_xml_path(str(model_path("pioneer2dx")))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("home").id)
    mujoco.mj_forward(model, data)
    base = model.body("base").id
    assert model.body_subtreemass[base] == pytest.approx(9.0)
    np.testing.assert_allclose(data.subtree_com[base], [-0.04, 0, 0.12], atol=1e-4)
    hull = model.geom("hull")
    np.testing.assert_allclose(2 * hull.size[:2], [0.44, 0.38])
    assert hull.pos[2] + hull.size[2] == pytest.approx(0.22)
    assert np.hypot(*hull.size[:2]) == pytest.approx(Pioneer2DX.radius, abs=1e-3)
    treads = [model.geom(f"tread_{side}") for side in ("left", "right")]
    assert [t.size[0] for t in treads] == [Pioneer2DX.wheel_radius] * 2
    (left, right) = (data.geom(t.id).xpos for t in treads)
    np.testing.assert_allclose(left - right, [0, Pioneer2DX.track, 0], atol=1e-12)
    world, _ = pioneers([[0.0, 0.0, 0.0]])
    simulation = Simulation(world)
    bound = Pioneer2DX().bind(simulation.model, ["pioneer2dx0/"])
    assert isinstance(bound, DiffDrive)
    assert bound.rolling_radius == pytest.approx(Pioneer2DX.rolling_radius, abs=1e-6)
    assert bound.track == pytest.approx(Pioneer2DX.track)
    skid = model.geom("skid")
    assert skid.pos[2] - skid.size[0] == pytest.approx(0.004)
    # README and model say the same
    text = (asset_folder() / "pioneer2dx" / "README.md").read_text()
    for name, value in {"mass": 9, "wheel radius": 97.5, "track": 331}.items():
        row = re.search(rf"^\| {name} \| ([\d.]+)", text, re.MULTILINE)
        assert row is not None
        assert float(row[1]) == value


def test_sonars_look_along_the_real_bearings():
    model = mujoco.MjModel.from_xml_path(str(model_path("pioneer2dx")))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    front = [90, 50, 30, 10, -10, -30, -50, -90]
    rear = [-90, -130, -150, -170, 170, 150, 130, 90]
    for k, bearing in enumerate(front + rear):
        site = data.site(f"sonar{k}")
        axis = site.xmat.reshape(3, 3)[:, 0]
        assert np.degrees(np.arctan2(axis[1], axis[0])) == pytest.approx(bearing, abs=0.01)
        # on the hull's surface, looking away from it
        assert max(abs(site.xpos[0]) - 0.22, abs(site.xpos[1]) - 0.19) == pytest.approx(
            0.006, abs=0.005
        )
        assert axis[:2] @ site.xpos[:2] > 0.1


@pytest.mark.parametrize("start", range(5))
def test_it_survives_halton_noise_without_a_warning(start):
    """1 s of quasi-random control on all wheels, beside a wall, boxes and each other."""
    rng = np.random.default_rng(start)
    poses = np.array([[-7.7, 0.0, 0.0], [0.0, 0.0, 0.0], [0.6, 0.1, 0.0], [3.0, 3.0, 0.0]])
    poses[:, 2] = rng.uniform(-np.pi, np.pi, 4)
    world, _ = pioneers(poses)
    world.add_box(1.2, 0.1, 0.4, 0.4, mass=5.0)
    world.add_box(-0.6, 0.0, 0.4, 0.4)
    simulation = Simulation(world)
    model, data = simulation.model, simulation.data
    steps = round(1.0 / model.opt.timestep)
    noise = qmc.Halton(model.nu, rng=rng).random(steps)
    for row in noise:
        # set points reach 16 rad/s, 1.6 m/s at the rim, within some 20 steps
        data.ctrl[:] = 400.0 * (row - 0.5)
        mujoco.mj_step(model, data)
    assert data.warning.number.sum() == 0
    assert np.isfinite(data.qpos).all()
    bases = [model.body(f"pioneer2dx{i}/base").id for i in range(4)]
    assert data.xmat[bases, 8].min() > np.cos(np.radians(10.0))
    assert np.abs(data.qvel).max() > 0.5


def test_it_starts_at_rest_and_stands_still():
    poses = [[1.0, 0.5, 0.3], [-1.0, -0.5, -2.0]]
    world, robots = pioneers(poses)
    simulation = Simulation(world, control_period=PERIOD)
    np.testing.assert_allclose(simulation.truth.poses(robots), poses, atol=1e-12)
    height = simulation.data.qpos[2]
    assert -1e-3 < height < -1e-5
    seen, twists, _ = drive(simulation, robots, np.zeros((20, 2)))
    assert np.abs(seen - seen[0]).max() < 1e-6
    assert np.abs(twists).max() < 1e-5
    assert simulation.data.qpos[2] == pytest.approx(height, abs=1e-6)


@pytest.mark.parametrize("dt_max", TIMESTEPS)
def test_five_metres_straight(dt_max):
    poses, twists, _ = run(profile(0.5, 0.0, 100), dt_max, (-3.0, 0.0, 0.0))
    assert poses[-1, 0] - poses[0, 0] == pytest.approx(5.0, rel=0.003)
    assert np.abs(poses[:, 1]).max() < 1e-3
    assert np.abs(np.degrees(poses[:, 2])).max() < 0.01
    assert twists[50, 0] == pytest.approx(0.5, rel=0.003)
    assert np.abs(twists[-1]).max() < 1e-3


@pytest.mark.parametrize("dt_max", TIMESTEPS)
def test_a_full_turn_in_place(dt_max):
    """63 periods of 0.1 s at 0.9973 rad/s: 360 degrees."""
    poses, _, _ = run(profile(0.0, 2 * np.pi / 6.3, 63), dt_max)
    turned = np.unwrap(poses[:, 2])[-1]
    assert turned == pytest.approx(2 * np.pi, rel=0.003)
    assert np.hypot(*poses[-1, :2]) < 1e-3


@pytest.mark.parametrize("dt_max", TIMESTEPS)
def test_a_circle_of_one_metre_closes(dt_max):
    """157 periods of 0.1 s at 0.4002 m/s and rad/s, on the arc in the ramps too."""
    rate = 2 * np.pi / 15.7
    poses, _, _ = run(profile(rate, rate, 157), dt_max)
    assert np.unwrap(poses[:, 2])[-1] == pytest.approx(2 * np.pi, rel=0.003)
    assert np.hypot(*poses[-1, :2]) < 0.003 * 2 * np.pi
    from_centre = np.hypot(poses[:, 0], poses[:, 1] - 1.0)
    # friction creeps: the circle lies up to 4 mm further out on one side
    np.testing.assert_allclose(from_centre, 1.0, atol=0.005)


@pytest.mark.parametrize("dt_max", TIMESTEPS)
def test_top_speed_and_an_emergency_stop_from_it(dt_max):
    """1.6 m/s after 1.6 s; "dead" brakes at 3.5 m/s^2."""
    world, robots = pioneers([[-4.0, 0.0, 0.0]])
    robots.faults.add(Fault(kind="dead", robot=0, start=3.0))
    simulation = Simulation(world, control_period=PERIOD, dt_max=dt_max)
    poses, twists, tilt = drive(simulation, robots, np.full((40, 2), [1.6, 0.0]))
    assert twists[10, 0, 0] == pytest.approx(1.0, rel=0.01)
    assert twists[30, 0, 0] == pytest.approx(1.6, rel=0.003)
    assert np.abs(twists[-1]).max() < 0.01
    assert tilt < 3.0
    # v^2 / 2 a = 0.366 m
    assert poses[-1, 0, 0] - poses[30, 0, 0] == pytest.approx(0.366, rel=0.05)


def test_a_reversal_as_hard_as_the_motors_can_does_not_tip_it():
    commands = np.concatenate([np.full((30, 2), [1.0, 0.0]), np.full((20, 2), [-1.0, 0.0])])
    _, twists, tilt = run(commands, acceleration=50.0)
    assert twists[-1, 0] == pytest.approx(-1.0, rel=0.01)
    # the nose comes down on the skid, 4 mm at 180 mm, and no further
    assert 0.5 < tilt < 3.0


def test_without_skid_and_weight_behind_the_axle_it_pitches_over():
    def top_heavy(spec):
        spec.body("pioneer2dx0/base").ipos = [-0.003, 0.0, 0.12]
        spec.delete(spec.geom("pioneer2dx0/skid"))

    world, robots = pioneers([[0.0, 0.0, 0.0]], Pioneer2DX(acceleration=50.0))
    world.edit(top_heavy)
    simulation = Simulation(world, control_period=PERIOD)
    commands = np.concatenate([np.full((30, 2), [1.0, 0.0]), np.full((20, 2), [-1.0, 0.0])])
    # on the edge of its hull: 50 mm over 220 mm are 13 degrees
    assert drive(simulation, robots, commands)[2] > 10.0


def test_the_motors_torque_bounds_what_it_pushes():
    """Against a wall: two wheels of 2 Nm at 97.5 mm push 41 N at the most, whatever is asked."""
    world, robots = pioneers([[7.6, 0.0, 0.0]])
    simulation = Simulation(world, control_period=PERIOD)
    pushes = []

    def look():
        force = np.zeros(6)
        total = 0.0
        for k, pair in enumerate(simulation.data.contact.geom):
            if "wall_east" in {simulation.model.geom(g).name for g in pair}:
                mujoco.mj_contactForce(simulation.model, simulation.data, k, force)
                total += force[0]
        pushes.append(total)

    simulation.observe(look)
    drive(simulation, robots, np.full((30, 2), [1.0, 0.0]))
    assert 0.8 * 41.0 < np.mean(pushes[-10:]) < 1.05 * 41.0


def test_only_contact_moves_it():
    def ice(spec):
        for geom in spec.geoms:
            if "tread" in geom.name:
                geom.friction[0] = 1e-5

    world, robots = pioneers([[0.0, 0.0, 0.0]])
    world.edit(ice)
    simulation = Simulation(world, control_period=PERIOD)
    poses, _, _ = drive(simulation, robots, np.full((20, 2), [0.5, 0.0]))
    assert np.abs(poses[:, 0, :2]).max() < 5e-3
    assert simulation.wheel_angles_of(robots).min() > 5.0


def test_both_simulations_agree():
    commands = profile(0.6, 0.5, 60)
    ends = []
    for kind in BOTH:
        world, robots = pioneers([[0.0, -1.0, 0.4]])
        simulation = kind(world, control_period=PERIOD)
        poses, _, _ = drive(simulation, robots, commands)
        ends.append((poses[-1, 0], simulation.wheel_angles_of(robots)[0]))
    np.testing.assert_allclose(ends[0][0], ends[1][0], atol=0.01)
    np.testing.assert_allclose(ends[0][1], ends[1][1], rtol=0.001)


@pytest.mark.parametrize("kind", BOTH)
def test_odometry_closes_a_square(kind):
    """2 m square from encoders alone: within 5 mm and 0.3 degrees of the truth, 8 m driven."""
    side = profile(0.4, 0.0, 50)
    corner = profile(0.0, np.pi / 2 / 2.0, 20)
    commands = np.concatenate([side, corner] * 4)
    world, robots = pioneers([[-1.0, -1.0, 0.0]])
    simulation = kind(world, control_period=PERIOD)
    encoders = robots.encoders
    odometry = Odometry(
        robots.start,
        radius=Pioneer2DX.rolling_radius,
        track=Pioneer2DX.track,
        counts_per_turn=encoders.counts_per_turn,
    )
    truth = []
    simulation.observe(lambda: truth.append(simulation.truth.poses(robots)[0]))
    # a count of each wheel, and what wheels slip in ramps
    far, askew = (0.005, 0.3) if kind is Simulation else (2e-4, 0.02)
    for k, _ in enumerate(simulation.ticks(len(commands) * PERIOD)):
        robots.drive([commands[k]])
        error = odometry.step(encoders.read())[0] - truth[-1]
        assert np.hypot(*error[:2]) < far
        assert abs(np.degrees((error[2] + np.pi) % (2 * np.pi) - np.pi)) < askew
    assert np.hypot(*(truth[-1][:2] - [-1.0, -1.0])) < 0.024
    assert max(p[0] for p in truth) > 0.99


def test_encoders_count_in_whole_steps():
    world, robots = pioneers([[0.0, 0.0, 0.0]])
    robots.mount(WheelEncoders(rate=10.0, counts_per_turn=100.0), "encoders")
    simulation = KinematicSimulation(world, control_period=PERIOD)
    counts = []
    for _ in simulation.ticks(4.0):
        robots.drive([[-0.2, 0.0]])
        counts.append(robots.encoders.read()[0])
    assert counts[0].dtype == np.int64
    np.testing.assert_array_equal(counts[0], [0, 0])
    # after the ramp of 0.2 s: -0.2 m/s x 3.7 s, wheels of 0.6117 m around
    way = -0.2 * (0.1 + 3.7)
    assert counts[-1][0] == counts[-1][1] == np.floor(way / (2 * np.pi * 0.09735) * 100)
    with pytest.raises(InvalidInputError, match="counts_per_turn"):
        WheelEncoders(counts_per_turn=0.0)


def test_a_robot_without_counters_refuses_encoders():
    world = World(bounds=[-2, -2, 2, 2])
    robots = world.add_group(SoccerBot, [[0.0, 0.0, 0.0]])
    robots.mount(WheelEncoders())
    with pytest.raises(InvalidInputError, match="soccer_bot has no wheels"):
        Simulation(world)


@pytest.mark.parametrize("kind", BOTH)
def test_same_bits_and_a_snapshot_goes_on(kind):
    def build():
        world, robots = pioneers([[-2.0, 0.5, 0.3], [-1.2, 0.5, -2.0]])
        return kind(world, seed=3, control_period=PERIOD), robots

    def go(simulation, robots, offset):
        angle = 0.3 * (np.arange(15) + offset)
        commands = np.column_stack([np.cos(angle), np.sin(2 * angle)])
        poses = drive(simulation, robots, commands)[0]
        return poses, robots.encoders.read().copy()

    simulation, robots = build()
    first, _ = go(simulation, robots, 0)
    snapshot = simulation.snapshot()
    once, counted = go(simulation, robots, 15)
    simulation.restore(snapshot)
    again, recounted = go(simulation, robots, 15)
    np.random.seed(7)  # noqa: NPY002 - nothing may depend on the global state
    fresh, others = build()
    assert go(fresh, others, 0)[0].tobytes() == first.tobytes()
    assert once.tobytes() == again.tobytes()
    assert counted.tobytes() == recounted.tobytes()
    assert counted.any()


def test_bad_commands_are_refused_and_large_ones_clamped():
    world, robots = pioneers([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    KinematicSimulation(world, control_period=PERIOD)
    with pytest.raises(InvalidInputError, match=r"\(2, 2\) \(forward, turn\)"):
        robots.drive(np.zeros((2, 3)))
    with pytest.raises(InvalidInputError, match="pioneer2dx1"):
        robots.drive([[0.0, 0.0], [np.nan, 0.0]])
    robots.drive([[2.0, 0.0], [1.6, -5.0]])
    np.testing.assert_allclose(robots.command, [[1.6, 0.0], [1.6, -5.0]])
    robots.drive([[0.5, 9.0], [-3.0, -9.0]])
    np.testing.assert_allclose(robots.command, [[0.5, 5.24], [-1.6, -5.24]])
    np.testing.assert_array_equal(robots.clamped, [2, 1])
    with pytest.raises(InvalidInputError, match="accelerations of Pioneer2DX"):
        Pioneer2DX(acceleration=0.0)


def test_an_emergency_stop_keeps_the_curvature():
    platform = Pioneer2DX()
    command = np.array([[1.0, 0.5], [-0.5, 2.0], [0.0, 0.0]])
    slower = platform.brake(command, 0.1)
    np.testing.assert_allclose(slower[:2, 1] / slower[:2, 0], command[:2, 1] / command[:2, 0])
    rim = np.abs(command) @ [1.0, platform.track / 2]
    np.testing.assert_allclose((np.abs(slower) @ [1.0, platform.track / 2])[:2], rim[:2] - 0.35)
    assert not platform.brake(slower, 10.0).any()


@pytest.mark.parametrize("reverse", [False, True])
def test_nobody_tips_in_a_crowd(reverse):
    """20 robots, 10 s among boxes, driving forward or reversing as hard as their motors can."""
    rng = np.random.default_rng(5)
    grid = np.stack(np.meshgrid(np.arange(5), np.arange(5)), axis=-1).reshape(-1, 2) * 1.2 - 2.4
    world = World(bounds=[-3.2, -3.2, 3.2, 3.2], wall_height=0.5)
    for x, y in grid[20:]:
        world.add_box(x, y, 0.4, 0.4, height=0.4, yaw=0.4)
    robots = world.add_group(
        Pioneer2DX(acceleration=50.0, turn_acceleration=150.0),
        np.column_stack([grid[:20], rng.uniform(-np.pi, np.pi, 20)]),
    )
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
    turns = rng.uniform(-1.0, 1.0, (100, 20)).repeat(10, axis=0)[:100]
    sign = np.where(reverse & (np.arange(100) // 25 % 2 == 1), -1.0, 1.0)
    commands = np.stack([np.repeat(0.4 * sign[:, None], 20, axis=1), turns], axis=-1)
    _, _, tilt = drive(simulation, robots, commands)
    assert tilt < 5.0
