"""The TJ Pro: a round body on two hobby servos, which need not do what they are told."""

import re

import mujoco
import numpy as np
import pytest
from scipy.stats import qmc

from mjmr.assets import asset_folder, model_path
from mjmr.errors import InvalidInputError
from mjmr.robots.diff_drive import DiffDrive
from mjmr.robots.tj_pro import TJPro, draw_servo_gains
from mjmr.sensors.bumper import Bumper
from mjmr.sensors.proximity import InfraredProximity
from mjmr.simulation import Simulation
from mjmr.world import World
from tests.mjmr.bases import drive, profile
from tests.mjmr.worlds import BOTH

PERIOD = 0.1
TIMESTEPS = (0.01, 0.005, 0.002)
SPEED = 0.152  # 3 inches in half a second


def tjs(poses=((0.0, 0.0, 0.0),), **options):
    """A hall; returns (world, robots)."""
    world = World(bounds=[-3, -3, 3, 3], wall_height=0.15)
    return world, world.add_group(TJPro(**options), poses)


def pushed(simulation, wall):
    """Normal force on a wall [N]."""
    force, total = np.zeros(6), 0.0
    for k, pair in enumerate(simulation.data.contact.geom):
        if wall in {simulation.model.geom(g).name for g in pair}:
            mujoco.mj_contactForce(simulation.model, simulation.data, k, force)
            total += force[0]
    return total


def test_the_compiled_model_has_the_stated_numbers():
    model = mujoco.MjModel.from_xml_path(str(model_path("tj_pro")))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("home").id)
    mujoco.mj_forward(model, data)
    base = model.body("base").id
    assert model.body_subtreemass[base] == pytest.approx(0.8)
    np.testing.assert_allclose(data.subtree_com[base], [-0.015, 0, 0.045], atol=1e-4)
    hull = model.geom("hull")
    assert hull.size[0] == TJPro.radius
    assert hull.pos[2] + hull.size[1] == pytest.approx(TJPro.height)
    rim = model.geom("rim")
    assert rim.size[0] == rim.size[1] == TJPro.radius
    assert (hull.contype[0] & 1, hull.conaffinity[0]) == (0, 0)
    hubs = np.array([data.body(f"wheel_{side}").xpos for side in ("left", "right")])
    np.testing.assert_allclose(hubs[0] - hubs[1], [0, TJPro.track, 0], atol=1e-12)
    servo = model.actuator("wheel_left")
    stall, slope = servo.forcerange[1], servo.gainprm[0]
    assert TJPro.max_twist[0] <= stall / slope * TJPro.wheel_radius
    for k, bearing in enumerate((25.0, -25.0)):
        site = data.site(f"ir{k}")
        axis = site.xmat.reshape(3, 3)[:, 0]
        assert np.degrees(np.arctan2(axis[1], axis[0])) == pytest.approx(bearing, abs=1e-4)
        np.testing.assert_allclose(site.xpos[:2], TJPro.radius * axis[:2], atol=1e-6)
    world, _ = tjs()
    bound = TJPro().bind(Simulation(world, dt_max=0.01).model, ["tj_pro0/"])
    assert isinstance(bound, DiffDrive)
    assert bound.rolling_radius == pytest.approx(TJPro.rolling_radius, abs=1e-6)
    # README and model say the same
    text = (asset_folder() / "tj_pro" / "README.md").read_text()
    stated = {"mass": 0.8, "wheel radius": 35, "track": 130, "servo's torque": stall,
              "servo's slope": slope}  # fmt: skip
    for name, value in stated.items():
        row = re.search(rf"^\| {name} \| ([\d.]+)", text, re.MULTILINE)
        assert row is not None
        assert float(row[1]) == pytest.approx(value)


@pytest.mark.parametrize("start", range(5))
def test_it_survives_halton_noise_without_a_warning(start):
    """1 s of quasi-random control on all servos, beside a wall, boxes and each other."""
    rng = np.random.default_rng(start)
    poses = np.array([[-2.9, 0.0, 0.0], [0.0, 0.0, 0.0], [0.19, 0.03, 0.0], [2.0, 2.0, 0.0]])
    poses[:, 2] = rng.uniform(-np.pi, np.pi, 4)
    world, _ = tjs(poses)
    world.add_box(0.4, 0.1, 0.2, 0.2, mass=1.0)
    world.add_box(-0.2, 0.0, 0.2, 0.2)
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
    model, data = simulation.model, simulation.data
    for row in qmc.Halton(model.nu, rng=rng).random(round(1.0 / model.opt.timestep)):
        data.ctrl[:] = 500.0 * (row - 0.5)
        mujoco.mj_step(model, data)
    assert data.warning.number.sum() == 0
    assert np.isfinite(data.qpos).all()
    bases = [model.body(f"tj_pro{i}/base").id for i in range(4)]
    assert data.xmat[bases, 8].min() > np.cos(np.radians(10.0))
    assert np.abs(data.qvel).max() > 0.5


@pytest.mark.parametrize("dt_max", TIMESTEPS)
def test_it_starts_at_rest_and_stands_still(dt_max):
    poses = [[1.0, 0.5, 0.3], [-1.0, -0.5, -2.0]]
    world, robots = tjs(poses)
    simulation = Simulation(world, control_period=PERIOD, dt_max=dt_max)
    height = simulation.data.qpos[2]
    assert -1e-3 < height < -1e-4
    seen, twists, _ = drive(simulation, robots, np.zeros((20, 2)))
    assert np.abs(seen - poses).max() < 1e-6
    assert np.abs(twists).max() < 1e-5
    assert simulation.data.qpos[2] == pytest.approx(height, abs=1e-6)


@pytest.mark.parametrize("dt_max", TIMESTEPS)
def test_three_inches_in_half_a_second_straight_on(dt_max):
    world, robots = tjs([[-2.0, 0.0, 0.0]])
    simulation = Simulation(world, control_period=PERIOD, dt_max=dt_max)
    poses, twists, tilt = drive(simulation, robots, profile(SPEED, 0.0, 200))
    assert poses[-1, 0, 0] - poses[0, 0, 0] == pytest.approx(20 * SPEED, rel=0.001)
    assert poses[105, 0, 0] - poses[100, 0, 0] == pytest.approx(0.076, rel=0.001)
    assert np.abs(poses[:, 0, 1]).max() < 1e-4
    assert twists[100, 0, 0] == pytest.approx(SPEED, rel=0.001)
    assert tilt < 1.0


@pytest.mark.parametrize("dt_max", TIMESTEPS)
def test_a_turn_in_place_turns_by_what_was_commanded_about_its_middle(dt_max):
    """20 degrees in half a second, nine times on: 180."""
    rate = np.radians(20.0) / 0.4
    once = np.repeat([[0.0, rate], [0.0, 0.0]], [4, 1], axis=0)
    world, robots = tjs()
    simulation = Simulation(world, control_period=PERIOD, dt_max=dt_max)
    poses, _, _ = drive(
        simulation, robots, np.concatenate([np.tile(once, (9, 1)), np.zeros((5, 2))])
    )
    turned = np.degrees(np.unwrap(poses[:, 0, 2]))
    assert turned[-1] == pytest.approx(180.0, abs=0.5)
    np.testing.assert_allclose(np.diff(turned[5:46:5]), 20.0, atol=0.5)
    assert np.abs(poses[:, 0, :2]).max() < 1e-3


@pytest.mark.parametrize("kind", BOTH)
@pytest.mark.parametrize("gains", [(0.95, 1.05), (1.04, 0.98)])
def test_unequal_servos_drive_an_arc(kind, gains):
    """Left a, right b: speed v m, curvature (b - a) / (track m), where m = (a + b) / 2."""
    world, robots = tjs([[0.0, -1.0, 0.0], [0.0, 1.5, 0.0]], servo_gains=[gains, (1.0, 1.0)])
    simulation = kind(world, control_period=PERIOD, dt_max=0.01)
    poses, twists, _ = drive(simulation, robots, profile(SPEED, 0.0, 100))
    a, b = gains
    mean = (a + b) / 2
    assert twists[60, 0, 0] == pytest.approx(SPEED * mean, rel=0.003)
    way = 10 * SPEED * mean
    turned = np.unwrap(poses[:, 0, 2])[-1]
    assert turned == pytest.approx(way * (b - a) / (TJPro.track * mean), rel=0.005)
    # the end of the chord, across
    radius = way / turned
    assert poses[-1, 0, 1] + 1.0 == pytest.approx(radius * (1 - np.cos(turned)), abs=0.01)
    assert abs(poses[-1, 1, 1] - 1.5) < 1e-4, "the other one is exact"
    np.testing.assert_array_equal(robots.command[0], robots.command[1])


def test_servos_are_drawn_within_their_spread_by_the_seed():
    gains = draw_servo_gains(np.random.default_rng(3), 2000, 0.05)
    assert gains.shape == (2000, 2)
    assert 0.95 <= gains.min() < 0.951
    assert 1.049 < gains.max() <= 1.05
    assert np.corrcoef(gains.T)[0, 1] == pytest.approx(0.0, abs=0.1)
    np.testing.assert_array_equal(gains, draw_servo_gains(np.random.default_rng(3), 2000, 0.05))
    with pytest.raises(InvalidInputError, match="0 to below 1; got 1.5"):
        draw_servo_gains(np.random.default_rng(3), 2, 1.5)


@pytest.mark.parametrize(
    ("gains", "words"),
    [
        ([[1.0, 1.0]] * 3, "servo_gains has 3 rows for 2 robots"),
        ([1.0], r"shape \(2,\) or \(n, 2\)"),
        ([1.0, 0.0], "must be positive and finite"),
        ([1.0, np.nan], "must be positive and finite"),
    ],
)
def test_bad_servo_gains_are_refused(gains, words):
    with pytest.raises(InvalidInputError, match=words):
        tjs([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], servo_gains=gains)


def test_tyres_slip_before_the_servos_stall():
    """Against a wall, not by the servos' 17 N; the wheels spin on.

    What pushes at 50 mm also unloads the tyres: with the tail at 70 mm and the weight's 7.85 N
    15 mm behind the axle, moments about it leave 3.8 N on tyres of friction 0.9.
    """
    world, robots = tjs([[2.85, 0.0, 0.0]])
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
    pushes = []
    simulation.observe(lambda: pushes.append(pushed(simulation, "wall_east")))
    poses, _, _ = drive(simulation, robots, np.full((40, 2), [SPEED, 0.0]))
    assert poses[-1, 0, 0] == pytest.approx(3.0 - TJPro.radius, abs=0.003)
    tail = (7.85 * 0.015 + 0.9 * 7.85 * 0.05) / (0.07 + 0.9 * 0.05)
    slipping = 0.9 * (7.85 - tail)
    assert np.mean(pushes[-10:]) == pytest.approx(slipping, rel=0.06)
    assert np.std(pushes[-10:]) < 0.5, "it does not hop"
    assert simulation.wheel_angles_of(robots).min() > 5.0


@pytest.mark.parametrize("kind", BOTH)
def test_same_bits_and_a_snapshot_goes_on(kind):
    def build():
        gains = draw_servo_gains(np.random.default_rng(1), 2)
        world, robots = tjs([[-1.0, 0.5, 0.3], [-0.75, 0.5, -2.0]], servo_gains=gains)
        return kind(world, seed=3, control_period=PERIOD, dt_max=0.01), robots

    def go(simulation, robots, offset):
        angle = 0.3 * (np.arange(15) + offset)
        commands = np.column_stack([0.15 * np.cos(angle), np.sin(2 * angle)])
        poses = drive(simulation, robots, commands)[0]
        return poses.tobytes(), robots.proximity.read().tobytes()

    simulation, robots = build()
    first = go(simulation, robots, 0)
    snapshot = simulation.snapshot()
    once = go(simulation, robots, 15)
    simulation.restore(snapshot)
    assert go(simulation, robots, 15) == once
    np.random.seed(7)  # noqa: NPY002 - nothing may depend on the global state
    fresh, others = build()
    assert go(fresh, others, 0) == first


def test_commands_beyond_a_servos_speed_keep_their_curvature():
    world, robots = tjs([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    Simulation(world, control_period=PERIOD)
    robots.drive([[0.18, 2.0], [0.1, -1.0]])
    forward, turn = robots.command[0]
    assert turn / forward == pytest.approx(2.0 / 0.18)
    assert forward + turn * TJPro.track / 2 == pytest.approx(0.18)
    np.testing.assert_array_equal(robots.command[1], [0.1, -1.0])
    np.testing.assert_array_equal(robots.clamped, [1, 0])


# its detectors and its bumper


@pytest.mark.parametrize("kind", BOTH)
@pytest.mark.parametrize("side", [0, 1])
def test_detectors_trip_where_geometry_says(kind, side):
    """A wall across one detector's axis, 1 mm within and 1 mm beyond 0.10 m."""
    bearing = np.radians((25.0, -25.0)[side])
    for off, tripped in ((-0.001, True), (0.001, False)):
        world, robots = tjs()
        away = TJPro.radius + 0.10 + off + 0.05
        # narrow: the other one's cone passes it
        world.add_box(
            away * np.cos(bearing), away * np.sin(bearing), 0.1, 0.02, yaw=bearing, height=0.15
        )
        simulation = kind(world, control_period=PERIOD, dt_max=0.01)
        for _ in simulation.ticks(0.3):
            found = robots.proximity.read()
        expected = np.array([False, False])
        expected[side] = tripped
        np.testing.assert_array_equal(found[0], expected)
        assert found.dtype == bool


def test_a_wall_dead_ahead_trips_both_where_the_inner_edges_of_their_cones_meet_it():
    """The cones' inner edges are 15 degrees off: from x = 81.6 mm, 0.10 m of them reach 96.6 mm."""
    reach = TJPro.radius * np.cos(np.radians(25)) + 0.10 * np.cos(np.radians(15))
    for off, tripped in ((-0.001, True), (0.001, False)):
        world, robots = tjs([[3.0 - reach - off, 0.0, 0.0]])
        simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
        for _ in simulation.ticks(0.2):
            pass
        assert (robots.proximity.read() == tripped).all()
    # 88 mm are left between the wall and the bumper, more than a program loop's 76 mm
    assert reach - TJPro.radius > 0.076


def test_detectors_see_other_robots_and_nothing_when_dead():
    world, robots = tjs([[0.0, 0.0, 0.0], [0.25, 0.08, 1.57], [-1.0, 0.0, 0.0]])
    dead = robots.mount(InfraredProximity(trip=0.10, drop_out=1.0), "dead")
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
    for _ in simulation.ticks(0.2):
        pass
    np.testing.assert_array_equal(
        robots.proximity.read(), [[True, False], [False, False], [False, False]]
    )
    assert not dead.read().any()


def test_a_bump_closes_the_switch_that_was_hit():
    """Six sectors, the middle of the first straight ahead; 50 degrees off a wall's normal."""
    hits = {0.0: 0, 50.0: 5, -50.0: 1}
    for heading, sector in hits.items():
        world, robots = tjs([[2.8, 0.0, np.radians(heading)]])
        bumper = robots.mount(Bumper(sectors=6, threshold=0.5, rate=10.0))
        simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
        closed = np.zeros(6, dtype=bool)
        for _ in simulation.ticks(2.0):
            robots.drive([[SPEED, 0.0]])
            closed |= bumper.read()[0]
        assert closed[sector], heading
        assert not closed[2:5].any()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"trip": 0.0}, "threshold must be positive"),
        ({"trip": np.inf}, "threshold must be positive"),
        ({"trip": 0.3, "max_range": 0.2}, "within max_range = 0.2 m; got 0.3"),
    ],
)
def test_bad_thresholds_are_refused(options, words):
    with pytest.raises(InvalidInputError, match=words):
        InfraredProximity(**options)


def test_it_slides_past_the_edge_of_a_block_and_off_others():
    """Past the edge of a block 6 mm in its way, and two that meet: 3 mm deep at the most."""
    world, robots = tjs([[-0.5, 0.284, 0.0], [-2.0, -1.0, 0.3], [-1.7, -0.95, np.pi + 0.2]])
    world.add_box(0.0, 0.0, 0.4, 0.4)
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
    deepest, fastest = [0.0], []
    floor = simulation.model.geom("floor").id

    def look():
        contact = simulation.data.contact
        others = (contact.geom != floor).all(axis=1)
        deepest.append(float(contact.dist[others].min(initial=0.0)))

    simulation.watch_steps(look)
    simulation.observe(lambda: fastest.append(simulation.truth.twists(robots)[:, 0].max()))
    poses, _, tilt = drive(simulation, robots, np.full((90, 2), [SPEED, 0.0]))
    # the face brakes its flank and turns it until it heads for the block
    assert poses[-1, 0, 0] > -0.15, "it is past the edge"
    assert min(deepest) > -0.003
    assert min(deepest) < 0.0, "it has touched"
    assert max(fastest) < 1.05 * SPEED
    assert tilt < 5.0
