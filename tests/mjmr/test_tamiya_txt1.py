"""The Tamiya TXT-1: sprung axles, one steering servo, one motor on open differentials."""

import math
import re

import mujoco
import numpy as np
import pytest
from scipy.stats import qmc

from controllers.estimation.odometry import Odometry
from mjmr.assets import asset_folder, model_path
from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.faults import Fault
from mjmr.kinematics import KinematicSimulation
from mjmr.robots import platform_class
from mjmr.robots.ackermann import AckermannDrive, mean_path
from mjmr.robots.tamiya_txt1 import TamiyaTXT1
from mjmr.sensors.camera import Camera
from mjmr.simulation import Simulation
from mjmr.world import World
from tests.mjmr.bases import drive
from tests.mjmr.worlds import BOTH

PERIOD = 0.1
TIMESTEPS = (0.005, 0.002)
LOCK = TamiyaTXT1.lock
NAME = "tamiya_txt10/"


class Fast(TamiyaTXT1):
    """One that may be driven until it rolls over."""

    max_speed = 4.0


def trucks(poses, platform=TamiyaTXT1, **options):
    """A large hall; returns (world, robots)."""
    world = World(bounds=[-15, -15, 15, 15], wall_height=0.5)
    return world, world.add_group(platform, poses, **options)


def run(commands, platform, dt_max=0.005, pose=(0.0, 0.0, 0.0), world_of=trucks):
    world, robots = world_of([pose], platform)
    simulation = Simulation(world, control_period=PERIOD, dt_max=dt_max)
    poses, twists, tilt = drive(simulation, robots, commands)
    assert simulation.data.warning.number.sum() == 0
    return poses[:, 0], twists[:, 0], tilt


def hold(forward, other, seconds):
    return np.tile([forward, other], (round(seconds / PERIOD), 1))


def fitted_radius(places):
    """Radius of the circle that fits places (k, 2) best."""
    matrix = np.column_stack([2 * places, np.ones(len(places))])
    x, y, rest = np.linalg.lstsq(matrix, (places**2).sum(axis=1), rcond=None)[0]
    return math.sqrt(rest + x * x + y * y)


def test_the_compiled_model_has_the_stated_numbers():
    model = mujoco.MjModel.from_xml_path(str(model_path("tamiya_txt1")))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("home").id)
    mujoco.mj_forward(model, data)
    base = model.body("base").id
    assert model.body_subtreemass[base] == pytest.approx(7.0)
    np.testing.assert_allclose(data.subtree_com[base], [0.155, 0, 0.156], atol=1e-3)
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for geom in range(model.ngeom):
        if model.geom_group[geom] == 0:
            low = np.minimum(low, data.geom_xpos[geom] - model.geom_size[geom])
            high = np.maximum(high, data.geom_xpos[geom] + model.geom_size[geom])
    np.testing.assert_allclose((high - low)[:2], [0.49, 0.386], atol=1e-9)
    assert low[2] == pytest.approx(0.0, abs=1e-12)
    bumper = model.geom("bumper_front")
    assert np.hypot(*(bumper.pos + bumper.size)[:2]) == pytest.approx(TamiyaTXT1.radius, abs=0.005)
    treads = [g for g in range(model.ngeom) if model.geom(g).name.startswith("tread")]
    assert len(treads) == 4
    assert {float(model.geom_size[t, 0]) for t in treads} == {TamiyaTXT1.wheel_radius}
    world, _ = trucks([[0.0, 0.0, 0.0]])
    bound = TamiyaTXT1().bind(Simulation(world).model, [NAME])
    assert isinstance(bound, AckermannDrive)
    for name in ("wheelbase", "track", "wheel_radius", "rolling_radius", "lock", "steering_rate"):
        assert getattr(bound, name) == pytest.approx(getattr(TamiyaTXT1, name), abs=2e-5), name
    # README and model say the same
    text = (asset_folder() / "tamiya_txt1" / "README.md").read_text()
    for name, value in {"mass": 7, "tyre diameter": 165, "wheelbase": 310, "track": 280}.items():
        row = re.search(rf"^\| {name}[^|]*\| ([\d.]+)", text, re.MULTILINE)
        assert row is not None, name
        assert float(row[1]) == value


def test_it_is_found_by_name():
    assert platform_class("tamiya_txt1") is TamiyaTXT1


def test_sonars_fan_out_in_front():
    model = mujoco.MjModel.from_xml_path(str(model_path("tamiya_txt1")))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    hull = model.geom("hull")
    for k in range(8):
        site = data.site(f"sonar{k}")
        axis = site.xmat.reshape(3, 3)[:, 0]
        assert np.degrees(np.arctan2(axis[1], axis[0])) == pytest.approx(52.5 - 15 * k, abs=0.01)
        # on the hull's surface
        beyond = np.abs(site.xpos - hull.pos) - hull.size
        assert beyond.max() == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("start", range(5))
def test_it_survives_halton_noise_without_a_warning(start):
    """1 s of quasi-random control on all servos, beside a wall, boxes and each other."""
    rng = np.random.default_rng(start)
    poses = np.array([[-14.5, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [3.0, 3.0, 0.0]])
    poses[:, 2] = rng.uniform(-np.pi, np.pi, 4)
    world, _ = trucks(poses)
    world.overlap = True
    world.add_box(2.0, 0.1, 0.4, 0.4, mass=5.0)
    world.add_box(-1.0, 0.0, 0.4, 0.4)
    simulation = Simulation(world)
    model, data = simulation.model, simulation.data
    # the motor's set point reaches 25 rad/s; the others' controls are in their own ranges
    reach = np.tile([400.0, TamiyaTXT1.steering_rate, 2.6, 1.2], 4)
    assert model.nu == len(reach)
    for row in qmc.Halton(model.nu, rng=rng).random(round(1.0 / model.opt.timestep)):
        data.ctrl[:] = 2.0 * reach * (row - 0.5)
        mujoco.mj_step(model, data)
    assert data.warning.number.sum() == 0
    assert np.isfinite(data.qpos).all()
    bases = [model.body(f"tamiya_txt1{i}/base").id for i in range(4)]
    assert data.xmat[bases, 8].min() > np.cos(np.radians(15.0))
    assert np.abs(data.qvel).max() > 0.5


def test_it_starts_at_rest_and_stands_still():
    poses = [[1.0, 0.5, 0.3], [-1.0, -0.5, -2.0]]
    world, robots = trucks(poses)
    simulation = Simulation(world, control_period=PERIOD)
    np.testing.assert_allclose(simulation.truth.poses(robots), poses, atol=1e-9)
    assert -1e-3 < simulation.data.qpos[2] < -1e-5
    springs = [simulation.model.joint(f"{NAME}heave_{end}").qposadr[0] for end in ("front", "rear")]
    assert np.abs(simulation.data.qpos[springs]).max() < 1e-4
    seen, twists, _ = drive(simulation, robots, np.zeros((20, 2)))
    assert np.abs(seen - seen[0]).max() < 1e-6
    assert np.abs(twists).max() < 1e-5


def test_a_truck_that_cannot_stand_is_refused():
    def tail_heavy(spec):
        spec.body(f"{NAME}base").ipos = [-0.5, 0.0, 0.18]

    world, _ = trucks([[0.0, 0.0, 0.0]])
    world.edit(tail_heavy)
    with pytest.raises(InvalidInputError, match="tamiya_txt10/base does not stand still"):
        Simulation(world)


@pytest.mark.parametrize("dt_max", TIMESTEPS)
@pytest.mark.parametrize("speed", [0.5, 1.0, 2.0])
@pytest.mark.parametrize("degrees", [10, 20, 28])
def test_it_turns_as_the_bicycle_model(degrees, speed, dt_max):
    """Radius within 2 % of wheelbase / tan(steering), yaw rate too."""
    steering = math.radians(degrees)
    radius = TamiyaTXT1.wheelbase / math.tan(steering)
    seconds = speed + 1.5 + min(2 * math.pi * radius / speed, 8.0)
    poses, twists, tilt = run(
        hold(speed, steering, seconds), TamiyaTXT1(command="steering"), dt_max
    )
    steady = round((speed + 1.2) / PERIOD)
    assert fitted_radius(poses[steady:, :2]) == pytest.approx(radius, rel=0.02)
    rate = np.diff(np.unwrap(poses[steady:, 2])).mean() / PERIOD
    assert rate == pytest.approx(speed / radius, rel=0.01)
    assert twists[-1, 0] == pytest.approx(speed, rel=0.02)
    assert tilt < 5.0


def test_left_and_right_mirror_each_other():
    platform = TamiyaTXT1(command="steering")
    ends = [run(hold(1.0, side * 0.4, 4.0), platform)[0][-1] for side in (1.0, -1.0)]
    np.testing.assert_allclose(ends[0] * [1, -1, -1], ends[1], atol=5e-3)


def test_the_knuckles_take_ackermanns_angles():
    """The coupling through one servo is within 0.06 degrees of the angles of rolling wheels."""
    model = mujoco.MjModel.from_xml_path(str(model_path("tamiya_txt1")))
    half = TamiyaTXT1.track / 2
    for side, sign in (("left", 1.0), ("right", -1.0)):
        (equality,) = [
            k for k in range(model.neq)
            if model.eq_obj1id[k] == model.joint(f"steer_{side}").id
        ]  # fmt: skip
        assert model.eq_obj2id[equality] == model.joint("steer").id
        coefficients = model.eq_data[equality, :5]
        # through the origin with slope 1: it does not pull when straight
        np.testing.assert_array_equal(coefficients[:2], [0.0, 1.0])
        for bicycle in np.linspace(-LOCK, LOCK, 29):
            along = TamiyaTXT1.wheelbase * math.tan(bicycle)
            real = math.atan(along / (TamiyaTXT1.wheelbase - sign * half * math.tan(bicycle)))
            modelled = np.polynomial.polynomial.polyval(bicycle, coefficients)
            assert math.degrees(abs(modelled - real)) < 0.06


def test_the_motor_turns_as_fast_as_the_wheels_on_average():
    assert mean_path(0.0, 0.31, 0.28) == 1.0
    # hubs at 0.443, 0.723 m and, in front, hypot with 0.31 m, from the centre 0.583 m to the left
    radius = 0.31 / math.tan(LOCK)
    near, far = radius - 0.14, radius + 0.14
    mean = (near + far + math.hypot(near, 0.31) + math.hypot(far, 0.31)) / 4.0
    assert mean_path(LOCK, 0.31, 0.28) == pytest.approx(mean / radius)
    assert mean_path(-LOCK, 0.31, 0.28) == pytest.approx(mean / radius)


@pytest.mark.parametrize("dt_max", TIMESTEPS)
def test_one_metre_a_second_at_0_3_rad_a_second_is_a_circle_of_3_33_m(dt_max):
    poses, _, _ = run(hold(1.0, 0.3, 24.0), TamiyaTXT1(), dt_max, (0.0, -3.3, 0.0))
    assert fitted_radius(poses[20:, :2]) == pytest.approx(10 / 3, rel=0.005)


def changes(seed):
    """15 s of speeds from 0 to 2 m/s, half of them 0, and of turns to either side."""
    rng = np.random.default_rng(seed)
    speeds = rng.uniform(0, 2, 20) * rng.integers(0, 2, 20)
    turns = rng.choice([-0.3, 0.3], 20)
    times = rng.uniform(0.1, 1.5, 20)
    return np.concatenate([hold(*row) for row in zip(speeds, turns, times, strict=True)])


YAW_CASES = {
    "from rest": hold(2.0, 0.3, 4.0),
    "from rest, slowly": hold(0.3, 0.3, 2.0),
    # near the lock, and the steering takes 0.4 s to come back
    "speeding up from 0.17": np.concatenate([hold(0.17, 0.3, 2.0), hold(2.0, 0.3, 4.0)]),
    "to the other side": np.concatenate([hold(0.2, 0.3, 2.0), hold(2.0, -0.3, 4.0)]),
    "slowing down": np.concatenate([hold(2.0, 0.3, 3.0), hold(0.2, 0.3, 3.0)]),
    "changes": changes(0),
    "other changes": changes(1),
}


@pytest.mark.parametrize("dt_max", TIMESTEPS)
@pytest.mark.parametrize("case", YAW_CASES)
def test_it_never_turns_faster_than_asked_for(case, dt_max):
    """At most 0.305 rad/s over any 0.5 s, 0.3 being commanded (Fierro et al. 2005)."""
    world, robots = trucks([[-5.0, -4.0, 0.0]])
    simulation = Simulation(world, control_period=PERIOD, dt_max=dt_max)
    quaternion = simulation.data.qpos[3:7]
    yaws = []
    simulation.watch_steps(lambda: yaws.append(2.0 * math.atan2(quaternion[3], quaternion[0])))
    _, twists, _ = drive(simulation, robots, YAW_CASES[case])
    width = round(0.5 / simulation.timestep)
    unwrapped = np.unwrap(yaws)
    rates = np.abs(unwrapped[width:] - unwrapped[:-width]) / 0.5
    assert 0.28 < rates.max() < 0.305
    assert np.abs(twists[..., 0]).max() < 2.005


@pytest.mark.parametrize("turn", [0.0, 0.3])
def test_it_drives_no_faster_than_published_whatever_it_is_told(turn):
    """At most 2 m/s over any 0.5 s, 2.5 being commanded (Fierro et al. 2005)."""
    poses, twists, _ = run(hold(2.5, turn, 6.0), TamiyaTXT1(), dt_max=0.01)
    ways = np.hypot(*(poses[5:, :2] - poses[:-5, :2]).T)
    assert 1.99 < ways.max() / 0.5 <= 2.0
    assert twists[-1, 0] > 1.99


def test_steering_for_the_present_speed_alone_turns_too_fast():
    """What the platform's slew prevents: v and w ramped each by itself."""

    class Naive(TamiyaTXT1):
        def slew(self, current, target, period):
            return target

    commands = np.concatenate([hold(0.17, 0.3, 2.0), hold(2.0, 0.3, 3.0)])
    commands[:, 0] = np.minimum(commands[:, 0], 0.17 + 0.1 * np.maximum(np.arange(50) - 19, 0))
    _, twists, _ = run(commands, Naive())
    assert np.abs(twists[..., 2]).max() > 0.32


@pytest.mark.parametrize("dt_max", TIMESTEPS)
def test_at_full_lock_it_holds_at_2_metres_a_second_and_rolls_over_above(dt_max):
    _, _, held = run(hold(2.0, LOCK, 7.0), TamiyaTXT1(command="steering"), dt_max)
    assert 2.0 < held < 6.0
    _, _, fast = run(hold(2.1, LOCK, 7.0), Fast(command="steering"), dt_max)
    assert fast < 6.0
    _, twists, over = run(hold(2.3, LOCK, 7.0), Fast(command="steering"), dt_max)
    assert over > 80.0
    assert twists[:, 0].max() > 2.0


def test_a_slalom_from_lock_to_lock_at_top_speed_does_not_tip_it():
    commands = np.concatenate([hold(2.0, s * LOCK, 2.0) for s in (0, 1, -1, 1, -1)])
    _, _, tilt = run(commands, TamiyaTXT1(command="steering"), pose=(-10.0, 0.0, 0.0))
    assert tilt < 6.0


@pytest.mark.parametrize("side", ["both", "left"])
@pytest.mark.parametrize("speed", [0.4, 1.0, 2.0])
def test_it_drives_over_a_plank(speed, side):
    """3 cm high and 10 cm wide, under both wheels of an axle or one."""

    def with_plank(poses, platform):
        world, robots = trucks(poses, platform)
        world.add_box(1.0, 0.0 if side == "both" else 0.52, 0.1, 1.0, height=0.03)
        return world, robots

    seconds = 4.0 / speed + speed + 1.0
    poses, twists, tilt = run(
        hold(speed, 0.0, seconds), TamiyaTXT1(), pose=(-2.0, 0.0, 0.0), world_of=with_plank
    )
    assert poses[-1, 0] > 2.0
    assert 3.0 < tilt < 15.0
    assert abs(poses[-1, 1]) < 0.1
    assert twists[-1, 0] == pytest.approx(speed, rel=0.01)


def test_the_springs_keep_all_wheels_on_uneven_ground():
    """One wheel on a 3 cm plate: every tyre still carries, the axles twist."""
    world, robots = trucks([[0.0, 0.0, 0.0]])
    world.add_box(0.31, 0.14, 0.12, 0.12, height=0.03)
    world.overlap = True
    simulation = Simulation(world, control_period=PERIOD)
    drive(simulation, robots, np.zeros((30, 2)))
    model, data = simulation.model, simulation.data
    loads, force = {}, np.zeros(6)
    for k, pair in enumerate(data.contact.geom):
        (tread,) = [n for n in (model.geom(g).name for g in pair) if "tread" in n]
        mujoco.mj_contactForce(model, data, k, force)
        loads[tread] = loads.get(tread, 0.0) + force[0]
    assert len(loads) == 4
    assert min(loads.values()) > 2.0
    twist = data.joint(f"{NAME}roll_front").qpos[0] - data.joint(f"{NAME}roll_rear").qpos[0]
    assert math.degrees(twist) > 2.0


def test_no_wheel_leaves_the_flat_floor():
    world, robots = trucks([[-8.0, -8.0, 0.6]])
    simulation = Simulation(world, control_period=PERIOD)
    treads = [
        simulation.model.geom(f"{NAME}tread_{end}_{side}").id
        for end in ("front", "rear")
        for side in ("left", "right")
    ]
    touching = []
    simulation.watch_steps(
        lambda: touching.append(np.isin(treads, simulation.data.contact.geom).all())
    )
    drive(simulation, robots, changes(2))
    assert np.all(touching)


@pytest.mark.parametrize("dt_max", TIMESTEPS)
def test_top_speed_and_an_emergency_stop_from_it(dt_max):
    """2 m/s after 2 s; "dead" brakes at 3 m/s^2."""
    world, robots = trucks([[-8.0, 0.0, 0.0]])
    robots.faults.add(Fault(kind="dead", robot=0, start=4.0))
    simulation = Simulation(world, control_period=PERIOD, dt_max=dt_max)
    poses, twists, tilt = drive(simulation, robots, hold(2.0, 0.0, 6.0))
    assert twists[10, 0, 0] == pytest.approx(1.0, rel=0.01)
    assert twists[35, 0, 0] == pytest.approx(2.0, rel=0.002)
    assert poses[40, 0, 0] == pytest.approx(-8.0 + 6.0, abs=0.015)
    assert np.abs(poses[:, 0, 1]).max() < 2e-3
    assert np.abs(twists[-1]).max() < 0.01
    assert tilt < 3.0
    # v^2 / 2 a = 0.667 m
    assert poses[-1, 0, 0] - poses[40, 0, 0] == pytest.approx(0.667, rel=0.05)


def test_it_drives_backwards_with_steering_commands():
    poses, _, _ = run(hold(-1.0, 0.3, 5.0), TamiyaTXT1(command="steering"))
    assert fitted_radius(poses[25:, :2]) == pytest.approx(0.31 / math.tan(0.3), rel=0.02)
    # the way back of a left turn turns it to the right
    assert np.unwrap(poses[:, 2])[-1] < -2.0


def test_only_contact_moves_it():
    def ice(spec):
        for geom in spec.geoms:
            if "tread" in geom.name:
                geom.friction[0] = 1e-5

    world, robots = trucks([[0.0, 0.0, 0.0]])
    world.edit(ice)
    simulation = Simulation(world, control_period=PERIOD)
    poses, _, _ = drive(simulation, robots, hold(0.5, 0.0, 2.0))
    assert np.abs(poses[:, 0, :2]).max() < 0.01
    assert simulation.wheel_angles_of(robots).min() > 5.0


@pytest.mark.parametrize(("command", "row"), [("unicycle", [0.8, 0.25]), ("steering", [0.8, 0.2])])
def test_both_simulations_agree(command, row):
    ends = []
    for kind in BOTH:
        world, robots = trucks([[0.0, -1.0, 0.4]], TamiyaTXT1(command=command))
        simulation = kind(world, control_period=PERIOD)
        commands = np.concatenate([hold(*row, 4.0), hold(0.0, 0.0, 2.0)])
        poses, _, _ = drive(simulation, robots, commands)
        ends.append((poses[-1, 0], simulation.wheel_angles_of(robots)[0]))
    np.testing.assert_allclose(ends[0][0], ends[1][0], atol=0.02)
    np.testing.assert_allclose(ends[0][1], ends[1][1], rtol=0.003)


@pytest.mark.parametrize("kind", BOTH)
def test_the_rear_wheels_are_enough_for_odometry(kind):
    """Four sides and corners, 24 m, by the differential drive's formulas: within 3 cm."""
    world, robots = trucks([[-4.0, -4.0, 0.0]])
    simulation = kind(world, control_period=PERIOD)
    encoders = robots.encoders
    odometry = Odometry(
        robots.start,
        radius=TamiyaTXT1.rolling_radius,
        track=TamiyaTXT1.track,
        counts_per_turn=encoders.counts_per_turn,
    )
    commands = np.concatenate([hold(0.8, 0.0, 5.0), hold(0.4, 0.3, 5.2)] * 4)
    truth = []
    simulation.observe(lambda: truth.append(simulation.truth.poses(robots)[0]))
    for k, _ in enumerate(simulation.ticks(len(commands) * PERIOD)):
        robots.drive([commands[k]])
        error = odometry.step(encoders.read())[0] - truth[-1]
        assert np.hypot(*error[:2]) < 0.03
        assert abs(np.degrees((error[2] + np.pi) % (2 * np.pi) - np.pi)) < 0.5
    assert np.hypot(*np.diff(np.array(truth)[:, :2], axis=0).T).sum() > 20.0


@pytest.mark.parametrize("kind", BOTH)
def test_same_bits_and_a_snapshot_goes_on(kind):
    def build():
        world, robots = trucks([[-2.0, 0.5, 0.3], [-0.8, 0.5, -2.0]])
        return kind(world, seed=3, control_period=PERIOD), robots

    def go(simulation, robots, offset):
        angle = 0.3 * (np.arange(15) + offset)
        commands = np.column_stack([1.0 + np.cos(angle), np.sin(2 * angle)])
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


def test_commands_are_cut_to_what_speed_control_and_steering_can_do():
    world, robots = trucks([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [4.0, 0.0, 0.0]])
    KinematicSimulation(world, control_period=PERIOD)
    robots.drive([[3.0, 0.2], [1.0, -0.5], [0.0, 0.0]])
    np.testing.assert_allclose(robots.command, [[1.998, 0.2], [1.0, -0.3], [0.0, 0.0]])
    # it cannot turn on the spot, nor sharper than its lock, nor go back as a unicycle
    robots.drive([[0.0, 0.3], [0.1, 0.3], [-1.0, 0.1]])
    turn = 0.1 * math.tan(LOCK) / 0.31
    np.testing.assert_allclose(robots.command, [[0.0, 0.0], [0.1, turn], [0.0, 0.0]])
    np.testing.assert_array_equal(robots.clamped, [2, 2, 1])
    with pytest.raises(InvalidInputError, match="tamiya_txt11"):
        robots.drive([[0.0, 0.0], [np.nan, 0.0], [0.0, 0.0]])
    world, robots = trucks([[0.0, 0.0, 0.0]], TamiyaTXT1(command="steering"))
    KinematicSimulation(world, control_period=PERIOD)
    with pytest.raises(InvalidInputError, match=r"\(1, 2\) \(forward, steering\)"):
        robots.drive(np.zeros((1, 3)))
    robots.drive([[-3.0, 0.7]])
    np.testing.assert_allclose(robots.command, [[-2.0, LOCK]])


def test_bad_options_are_refused():
    with pytest.raises(UnknownNameError, match="unicycle"):
        TamiyaTXT1(command="twist")
    with pytest.raises(InvalidInputError, match="acceleration of TamiyaTXT1"):
        TamiyaTXT1(acceleration=0.0)


@pytest.mark.parametrize("command", ["unicycle", "steering"])
def test_an_emergency_stop_keeps_the_curvature(command):
    platform = TamiyaTXT1(command=command)
    now = np.array([[1.0, 0.25], [0.5, -0.2], [0.0, 0.0]])
    slower = platform.brake(now, 0.1)
    np.testing.assert_allclose(slower[:, 0], [0.7, 0.2, 0.0])
    before, after = platform.twist_of(now)[:2], platform.twist_of(slower)[:2]
    np.testing.assert_allclose(after[:, 2] / after[:, 0], before[:, 2] / before[:, 0])
    assert not platform.twist_of(platform.brake(slower, 10.0)).any()


def test_the_steering_takes_its_time():
    """28 degrees at 60 degrees/s; the servo's set point, the knuckles behind it."""
    world, robots = trucks([[0.0, 0.0, 0.0]], TamiyaTXT1(command="steering"))
    simulation = Simulation(world, control_period=PERIOD)
    angles = []
    simulation.watch_steps(lambda: angles.append(simulation.data.joint(f"{NAME}steer").qpos[0]))
    drive(simulation, robots, hold(0.0, LOCK, 1.0))
    rates = np.diff(angles) / simulation.timestep
    assert rates.max() < 1.1 * TamiyaTXT1.steering_rate
    times = simulation.timestep * np.arange(1, len(angles) + 1)
    assert 0.4 < times[np.argmax(np.array(angles) > 0.95 * LOCK)] < 0.5
    assert angles[-1] == pytest.approx(LOCK, abs=0.002)


def test_the_camera_turns_left_and_down():
    world, robots = trucks([[0.0, 0.0, 0.0]])
    robots.mount(Camera(at="camera", width=32, height=24), "eye")
    simulation = Simulation(world, control_period=PERIOD)
    model, data = simulation.model, simulation.data

    def look(pan, tilt):
        data.ctrl[model.actuator(f"{NAME}pan").id] = pan
        data.ctrl[model.actuator(f"{NAME}tilt").id] = tilt
        for _ in simulation.ticks(1.0):
            pass
        return -data.cam_xmat[model.camera(f"{NAME}camera").id].reshape(3, 3)[:, 2]

    np.testing.assert_allclose(look(0.0, 0.0), [1, 0, 0], atol=0.01)
    down = math.radians(-33.0)
    left = math.radians(51.0)
    expected = [math.cos(down) * math.cos(left), math.cos(down) * math.sin(left), math.sin(down)]
    np.testing.assert_allclose(look(left, down), expected, atol=0.01)


def test_it_shares_the_floor_with_many():
    """30 robots: each is placed at rest, whoever else is in the model."""
    xy = np.stack(np.meshgrid(np.arange(6), np.arange(5)), axis=-1).reshape(-1, 2) * 2.0 - 5.0
    poses = np.column_stack([xy, np.linspace(-3.0, 3.0, 30)])
    world, robots = trucks(poses)
    simulation = Simulation(world, control_period=PERIOD)
    seen, twists, _ = drive(simulation, robots, hold(0.5, 0.2, 1.0))
    assert np.abs(seen[0] - poses).max() < 1e-9
    np.testing.assert_allclose(twists[-1, :, 0], 0.5, rtol=0.02)
