"""The pan-tilt unit: limits of the real one, and what its camera sees against projection."""

import cv2
import mujoco
import numpy as np
import pytest
from scipy.stats import qmc

from mjmr.assets import model_path
from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.kinematics import KinematicSimulation
from mjmr.recording import Recording
from mjmr.robots.pioneer2dx import Pioneer2DX
from mjmr.robots.tamiya_txt1 import TamiyaTXT1
from mjmr.sensors.camera import Camera
from mjmr.sensors.pan_tilt import PanTilt
from mjmr.simulation import Simulation
from mjmr.world import World
from tests.mjmr.test_camera import depth_by_rays, spots
from tests.mjmr.worlds import BOTH

LIMITS = np.radians([[-100, 100], [-25, 25]])
RATES = np.radians([80.0, 50.0])
STEPS = np.radians([100 / 880, 25 / 300])


def pioneers(poses=((0.0, 0.0, 0.0),), platform=Pioneer2DX, unit=None, **camera):
    """Pioneers with a unit and, if it is told how, a camera on it; returns (world, robots)."""
    world = World(bounds=[-8, -8, 8, 8], wall_height=0.5)
    robots = world.add_group(platform, poses)
    robots.mount(unit or PanTilt(site="camera"))
    if camera:
        robots.mount(Camera(at="pan_tilt", **camera))
    return world, robots


def turns(simulation, robots, seconds, pan, tilt):
    """True angles (steps, n, 2) and rates at every physics step of a move."""
    model, data = simulation.model, simulation.data
    joints = [[model.joint(f"{p}pan_tilt/{a}") for a in ("pan", "tilt")] for p in robots.prefixes]
    at = np.array([[j.qposadr[0] for j in pair] for pair in joints])
    speed = np.array([[j.dofadr[0] for j in pair] for pair in joints])
    angles, rates = [], []
    simulation.watch_steps(lambda: (angles.append(data.qpos[at]), rates.append(data.qvel[speed])))
    for _ in simulation.ticks(seconds):
        robots.pan_tilt.aim(pan, tilt)
    simulation._step_watchers.clear()
    assert simulation.data.warning.number.sum() == 0
    return np.array(angles), np.array(rates)


def test_the_model_has_the_units_numbers():
    model = mujoco.MjModel.from_xml_path(str(model_path("evi_d30")))
    assert model.key("home").qpos.tolist() == [0.0, 0.0]
    np.testing.assert_allclose(model.jnt_range, LIMITS, atol=1e-7)
    np.testing.assert_allclose(model.actuator_actrange, LIMITS, atol=1e-7)
    np.testing.assert_allclose(model.actuator_ctrlrange[:, 1], RATES, atol=1e-7)
    assert model.body_mass.sum() == pytest.approx(1.2)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    top = max(data.geom_xpos[g, 2] + model.geom_size[g, 2] for g in (model.geom("head").id,))
    assert top == pytest.approx(0.109, abs=1e-3)
    np.testing.assert_allclose(2 * model.geom("casing").size[:2], [0.164, 0.142])
    world, robots = pioneers(width=320, height=240)
    Simulation(world)
    view = robots.camera.calibration
    assert np.degrees(2 * np.arctan(160 / view.focal)) == pytest.approx(48.8, abs=0.02)
    np.testing.assert_allclose(robots.pan_tilt.limits, LIMITS, atol=1e-7)


@pytest.mark.parametrize("dt_max", [0.002, 0.005, 0.01])
@pytest.mark.parametrize("period", [0.1, 1 / 60])
def test_it_turns_as_fast_as_the_real_one_and_no_further(dt_max, period):
    """From -100 to 100 degrees in 2.5 s, from -25 to 25 in 1 s, and never faster."""
    world, robots = pioneers([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    simulation = Simulation(world, control_period=period, dt_max=dt_max)
    turns(simulation, robots, 2.0, [-9.0, 9.0], [-9.0, 9.0])
    angles, rates = turns(simulation, robots, 3.0, [9.0, -9.0], [9.0, -9.0])
    time = np.arange(1, len(angles) + 1) * simulation.timestep
    assert (np.abs(rates) / RATES).max() < 1.01
    assert np.abs(angles / LIMITS[:, 1]).max() < 1.001
    np.testing.assert_allclose(angles[-1], [LIMITS[:, 1], LIMITS[:, 0]], atol=1e-3)
    for axis, (lag, low) in enumerate(((0.05, LIMITS[0, 0]), (0.05, LIMITS[1, 0]))):
        moving = (time > 0.3) & (time < -2 * low / RATES[axis])
        behind = low + RATES[axis] * time[moving] - angles[moving, 0, axis]
        assert behind.min() > 0
        assert behind.max() < lag * RATES[axis], "a servo is a little late"
    np.testing.assert_allclose(angles[:, 0], -angles[:, 1], atol=1e-5)
    assert robots.pan_tilt.clamped.tolist() == [round(5.0 / period)] * 2


@pytest.mark.parametrize("kind", BOTH)
@pytest.mark.parametrize("period", [0.1, 0.03])
def test_both_simulations_turn_it_alike(kind, period):
    """Exact in the kinematic one, some 40 ms late and within a step at rest in the other."""
    world, robots = pioneers(unit=PanTilt(rate=50.0))
    simulation = kind(world, control_period=period)
    late = 0.05 if kind is Simulation else 1e-9
    for t in simulation.ticks(2.4):
        wanted = np.minimum(RATES * robots.pan_tilt.sampled_at, [1.5, 0.4])
        off = wanted - robots.pan_tilt.read()[0]
        assert (off >= -STEPS / 2 - 1e-9).all()
        assert (off <= STEPS / 2 + late * RATES).all()
        if t > 1.5:
            assert np.abs(off).max() <= STEPS.max() / 2 + 1e-4
        robots.pan_tilt.aim(1.5, 0.4)


def test_a_recording_of_a_kinematic_simulation_shows_the_turn():
    world, robots = pioneers([[0.0, 0.0, 0.0], [2.0, 0.0, 1.0]])
    simulation = KinematicSimulation(world, control_period=0.1)
    recording = Recording(simulation)
    for _ in simulation.ticks(1.0):
        robots.pan_tilt.aim([0.5, -0.3], 0.2)
    footage = recording.footage()
    joints = [f"{p}pan_tilt/{a}" for p in robots.prefixes for a in ("pan", "tilt")]
    columns = [footage.model.joint(name).qposadr[0] for name in joints]
    np.testing.assert_allclose(footage.positions[-1, columns], [0.5, 0.2, -0.3, 0.2])
    np.testing.assert_allclose(footage.positions[0, columns], 0.0)


def test_a_small_turn_settles_within_a_step():
    world, robots = pioneers()
    simulation = Simulation(world, control_period=0.1)
    angles, _ = turns(simulation, robots, 0.6, 0.3, -0.1)
    assert np.abs(angles[-1, 0] - [0.3, -0.1]).max() < STEPS.min() / 10
    assert angles[:, 0, 0].max() < 0.3 + STEPS[0] / 2, "it does not overshoot"


def test_angles_are_reported_in_the_units_steps_and_late_if_told():
    unit = PanTilt(site="camera", rate=10.0, latency=0.1)
    world, robots = pioneers(unit=unit)
    simulation = Simulation(world, control_period=0.1)
    at = simulation.model.joint("pioneer2dx0/pan_tilt/pan").qposadr[0]
    true, told = [], []
    for k, _ in enumerate(simulation.ticks(1.5)):
        true.append(simulation.data.qpos[at : at + 2].copy())
        told.append(unit.read()[0].copy())
        unit.aim(0.02 * k, -0.01 * k)
    true, told = np.array(true), np.array(told)
    assert np.isnan(told[0]).all()
    np.testing.assert_allclose(told[1:] / STEPS, np.round(told[1:] / STEPS), atol=1e-9)
    assert np.abs(told[1:] - true[:-1]).max() <= STEPS.max() / 2 + 1e-12
    assert np.abs(told[-1]).min() > 0.1


def test_it_stands_where_it_is_told_and_turns_as_far():
    unit = PanTilt(position=(-0.1, 0.05, 0.22), pan=(-0.5, 3.0), tilt=(-1.0, 0.1), rates=(2.0, 3.0))
    world, robots = pioneers(unit=unit)
    simulation = Simulation(world, control_period=0.1)
    angles, rates = turns(simulation, robots, 3.0, 9.0, -9.0)
    np.testing.assert_allclose(angles[-1, 0], [3.0, -1.0], atol=1e-3)
    assert rates[:, 0, 0].max() == pytest.approx(2.0, rel=0.01)
    assert np.abs(rates[:, 0, 1]).max() == pytest.approx(3.0, rel=0.1)
    casing = simulation.data.body("pioneer2dx0/pan_tilt/casing").xpos
    base = simulation.data.body("pioneer2dx0/base").xpos
    np.testing.assert_allclose(casing - base, [-0.1, 0.05, 0.22], atol=1e-3)


def test_camera_poses_are_those_of_the_physics():
    poses = [[0.0, 0.0, 0.4], [2.0, 1.0, -2.0], [-3.0, 2.0, 3.0]]
    world, robots = pioneers(poses, width=64, height=48)
    simulation = Simulation(world, control_period=0.1)
    for _ in simulation.ticks(2.0):
        robots.pan_tilt.aim([1.2, -0.7, 0.3], [0.4, -0.3, 0.1])
        robots.drive([[0.2, 0.3]] * 3)
    data, model = simulation.data, simulation.model
    mujoco.mj_forward(model, data)
    angles = np.array(
        [[data.joint(f"{p}pan_tilt/{a}").qpos[0] for a in ("pan", "tilt")] for p in robots.prefixes]
    )
    found = robots.pan_tilt.camera_poses(angles)
    for i, prefix in enumerate(robots.prefixes):
        base, camera = data.body(f"{prefix}base"), data.camera(f"{prefix}pan_tilt")
        frame = base.xmat.reshape(3, 3)
        np.testing.assert_allclose(base.xpos + frame @ found[i, :3, 3], camera.xpos, atol=1e-9)
        seen = camera.xmat.reshape(3, 3) * [1.0, -1.0, -1.0]
        np.testing.assert_allclose(frame @ found[i, :3, :3], seen, atol=1e-9)
    # 17 cm ahead, looking straight ahead and 5 cm in front of both axes
    ahead = robots.pan_tilt.camera_poses(np.zeros((1, 2)))[0]
    np.testing.assert_allclose(ahead[:3, 3], [0.22, 0.0, 0.303], atol=1e-9)
    np.testing.assert_allclose(ahead[:3, 2], [1, 0, 0], atol=1e-9)
    left = robots.pan_tilt.camera_poses([[np.pi / 2, 0.2]])[0]
    np.testing.assert_allclose(left[:3, 2], [0, np.cos(0.2), np.sin(0.2)], atol=1e-9)


AIMS = [(0.0, 0.0), (0.9, 0.3), (-1.3, -0.2)]


@pytest.mark.parametrize("kind", BOTH)
@pytest.mark.parametrize("aim", AIMS)
def test_points_are_found_where_they_are_projected(aim, kind):
    """Spheres of 10 mm, by OpenCV, at the angles the unit reports: within a pixel."""
    poses = np.array([[0.5, -0.5, 0.7], [-3.0, 1.0, -2.5]])
    world, robots = pioneers(poses, width=640, height=480, rate=10.0)
    # three points on the axis and off it, in front of each robot's camera
    spread = np.array([[0.0, 0.0, 1.0], [-0.25, -0.15, 0.8], [0.3, 0.1, 0.7]])
    simulation = Simulation(world)
    poses_there = robots.pan_tilt.camera_poses([aim, aim])
    points = []
    for (x, y, yaw), transform in zip(poses, poses_there, strict=True):
        c, s = np.cos(yaw), np.sin(yaw)
        local = spread @ transform[:3, :3].T + transform[:3, 3]
        points.append(local @ [[c, s, 0], [-s, c, 0], [0, 0, 1]] + [x, y, 0])
    world, robots = pioneers(poses, width=640, height=480, rate=10.0)
    world.edit(lambda spec: [add_spot(spec, p) for p in np.concatenate(points)])
    simulation = kind(world, control_period=0.1)
    for _ in simulation.ticks(3.0):
        robots.pan_tilt.aim(*aim)
    images = robots.camera.read()
    # as pictured: a kinematic simulation shows robots as deep and as tilted as contact carries them
    scene = simulation.data if kind is Simulation else simulation.studio.data
    bodies = [scene.body(f"{prefix}base") for prefix in robots.prefixes]
    bases = [np.concatenate([b.xpos, b.xquat]) for b in bodies]
    for i, image in enumerate(images):
        view = robots.pan_tilt.pinhole(robots.camera, robots.pan_tilt.read()[i], bases[i])
        wanted = view.project(points[i])
        found = spots(image)
        assert len(found) == 3
        apart = np.linalg.norm(found[:, None] - wanted[None], axis=2)
        assert apart.min(axis=0).max() < 1.0
        assert sorted(apart.argmin(axis=0)) == [0, 1, 2]
    assert not np.allclose(robots.camera.read()[0], robots.camera.read()[1])


def add_spot(spec, point):
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_SPHERE, pos=point, size=[0.01, 0, 0], rgba=[1, 0, 1, 1],
        contype=0, conaffinity=0, group=1,
    )  # fmt: skip


@pytest.mark.parametrize("aim", AIMS)
def test_depth_through_the_unit_is_that_of_rays(aim):
    poses = [[0.0, 0.0, 0.3], [1.2, 0.9, -2.0]]
    world, robots = pioneers(poses, modality="depth", width=160, height=120, rate=10.0)
    world.add_box(1.5, -0.8, 0.4, 0.6, height=0.5)
    simulation = Simulation(world, control_period=0.1)
    for _ in simulation.ticks(3.0):
        robots.pan_tilt.aim(*aim)
    for i, depth in enumerate(robots.camera.read()):
        wanted, smooth = depth_by_rays(simulation, f"pioneer2dx{i}/pan_tilt", 160, 120)
        assert smooth.sum() > 1000
        np.testing.assert_allclose(depth[smooth], wanted[smooth], atol=0.01)


class OwnUnit(Pioneer2DX):
    """Has a pan-tilt camera of its own, with position servos."""

    name = "own"

    def model(self, number, team):
        spec = mujoco.MjSpec.from_file(str(model_path("pioneer2dx")))
        for key in list(spec.keys):
            spec.delete(key)
        body = spec.body("base")
        for joint, axis, limit in (("pan", [0, 0, 1], 1.2), ("tilt", [0, -1, 0], 0.7)):
            body = body.add_body(name=f"{joint}_body", pos=[0.05, 0, 0.15])
            body.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[0.02, 0, 0], mass=0.1,
                          contype=0, conaffinity=0, group=1)  # fmt: skip
            body.add_joint(name=joint, axis=axis, range=[-limit, limit], limited=1, armature=0.01)
            servo = spec.add_actuator(
                name=joint, target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT
            )  # fmt: skip
            servo.set_to_position(kp=20.0, kv=0.8, inheritrange=1.0)
        body.add_camera(name="eye", pos=[0.05, 0, 0], xyaxes=[0, -1, 0, 0, 0, 1])
        return spec


def test_a_robots_own_unit_is_taken_over_with_limited_rates():
    world = World(bounds=[-8, -8, 8, 8])
    robots = world.add_group(OwnUnit, [[0.0, 0.0, 0.5], [2.0, 0.0, 0.0]])
    unit = robots.mount(PanTilt(rates=(1.0, 0.5), tilt=(-0.2, 0.7)))
    robots.mount(Camera(at="eye", width=64, height=48))
    simulation = Simulation(world, control_period=0.1)
    assert simulation.model.njnt == 2 * 5, "nothing is added"
    np.testing.assert_allclose(unit.limits, [[-1.2, 1.2], [-0.2, 0.7]])
    rates = []
    speed = [simulation.model.joint(f"own1/{a}").dofadr[0] for a in ("pan", "tilt")]
    simulation.watch_steps(lambda: rates.append(simulation.data.qvel[speed]))
    for _ in simulation.ticks(2.0):
        unit.aim(-3.0, [-0.6, 0.6])
    np.testing.assert_allclose(unit.read(), [[-1.2, -0.2], [-1.2, 0.6]], atol=2 * STEPS.max())
    assert np.abs(rates).max(axis=0) == pytest.approx([1.0, 0.5], rel=0.05)
    data = simulation.data
    mujoco.mj_forward(simulation.model, data)
    transform = unit.camera_poses(
        [[data.joint("own1/pan").qpos[0], data.joint("own1/tilt").qpos[0]]]
    )
    base = data.body("own1/base")
    where = base.xpos + base.xmat.reshape(3, 3) @ transform[0, :3, 3]
    np.testing.assert_allclose(where, data.camera("own1/eye").xpos, atol=1e-9)
    assert unit.pinhole(robots.camera, (0.0, 0.0)).width == 64
    world = World(bounds=[-8, -8, 8, 8])
    world.add_group(OwnUnit, [[0.0, 0.0, 0.5]]).mount(PanTilt(pan=(-2.0, 0.0)))
    with pytest.raises(InvalidInputError, match="pan of own0 turns from -1.2 to 1.2 rad; got -2"):
        Simulation(world)


def test_the_pioneer_drives_as_well_with_it():
    world, robots = pioneers([[-3.0, 0.0, 0.0]])
    simulation = Simulation(world, control_period=0.1)
    base = simulation.model.body("pioneer2dx0/base").id
    tilts = []
    simulation.watch_steps(lambda: tilts.append(simulation.data.xmat[base, 8]))
    ends = []
    simulation.observe(lambda: ends.append(simulation.truth.poses(robots)[0]))
    for t in simulation.ticks(12.0):
        robots.drive([[0.5 if t < 9.95 else 0.0, 0.0]])
        robots.pan_tilt.aim(np.sin(2 * t), 0.4 * np.sin(3 * t))
    # ramps of 0.5 s
    assert ends[-1][0] - ends[0][0] == pytest.approx(5.0, rel=0.003)
    assert abs(ends[-1][1]) < 0.01
    assert np.degrees(np.arccos(min(tilts))) < 1.0


@pytest.mark.parametrize("start", range(3))
def test_it_survives_halton_noise_without_a_warning(start):
    world, robots = pioneers([[0.0, 0.0, 0.0], [0.6, 0.3, 2.0]])
    simulation = Simulation(world)
    model, data = simulation.model, simulation.data
    noise = qmc.Halton(model.nu, rng=start).random(200)
    low, high = np.where(model.actuator_ctrllimited[:, None], model.actuator_ctrlrange, [-3, 3]).T
    for row in noise:
        data.ctrl[:] = low + row * (high - low)
        mujoco.mj_step(model, data)
    assert data.warning.number.sum() == 0
    assert np.isfinite(data.qpos).all()
    pans = [data.joint(f"{p}pan_tilt/pan").qpos[0] for p in robots.prefixes]
    assert np.ptp(pans) > 0


@pytest.mark.parametrize("kind", BOTH)
def test_same_bits_and_a_snapshot_goes_on(kind):
    def run(simulation, robots, seconds):
        found = []
        for _ in simulation.ticks(seconds):
            found.append(robots.pan_tilt.read().tobytes())
            if 0.4 < simulation.time < 0.6:
                robots.pan_tilt.aim([3.0, 0.5], 0.2)
        state = simulation._physics_state().tobytes(), simulation.moved_parts()[0].tobytes()
        return found, *state, robots.pan_tilt.clamped.tolist()

    def fresh():
        world, robots = pioneers([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
        return kind(world, control_period=0.05), robots

    whole = run(*fresh(), 2.0)
    simulation, robots = fresh()
    begin = run(simulation, robots, 0.7)
    snapshot = simulation.snapshot()
    rest = run(simulation, robots, 1.3)
    assert (begin[0] + rest[0], *rest[1:]) == whole
    simulation.restore(snapshot)
    assert run(simulation, robots, 1.3) == rest
    other, robots = fresh()
    other.restore(snapshot)
    np.testing.assert_allclose(robots.pan_tilt.aimed, [[LIMITS[0, 1], 0.2], [0.5, 0.2]], atol=1e-7)
    assert run(other, robots, 1.3) == rest


def test_exported_mjcf_has_the_unit():
    world, _ = pioneers()
    model = mujoco.MjModel.from_xml_string(world.to_xml())
    fastest = model.actuator("pioneer2dx0/pan_tilt/pan").ctrlrange[1]
    assert fastest == pytest.approx(RATES[0], rel=1e-5)
    assert model.camera("pioneer2dx0/pan_tilt").id >= 0


def test_bad_aims_are_refused_by_name():
    world, robots = pioneers([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    with pytest.raises(InvalidInputError, match="in a simulation"):
        robots.pan_tilt.aim(0.0, 0.0)
    simulation = Simulation(world)
    for pan, tilt in (([0.0, np.nan], 0.0), (0.0, [0.0, np.inf])):
        with pytest.raises(InvalidInputError, match="finite; they are not for pioneer2dx1$"):
            robots.pan_tilt.aim(pan, tilt)
    with pytest.raises(InvalidInputError, match=r"shape \(2,\), or one for all; got \(3,\)"):
        robots.pan_tilt.aim(np.zeros(3), 0.0)
    with pytest.raises(InvalidInputError, match=r"shape \(n, 2\)"):
        robots.pan_tilt.camera_poses(np.zeros(2))
    for _ in simulation.ticks(0.1):
        pass
    assert not robots.pan_tilt.aimed.any()
    assert not robots.pan_tilt.clamped.any()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"pan": (1.0, -1.0)}, "pan needs a least and a larger"),
        ({"tilt": (0.0, np.nan)}, "tilt needs a least and a larger"),
        ({"rates": (0.0, 1.0)}, "rates of pan and tilt must be positive"),
        ({"steps": (0.1, -0.1)}, "steps of pan and tilt must be positive"),
        ({"position": (0.0, 0.0)}, "three finite"),
        ({"rate": 0.0}, "rate must be positive"),
    ],
)
def test_bad_units_are_refused(options, message):
    with pytest.raises(InvalidInputError, match=message):
        PanTilt(**options)


def test_places_it_cannot_stand_are_refused():
    world, _ = pioneers(unit=PanTilt(site="roof"))
    with pytest.raises(UnknownNameError, match="'roof'; valid: .*camera"):
        Simulation(world)
    world, robots = pioneers()
    with pytest.raises(InvalidInputError, match="named 'pan_tilt' already"):
        robots.mount(PanTilt(site="lidar"))
    world = World(bounds=[-8, -8, 8, 8])
    robots = world.add_group(Pioneer2DX, [[0.0, 0.0, 0.0]])
    robots.mount(Camera(at="pan_tilt"))
    robots.mount(PanTilt())
    with pytest.raises(UnknownNameError, match="'pan_tilt'"):
        Simulation(world)


def test_two_units_on_one_robot():
    world, robots = pioneers()
    robots.mount(PanTilt(position=(-0.15, 0.0, 0.22)), "rear")
    robots.mount(Camera(at="rear", width=32, height=24))
    simulation = Simulation(world, control_period=0.1)
    for _ in simulation.ticks(1.0):
        robots.pan_tilt.aim(0.5, 0.0)
        robots.rear.aim(-0.5, 0.1)
    np.testing.assert_allclose(robots.rear.read()[0], [-0.5, 0.1], atol=STEPS.max())
    np.testing.assert_allclose(robots.pan_tilt.read()[0], [0.5, 0.0], atol=STEPS.max())
    assert cv2.mean(robots.camera.read()[0])[1] > 0


def test_a_robots_own_unit_stands_where_it_stands_and_has_one_master():
    for units, told in (
        ([PanTilt(position=(0.0, 0.0, 0.5))], "has a pan-tilt unit of its own"),
        ([PanTilt(), PanTilt()], "moved by another PanTilt already"),
    ):
        world = World.rectangle(4.0, 4.0)
        truck = world.add_group(TamiyaTXT1, [[0.0, 0.0, 0.0]])
        for k, unit in enumerate(units):
            truck.mount(unit, f"unit{k}")
        with pytest.raises(InvalidInputError, match=told):
            Simulation(world)
    with pytest.raises(InvalidInputError, match="takes a position"):
        PanTilt(body="base")
