"""The Koala: a free body on six wheels, geared in threes, that scrub when it turns."""

import re

import mujoco
import numpy as np
import pytest
from scipy.stats import qmc

from controllers.estimation.odometry import Odometry
from mjmr.assets import asset_folder, model_path
from mjmr.errors import InvalidInputError
from mjmr.kinematics import KinematicSimulation
from mjmr.robots.koala import Koala
from mjmr.robots.platform import FramedDrive
from mjmr.robots.skid_steer import SkidSteerDrive
from mjmr.simulation import Simulation
from mjmr.world import World
from tests.mjmr.bases import drive, profile
from tests.mjmr.worlds import BOTH

PERIOD = 0.1
TIMESTEPS = (0.005, 0.002)
SIDES = ("left", "right")
WHEELS = [f"{side}{place}" for side in SIDES for place in ("_front", "", "_rear")]


def koalas(poses=((0.0, 0.0, 0.0),), platform=Koala):
    """A large hall; returns (world, robots)."""
    world = World(bounds=[-8, -8, 8, 8], wall_height=0.5)
    return world, world.add_group(platform, poses)


def tyres(world, friction):
    """Give the tyres ``friction``, one number or one a wheel."""

    def change(spec):
        for name, value in zip(WHEELS, np.broadcast_to(friction, 6), strict=True):
            spec.geom(f"koala0/tread_{name}").friction[0] = value

    world.edit(change)


def loads(simulation):
    """Normal forces of koala0's six wheels on the floor [N]."""
    treads = [simulation.model.geom(f"koala0/tread_{name}").id for name in WHEELS]
    found, force = np.zeros(6), np.zeros(6)
    for k, pair in enumerate(simulation.data.contact.geom):
        if pair[1] in treads:
            mujoco.mj_contactForce(simulation.model, simulation.data, k, force)
            found[treads.index(pair[1])] += force[0]
    return found


def odometry(robots):
    return Odometry(
        robots.start,
        radius=Koala.rolling_radius,
        track=Koala.effective_track,
        counts_per_turn=robots.encoders.counts_per_turn,
    )


def dead_reckon(commands, kind=Simulation, friction=None, dt_max=0.005):
    """Drive ``commands`` (k, 2); true and estimated poses (k, 3), yaws unwrapped."""
    world, robots = koalas()
    if friction is not None:
        tyres(world, friction)
    simulation = kind(world, control_period=PERIOD, dt_max=dt_max)
    estimate, truth, believed = odometry(robots), [], []
    simulation.observe(lambda: truth.append(simulation.truth.poses(robots)[0]))
    for k, _ in enumerate(simulation.ticks(len(commands) * PERIOD)):
        robots.drive([commands[k]])
        believed.append(estimate.step(robots.encoders.read())[0])
    poses, believed = np.array(truth[: len(believed)]), np.array(believed)
    poses[:, 2], believed[:, 2] = np.unwrap(poses[:, 2]), np.unwrap(believed[:, 2])
    return poses, believed


def turns(rate):
    """Commands for five turns in place at about ``rate`` [rad/s]."""
    periods = round(10 * np.pi / rate / PERIOD)
    return profile(0.0, 10 * np.pi / periods / PERIOD, periods)


def test_the_compiled_model_has_the_stated_numbers():
    model = mujoco.MjModel.from_xml_path(str(model_path("koala")))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("home").id)
    mujoco.mj_forward(model, data)
    assert model.body_subtreemass[model.body("base").id] == pytest.approx(4.0)
    assert model.nu == 2
    hubs = np.array([data.body(f"wheel_{name}").xpos for name in WHEELS])
    np.testing.assert_allclose(hubs[:, 0], [0.09, 0.0, -0.09] * 2)
    np.testing.assert_allclose(hubs[:3, 1] - hubs[3:, 1], Koala.track)
    tower = model.geom("tower")
    assert tower.pos[2] + tower.size[2] == pytest.approx(Koala.height)
    world, robots = koalas()
    simulation = Simulation(world)
    bound = Koala().bind(simulation.model, ["koala0/"])
    assert isinstance(bound, SkidSteerDrive)
    assert isinstance(bound, FramedDrive)
    assert robots.encoders.counts_per_turn == 23400
    # 11.1 um a count, and a quarter turn of 25.1 cm along the rims
    assert 2e6 * np.pi * Koala.rolling_radius / 23400 == pytest.approx(11.1, rel=0.005)
    assert Koala.effective_track == pytest.approx(1.12 * Koala.track, rel=0.005)
    # README and model say the same
    text = (asset_folder() / "koala" / "README.md").read_text()
    stated = {"mass": 4, "rolling radius": 1e3 * Koala.rolling_radius, "track": 285,
              "effective track": 1e3 * Koala.effective_track}  # fmt: skip
    for name, value in stated.items():
        row = re.search(rf"^\| {name} \| ([\d.]+)", text, re.MULTILINE)
        assert row is not None
        assert float(row[1]) == pytest.approx(value)


def test_rangers_look_along_the_real_bearings():
    model = mujoco.MjModel.from_xml_path(str(model_path("koala")))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    right = [-5.73, -11.46, -17.19, -45.84, -90.0, -90.0, -138.84, 180.0]
    # the maker's left rear one is turned a little less
    left = [180.0, 134.78, 90.0, 90.0, 45.84, 17.19, 11.46, 5.73]
    for k, bearing in enumerate(right + left):
        site = data.site(f"ir{k}")
        axis = site.xmat.reshape(3, 3)[:, 0]
        off = np.degrees(np.arctan2(axis[1], axis[0])) - bearing
        assert abs((off + 180) % 360 - 180) < 0.01
        assert axis[:2] @ site.xpos[:2] > 0.1
        assert site.xpos[2] == pytest.approx(0.107 if k in (7, 8) else 0.102)


@pytest.mark.parametrize("start", range(5))
def test_it_survives_halton_noise_without_a_warning(start):
    """1 s of quasi-random control on all motors, beside a wall, boxes and each other."""
    rng = np.random.default_rng(start)
    poses = np.array([[-7.78, 0.0, 0.0], [0.0, 0.0, 0.0], [0.45, 0.05, 0.0], [3.0, 3.0, 0.0]])
    poses[:, 2] = rng.uniform(-np.pi, np.pi, 4)
    world, _ = koalas(poses)
    world.add_box(0.9, 0.1, 0.4, 0.4, mass=5.0)
    world.add_box(-0.45, 0.0, 0.4, 0.4)
    simulation = Simulation(world)
    model, data = simulation.model, simulation.data
    for row in qmc.Halton(model.nu, rng=rng).random(round(1.0 / model.opt.timestep)):
        # set points reach 5 rad/s within some 20 steps
        data.ctrl[:] = 1000.0 * (row - 0.5)
        mujoco.mj_step(model, data)
    assert data.warning.number.sum() == 0
    assert np.isfinite(data.qpos).all()
    bases = [model.body(f"koala{i}/base").id for i in range(4)]
    assert data.xmat[bases, 8].min() > np.cos(np.radians(10.0))
    assert np.abs(data.qvel).max() > 0.5


def test_it_starts_at_rest_and_stands_still():
    poses = [[1.0, 0.5, 0.3], [-1.0, -0.5, -2.0]]
    world, robots = koalas(poses)
    simulation = Simulation(world, control_period=PERIOD)
    height = simulation.data.qpos[2]
    assert -2e-3 < height < -1e-3
    seen, twists, _ = drive(simulation, robots, np.zeros((20, 2)))
    assert np.abs(seen - poses).max() < 1e-6
    assert np.abs(twists).max() < 1e-5
    assert simulation.data.qpos[2] == pytest.approx(height, abs=1e-6)


@pytest.mark.parametrize("seed", range(3))
def test_five_metres_straight_on_uneven_tyres(seed):
    world, robots = koalas([[-3.0, 0.0, 0.0]])
    tyres(world, 0.8 * np.random.default_rng(seed).uniform(0.9, 1.1, 6))
    simulation = Simulation(world, control_period=PERIOD)
    poses, twists, _ = drive(simulation, robots, profile(0.5, 0.0, 100))
    assert poses[-1, 0, 0] - poses[0, 0, 0] == pytest.approx(5.0, rel=0.003)
    assert np.abs(poses[:, 0, 1]).max() < 0.005
    assert twists[50, 0, 0] == pytest.approx(0.5, rel=0.003)


def test_turning_scrubs_as_the_real_one_at_every_speed_and_timestep():
    """Encoder turn over true turn; 1.12 on the real robot. No wheel lifts."""
    ratios = np.zeros((len(TIMESTEPS), 4))
    for i, dt_max in enumerate(TIMESTEPS):
        for k, rate in enumerate((0.3, 0.8, 1.0, 2.0)):
            world, robots = koalas()
            simulation = Simulation(world, control_period=PERIOD, dt_max=dt_max)
            least, turned = [], []
            simulation.observe(lambda s=simulation, n=least: n.append(loads(s).min()))
            simulation.observe(
                lambda s=simulation, r=robots, t=turned: t.append(s.wheel_angles_of(r)[0])
            )
            poses, twists, _ = drive(simulation, robots, np.full((60, 2), [0.0, rate]))
            way = np.diff(np.diff(np.array(turned)[[20, -1]], axis=0)[0])[0]
            true = np.diff(np.unwrap(poses[:, 0, 2])[[20, -1]])[0]
            ratios[i, k] = way * Koala.rolling_radius / Koala.track / true
            assert min(least) > 2.0
            assert twists[-1, 0, 2] == pytest.approx(rate, rel=0.02)
    assert (np.abs(ratios - 1.12) < 0.025).all()
    assert np.abs(ratios[0] - ratios[1]).max() < 0.005


@pytest.mark.parametrize(
    ("rate", "friction", "most"),
    [(0.8, None, 15.0), (0.4, None, 40.0), (2.0, None, 40.0), (0.8, 0.5, 40.0), (2.0, 1.1, 40.0)],
)
def test_odometry_keeps_its_heading_over_five_turns(rate, friction, most):
    """Degrees of 1800, with the track fitted at 1 rad/s and a friction of 0.8."""
    poses, believed = dead_reckon(turns(rate), friction=friction)
    assert poses[-1, 2] > 9.5 * np.pi
    assert abs(np.degrees(believed[-1, 2] - poses[-1, 2])) < most


@pytest.mark.parametrize("kind", BOTH)
def test_odometry_closes_a_square(kind):
    """2 m square from encoders alone: 10 mm where 50 are allowed; 8 m driven, four corners."""
    side, corner = profile(0.4, 0.0, 50), profile(0.0, np.pi / 2 / 1.6, 16)
    poses, believed = dead_reckon(np.concatenate([side, corner] * 4), kind)
    error = np.hypot(*(believed - poses)[:, :2].T)
    assert error.max() < (0.010 if kind is Simulation else 2e-4)
    assert poses[:, 0].max() > 1.99
    assert np.hypot(*poses[-1, :2]) < 0.02


def test_a_side_that_is_held_does_not_wind_up():
    """Against a wall for 4 s; it leaves as soon as it is told to."""
    world, robots = koalas([[7.7, 0.0, 0.0]])
    simulation = Simulation(world, control_period=PERIOD)
    commands = np.concatenate([np.full((40, 2), [0.4, 0.0]), np.full((10, 2), [-0.4, 0.0])])
    poses, twists, tilt = drive(simulation, robots, commands)
    assert poses[40, 0, 0] < 8.0 - 0.15
    assert np.abs(twists[40]).max() < 0.02
    # up to speed 0.4 s after the ramp of 0.8 s began at +0.4 m/s
    assert twists[-1, 0, 0] == pytest.approx(-0.4, abs=0.01)
    assert tilt < 3.0


def test_it_creeps_on_a_slope():
    """A trap of soft contacts: 0.8 % slower up 0.2 rad, and 2.4 mm/s down it at rest."""
    slope = 0.2

    def tilt(spec):
        spec.option.gravity = [-9.81 * np.sin(slope), 0.0, -9.81 * np.cos(slope)]

    found = []
    for speed in (0.3, 0.0):
        world, robots = koalas()
        world.edit(tilt)
        simulation = Simulation(world, control_period=PERIOD)
        found.append(drive(simulation, robots, np.full((30, 2), [speed, 0.0]))[1][-1, 0, 0])
    assert 0.98 * 0.3 < found[0] < 0.3
    assert -0.005 < found[1] < -0.001


def test_both_simulations_agree():
    commands = profile(0.3, 0.5, 60)
    ends = []
    for kind in BOTH:
        world, robots = koalas([[0.0, -1.0, 0.4]])
        simulation = kind(world, control_period=PERIOD)
        poses, _, _ = drive(simulation, robots, commands)
        ends.append((poses[-1, 0], simulation.wheel_angles_of(robots)[0]))
    np.testing.assert_allclose(ends[0][0], ends[1][0], atol=0.02)
    np.testing.assert_allclose(ends[0][1], ends[1][1], rtol=0.002)


@pytest.mark.parametrize("period", [0.1, 1 / 60])
def test_same_bits_and_a_snapshot_goes_on(period):
    """At a control period that is a multiple of the motors' frame and at one that is not."""

    def build():
        world, robots = koalas([[-2.0, 0.5, 0.3], [-1.2, 0.5, -2.0]])
        return Simulation(world, seed=3, control_period=period), robots

    def go(simulation, robots, offset):
        angle = 0.3 * (np.arange(15) + offset)
        commands = np.column_stack([0.4 * np.cos(angle), np.sin(2 * angle)])
        poses = drive(simulation, robots, commands)[0]
        return poses, robots.encoders.read().copy()

    simulation, robots = build()
    first, _ = go(simulation, robots, 0)
    snapshot = simulation.snapshot()
    once, counted = go(simulation, robots, 15)
    simulation.restore(snapshot)
    again, recounted = go(simulation, robots, 15)
    fresh, others = build()
    assert go(fresh, others, 0)[0].tobytes() == first.tobytes()
    assert once.tobytes() == again.tobytes()
    assert counted.tobytes() == recounted.tobytes()
    assert counted.any()


def test_commands_beyond_a_sides_speed_keep_their_curvature():
    world, robots = koalas([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    KinematicSimulation(world, control_period=PERIOD)
    robots.drive([[0.6, 2.0], [0.3, -1.0]])
    forward, turn = robots.command[0]
    assert turn / forward == pytest.approx(2.0 / 0.6)
    assert forward + turn * Koala.effective_track / 2 == pytest.approx(0.6)
    np.testing.assert_array_equal(robots.command[1], [0.3, -1.0])
    np.testing.assert_array_equal(robots.clamped, [1, 0])
    with pytest.raises(InvalidInputError, match=r"\(2, 2\) \(forward, turn\)"):
        robots.drive(np.zeros((2, 3)))
    with pytest.raises(InvalidInputError, match="koala1"):
        robots.drive([[0.0, 0.0], [np.nan, 0.0]])
    with pytest.raises(InvalidInputError, match="accelerations of Koala"):
        Koala(turn_acceleration=-1.0)


def test_nobody_climbs_in_a_crowd():
    """20 robots, 5 s among boxes as hard as their motors can; without the bay one tips in 2 s."""
    rng = np.random.default_rng(5)
    grid = np.stack(np.meshgrid(np.arange(5), np.arange(5)), axis=-1).reshape(-1, 2) * 0.75 - 1.5
    world = World(bounds=[-2, -2, 2, 2], wall_height=0.5)
    for x, y in grid[20:]:
        world.add_box(x, y, 0.3, 0.3, height=0.4, yaw=0.4)
    robots = world.add_group(
        Koala(acceleration=50.0, turn_acceleration=150.0),
        np.column_stack([grid[:20], rng.uniform(-np.pi, np.pi, 20)]),
    )
    simulation = Simulation(world, control_period=PERIOD)
    rates = rng.uniform(-1.0, 1.0, (5, 20)).repeat(10, axis=0)
    commands = np.stack([np.full((50, 20), 0.4), rates], axis=-1)
    assert drive(simulation, robots, commands)[2] < 4.0
