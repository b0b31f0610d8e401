"""The loop, the SoccerBot's drive and what both simulations promise alike."""

import mujoco
import numpy as np
import pytest

from mjmr.errors import InvalidInputError, SimulationDivergedError, TruthError
from mjmr.faults import Fault
from mjmr.geometry import rotate
from mjmr.kinematics import KinematicSimulation
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.sensors import (
    IMU,
    Bumper,
    Camera,
    Compass,
    Lidar,
    LineOfSight,
    Localizer,
    PanTilt,
    WheelEncoders,
)
from mjmr.simulation import Simulation
from mjmr.world import World
from tests.mjmr.worlds import BOTH, drive, ramp, soccer

POSES = [[-2.0, 0.5, 0.3], [-1.5, -1.0, -2.0], [0.5, 1.0, 1.0]]


@pytest.mark.parametrize("dt_max", [0.001, 0.002, 0.005])
def test_planar_drive_covers_the_commanded_ramp(dt_max):
    """2 m/s at 3 m/s^2 up and 6 down: 0.667 + 0.6 + 0.333 m, at any timestep, to 0.1 mm."""
    world, robots = soccer([[-2.0, 0.0, 0.0]])
    poses, twists = drive(Simulation(world, dt_max=dt_max), robots, ramp(2.0))
    speeds = np.concatenate([[0.0], ramp(2.0)[:, 0]])
    expected = ((speeds[1:] + speeds[:-1]) / 2 / 60).sum()
    assert poses[-1, 0, 0] + 2.0 == pytest.approx(expected, abs=1e-4)
    assert np.abs(poses[:, 0, 1:]).max() < 1e-9
    slope = np.diff(twists[:, 0, 0]) * 60
    assert slope.max() == pytest.approx(3.0, rel=0.05)
    assert slope.min() == pytest.approx(-6.0, rel=0.05)


def test_planar_drive_is_limited_by_force():
    """A jump to 2 m/s: 25 N on 2.5 kg is 10 m/s^2, whatever was commanded."""
    world, robots = soccer([[-2.0, 0.0, 0.0]])
    _, twists = drive(Simulation(world), robots, np.tile([2.0, 0.0, 0.0], (30, 1)))
    slope = np.diff(twists[:, 0, 0]) * 60
    assert slope.max() == pytest.approx(10.0, rel=0.02)
    assert twists[-1, 0, 0] == pytest.approx(2.0, abs=1e-3)


@pytest.mark.parametrize("kind", BOTH)
def test_a_circle_closes(kind):
    """1 m/s forward at 1 rad/s: a circle of 1 m radius; both simulations, to 2 mm."""
    world, robots = soccer([[0.0, -1.0, 0.0]])
    simulation = kind(world)
    turns = round(2 * np.pi * 60)
    up = np.linspace(1 / 20, 1, 20)
    commands = np.concatenate(
        [np.column_stack([up, 0 * up, up]), np.tile([1.0, 0.0, 1.0], (turns + 60, 1))]
    )
    poses, _ = drive(simulation, robots, commands)
    a, b = poses[40, 0], poses[40 + turns, 0]
    assert np.hypot(*(a - b)[:2]) < 3e-3
    centre = a[:2] + rotate([0.0, 1.0], a[2])
    radii = np.hypot(*(poses[40:, 0, :2] - centre).T)
    assert np.abs(radii - 1.0).max() < 2e-3


def test_both_simulations_agree_on_a_winding_path():
    rng = np.random.default_rng(0)
    steps = rng.uniform(-1, 1, (90, 3, 3)) * [0.05, 0.05, 0.1]
    commands = np.cumsum(steps, axis=0)
    found = []
    for kind in BOTH:
        world, robots = soccer(POSES)
        found.append(drive(kind(world), robots, commands)[0])
    assert np.abs(found[0] - found[1])[..., :2].max() < 1.5e-3
    assert np.abs(found[0] - found[1])[..., 2].max() < 5e-3


def test_kinematic_turning_is_exact():
    """Against integration in 20,000 small steps."""
    world, robots = soccer([[0.0, 0.0, 0.4]])
    commands = np.array([[0.5, 0.2, 3.0], [1.0, -0.4, -2.0], [0.2, 0.9, 6.0]])
    poses, _ = drive(KinematicSimulation(world), robots, commands)
    pose, twist = np.array([0.0, 0.0, 0.4]), np.zeros(3)
    n = 20_000
    for target in commands:
        for k in range(n):
            middle = twist + (target - twist) * (k + 0.5) / n
            half = pose[2] + 0.5 * middle[2] / 60 / n
            pose[:2] += rotate(middle[:2], half) / 60 / n
            pose[2] += middle[2] / 60 / n
        twist = target
    np.testing.assert_allclose(poses[-1, 0], pose, atol=1e-9)


@pytest.mark.parametrize("kind", BOTH)
def test_truth_is_shut_while_a_controller_is_to_act(kind):
    world, robots = soccer(POSES)
    simulation = kind(world)
    simulation.truth.poses(robots)
    for _ in simulation.ticks(1 / 60):
        for read in (simulation.truth.poses, simulation.truth.twists):
            with pytest.raises(TruthError, match="controller"):
                read(robots)
        with pytest.raises(TruthError, match="controller"):
            simulation.truth.movers()
    simulation.truth.poses(robots)


@pytest.mark.parametrize("kind", BOTH)
def test_a_loop_left_early_opens_truth_again(kind):
    world, robots = soccer(POSES)
    simulation = kind(world)
    for _ in simulation.ticks(1.0):
        break
    assert simulation.truth.poses(robots).shape == (3, 3)


@pytest.mark.parametrize("kind", BOTH)
def test_same_seed_same_bits_while_global_randomness_is_stirred(kind):
    def run(stir):
        world, robots = soccer(POSES)
        robots.localizer.position_noise = 0.003
        simulation = kind(world, seed=5)
        rng = simulation.rng("commands")
        seen = []
        for _ in simulation.ticks(1.0):
            if stir:
                np.random.seed(len(seen))  # noqa: NPY002
                np.random.random(3)  # noqa: NPY002
            seen.append(robots.localizer.read().copy())
            robots.drive(rng.uniform(-1, 1, (3, 3)))
        return np.array(seen), simulation.truth.poses(robots)

    for a, b in zip(run(False), run(True), strict=True):
        assert a.tobytes() == b.tobytes()


@pytest.mark.parametrize("kind", BOTH)
def test_a_restored_snapshot_goes_on_bit_for_bit(kind):
    def build():
        world, robots = soccer(POSES, command_latency=2)
        world.add_golf_ball(-1.8, 0.55)
        robots.localizer.position_noise = 0.002
        robots.localizer.latency = 0.03
        robots.faults.add(Fault(kind="commands-lost", robot=1, start=0.3, end=0.7))
        return kind(world, seed=3), robots

    def go(simulation, robots, offset):
        seen = []
        for k, _ in enumerate(simulation.ticks(0.5)):
            seen.append(robots.localizer.read().copy())
            a = 0.1 * (k + offset)
            robots.drive(np.tile([np.cos(a), 0.5 * np.sin(a), 0.4], (3, 1)))
        return np.array(seen), simulation.truth.poses(robots), simulation.truth.twists(robots)

    simulation, robots = build()
    go(simulation, robots, 0)
    snapshot = simulation.snapshot()
    once = go(simulation, robots, 30)
    simulation.restore(snapshot)
    again = go(simulation, robots, 30)
    fresh, other_robots = build()
    fresh.restore(snapshot)
    elsewhere = go(fresh, other_robots, 30)
    for a, b, c in zip(once, again, elsewhere, strict=True):
        assert a.tobytes() == b.tobytes() == c.tobytes()


@pytest.mark.parametrize("kind", BOTH)
def test_command_latency_delays_by_whole_cycles(kind):
    found = []
    for latency in (0, 2):
        world, robots = soccer([[-2.0, 0.0, 0.0]], command_latency=latency)
        poses, _ = drive(kind(world), robots, ramp(1.0))
        found.append(poses[:, 0, 0])
    np.testing.assert_allclose(found[1][2:], found[0][:-2], atol=1e-12)


@pytest.mark.parametrize("kind", BOTH)
def test_a_dead_robot_brakes_at_its_bound_and_stays(kind):
    world, robots = soccer([[-2.0, 0.5, 0.0], [-2.0, -0.5, 0.0]])
    robots.faults.add(Fault(kind="dead", robot=1, start=0.5))
    up = np.minimum(np.arange(1, 91) * 0.05, 1.5)
    poses, twists = drive(kind(world), robots, np.column_stack([up, 0 * up, 0 * up]))
    assert poses[-1, 0, 0] > poses[-1, 1, 0] + 0.5
    assert np.abs(twists[-1, 1]).max() < 1e-6
    slope = np.diff(twists[31:40, 1, 0]) * 60
    assert slope[0] == pytest.approx(-6.0, rel=0.1)
    assert robots.executed[1] == pytest.approx([0, 0, 0])


@pytest.mark.parametrize("kind", BOTH)
def test_a_robot_out_of_radio_moves_again(kind):
    world, robots = soccer([[-2.0, 0.0, 0.0]])
    robots.faults.add(Fault(kind="commands-lost", robot=0, start=0.5, end=0.8))
    _, twists = drive(kind(world), robots, np.tile([0.5, 0.0, 0.0], (90, 1)))
    speed = twists[:, 0, 0]
    assert abs(speed[45]) < 1e-6
    assert speed[70] == pytest.approx(0.5, abs=1e-6)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_command_that_is_not_finite_is_refused_with_the_robots_name(bad):
    _, robots = soccer(POSES)
    command = np.zeros((3, 3))
    command[1, 2] = bad
    with pytest.raises(InvalidInputError, match="soccer_bot1"):
        robots.drive(command)
    with pytest.raises(InvalidInputError, match=r"\(3, 3\)"):
        robots.drive(np.zeros((2, 3)))


def test_commands_over_the_limits_are_scaled_and_counted():
    world, robots = soccer(POSES)
    Simulation(world)
    robots.drive([[6.0, 8.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -50.0]])
    start, target = robots.next_ramp(0.0, 1 / 60)
    np.testing.assert_allclose(target, [[1.8, 2.4, 0], [1, 0, 0], [0, 0, -12.0]])
    assert not start.any()
    assert robots.clamped.tolist() == [1, 0, 1]


def test_arrays_handed_out_are_no_alias_of_the_state():
    world, robots = soccer(POSES)
    simulation = Simulation(world)
    poses = simulation.truth.poses(robots)
    poses += 5.0
    assert np.abs(simulation.truth.poses(robots) - np.array(POSES)).max() < 1e-12
    with pytest.raises(ValueError, match="read-only"):
        robots.executed[0, 0] = 1.0


def test_divergence_stops_the_run_and_brings_snapshots():
    world, robots = soccer(POSES)
    world.add_golf_ball(0.0, 0.0)
    simulation = Simulation(world)

    def explode():
        for t in simulation.ticks(2.0):
            robots.drive(np.zeros((3, 3)))
            if t > 1.0:
                simulation.data.qvel[-6:] = 1e12

    with pytest.raises(SimulationDivergedError, match=r"t = \d") as caught:
        explode()
    assert len(caught.value.snapshots) >= 9
    span = caught.value.snapshots[-1].time - caught.value.snapshots[0].time
    assert 0.8 < span < 1.1


def test_an_adopted_pair_is_shared_not_copied():
    world, robots = soccer(POSES)
    spec = world.spec()
    spec.option.timestep = 1 / 240
    model = spec.compile()
    data = mujoco.MjData(model)
    simulation = Simulation(world, model=model, data=data)
    for _ in simulation.ticks(0.1):
        robots.drive(np.tile([1.0, 0, 0], (3, 1)))
    assert data.time == pytest.approx(0.1)
    assert simulation.data is data
    reference_world, reference_robots = soccer(POSES)
    reference = Simulation(reference_world)
    for _ in reference.ticks(0.1):
        reference_robots.drive(np.tile([1.0, 0, 0], (3, 1)))
    assert data.qpos.tobytes() == reference.data.qpos.tobytes()
    spec.option.timestep = 0.007
    odd = spec.compile()
    with pytest.raises(InvalidInputError, match="divide"):
        Simulation(world, model=odd, data=mujoco.MjData(odd))
    with pytest.raises(InvalidInputError, match="both"):
        Simulation(world, model=model)


def test_the_timestep_divides_the_control_period():
    world, _ = soccer(POSES)
    simulation = Simulation(world, control_period=1 / 60, dt_max=0.005)
    assert simulation.substeps == 4
    assert simulation.model.opt.timestep == pytest.approx(1 / 240)
    world, robots = soccer(POSES)
    robots.mount(Localizer(rate=10.0))
    assert KinematicSimulation(world, control_period=0.1, dt_max=0.1).substeps == 1


def test_every_model_survives_halton_noise_without_a_warning():
    """1 s of quasi-random control on all actuators."""
    from scipy.stats import qmc

    world, _ = soccer(POSES)
    world.add_golf_ball(0.0, 0.3)
    world.add_box(1.0, -1.0, 0.3, 0.2, mass=1.0)
    world.add_box(-1.0, 1.5, 0.3, 0.2)
    model = world.spec().compile()
    data = mujoco.MjData(model)
    noise = qmc.Halton(model.nu, seed=0).random(round(1.0 / model.opt.timestep))
    for row in noise:
        data.ctrl[:] = 20.0 * (row - 0.5)
        mujoco.mj_step(model, data)
    assert data.warning.number.sum() == 0
    assert np.isfinite(data.qpos).all()


def test_a_home_keyframe_comes_with_the_asset():
    from mjmr.assets import model_path

    model = mujoco.MjModel.from_xml_path(str(model_path("soccer_bot")))
    assert model.key("home").qpos.tolist() == [0, 0, 0]
    assert model.body("base").mass[0] == 2.5


def test_the_compiled_hull_has_the_platforms_dimensions():
    world, _ = soccer(POSES)
    model = world.spec().compile()
    hull = model.geom("soccer_bot0/hull")
    assert hull.size[0] == SoccerBot.radius
    assert hull.pos[2] + hull.size[1] == pytest.approx(SoccerBot.height)


def test_a_ball_rolls_to_a_stop_and_bounces_off_the_wall():
    world, _ = soccer([[-2.0, -1.5, 0.0]])
    world.add_golf_ball(1.5, 0.0)
    simulation = Simulation(world)
    start = simulation.model.joint("ball0").dofadr[0]
    simulation.data.qvel[start] = 3.0
    track = []
    simulation.observe(lambda: track.append(simulation.truth.movers()[0, :3]))
    for _ in simulation.ticks(10.0):
        pass
    track = np.array(track)
    # it may sink into the wall by what it travels in one step, 3 m/s x 4.2 ms, not more
    assert track[:, 0].max() - (world.bounds[2] - 0.02135) < 3.0 * simulation.timestep
    assert track[-1, 0] < track[:, 0].max() - 0.1
    assert track[:, 2].min() > 0.02135 - 2e-3
    assert track[-1, 2] == pytest.approx(0.02135, abs=1e-4)
    assert np.abs(track[-1] - track[-30]).max() < 1e-3


def test_a_robot_pushes_a_box_by_contact_and_a_wall_holds_it():
    # a short way: a round robot cannot push a box far before it turns away
    world, robots = soccer([[1.8, 0.0, 0.0]])
    world.add_box(2.2, 0.0, 0.2, 0.2, mass=0.5)
    simulation = Simulation(world)
    for _ in simulation.ticks(3.0):
        robots.drive([[0.5, 0.0, 0.0]])
    pose = simulation.truth.poses(robots)[0]
    box = simulation.truth.movers()[0]
    assert box[0] > 2.6
    assert box[0] + 0.1 < world.bounds[2] + 0.005
    assert pose[0] < box[0] - 0.1 - SoccerBot.radius + 0.005
    # 25 N squeeze it between the hull and a lower wall: it tips a little and does not climb
    assert box[2] == pytest.approx(0.15, abs=0.01)


def test_worlds_say_what_is_wrong():
    with pytest.raises(InvalidInputError, match="outside the walls"):
        soccer([[9.0, 0.0, 0.0]])
    with pytest.raises(InvalidInputError, match=r"\(n, 3\)"):
        soccer([[0.0, 0.0]])
    with pytest.raises(InvalidInputError, match="finite"):
        soccer([[np.nan, 0.0, 0.0]])
    with pytest.raises(InvalidInputError, match="valid: carpet"):
        World(bounds=[0, 0, 1, 1], floor="carpets")
    with pytest.raises(InvalidInputError, match="xmin < xmax"):
        World(bounds=[1, 0, 0, 1])
    with pytest.raises(InvalidInputError, match="no robots"):
        Simulation(World(bounds=[0, 0, 1, 1]))
    with pytest.raises(InvalidInputError, match="dead"):
        Fault(kind="ded", robot=0, start=0.0)
    with pytest.raises(InvalidInputError, match="0 to 2"):
        soccer(POSES)[1].faults.add(Fault(kind="dead", robot=3, start=0.0))


def test_two_groups_share_a_world():
    world, yellow = soccer([[-1.0, 0.0, 0.0]])
    blue = world.add_group(SoccerBot, [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0]], team="blue")
    for kind in BOTH:
        simulation = kind(world)
        for _ in simulation.ticks(0.5):
            yellow.drive([[0.4, 0.0, 0.0]])
            blue.drive([[-0.4, 0.0, 0.0], [0.0, 0.4, 0.0]])
        assert simulation.truth.poses(yellow)[0, 0] > -0.9
        assert simulation.truth.poses(blue)[0, 0] < 0.9
        assert simulation.truth.poses(blue)[1, 1] > 1.1
        assert simulation.team.n == 3


def test_turning_for_ever_is_no_divergence():
    world, robots = soccer([[0.0, 0.0, 0.0]])
    simulation = Simulation(world)
    for _ in simulation.ticks(15.0):
        robots.drive([[0.0, 0.0, 12.0]])
    assert np.abs(simulation.data.qpos).max() > 100.0
    assert -np.pi < simulation.truth.poses(robots)[0, 2] <= np.pi


def test_a_snapshot_leads_out_of_a_divergence():
    world, robots = soccer(POSES)
    world.add_golf_ball(0.0, 0.0)
    simulation = Simulation(world)
    for _ in simulation.ticks(0.5):
        robots.drive(np.zeros((3, 3)))
    good = simulation.snapshot()
    simulation.data.qvel[-6:] = 1e12

    def go(seconds):
        for _ in simulation.ticks(seconds):
            robots.drive(np.zeros((3, 3)))

    with pytest.raises(SimulationDivergedError):
        go(0.1)
    simulation.restore(good)
    go(0.5)
    assert simulation.time == pytest.approx(1.0)


def test_exported_mjcf_starts_where_the_robots_start():
    world, robots = soccer(POSES)
    world.add_golf_ball(0.3, 0.2)
    model = mujoco.MjModel.from_xml_string(world.to_xml())
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    mujoco.mj_forward(model, data)
    reference = Simulation(world)
    assert model.opt.timestep == pytest.approx(reference.model.opt.timestep)
    np.testing.assert_allclose(model.jnt_actfrcrange, reference.model.jnt_actfrcrange, rtol=1e-5)
    for i, pose in enumerate(POSES):
        found = data.body(f"soccer_bot{i}/base")
        np.testing.assert_allclose(found.xpos[:2], pose[:2], atol=1e-5)


def test_a_dead_robot_never_acknowledges_and_one_out_of_radio_does_again():
    world, robots = soccer(POSES)
    robots.faults.add(Fault(kind="dead", robot=0, start=0.5))
    robots.faults.add(Fault(kind="commands-lost", robot=1, start=0.5, end=1.0))
    heard = []
    for _ in KinematicSimulation(world).ticks(1.5):
        heard.append(robots.acknowledged.copy())
        robots.drive(np.tile([0.3, 0.0, 0.0], (3, 1)))
    heard = np.array(heard)
    np.testing.assert_array_equal(np.flatnonzero(~heard[:, 0]), np.arange(31, 90))
    np.testing.assert_array_equal(np.flatnonzero(~heard[:, 1]), np.arange(31, 61))
    assert heard[:, 2].all()


def test_a_world_serves_one_simulation_at_a_time():
    world, _ = soccer(POSES)
    first = KinematicSimulation(world)
    KinematicSimulation(world)
    with pytest.raises(InvalidInputError, match="another simulation"):
        next(first.ticks(1.0))


def test_a_sensor_has_one_group():
    world, robots = soccer([[-1.0, 0.0, 0.0]])
    others = world.add_group(SoccerBot, [[1.0, 0.0, 0.0]])
    eye = Localizer()
    robots.mount(eye)
    with pytest.raises(InvalidInputError, match="on group .soccer_bot. already"):
        others.mount(eye)


@pytest.mark.parametrize("duration", [-1.0, np.nan, np.inf])
def test_bad_durations_are_refused(duration):
    world, _ = soccer(POSES)
    with pytest.raises(InvalidInputError, match="duration"):
        next(KinematicSimulation(world).ticks(duration))
    with pytest.raises(InvalidInputError, match="seed"):
        KinematicSimulation(world, seed=-1)


def test_observers_see_the_start_once():
    world, _ = soccer(POSES)
    simulation = KinematicSimulation(world)
    seen = []
    simulation.observe(lambda: seen.append(simulation.time))
    for seconds in (0.0, 0.1, 0.1):
        for _ in simulation.ticks(seconds):
            pass
    np.testing.assert_allclose(seen, np.arange(13) / 60)


@pytest.mark.parametrize("kind", BOTH)
def test_a_snapshot_from_before_the_start_has_the_first_samples_again(kind):
    world, robots = soccer([[0.0, 0.0, 0.0]])
    simulation = kind(world, seed=1)
    snapshot = simulation.snapshot()
    runs = []
    for _ in range(2):
        runs.append([robots.localizer.read().copy() for _ in simulation.ticks(0.1)])
        simulation.restore(snapshot)
    assert np.isfinite(runs[0][0]).all()
    np.testing.assert_array_equal(runs[0], runs[1])


def test_a_mount_that_was_refused_leaves_nothing_behind():
    world, robots = soccer([[0.0, 0.0, 0.0]])
    others = world.add_group(SoccerBot, [[1.0, 0.0, 0.0]])
    robots.mount(Compass())
    spare = Compass()
    with pytest.raises(InvalidInputError, match="already"):
        robots.mount(spare)
    others.mount(spare)
    with pytest.raises(InvalidInputError, match="mounted on group 'soccer_bot_1_' already"):
        others.mount(spare, "twin")
    for name in ("n", "start", "drive", "command", "sensors"):
        with pytest.raises(InvalidInputError, match="attribute that every group has"):
            robots.mount(Compass(), name)
    assert list(robots.sensors) == ["localizer", "compass"]


def test_robots_have_names_that_are_nobody_elses():
    """Shapes are told apart by them: a robot called box0 would be taken for the box."""
    world, _ = soccer([[-2.0 + 0.35 * k, 1.0, 0.0] for k in range(11)], name="r")
    with pytest.raises(InvalidInputError, match="robots named r10 already"):
        world.add_group(SoccerBot, [[0.0, 0.0, 0.0]], name="r1")
    for name in ("box", "ball1", "cart", "a/b", ""):
        with pytest.raises(InvalidInputError, match="a group's name"):
            world.add_group(SoccerBot, [[0.0, 0.0, 0.0]], name=name)
    world.add_group(SoccerBot, [[0.0, 0.0, 0.0]], name="boxer")
    assert [group.name for group in world.groups] == ["r", "boxer"]


def test_what_stands_in_the_world_needs_no_robot():
    world, robots = soccer([[0.0, 0.0, 0.0]])
    for sensor in (Compass(), Localizer(), Lidar(), IMU(), Bumper(), WheelEncoders(), PanTilt()):
        with pytest.raises(InvalidInputError, match="is mounted on robots"):
            world.mount(sensor)
    with pytest.raises(InvalidInputError, match="is mounted already"):
        world.mount(robots.mount(LineOfSight()))
    above, middle = (0.0, 0.0, 2.0), (0.0, 0.0, 0.0)
    world.add_camera(Camera(), position=above, look_at=middle)
    spare = Camera()
    with pytest.raises(InvalidInputError, match="named 'camera'"):
        world.add_camera(spare, position=above, look_at=middle)
    world.add_camera(spare, position=above, look_at=middle, name="spare")
    assert list(world.sensors) == ["camera", "spare"]


def test_starts_that_are_refused_change_nothing():
    world, robots = soccer(POSES)
    others = world.add_group(SoccerBot, [[1.5, 0.0, 0.0]], name="others")
    with pytest.raises(InvalidInputError, match="outside the walls"):
        world.start_at({"soccer_bot": np.array(POSES) + 0.1, "others": [[9.0, 0.0, 0.0]]})
    np.testing.assert_array_equal(robots.start, POSES)
    np.testing.assert_array_equal(others.start, [[1.5, 0.0, 0.0]])
