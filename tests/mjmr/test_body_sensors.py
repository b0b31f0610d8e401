"""Compass, IMU, bumper and force-torque sensor against statistics and statics."""

import subprocess
import sys

import mujoco
import numpy as np
import pytest

from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.geometry import angle_difference
from mjmr.kinematics import KinematicSimulation
from mjmr.robots.pioneer2dx import Pioneer2DX
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.sensors.bumper import Bumper
from mjmr.sensors.compass import Compass
from mjmr.sensors.force_torque import ForceTorque
from mjmr.sensors.imu import IMU
from mjmr.simulation import Simulation
from mjmr.world import World
from tests.mjmr.worlds import BOTH

G = 9.81
SENSORS = {"compass": Compass, "imu": IMU, "bumper": Bumper, "force_torque": ForceTorque}


def pioneers(poses, **options):
    world = World(bounds=[-8, -8, 8, 8], wall_height=0.5, **options)
    return world, world.add_group(Pioneer2DX, poses)


def readings(simulation, robots, name, seconds, command=(0.0, 0.0)):
    """Every reading of a sensor whose rate is that of the ticks."""
    found = []
    for _ in simulation.ticks(seconds):
        found.append(getattr(robots, name).read().copy())
        robots.drive(np.broadcast_to(command, (robots.n, 2)))
    return np.array(found)


# compass


@pytest.mark.parametrize("kind", BOTH)
def test_an_exact_compass_reads_the_heading_of_a_turning_robot(kind):
    world, robots = pioneers([[0.0, 0.0, 3.0], [2.0, 0.0, -1.0]])
    robots.mount(Compass(rate=10.0))
    simulation = kind(world, control_period=0.1)
    poses = []
    simulation.observe(lambda: poses.append(simulation.truth.poses(robots)))
    found = readings(simulation, robots, "compass", 3.0, (0.0, 0.5))
    np.testing.assert_allclose(found, np.array(poses)[:-1, :, 2], atol=1e-12)
    assert found.shape == (30, 2)
    assert np.abs(found).max() <= np.pi
    assert (np.diff(found[:, 0]) < -6.0).sum() == 1, "it passes pi"


def test_noise_and_biases_of_the_compass_have_the_stated_size():
    yaws = np.linspace(-3.1, 3.1, 400)
    world = World(bounds=[-80, -8, 80, 8])
    robots = world.add_group(
        SoccerBot, np.column_stack([np.linspace(-70, 70, 400), np.zeros(400), yaws])
    )
    robots.mount(Compass(rate=10.0, noise=0.03, bias=0.1))
    simulation = KinematicSimulation(world, seed=5, control_period=0.1)
    found = np.array([robots.compass.read().copy() for _ in simulation.ticks(20.0)])
    errors = angle_difference(found, yaws)
    biases = errors.mean(axis=0)
    # 400 draws give a deviation within 7 % of the true one, at two sigmas
    assert biases.std() == pytest.approx(0.1, rel=0.08)
    assert abs(biases.mean()) < 0.1 * 3 / np.sqrt(400)
    noise = errors - biases
    assert noise.std() == pytest.approx(0.03, rel=0.01)
    assert abs((noise[1:] * noise[:-1]).mean()) / 0.03**2 < 0.02, "white in time"


def test_a_coarse_compass_reads_whole_steps():
    world, robots = pioneers([[0.0, 0.0, 0.0]])
    step = np.radians(10.0)
    robots.mount(Compass(rate=10.0, step=step))
    simulation = KinematicSimulation(world, control_period=0.1)
    found = readings(simulation, robots, "compass", 14.0, (0.0, 0.5))[:, 0]
    np.testing.assert_allclose(found / step, np.round(found / step), atol=1e-9)
    assert len(np.unique(np.round(found / step))) == 36, "10 degrees 36 times; -180 is 180"


# imu


@pytest.mark.parametrize("pose", [(0.0, 0.0, 0.0), (1.0, -2.0, 2.5)])
def test_at_rest_an_imu_feels_one_g_upwards(pose):
    world, robots = pioneers([pose])
    robots.mount(IMU(rate=10.0, position=(0.1, 0.05, 0.2)))
    simulation = Simulation(world, control_period=0.1)
    found = readings(simulation, robots, "imu", 2.0)[5:, 0]
    # the base rests 0.09 degrees nose down
    assert np.abs(found[:, :2]).max() < 0.02
    np.testing.assert_allclose(found[:, 2], G, atol=1e-3)
    assert np.abs(found[:, 3:]).max() < 1e-4


def test_in_free_fall_an_imu_feels_nothing():
    world, robots = pioneers([[0.0, 0.0, 0.0]])
    robots.mount(IMU(rate=100.0, position=(0.1, 0.05, 0.2)))
    simulation = Simulation(world, control_period=0.01)
    simulation.data.qpos[2] = 1.0
    found = readings(simulation, robots, "imu", 0.4)[1:, 0]
    assert np.abs(found[1:, :3]).max() < 1e-6
    assert simulation.data.qpos[2] == pytest.approx(1.0 - G * 0.4**2 / 2, abs=0.02)


def test_on_a_turning_robot_an_imu_feels_the_centripetal_acceleration():
    """Off the axis by r, at w, on a circle driven at v: (-w^2 x, v w - w^2 y) and w."""
    x, y, v, w = 0.15, -0.1, 0.4, 1.0
    world, robots = pioneers([[0.0, 0.0, 0.0]])
    robots.mount(IMU(rate=10.0, position=(x, y, 0.1)))
    simulation = Simulation(world, control_period=0.1)
    found = readings(simulation, robots, "imu", 6.0, (v, w))[20:, 0].mean(axis=0)
    pitch = -0.0016 * G  # at rest the base is nose down
    np.testing.assert_allclose(found[:2], [pitch - w**2 * x, v * w - w**2 * y], atol=0.02)
    assert found[2] == pytest.approx(G, abs=0.01)
    np.testing.assert_allclose(found[3:], [0.0, 0.0, w], atol=2e-3)


def test_speeding_up_shows_in_the_imu():
    world, robots = pioneers([[-3.0, 0.0, 0.0]])
    robots.mount(IMU(rate=10.0, position=(0.0, 0.0, 0.0975)))
    simulation = Simulation(world, control_period=0.1)
    found = readings(simulation, robots, "imu", 1.4, (1.5, 0.0))[3:, 0]
    assert found[:, 0].mean() == pytest.approx(1.0, abs=0.05), "the platform's 1 m/s^2"


def test_imu_noise_follows_its_density_and_biases_wander():
    poses = [[x, y, 0.0] for x in (-4, -2, 0, 2, 4) for y in (-4, -2, 0, 2, 4)]
    world, robots = pioneers(poses)
    robots.mount(
        IMU(
            rate=50.0,
            acceleration_noise=0.002,
            gyro_noise=0.001,
            acceleration_bias=0.05,
            gyro_bias=0.02,
            bias_time=0.4,
        )
    )
    exact = robots.mount(IMU(rate=50.0), "exact")
    simulation = Simulation(world, control_period=0.02, seed=1, dt_max=0.01)
    errors = []
    for _ in simulation.ticks(12.0):
        errors.append(robots.imu.read() - exact.read())
    errors = np.array(errors)
    spread = np.hypot(np.repeat([0.05, 0.02], 3), np.repeat([0.002, 0.001], 3) * 5.0)
    np.testing.assert_allclose(errors.std(axis=(0, 1)), spread, rtol=0.1)
    white = np.repeat([0.002, 0.001], 3) * 5.0  # sqrt(50 Hz / 2)
    lag = 20  # 0.4 s: 1/e is left, of the bias alone
    kept = (errors[lag:] * errors[:-lag]).mean(axis=(0, 1)) / (spread**2 - white**2)
    np.testing.assert_allclose(kept, np.exp(-1.0), atol=0.12)
    still, robots = pioneers(poses)
    robots.mount(IMU(rate=50.0, acceleration_noise=0.002, acceleration_bias=1.0))
    exact = robots.mount(IMU(rate=50.0), "exact")
    simulation = Simulation(still, control_period=0.02, seed=1, dt_max=0.01)
    errors = np.array([robots.imu.read() - exact.read() for _ in simulation.ticks(4.0)])
    np.testing.assert_allclose(errors[..., :3].std(axis=0), 0.01, rtol=0.25)
    assert not errors[..., 3:].any()
    assert errors[..., :3].mean(axis=0).std() == pytest.approx(1.0, rel=0.25)


# bumper


def pressed(yaw, sectors=8, wall=0.0, **options):
    """Switches closed after a robot at ``yaw`` was pushed against the wall at the bearing ``wall``.

    Both are in the world frame: 0 is the east wall, pi / 2 the north wall.
    """
    world = World(bounds=[-2, -2, 2, 2], wall_height=0.3)
    robots = world.add_group(SoccerBot, [[1.895 * np.cos(wall), 1.895 * np.sin(wall), yaw]])
    robots.mount(Bumper(sectors=sectors, rate=10.0, **options))
    simulation = Simulation(world, control_period=0.1)
    for t in simulation.ticks(0.6):
        speed = min(t, 0.3)
        robots.drive([[speed * np.cos(wall - yaw), speed * np.sin(wall - yaw), 0.0]])
    return robots.bumper.read()[0]


@pytest.mark.parametrize("wall", [0.0, np.pi / 2, np.pi])
@pytest.mark.parametrize("degrees", range(-170, 190, 40))
def test_the_sector_that_meets_the_wall_closes(degrees, wall):
    """A round robot touches the wall at the bearing ``wall - yaw`` of its body."""
    yaw = np.radians(degrees)
    found = np.flatnonzero(pressed(yaw, wall=wall))
    assert found.tolist() == [round((wall - yaw) / (np.pi / 4)) % 8]


def test_sectors_start_where_they_are_told():
    left, right = pressed(-0.1, sectors=2, start=0.0), pressed(0.1, sectors=2, start=0.0)
    assert left.tolist() == [True, False]
    assert right.tolist() == [False, True]


def test_a_switch_needs_its_force():
    """Pushing the wall takes the drive's force at most; twice as much closes nothing."""
    world = World(bounds=[-2, -2, 2, 2], wall_height=0.3)
    robots = world.add_group(SoccerBot, [[1.905, 0.0, 0.0]])
    thresholds = (0.1, 2.0, 10.0, 1000.0)
    for k, threshold in enumerate(thresholds):
        robots.mount(Bumper(threshold=threshold, rate=100.0, latch=False), f"b{k}")
    simulation = Simulation(world, control_period=0.01)
    east = simulation.model.geom("wall_east").id
    forces, found = [], []
    for _ in simulation.ticks(1.0):
        robots.drive([[0.2, 0.0, 0.0]])
        wrench, total = np.zeros(6), 0.0
        for k in range(simulation.data.ncon):
            if east in simulation.data.contact[k].geom:
                mujoco.mj_contactForce(simulation.model, simulation.data, k, wrench)
                total += wrench[0]
        forces.append(total)
        found.append([robots.sensors[f"b{k}"].read()[0, 0] for k in range(4)])
    np.testing.assert_array_equal(found, np.array(forces)[:, None] >= thresholds)
    assert 0 < np.sum(found, axis=0)[2] < len(forces)
    assert not np.any(found, axis=0)[3]


def test_a_short_bump_is_latched_until_the_next_sample_and_no_longer():
    """A ball bounces off between two samples; polling alone misses it."""
    world = World(bounds=[-2, -2, 2, 2])
    robots = world.add_group(SoccerBot, [[0.0, 0.0, 0.0]])
    world.add_golf_ball(0.35, 0.0)
    robots.mount(Bumper(rate=5.0))
    polled = robots.mount(Bumper(rate=5.0, latch=False), "polled")
    simulation = Simulation(world, control_period=0.2)
    simulation.data.qvel[simulation.model.joint("ball0").dofadr] = -2.0
    ball, wrench = simulation.model.geom("ball0").id, np.zeros(6)
    pushes, latched, seen = [], [], []

    def push():
        geoms = simulation.data.contact.geom
        hits = np.flatnonzero((geoms == ball).any(axis=1) & (geoms != 0).all(axis=1))
        for k in hits:
            mujoco.mj_contactForce(simulation.model, simulation.data, k, wrench)
            if wrench[0] >= 1.0:
                pushes.append(simulation.data.time - simulation.timestep)

    simulation.watch_steps(push)
    for _ in simulation.ticks(1.2):
        latched.append(robots.bumper.read()[0].tolist())
        seen.append(polled.read().any())
    assert simulation.model.geom(0).name == "floor"
    hit = [bool(np.any((np.array(pushes) // 0.2) == k - 1)) for k in range(6)]
    assert [flags[0] for flags in latched] == hit
    assert hit[:3] == [False, True, False]
    assert not any(any(flags[1:]) for flags in latched)
    assert not any(seen)


def test_a_snapshot_keeps_a_bump_that_was_not_yet_reported():
    def build():
        world = World(bounds=[-2, -2, 2, 2])
        robots = world.add_group(SoccerBot, [[0.0, 0.0, 0.0]])
        world.add_golf_ball(0.2, 0.0)
        robots.mount(Bumper(rate=5.0))
        return Simulation(world, control_period=0.1), robots.bumper

    simulation, bumper = build()
    simulation.data.qvel[simulation.model.joint("ball0").dofadr] = -2.0
    for _ in simulation.ticks(0.1):
        pass
    assert not bumper.read().any()
    snapshot = simulation.snapshot()
    other, again = build()
    other.restore(snapshot)
    for _ in other.ticks(0.1):
        pass
    assert again.read()[0].tolist() == [True] + [False] * 7


def test_both_robots_feel_a_push_and_neither_feels_the_floor_or_a_third():
    world, robots = pioneers([[-0.3, 0.0, 0.0], [0.3, 0.05, np.pi], [0.0, 3.0, 0.0]])
    others = world.add_group(SoccerBot, [[-0.7, 0.0, 0.0]])
    others.mount(Bumper())
    robots.mount(Bumper(sectors=4))
    simulation = Simulation(world, control_period=0.1)
    for _ in simulation.ticks(2.0):
        robots.drive([[0.3, 0.0], [0.3, 0.0], [0.0, 0.0]])
        others.drive([[0.5, 0.0, 0.0]])
    expected = [[True, False, True, False], [True, False, False, False], [False] * 4]
    np.testing.assert_array_equal(robots.bumper.read(), expected)
    np.testing.assert_array_equal(others.bumper.read()[0], [True] + [False] * 7)


def test_a_bumper_may_be_on_some_shapes_only():
    world, robots = pioneers([[0.0, 0.0, 0.0]])
    robots.mount(Bumper(geoms=["hull"]))
    robots.mount(Bumper(geoms="caster"), "other")
    world.add_box(0.5, 0.0, 0.4, 0.6)
    simulation = Simulation(world, control_period=0.1)
    for _ in simulation.ticks(1.5):
        robots.drive([[0.3, 0.0]])
    assert robots.bumper.read()[0].any()
    assert not robots.other.read().any()
    world, robots = pioneers([[0.0, 0.0, 0.0]])
    robots.mount(Bumper(geoms=["hul"]))
    with pytest.raises(UnknownNameError, match="'hul'; valid: hull"):
        Simulation(world)


# force and torque


class Laden(Pioneer2DX):
    """Carries 2 kg, welded on, whose centre is 0.1 m ahead of the place it stands on."""

    def model(self, number, team):
        spec = super().model(number, team)
        load = spec.body("base").add_body(name="load", pos=[-0.05, 0.02, 0.22])
        load.add_geom(
            type=mujoco.mjtGeom.mjGEOM_BOX,
            pos=[0.1, 0.0, 0.05],
            size=[0.05] * 3,
            mass=2.0,
            contype=0,
            conaffinity=0,
        )
        load.add_site(name="foot", group=3)
        return spec


def test_a_load_presses_with_its_weight_and_leans_with_its_lever():
    world = World(bounds=[-8, -8, 8, 8])
    robots = world.add_group(Laden, [[0.0, 0.0, 0.7], [2.0, 0.0, 0.0]])
    robots.mount(ForceTorque(site="foot", rate=10.0))
    robots.mount(ForceTorque(body="load", position=(0.1, 0.0, 0.0), rate=10.0), "below")
    simulation = Simulation(world, control_period=0.1)
    both = readings(simulation, robots, "force_torque", 2.0)[-1]
    lean = 2.0 * G * 0.005  # the base is a little nose down
    for row in both:
        np.testing.assert_allclose(row, [0, 0, -2 * G, 0, 2 * G * 0.1, 0], atol=lean)
        assert row[2] == pytest.approx(-2.0 * G, abs=1e-3)
    np.testing.assert_allclose(robots.below.read()[0], [0, 0, -2 * G, 0, 0, 0], atol=lean)


def test_a_load_that_is_sped_up_pushes_back():
    world = World(bounds=[-8, -8, 8, 8])
    robots = world.add_group(Laden, [[-3.0, 0.0, 0.0]])
    robots.mount(ForceTorque(site="foot", rate=10.0))
    simulation = Simulation(world, control_period=0.1)
    found = readings(simulation, robots, "force_torque", 1.4, (1.5, 0.0))[4:, 0]
    assert found[:, 0].mean() == pytest.approx(-2.0, abs=0.15), "2 kg at 1 m/s^2"


def test_force_errors_have_the_stated_size():
    world = World(bounds=[-8, -8, 8, 8])
    poses = [[x, y, 0.0] for x in range(-6, 7, 2) for y in range(-6, 7, 2)]
    robots = world.add_group(Laden, poses)
    options = {"force_noise": 0.3, "torque_noise": 0.02, "force_bias": 2.0, "torque_bias": 0.1}
    robots.mount(ForceTorque(site="foot", rate=50.0, **options))
    exact = robots.mount(ForceTorque(site="foot", rate=50.0), "exact")
    simulation = Simulation(world, control_period=0.02, dt_max=0.01)
    errors = np.array([robots.force_torque.read() - exact.read() for _ in simulation.ticks(2.0)])
    offsets = errors.mean(axis=0)
    np.testing.assert_allclose(offsets.std(axis=0), np.repeat([2.0, 0.1], 3), rtol=0.3)
    np.testing.assert_allclose((errors - offsets).std(axis=(0, 1)), np.repeat([0.3, 0.02], 3),
                               rtol=0.05)  # fmt: skip


# all of them


def everything(world_kind=Simulation, **schedule):
    """A robot that hits a wall, with every sensor noisy, 10 Hz and 0.1 s late unless told."""
    world = World(bounds=[-1, -1, 1, 1], wall_height=0.3)
    robots = world.add_group(Laden, [[0.2, 0.0, 0.0], [-0.4, 0.0, 2.0]])
    options = {"rate": 10.0, "latency": 0.1} | schedule
    robots.mount(Compass(noise=0.01, bias=0.02, **options))
    robots.mount(IMU(acceleration_noise=0.1, gyro_bias=0.1, bias_time=1.0, **options))
    robots.mount(ForceTorque(site="foot", force_noise=0.1, **options))
    robots.mount(Bumper(**options))
    return world_kind(world, seed=9, control_period=0.05), robots


def history(simulation, robots, seconds, stir=False):
    found = []
    for k, _ in enumerate(simulation.ticks(seconds)):
        if stir:
            np.random.seed(k)  # noqa: NPY002
        robots.drive([[0.8, 0.3], [0.6, -0.5]])
        for name in SENSORS:
            found.append(np.append(robots.sensors[name].read(), robots.sensors[name].sampled_at))
    return [row.tobytes() for row in found]


def test_a_slow_late_sensor_delivers_exactly_that():
    """10 Hz, 0.1 s late: nothing before 0.1 s, then the punctual one's reading of 0.1 s ago."""
    simulation, robots = everything()
    punctual, same = everything(latency=0.0)
    seen = {name: {} for name in SENSORS}
    for t in punctual.ticks(2.0):
        same.drive([[0.8, 0.3], [0.6, -0.5]])
        for name in SENSORS:
            seen[name][round(t, 6)] = same.sensors[name].read().copy()
    for t in simulation.ticks(2.0):
        robots.drive([[0.8, 0.3], [0.6, -0.5]])
        for name, sensor in ((name, robots.sensors[name]) for name in SENSORS):
            if t < 0.1 - 1e-9:
                np.testing.assert_array_equal(sensor.read(), sensor.nothing())
                assert np.isnan(sensor.sampled_at)
                continue
            taken = np.floor((t - 0.1) * 10 + 1e-6) / 10
            assert sensor.sampled_at == pytest.approx(taken, abs=1e-9)
            np.testing.assert_array_equal(sensor.read(), seen[name][round(taken, 6)])
    assert any(flags.any() for flags in seen["bumper"].values())


def test_same_bits_whoever_stirs_and_a_snapshot_goes_on():
    first = history(*everything(), 2.0)
    simulation, robots = everything()
    begin = history(simulation, robots, 0.83 // 0.05 * 0.05, stir=True)
    snapshot = simulation.snapshot()
    rest = history(simulation, robots, 2.0 - simulation.time, stir=True)
    assert begin + rest == first
    simulation.restore(snapshot)
    assert history(simulation, robots, 2.0 - simulation.time) == rest
    other, robots = everything()
    other.restore(snapshot)
    assert history(other, robots, 2.0 - other.time) == rest


@pytest.mark.parametrize("name", ["imu", "bumper", "force_torque"])
def test_what_feels_forces_is_refused_where_there_are_none(name):
    world, robots = pioneers([[0.0, 0.0, 0.0]])
    robots.mount(SENSORS[name]())
    with pytest.raises(InvalidInputError, match=f"'{name}' in a KinematicSimulation.*Simulation"):
        KinematicSimulation(world)


@pytest.mark.parametrize(
    ("kind", "options", "message"),
    [
        (Compass, {"noise": -0.1}, "noise must be 0 or more"),
        (Compass, {"bias": np.nan}, "bias must be"),
        (Compass, {"step": np.inf}, "step must be"),
        (Compass, {"rate": 0.0}, "rate must be positive"),
        (IMU, {"gyro_noise": -1.0}, "gyro_noise must be"),
        (IMU, {"bias_time": 0.0}, "bias_time must be positive"),
        (IMU, {"position": (0.0, 0.0)}, "three finite"),
        (IMU, {"position": (0.0, 0.0, np.nan)}, "three finite"),
        (IMU, {"site": "top", "body": "base"}, "name alone"),
        (ForceTorque, {"torque_bias": -1.0}, "torque_bias must be"),
        (ForceTorque, {"rate": -5.0}, "rate must be positive"),
        (Bumper, {"sectors": 0}, "1 sector or more"),
        (Bumper, {"sectors": 2.5}, "1 sector or more"),
        (Bumper, {"threshold": 0.0}, "threshold must be positive"),
        (Bumper, {"start": np.nan}, "start"),
    ],
)
def test_bad_options_are_one_sentence(kind, options, message):
    with pytest.raises(InvalidInputError, match=message):
        kind(**options)


def test_unknown_sites_and_bodies_list_those_there_are():
    for options, message in (
        ({"site": "tob"}, "unknown site of the robot's model 'tob'; valid: top"),
        ({"body": "bass"}, "unknown body of the robot 'bass'; valid: base"),
    ):
        world, robots = pioneers([[0.0, 0.0, 0.0]])
        robots.mount(IMU(**options))
        with pytest.raises(UnknownNameError, match=message):
            Simulation(world)


def test_sensors_are_loaded_without_mujoco():
    code = "import mjmr.sensors, mjmr.radio, sys; assert 'mujoco' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)
