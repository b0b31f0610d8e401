"""The four-wheeler: a free body on two geared wheels a side, all of which scrub when it turns."""

import re

import mujoco
import numpy as np
import pytest
from scipy.stats import qmc

from controllers.estimation.odometry import Odometry
from mjmr.assets import asset_folder, model_path
from mjmr.robots.four_wheeler import FourWheeler
from mjmr.robots.skid_steer import SkidSteerDrive
from mjmr.simulation import Simulation
from mjmr.world import World
from tests.mjmr.bases import drive, profile
from tests.mjmr.worlds import BOTH

PERIOD = 0.02
WHEELS = ("left", "left_rear", "right", "right_rear")


def rovers(poses=((0.0, 0.0, 0.0),)):
    world = World(bounds=[-8, -8, 8, 8], wall_height=0.5)
    return world, world.add_group(FourWheeler, poses)


def test_the_compiled_model_has_the_stated_numbers():
    model = mujoco.MjModel.from_xml_path(str(model_path("four_wheeler")))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("home").id)
    mujoco.mj_forward(model, data)
    assert model.body_subtreemass[model.body("base").id] == pytest.approx(10.0)
    assert model.nu == 2
    hubs = np.array([data.xpos[model.jnt_bodyid[model.joint(f"wheel_{w}").id]] for w in WHEELS])
    np.testing.assert_allclose(hubs[:, 0], [0.135, -0.135] * 2)
    np.testing.assert_allclose(hubs[:2, 1] - hubs[2:, 1], FourWheeler.track)
    sizes = np.array([model.geom(f"tread_{w}").size for w in WHEELS])
    np.testing.assert_allclose(sizes[:, [0, 2]], 0.11)
    np.testing.assert_allclose(
        [model.dof_armature[model.joint(f"wheel_{w}").dofadr[0]] for w in WHEELS], 0.05
    )
    # no two wheels overlap
    assert hubs[0, 0] - hubs[1, 0] > 2 * sizes[0, 0]
    assert hubs[0, 1] - hubs[2, 1] > 2 * sizes[0, 1]
    hull = model.geom("hull")
    assert hull.pos[2] + hull.size[2] == pytest.approx(FourWheeler.height)
    bay = model.geom("bay").size
    assert np.hypot(bay[0], bay[1]) <= FourWheeler.radius
    assert FourWheeler.effective_track == pytest.approx(1.6 * FourWheeler.track)
    world, _ = rovers()
    assert isinstance(
        FourWheeler().bind(Simulation(world).model, ["four_wheeler0/"]), SkidSteerDrive
    )
    text = (asset_folder() / "four_wheeler" / "README.md").read_text()
    stated = {"mass": 10, "rolling radius": 1e3 * FourWheeler.rolling_radius, "track": 400,
              "effective track": 1e3 * FourWheeler.effective_track}  # fmt: skip
    for name, value in stated.items():
        row = re.search(rf"^\| {name} \| ([\d.]+)", text, re.MULTILINE)
        assert row is not None
        assert float(row[1]) == pytest.approx(value)


@pytest.mark.parametrize("start", range(3))
def test_it_survives_halton_noise_without_a_warning(start):
    """1 s of quasi-random control on all motors, beside a wall, boxes and each other."""
    rng = np.random.default_rng(start)
    poses = np.array([[-7.64, 0.0, 0.0], [0.0, 0.0, 0.0], [0.75, 0.05, 0.0], [3.0, 3.0, 0.0]])
    poses[:, 2] = rng.uniform(-np.pi, np.pi, 4)
    world, _ = rovers(poses)
    world.add_box(1.4, 0.1, 0.4, 0.4, mass=5.0)
    world.add_box(-0.65, 0.0, 0.4, 0.4)
    simulation = Simulation(world)
    model, data = simulation.model, simulation.data
    for row in qmc.Halton(model.nu, rng=rng).random(round(1.0 / model.opt.timestep)):
        data.ctrl[:] = 400.0 * (row - 0.5)
        mujoco.mj_step(model, data)
    assert data.warning.number.sum() == 0
    assert np.isfinite(data.qpos).all()
    bases = [model.body(f"four_wheeler{i}/base").id for i in range(4)]
    assert data.xmat[bases, 8].min() > np.cos(np.radians(10.0))
    assert np.abs(data.qvel).max() > 0.5


def test_it_starts_at_rest_and_stands_still():
    poses = [[1.0, 0.5, 0.3], [-1.0, -0.5, -2.0]]
    world, robots = rovers(poses)
    simulation = Simulation(world, control_period=PERIOD)
    seen, twists, _ = drive(simulation, robots, np.zeros((50, 2)))
    assert np.abs(seen - poses).max() < 1e-6
    assert np.abs(twists).max() < 1e-5


def test_five_metres_straight():
    world, robots = rovers([[-3.0, 0.0, 0.0]])
    simulation = Simulation(world, control_period=PERIOD)
    poses, _, tilt = drive(simulation, robots, profile(0.5, 0.0, 500))
    # the profile's ramps take half a period each: 4.955 m
    assert poses[-1, 0, 0] - poses[0, 0, 0] == pytest.approx(4.955, rel=0.001)
    assert np.abs(poses[:, 0, 1]).max() < 0.001
    assert tilt < 0.5


def test_wheels_have_to_turn_the_stated_factor_further_at_every_rate_and_timestep():
    """Encoder turn over true turn; geometry without friction in turning would be 1.456."""
    ratios = np.zeros((2, 3))
    for i, dt_max in enumerate((0.005, 0.002)):
        for k, rate in enumerate((0.3, 0.6, 1.0)):
            world, robots = rovers()
            simulation = Simulation(world, control_period=PERIOD, dt_max=dt_max)
            turned = []
            simulation.observe(
                lambda s=simulation, r=robots, t=turned: t.append(s.wheel_angles_of(r)[0])
            )
            poses, twists, _ = drive(simulation, robots, np.full((200, 2), [0.0, rate]))
            way = np.diff(np.diff(np.array(turned)[[60, -1]], axis=0)[0])[0]
            true = np.diff(np.unwrap(poses[:, 0, 2])[[60, -1]])[0]
            ratios[i, k] = way * FourWheeler.rolling_radius / FourWheeler.track / true
            assert twists[-1, 0, 2] == pytest.approx(rate, rel=0.01)
            # no chatter
            assert twists[60:, 0, 2].std() < 0.002
    assert (np.abs(ratios - 1.6) < 0.02).all()
    assert np.abs(ratios[0] - ratios[1]).max() < 0.002


@pytest.mark.parametrize("kind", BOTH)
def test_odometry_closes_a_square(kind):
    """2 m square from encoders alone: 8 m driven, four corners."""
    side, corner = profile(0.4, 0.0, 250), profile(0.0, np.pi / 2 / 1.6, 80)
    commands = np.concatenate([side, corner] * 4)
    world, robots = rovers()
    simulation = kind(world, control_period=PERIOD)
    estimate = Odometry(
        robots.start, radius=FourWheeler.rolling_radius, track=FourWheeler.effective_track,
        counts_per_turn=robots.encoders.counts_per_turn,
    )  # fmt: skip
    truth, believed = [], []
    simulation.observe(lambda: truth.append(simulation.truth.poses(robots)[0]))
    for k, _ in enumerate(simulation.ticks(len(commands) * PERIOD)):
        robots.drive([commands[k]])
        believed.append(estimate.step(robots.encoders.read())[0])
    error = np.hypot(*(np.array(believed) - np.array(truth[: len(believed)]))[:, :2].T)
    assert error.max() < (0.05 if kind is Simulation else 2e-3)
    assert np.array(truth)[:, 0].max() > 1.9


def test_speed_and_turn_are_cut_each_by_itself():
    world, robots = rovers()
    Simulation(world, control_period=PERIOD)
    robots.drive([[1.5, -0.5]])
    np.testing.assert_allclose(robots.command, [[1.0, -0.5]])
    robots.drive([[0.2, -3.0]])
    np.testing.assert_allclose(robots.command, [[0.2, -2.0]])
    assert robots.clamped.tolist() == [2]
