"""NIMS: a carriage on a cable, on a curve or between two tendons, with a package on a winch."""

import re

import mujoco
import numpy as np
import pytest
from scipy.stats import qmc

import mjmr.robots.cable_drive
from controllers.motion.swing_free import swing_free
from controllers.motion.trapezoid import Limits, profile
from mjmr.assets import asset_folder, model_path
from mjmr.errors import InvalidInputError, SimulationDivergedError, UnknownNameError
from mjmr.faults import Fault
from mjmr.kinematics import KinematicSimulation
from mjmr.robots.cable_drive import FRAME
from mjmr.robots.nims import Nims
from mjmr.robots.pioneer2dx import Pioneer2DX
from mjmr.sensors.cable_tension import CableTension
from mjmr.sensors.camera import Camera
from mjmr.simulation import Simulation
from mjmr.world import World
from tests.mjmr.worlds import BOTH

PERIOD = 0.1
BOUNDS = {"lab": [-4, -2, 4, 2], "field": [-38, -4, 38, 4]}
WAY = {"lab": 4.0, "field": 20.0}
VARIANTS = [(size, cable) for size in ("lab", "field") for cable in ("curve", "tendon")]
variants = pytest.mark.parametrize(("size", "cable"), VARIANTS)


def rig(size="lab", cable="curve", dt_max=0.01, period=PERIOD, change=None, **options):
    """One rig in the middle of its world; returns (platform, group, simulation)."""
    platform = Nims(size=size, cable=cable, **options)
    world = World(bounds=BOUNDS[size], overlap=True)
    group = world.add_group(platform, [[0.0, 0.0, 0.0]])
    if change is not None:
        change(world)
    return platform, group, Simulation(world, control_period=period, dt_max=dt_max)


def watch(simulation):
    """Rows (along, lift, swing, sway, line) at every physics step to come."""
    rows = []
    simulation.watch_steps(lambda: rows.append(simulation.data.qpos[:5].copy()))
    return rows


def off_curve(platform, rows):
    """How far rows of :func:`watch` are above the curve [m]."""
    return rows[:, 1] - platform.cable.sag * (rows[:, 0] / (platform.cable.span / 2)) ** 2


def move(size, cable, speed, dt_max=0.01, settle=15.0):
    """A swing-free move over WAY; returns platform, every step's rows and the step of arrival."""
    way = WAY[size]
    platform, group, simulation = rig(size, cable, dt_max, along=-way / 2)
    plan = swing_free(way, speed, platform.swing_period(platform.line))
    ticks = int(np.ceil(plan.duration / PERIOD))
    rows = watch(simulation)
    for k, _ in enumerate(simulation.ticks(ticks * PERIOD + settle)):
        group.drive([[plan.velocity((k + 1) * PERIOD), 0.0]])
    assert simulation.data.warning.number.sum() == 0
    return platform, np.array(rows), round(ticks * PERIOD / simulation.timestep)


def test_the_compiled_model_has_the_stated_numbers():
    text = (asset_folder() / "nims" / "README.md").read_text()
    for size, column in (("lab", 1), ("field", 2)):
        platform, _, simulation = rig(size)
        model, cable = simulation.model, platform.cable
        ends = [model.site(f"nims0/anchor_{end}").pos for end in ("rear", "front")]
        np.testing.assert_allclose(ends[1] - ends[0], [cable.span, 0, 0])
        assert ends[0][2] == pytest.approx(cable.height)
        assert model.body("nims0/base").pos[2] == pytest.approx(cable.height - cable.sag)
        carriage, package = (float(model.body(f"nims0/{b}").mass[0]) for b in ("base", "package"))
        assert carriage + package == pytest.approx(platform.mass)
        assert package == platform.package_mass
        # nothing of the carriage is drawn outside the cylinder the platform states
        reach = 0.0
        base = model.body("nims0/base").id
        for geom in np.flatnonzero(model.geom_bodyid == base):
            reach = max(reach, np.hypot(*model.geom_pos[geom, :2]))
        assert 0.5 * platform.radius < reach < platform.radius
        stated = {
            "span": cable.span, "height of the cable's ends": cable.height, "sag": cable.sag,
            "carriage's mass": carriage, "package's mass": package,
            "line at the start": platform.line,
        }  # fmt: skip
        for name, value in stated.items():
            row = re.search(rf"^\| {name} \| ([\d.]+)[^|]* \| ([\d.]+)", text, re.MULTILINE)
            assert row is not None, name
            assert float(row[column]) == pytest.approx(value), name
    # the file by itself compiles too
    alone = mujoco.MjModel.from_xml_path(str(model_path("nims")))
    assert alone.key("home").id == 0


@pytest.mark.parametrize("speed", [0.1, 1.0])
@variants
def test_it_arrives_settles_and_leaves_no_swing(size, cable, speed):
    platform, rows, arrived = move(size, cable, speed)
    period = platform.swing_period(platform.line)
    target = WAY[size] / 2
    # asked are 20 mm, 5 mm and 0.5 degrees
    assert abs(rows[arrived, 0] - target) < 1e-3
    assert abs(rows[-1, 0] - target) < 2e-4
    assert np.abs(off_curve(platform, rows)).max() < 2e-3
    after = rows[arrived : arrived + round(2 * period / 0.01), 2]
    assert np.degrees(np.abs(after).max()) < 0.15
    # the theory of a pendulum whose pivot accelerates: it swings to twice its new rest
    peak = 2.0 * speed / period / 9.81
    assert 0.85 * peak < np.abs(rows[:, 2]).max() < 1.1 * peak


@pytest.mark.parametrize("cable", ["curve", "tendon"])
def test_two_timesteps_agree(cable):
    """2 and 10 ms within 0.2 mm of each other all the way; 2 mm are asked."""
    _, fine, _ = move("lab", cable, 1.0, dt_max=0.002, settle=5.0)
    _, coarse, _ = move("lab", cable, 1.0, dt_max=0.01, settle=5.0)
    apart = np.abs(fine[4::5] - coarse)
    assert apart[:, :2].max() < 2e-4
    assert np.degrees(apart[:, 2].max()) < 0.02
    assert np.ptp(coarse[:, 0]) > 3.99


@pytest.mark.parametrize("joint", [2, 3])
@pytest.mark.parametrize("line", [0.6, 1.6])
@pytest.mark.parametrize("cable", ["curve", "tendon"])
def test_the_package_swings_as_a_pendulum(cable, line, joint):
    platform, _, simulation = rig("lab", cable, line=line)
    simulation.data.qpos[joint] = 0.1
    rows = watch(simulation)
    # a point mass on the line; the package's own inertia adds 0.1 to 0.3 %
    period = 2 * np.pi * np.sqrt(line / 9.81)
    assert platform.swing_period(line) == pytest.approx(period, rel=0.004)
    for _ in simulation.ticks(12 * period):
        pass
    angle = np.array(rows)[:, joint]
    up = np.flatnonzero((angle[:-1] < 0) & (angle[1:] >= 0))
    crossed = up - angle[up] / (angle[up + 1] - angle[up])
    measured = np.diff(crossed).mean() * simulation.timestep
    assert measured == pytest.approx(platform.swing_period(line), rel=0.005)
    # swing_damping: 0.02 of critical
    amplitude = np.abs(angle[up[-2] : up[-1]]).max()
    periods = (up[-2] + np.argmax(np.abs(angle[up[-2] : up[-1]]))) * simulation.timestep / measured
    assert -np.log(amplitude / 0.1) / (2 * np.pi * periods) == pytest.approx(0.02, rel=0.15)


@variants
def test_tensions_at_rest_are_those_of_statics(size, cable):
    away = {"lab": 2.0, "field": 25.0}[size]
    for along in (0.0, away):
        platform, group, simulation = rig(
            size, cable, along=along, change=lambda w: w.groups[0].mount(CableTension())
        )
        for _ in simulation.ticks(3.0):
            pass
        measured = group.tension.read()[0]
        weight, half = 9.81 * platform.mass, platform.cable.span / 2
        rise = platform.cable.sag * (1 - (along / half) ** 2)
        back, front = np.hypot(half + along, rise), np.hypot(half - along, rise)
        # horizontal parts cancel, vertical ones carry the weight
        assert measured[0] * (half + along) / back == pytest.approx(
            measured[1] * (half - along) / front, rel=0.001
        )
        lifted = measured @ [rise / back, rise / front]
        assert lifted == pytest.approx(weight, rel=0.01)
        np.testing.assert_allclose(
            measured, platform.cable.tensions(along, weight), rtol=0.01, atol=0
        )
    assert {"lab": 140, "field": 480}[size] < measured.min()


def test_tension_is_for_those_who_have_a_cable():
    world = World(bounds=[-2, -2, 2, 2])
    robots = world.add_group(Pioneer2DX, [[0.0, 0.0, 0.0]])
    robots.mount(CableTension())
    with pytest.raises(InvalidInputError, match="no cable"):
        Simulation(world)
    with pytest.raises(InvalidInputError, match="deviation"):
        CableTension(noise=-1.0)


@variants
def test_the_winch_reaches_its_length(size, cable):
    platform, group, simulation = rig(size, cable)
    rows, target = watch(simulation), platform.line + 0.5
    plan = profile(0.5, 0.0, Limits(max_speed=0.3, acceleration=0.3, deceleration=0.3))
    for k, _ in enumerate(simulation.ticks(8.0)):
        group.drive([[0.0, plan.velocity((k + 1) * PERIOD)]])
    rows = np.array(rows)
    assert rows[-1, 4] == pytest.approx(target, abs=2e-3)
    assert np.abs(off_curve(platform, rows)).max() < 5e-3
    counts = group.encoders.read()[0] * (2 * np.pi / group.encoders.counts_per_turn)
    np.testing.assert_allclose(counts * platform.wheel_radii, [0.0, 0.5], atol=2e-3)


@pytest.mark.parametrize("period", [0.1, 1.0])
@variants
def test_it_stops_before_the_ends_of_its_travel(size, cable, period):
    platform = Nims(size=size)
    platform, group, simulation = rig(size, cable, period=period, along=platform.reach - 2.0)
    rows = watch(simulation)
    for _ in simulation.ticks(12.0):
        group.drive([[1.0, 0.3]])
    rows = np.array(rows)
    assert platform.reach - 0.01 < rows[-1, 0] < platform.reach + 1e-3
    assert rows[:, 0].max() < platform.reach + 1e-3
    assert rows[:, 4].max() < platform.lines[1] + 1e-3
    # and comes back
    for _ in simulation.ticks(14.0):
        group.drive([[-1.0, -0.3]])
    assert simulation.data.qpos[0] < platform.reach - 1.5


def test_a_dead_carriage_brakes():
    platform, group, simulation = rig(along=-2.0)
    group.faults.add(Fault(kind="dead", robot=0, start=3.0))
    rows = watch(simulation)
    for _ in simulation.ticks(6.0):
        group.drive([[1.0, 0.0]])
    speed = np.gradient(np.array(rows)[:, 0], simulation.timestep)
    assert speed[298] > 0.95
    assert abs(speed[415:]).max() < 0.02
    assert np.diff(speed[300:400:10]).mean() / 0.1 == pytest.approx(-platform.braking, rel=0.1)


def pulls_of(simulation, actuator):
    """Forces of an actuator at every physics step to come."""
    forces = []
    simulation.watch_steps(lambda: forces.append(float(simulation.data.actuator_force[actuator])))
    return forces


def test_a_line_does_not_push():
    """The package lands on a box: the line goes slack, and the carriage is lighter."""
    for cable in ("curve", "tendon"):
        _, group, simulation = rig(
            cable=cable, change=lambda w: w.add_box(0.0, 0.0, 1.0, 1.0, height=0.5)
        )
        winch = simulation.model.actuator("nims0/winch").id
        forces = pulls_of(simulation, winch)
        for _ in simulation.ticks(9.0):
            group.drive([[0.0, 0.3]])
        assert max(forces) <= 0.0
        assert abs(forces[-1]) < 0.1
        bottom = simulation.data.geom("nims0/package").xpos[2] - 0.066
        assert bottom == pytest.approx(0.5, abs=2e-3)
        for _ in simulation.ticks(9.0):
            group.drive([[0.0, -0.3]])
        assert simulation.data.qpos[4] == pytest.approx(0.25, abs=2e-3)


def break_tie(spec):
    spec.delete(spec.equality("nims0/curve"))


def test_a_carriage_off_its_curve_ends_the_trial():
    _, _, simulation = rig(change=lambda w: w.edit(break_tie))
    with pytest.raises(SimulationDivergedError, match="carriage of nims0 is .* mm off"):
        for _ in simulation.ticks(1.0):
            pass
    assert simulation.diverged
    assert simulation.time <= 0.1
    # MuJoCo itself has nothing to say
    assert simulation.data.warning.number.sum() == 0


def test_others_are_not_checked():
    world = World(bounds=[-2, -2, 2, 2])
    world.add_group(Pioneer2DX, [[0.0, 0.0, 0.0]])
    assert not Simulation(world)._checks


def phase(value, dt=0.01):
    """Axial stiffness [N] at which the stiffest mode turns by ``value`` [rad] in a timestep."""
    return (value / dt) ** 2 * 2.0 / 2 * 3.0


def test_a_cable_too_stiff_for_the_timestep_is_refused(monkeypatch):
    with pytest.raises(InvalidInputError, match="10 ms is too large for this cable"):
        rig(cable="tendon", axial_stiffness=phase(2.05))
    rig(cable="tendon", axial_stiffness=phase(2.05), dt_max=0.005)
    rig(cable="curve", axial_stiffness=phase(2.05))

    def run(value):
        _, group, simulation = rig(cable="tendon", axial_stiffness=phase(value), along=-2.0)
        for _ in simulation.ticks(6.0):
            group.drive([[1.0, 0.0]])

    # the bound has a margin, and what is beyond it fails
    run(1.99)
    monkeypatch.setattr(mjmr.robots.cable_drive, "_LARGEST_PHASE", 10.0)
    run(2.2)
    with pytest.raises(SimulationDivergedError, match="off its cable's curve"):
        run(2.7)


@pytest.mark.parametrize("start", range(5))
@variants
def test_it_survives_halton_noise_without_a_warning(size, cable, start):
    """1 s of quasi-random control on all actuators from a random place, a box in its way."""
    rng = np.random.default_rng(start)
    free = Nims(size=size)
    line, along = rng.uniform(*free.lines), rng.uniform(-1, 1) * free.reach
    below = free.package_height(along, line)
    # as high as the package's middle, and close
    _, _, simulation = rig(
        size, cable, (0.01, 0.005)[start % 2], along=along, line=line,
        change=lambda w: w.add_box(along + 0.5, 0.0, 0.4, 0.4, height=float(below), mass=3.0),
    )  # fmt: skip
    model, data = simulation.model, simulation.data
    before = data.qpos.copy()
    # set points go up and down by about 4 m/s, the tendons' by 0.2 m
    scale = [20.0 if "cable" in model.actuator(k).name else 400.0 for k in range(model.nu)]
    for row in qmc.Halton(model.nu, rng=rng).random(round(1.0 / model.opt.timestep)):
        data.ctrl[:] = np.array(scale) * (2 * row - 1)
        mujoco.mj_step(model, data)
    assert data.warning.number.sum() == 0
    assert np.isfinite(data.qpos).all()
    assert np.abs(data.qpos - before).max() > 0.005
    assert np.abs(data.qvel).max() < 50.0


@pytest.mark.parametrize("kind", BOTH)
def test_rigs_stand_where_they_are_put(kind):
    """Two rigs at an angle; poses, heights and counters are the carriages'."""
    sites = np.array([[0.0, 1.5, 0.4], [0.5, -2.0, np.pi]])
    world = World(bounds=[-5, -5, 5, 5])
    platform = Nims(along=-1.0)
    group = world.add_group(platform, sites)
    simulation = kind(world, control_period=PERIOD)
    heading = np.column_stack([np.cos(sites[:, 2]), np.sin(sites[:, 2])])
    np.testing.assert_allclose(group.start[:, :2], sites[:, :2] - heading)
    poses = simulation.poses_of(group)
    np.testing.assert_allclose(poses, group.start, atol=1e-12)
    heights = 2.0 + 0.25 / 9
    np.testing.assert_allclose(simulation.base_poses_of(group)[:, 2], heights, atol=1e-4)
    for _ in simulation.ticks(5.0):
        group.drive([[0.4, 0.1], [-0.2, -0.05]])
    for _ in simulation.ticks(PERIOD):
        pass
    way = group.encoders.read() * (2 * np.pi / group.encoders.counts_per_turn)
    way = way * platform.wheel_radii
    # 5.1 s with ramps of 0.8 and 0.4 s at 0.498 m/s^2
    expected = [0.4 * (5.1 - 0.4 / 0.498 / 2), -0.2 * (5.1 - 0.2 / 0.498 / 2)]
    np.testing.assert_allclose(way[:, 0], expected, atol=0.01)
    np.testing.assert_allclose(way[:, 1], [0.493, -0.251], atol=0.01)
    moved = simulation.poses_of(group)
    np.testing.assert_allclose(moved[:, :2] - sites[:, :2], heading * (way[:, :1] - 1.0), atol=2e-3)
    np.testing.assert_allclose(moved[:, 2], [0.4, np.pi])
    along = ((moved - sites)[:, :2] * heading).sum(axis=1)
    np.testing.assert_allclose(
        simulation.base_poses_of(group)[:, 2], platform.cable.curve(along), atol=1e-4
    )
    twists = simulation.twists_of(group)
    np.testing.assert_allclose(twists[:, 0], [0.4, -0.2], atol=5e-3)


def test_supports_outside_the_walls_are_refused():
    world = World(bounds=[-3.2, -2, 3.2, 2])
    with pytest.raises(InvalidInputError, match=r"towers .* nims1 by 0\.80 m.*6 m apart"):
        world.add_group(Nims, [[0.0, 0.0, np.pi / 2], [0.5, 0.0, 0.0]])
    with pytest.raises(InvalidInputError, match="trees"):
        world.add_group(Nims(supports="trees"), [[0.0, 0.0, 0.0]])
    World(bounds=[-3.6, -2, 3.6, 2]).add_group(Nims, [[0.0, 0.0, 0.0]])


@pytest.mark.parametrize("cable", ["curve", "tendon"])
def test_same_bits_and_a_snapshot_goes_on(cable):
    """Control at 60 Hz: frames of 10 ms begin inside control periods."""

    def go(simulation, group, offset):
        rows = watch(simulation)
        for k, _ in enumerate(simulation.ticks(0.5)):
            angle = 0.4 * (k + offset)
            group.drive([[np.cos(angle), 0.3 * np.sin(angle)]])
        return np.array(rows), group.encoders.read().copy()

    _, group, simulation = rig(cable=cable, period=1 / 60)
    assert FRAME % simulation.timestep > 1e-4
    first, _ = go(simulation, group, 0)
    snapshot = simulation.snapshot()
    once, counted = go(simulation, group, 30)
    simulation.restore(snapshot)
    again, recounted = go(simulation, group, 30)
    assert once.tobytes() == again[-len(once) :].tobytes()
    assert counted.tobytes() == recounted.tobytes()
    assert counted.any()
    np.random.seed(7)  # noqa: NPY002 - nothing may depend on the global state
    _, others, fresh = rig(cable=cable, period=1 / 60)
    assert go(fresh, others, 0)[0].tobytes() == first.tobytes()


@pytest.mark.parametrize("kind", BOTH)
def test_the_carriage_sees_its_package_and_line(kind):
    world = World(bounds=BOUNDS["lab"])
    group = world.add_group(Nims(along=-1.0), [[0.0, 0.0, 0.0]])
    group.mount(Camera(at="down", width=160, height=120, modality="segmentation"), "labels")
    group.mount(Camera(at="down", width=160, height=120), "picture")
    simulation = kind(world, control_period=PERIOD)
    for _ in simulation.ticks(PERIOD):
        pass
    own = group.labels.read()[0] == 0
    assert 20 < own.sum() < 2000
    red, green, blue = group.picture.read()[0].astype(int).transpose(2, 0, 1)
    # the line is orange; the floor is green and the package white
    orange = (red > 80) & (red > 2 * green) & (green > blue)
    assert orange.sum() > 10
    rows, columns = np.nonzero(orange)
    # it is seen along its length: towards the package, under which it ends
    assert np.ptp(rows) > 3 * np.ptp(columns)


def test_the_world_can_be_exported():
    world = World(bounds=BOUNDS["lab"])
    world.add_group(Nims(cable="tendon", along=1.0), [[0.2, 0.0, 0.0]])
    model = mujoco.MjModel.from_xml_string(world.to_xml())
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    mujoco.mj_step(model, data, 100)
    np.testing.assert_allclose(data.body("nims0/base").xpos[:2], [1.2, 0.0], atol=1e-3)


def test_bad_input_is_refused():
    with pytest.raises(UnknownNameError, match="size of Nims 'huge'; valid"):
        Nims(size="huge")
    with pytest.raises(UnknownNameError, match="cable of Nims 'rope'"):
        Nims(cable="rope")
    with pytest.raises(UnknownNameError, match="supports of Nims"):
        Nims(supports="poles")
    for options, words in (
        ({"sag": 0.0}, "a cable needs"),
        ({"sag": 3.0}, "a cable needs"),
        ({"span": float("nan")}, "a cable needs"),
        ({"span": 0.4, "sag": 0.05}, "no room"),
        ({"line": 0.1}, r"line can be 0\.25 to 1\.694 m"),
        ({"along": 2.9}, r"up to 2\.735 m"),
        ({"acceleration": -1.0}, "acceleration of Nims"),
        ({"axial_stiffness": 0.0}, "axial_stiffness of Nims"),
        ({"swing_damping": 1.0}, "swing_damping"),
    ):
        with pytest.raises(InvalidInputError, match=words):
            Nims(**options)
    world = World(bounds=BOUNDS["lab"])
    group = world.add_group(Nims, [[0.0, 0.0, 0.0]])
    KinematicSimulation(world, control_period=PERIOD)
    with pytest.raises(InvalidInputError, match=r"\(1, 2\) \(travel, winch\)"):
        group.drive(np.zeros((1, 3)))
    with pytest.raises(InvalidInputError, match="nims0"):
        group.drive([[np.nan, 0.0]])
    group.drive([[1.0, 0.3]])
    group.drive([[0.2, 0.5]])
    np.testing.assert_allclose(group.command, [[0.2, 0.3]])
    group.drive([[-2.0, -0.1]])
    np.testing.assert_allclose(group.command, [[-1.0, -0.1]])
    assert group.clamped[0] == 2
