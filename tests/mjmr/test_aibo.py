"""The AIBO ERS-7: 20 servoed joints on a free body."""

import re

import mujoco
import numpy as np
import pytest
from scipy.stats import qmc

from controllers.legged.leg import ERS7
from mjmr.assets import asset_folder, model_path
from mjmr.errors import InvalidInputError
from mjmr.kinematics import KinematicSimulation
from mjmr.robots.aibo_ers7 import FRAME, JOINTS, AiboERS7
from mjmr.robots.ik_check import legs_by_mink
from mjmr.robots.joint_servos import JointServos
from mjmr.simulation import Simulation
from mjmr.world import World

PERIOD = 0.04
FEET = tuple(f"paw{i}" for i in range(4))
LEG_JOINTS = tuple(joint.name for joint in JOINTS[:12])


def lone_model():
    return mujoco.MjModel.from_xml_path(str(model_path("aibo_ers7")))


def aibos(poses, platform=AiboERS7, friction=0.8, **options):
    world = World(bounds=[-2, -2, 2, 2], **options)

    def floor(spec):
        spec.geom("floor").friction[0] = friction

    world.edit(floor)
    return world, world.add_group(platform, poses)


def servos(simulation, group):
    drive = simulation._drives[id(group)]
    assert isinstance(drive, JointServos)
    return drive


class Nodder:
    """An engine of one command: how far the head nods; it sways with the time it remembers."""

    command_names = ("nod",)
    command_limits = np.array([[-0.2, 0.7]])

    def bind(self, n):
        engine = Nodder()
        engine.n, engine.frames, engine.seen = n, 0, []
        return engine

    def targets(self, command, proprioception):
        self.seen.append(proprioception)
        self.frames += 1
        wanted = np.tile(AiboERS7.home, (self.n, 1))
        wanted[:, 14] = command[:, 0]
        wanted[:, 13] = np.sin(0.1 * self.frames)
        return wanted

    def state(self):
        return self.frames

    def set_state(self, state):
        self.frames = state


def test_the_compiled_model_has_the_stated_numbers():
    model = lone_model()
    assert (model.nq, model.nv, model.nu) == (27, 26, 20)
    assert model.body_subtreemass[1] == pytest.approx(1.65)
    assert [model.actuator(i).name for i in range(20)] == [joint.name for joint in JOINTS]
    for k, joint in enumerate(JOINTS):
        hinge = model.joint(joint.name)
        limits = AiboERS7.joint_limits[k]
        np.testing.assert_allclose(hinge.range, limits, atol=1e-8)
        np.testing.assert_allclose(model.actuator_ctrlrange[k], limits, atol=1e-8)
        home = model.key("home")
        for value in (home.qpos[hinge.qposadr[0]], home.ctrl[k]):
            assert value == pytest.approx(AiboERS7.home[k], abs=1e-6)
        assert limits[0] <= AiboERS7.home[k] <= limits[1]
    np.testing.assert_allclose(model.actuator_forcerange[:15], [[-1.2, 1.2]] * 15)
    assert [model.geom(paw).size[0] for paw in FEET] == [0.013] * 4
    camera = model.camera("camera")
    width, height = model.cam_resolution[camera.id]
    focal = height / 2 / np.tan(np.radians(camera.fovy[0]) / 2)
    assert (width, height) == (208, 160)
    assert np.degrees(2 * np.arctan(width / 2 / focal)) == pytest.approx(56.9, abs=0.1)
    # README and model say the same
    text = (asset_folder() / "aibo_ers7" / "README.md").read_text()
    rows = {"mass": 1.65, "torque of legs, neck and head": 1.2, "frame": 1e3 * FRAME}
    for name, value in rows.items():
        row = re.search(rf"^\| {name} \| ([\d.]+)", text, re.MULTILINE)
        assert row is not None
        assert float(row[1]) == value


def test_it_fits_the_cylinder_it_claims():
    model = lone_model()
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("home").id)
    mujoco.mj_forward(model, data)
    shapes = np.flatnonzero(model.geom_contype)
    reach = []
    for geom in shapes:
        half = model.geom_size[geom, 1] * data.geom_xmat[geom].reshape(3, 3)[:, 2]
        for end in (data.geom_xpos[geom] + half, data.geom_xpos[geom] - half):
            reach.append(np.hypot(*end[:2]) + model.geom_size[geom, 0])
    assert 0.9 * AiboERS7.radius < max(reach) <= AiboERS7.radius
    skull = model.geom("skull")
    top = data.geom(skull.id).xpos[2] + skull.size[0]
    assert 0.9 * AiboERS7.height < top < AiboERS7.height


def test_signs_are_those_of_open_r():
    model = lone_model()
    data = mujoco.MjData(model)

    def moved(joint, what):
        """By how much a body's point is moved when a joint turns by 0.1 rad from zero."""
        places = []
        for angle in (0.0, 0.1):
            data.qpos[:] = [0, 0, 0, 1, 0, 0, 0] + [0] * 20
            data.qpos[model.joint(joint).qposadr[0]] = angle
            mujoco.mj_kinematics(model, data)
            places.append(data.geom(what).xpos.copy())
        return places[1] - places[0]

    for i, leg in enumerate(("fl", "fr", "hl", "hr")):
        towards_end = 1 if leg[0] == "f" else -1
        outwards = 1 if leg[1] == "l" else -1
        assert moved(f"{leg}_rotator", f"paw{i}")[0] * towards_end > 0.01
        assert moved(f"{leg}_elevator", f"paw{i}")[1] * outwards > 0.01
        assert moved(f"{leg}_knee", f"paw{i}")[0] * towards_end > 0.005
    assert moved("tilt1", "skull")[0] < -0.005  # rises: backwards from upright
    assert moved("pan", "skull")[1] > 0.001
    assert moved("tilt2", "skull")[2] > 0.001
    assert moved("mouth", "jaw")[2] > 0.001  # closes
    assert moved("tail_tilt", "tail")[2] > 0.002
    assert moved("tail_pan", "tail")[1] > 0.002


@pytest.mark.parametrize("friction", [0.6, 1.0])
@pytest.mark.parametrize("dt", [0.002, 0.004])
def test_it_stands_still(friction, dt):
    world, robots = aibos([[0.3, -0.2, 1.0], [-0.5, 0.4, -2.5]], friction=friction)
    simulation = Simulation(world, control_period=PERIOD, dt_max=dt)
    drive, data = servos(simulation, robots), simulation.data
    start, speeds = drive.base_poses(data), []
    np.testing.assert_allclose(drive.poses(data), robots.start, atol=1e-12)
    simulation.watch_steps(lambda: speeds.append(np.abs(data.qvel).max()))
    for _ in simulation.ticks(2.0):
        pass
    assert max(speeds) < 0.004
    assert np.abs(drive.base_poses(data) - start).max() < 3e-4
    assert np.abs(drive.joint_angles(data) - AiboERS7.home).max() < np.radians(1.0)
    # four feet carry it, no leg touches another
    assert data.ncon == 8
    paws = [data.sensor(f"aibo_ers71/{paw}").data[0] for paw in FEET]
    assert np.sum(paws) == pytest.approx(1.65 * 9.81, rel=1e-3)
    assert min(paws) > 2.0
    imu = data.sensor("aibo_ers70/imu").data
    assert np.linalg.norm(imu) == pytest.approx(9.81, abs=0.01)
    assert imu[2] > 9.8
    assert data.warning.number.sum() == 0


@pytest.mark.parametrize("start", range(20))
def test_it_survives_halton_noise_without_a_warning(start):
    """1 s of quasi-random targets on all joints, from any pose, beside a wall and another one."""
    rng = np.random.default_rng(start)
    world, robots = aibos([[-1.75, 0, 0], [-1.4, 0.1, 2.0]], friction=(0.6, 1.0)[start % 2])
    world.add_box(-1.5, 0.5, 0.2, 0.2, mass=0.5)
    simulation = Simulation(world, control_period=PERIOD, dt_max=(0.004, 0.002)[start // 10])
    model, data = simulation.model, simulation.data
    drive = servos(simulation, robots)
    tilt = rng.normal(size=(2, 4))
    data.qpos[drive._qpos[:, 2]] = 0.3
    data.qpos[drive._qpos[:, 3:]] = tilt / np.linalg.norm(tilt, axis=1, keepdims=True)
    data.qpos[drive._angle] = rng.uniform(*AiboERS7.joint_limits.T, (2, 20))
    low, high = model.actuator_ctrlrange.T
    fastest = 0.0
    for row in qmc.Halton(model.nu, rng=rng).random(round(1.0 / model.opt.timestep)):
        data.ctrl[:] = low + row * (high - low)
        mujoco.mj_step(model, data)
        fastest = max(fastest, np.abs(drive.joint_rates(data)).max())
    assert data.warning.number.sum() == 0
    assert np.isfinite(data.qpos).all()
    assert np.abs(drive.base_poses(data)[:, :3]).max() < 2.5
    assert 5.0 < fastest < 100.0


def test_targets_move_no_faster_than_the_joints_can():
    world, robots = aibos([[0, 0, 0]])
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.004)
    drive, data = servos(simulation, robots), simulation.data
    targets, rates = [drive.joint_targets(data)[0]], []
    simulation.watch_steps(
        lambda: (
            targets.append(drive.joint_targets(data)[0]),
            rates.append(np.abs(drive.joint_rates(data)[0])),
        )
    )
    command = np.where(AiboERS7.home > AiboERS7.joint_limits.mean(axis=1), *AiboERS7.joint_limits.T)
    command[:12] = AiboERS7.home[:12]
    command[14] = AiboERS7.joint_limits[14, 1]  # nose up, so that the mouth has room to open
    for _ in simulation.ticks(1.0):
        robots.drive([command])
    moves = np.diff(targets, axis=0)
    # two steps a frame, the first of which begins at once; nobody but the servo writes targets
    assert not moves[1::2].any()
    largest = np.abs(moves[0::2]).max(axis=0)
    assert (largest <= AiboERS7.joint_rates * FRAME * (1 + 1e-9)).all()
    np.testing.assert_allclose(largest[12:18], AiboERS7.joint_rates[12:18] * FRAME, rtol=1e-6)
    np.testing.assert_allclose(targets[-1], command, atol=1e-7)
    assert (np.max(rates, axis=0)[12:15] < 1.3 * AiboERS7.joint_rates[12:15]).all()
    np.testing.assert_allclose(drive.joint_angles(data)[0], command, atol=0.06)


def test_bad_commands_are_refused_and_large_ones_clamped():
    world, robots = aibos([[0, 0, 0], [0.6, 0, 0]])
    Simulation(world, control_period=PERIOD)
    np.testing.assert_array_equal(robots.command, [AiboERS7.home] * 2)
    with pytest.raises(InvalidInputError, match=r"\(2, 20\) \(fl_rotator, fl_elevator"):
        robots.drive(np.zeros((2, 3)))
    with pytest.raises(InvalidInputError, match="aibo_ers71"):
        robots.drive([AiboERS7.home, np.full(20, np.nan)])
    robots.drive([AiboERS7.home, AiboERS7.home])
    np.testing.assert_array_equal(robots.clamped, [0, 0])
    # zero is outside the ranges of mouth and tail
    robots.drive([AiboERS7.home, np.zeros(20)])
    np.testing.assert_array_equal(robots.clamped, [0, 1])
    assert np.degrees(robots.command[1, [15, 16]]) == pytest.approx([-3.0, 5.0])
    world, robots = aibos([[0, 0, 0]], AiboERS7(Nodder()))
    Simulation(world, control_period=PERIOD)
    np.testing.assert_array_equal(robots.command, [[0.0]])
    robots.drive([[5.0]])
    np.testing.assert_allclose(robots.command, [[0.7]])
    np.testing.assert_array_equal(robots.clamped, [1])


def test_an_engine_is_asked_every_frame_and_sees_what_the_robot_measures():
    world, robots = aibos([[0, 0, 0], [0.6, 0, 0]], AiboERS7(Nodder()))
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.004)
    drive, data = servos(simulation, robots), simulation.data
    engine = drive._motion
    for _ in simulation.ticks(0.8):
        robots.drive([[0.5], [0.1]])
    np.testing.assert_allclose([s.time for s in engine.seen], FRAME * np.arange(100), atol=1e-12)
    np.testing.assert_allclose(drive.joint_angles(data)[:, 14], [0.5, 0.1], atol=0.02)
    last = engine.seen[-1]
    assert last.joint_angles.shape == (2, 20)
    np.testing.assert_allclose(last.joint_angles[:, 14], [0.5, 0.1], atol=0.02)
    np.testing.assert_allclose(last.accelerometer, [[0, 0, 9.81]] * 2, atol=1.0)


@pytest.mark.parametrize(
    ("wanted", "words"),
    [(np.zeros((1, 3)), r"shape \(1, 20\); got"), (np.full((1, 20), np.nan), "aibo_ers70")],
)
def test_an_engine_that_gives_nonsense_is_refused(wanted, words):
    platform = AiboERS7(Nodder())
    world, _ = aibos([[0, 0, 0]], platform)
    simulation = Simulation(world, control_period=PERIOD)
    servos(simulation, world.groups[0])._motion.targets = lambda *_: wanted
    ticks = simulation.ticks(1.0)
    next(ticks)
    with pytest.raises(InvalidInputError, match=words):
        next(ticks)
    engine = Nodder()
    engine.command_limits = np.array([[0.1, 0.7]])
    with pytest.raises(InvalidInputError, match="command_limits of Nodder"):
        AiboERS7(engine)


def test_a_legged_robot_has_no_kinematic_run():
    world, _ = aibos([[0, 0, 0]])
    ticks = KinematicSimulation(world).ticks(1.0)
    next(ticks)
    with pytest.raises(InvalidInputError, match="has legs"):
        next(ticks)


@pytest.mark.parametrize("engine", [False, True])
def test_same_bits_and_a_snapshot_goes_on(engine):
    def build():
        platform = AiboERS7(Nodder() if engine else None)
        world, robots = aibos([[0, 0, 0.3], [0.5, 0.1, 2.0]], platform)
        return Simulation(world, seed=3, control_period=PERIOD, dt_max=0.004), robots

    def go(simulation, robots, offset):
        for k, _ in enumerate(simulation.ticks(0.4)):
            wave = 0.3 * np.sin(0.8 * (k + offset) + np.arange(2))[:, None]
            robots.drive(wave if engine else AiboERS7.home + wave)
        return simulation.data.qpos.tobytes()

    simulation, robots = build()
    first = go(simulation, robots, 0)
    snapshot = simulation.snapshot()
    once = go(simulation, robots, 10)
    simulation.restore(snapshot)
    again = go(simulation, robots, 10)
    np.random.seed(7)  # noqa: NPY002 - nothing may depend on the global state
    assert go(*build(), 0) == first
    assert once == again != first


def test_robots_touch_each_other_and_themselves():
    world, robots = aibos([[0, 0, 0]])
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.004)
    model, data = simulation.model, simulation.data
    # fore and hind legs swung under the belly meet
    command = AiboERS7.home.copy()
    command[[0, 3, 6, 9]] = np.radians(-70)
    touched = set()

    def look():
        for pair in data.contact.geom[: data.ncon]:
            touched.add(frozenset(model.geom(g).name.split("/")[-1] for g in pair))

    simulation.watch_steps(look)
    for _ in simulation.ticks(1.0):
        robots.drive([command])
    legs = [{"fl_lower", "paw0"}, {"hl_lower", "paw2"}]
    assert any(pair & legs[0] and pair & legs[1] for pair in touched)
    with pytest.raises(InvalidInputError, match="aibo_ers70 and aibo_ers71 by"):
        Simulation(aibos([[0, 0, 0], [0.05, 0.02, 0]])[0])


def test_mink_and_the_closed_form_agree_along_a_locus():
    model = lone_model()
    phase = np.linspace(0, 2 * np.pi, 48, endpoint=False)[:, None]
    stand = ERS7.feet(AiboERS7.home[:12].reshape(4, 3))
    loci = np.repeat(stand[None], 48, axis=0)
    loci[..., 0] += 0.03 * np.sin(phase)
    loci[..., 1] += 0.01 * np.sin(2 * phase)
    loci[..., 2] += 0.02 * np.cos(phase).clip(0)
    found = legs_by_mink(model, loci, feet=FEET, joints=LEG_JOINTS)
    np.testing.assert_allclose(found, ERS7.angles(loci).reshape(48, 12), atol=1e-4)
    bad = loci[:2].copy()
    bad[1, 2, 2] -= 0.1
    with pytest.raises(InvalidInputError, match="foot paw2 stays .* from point 1 of its locus"):
        legs_by_mink(model, bad, feet=FEET, joints=LEG_JOINTS)
    with pytest.raises(InvalidInputError, match=r"shape \(k, 4, 3\)"):
        legs_by_mink(model, loci[0], feet=FEET, joints=LEG_JOINTS)
