"""Discs: they slide and stop by Coulomb friction, hold below it, and everybody sees them."""

import numpy as np
import pytest

from mjmr.disc import Disc, let_discs_sleep
from mjmr.errors import InvalidInputError, SimulationDivergedError
from mjmr.recording import Recording
from mjmr.robots.round_pusher import RoundPusher
from mjmr.sensors.lidar import Lidar
from mjmr.sensors.line_of_sight import line_of_sight
from mjmr.simulation import Simulation
from mjmr.world import World
from tests.mjmr.worlds import BOTH

FORCE, MASS = 12.0, 2.0


def hall(*discs, robots=((-4.0, -4.0, 0.0),), dt_max=0.01, kind=Simulation):
    """Discs (x, y, radius) and robots out of their way; returns (world, robots, simulation)."""
    world = World(bounds=[-5, -5, 5, 5], wall_height=0.3)
    for x, y, radius in discs:
        world.add_disc(x, y, radius, FORCE, mass=MASS)
    group = world.add_group(RoundPusher, robots)
    return world, group, kind(world, control_period=0.1, dt_max=dt_max)


def start(simulation, velocity, rate=0.0, name="disc0"):
    """Give a disc a velocity [m/s] and a rate of turn [rad/s]."""
    model, data = simulation.model, simulation.data
    for ending, value in zip(("", "_y", "_yaw"), (*velocity, rate), strict=True):
        data.qvel[model.joint(name + ending).dofadr[0]] = value


def run(simulation, duration):
    """Places and headings (k, 3) of the first disc at control instants."""
    seen = []

    def see():
        pose = simulation.truth.movers()[0]
        seen.append([*pose[:2], 2.0 * np.arctan2(pose[6], pose[3])])

    simulation.observe(see)
    for _ in simulation.ticks(duration):
        pass
    return np.array(seen)


@pytest.mark.parametrize("dt_max", [0.01, 0.005])
@pytest.mark.parametrize("angle", [0.0, 0.4, np.pi / 4, 2.5])
def test_a_disc_slides_straight_and_stops_where_friction_says(angle, dt_max):
    """After v^2 M / 2 F, less half a step at v: the speed of a step is that of its end."""
    _, _, simulation = hall((0.0, 0.0, 0.3), dt_max=dt_max)
    speed, way = 0.8, np.array([np.cos(angle), np.sin(angle)])
    start(simulation, speed * way)
    gone = run(simulation, 1.0)
    end = gone[-1, :2]
    expected = speed**2 * MASS / (2 * FORCE) - speed * dt_max / 2
    assert end @ way == pytest.approx(expected, rel=0.01)
    assert abs(way[0] * end[1] - way[1] * end[0]) < 1e-4
    assert np.abs(gone[-1] - gone[-2]).max() < 1e-6
    assert abs(gone[-1, 2]) < 1e-4


@pytest.mark.parametrize("dt_max", [0.01, 0.005])
def test_a_disc_that_spins_stops_by_the_torque_of_an_even_load(dt_max):
    """Torque 2/3 F R against M R^2 / 2, less half a step."""
    radius, rate = 0.3, 6.0
    _, _, simulation = hall((0.0, 0.0, radius), dt_max=dt_max)
    start(simulation, (0.0, 0.0), rate)
    turned = np.unwrap(run(simulation, 1.0)[:, 2])[-1]
    deceleration = (2 / 3 * FORCE * radius) / (MASS * radius**2 / 2)
    expected = rate**2 / 2 / deceleration - rate * dt_max / 2
    assert turned == pytest.approx(expected, rel=0.01)


def test_a_spinning_disc_slides_further():
    ends = []
    for rate in (0.0, 6.0):
        _, _, simulation = hall((0.0, 0.0, 0.3), dt_max=0.002)
        start(simulation, (0.8, 0.0), rate)
        ends.append(run(simulation, 2.0)[-1, 0])
    assert ends[1] > 1.2 * ends[0]


@pytest.mark.parametrize("angle", np.arange(8) * np.pi / 4 + 0.2)
def test_it_holds_just_below_its_friction_and_goes_just_above_it(angle):
    way = np.array([np.cos(angle), np.sin(angle)])
    gone = []
    for share in (0.95, 1.05):
        _, _, simulation = hall((0.0, 0.0, 1.0))
        simulation.data.xfrc_applied[simulation.model.body("disc0").id, :2] = share * FORCE * way
        gone.append(run(simulation, 2.0)[-1, :2] @ way)
    # a millimetre a minute; and (0.05 F / M) t^2 / 2
    assert abs(gone[0]) < 1e-3 / 30
    assert gone[1] == pytest.approx(0.05 * FORCE / MASS * 2.0, rel=0.05)


def test_it_stays_upright_and_on_its_foot_alone():
    _, _, simulation = hall((0.0, 0.0, 0.1))
    start(simulation, (1.0, 0.5), 3.0)
    model, data = simulation.model, simulation.data
    foot, heights, touched = model.geom("disc0_foot").id, [], []

    def see():
        touched.append((data.contact.geom[:, 1] == foot).tolist())
        heights.append(data.body("disc0").xpos[2])

    simulation.watch_steps(see)
    run(simulation, 1.0)
    # its foot and the robot's wheels and caster
    assert all(sum(each) == 1 for each in touched)
    assert all(len(each) == 4 for each in touched)
    assert np.ptp(heights) < 1e-3
    assert data.body("disc0").xmat[8] == pytest.approx(1.0)


def test_a_heap_of_discs_stays_whole():
    """Robots shove 30 discs about for a minute: none is deep in another, nor thrown away."""
    rng = np.random.default_rng(1000)
    world = World(bounds=[-2, -2, 2, 2], wall_height=0.3)
    places = np.empty((0, 2))
    while len(places) < 30:
        place = rng.uniform(-1.8, 1.8, 2)
        if (np.hypot(*(places - place).T) > 0.205).all() and np.hypot(*place) > 1.0:
            places = np.vstack([places, place])
    for x, y in places:
        world.add_disc(x, y, 0.1, rng.choice([1.8, 7.2]))
    robots = world.add_group(
        RoundPusher, [[-0.4, -0.4, 0.0], [0.4, -0.4, 1.0], [0.4, 0.4, 2.0], [-0.4, 0.4, 3.0]]
    )
    simulation = Simulation(world, control_period=0.1, dt_max=0.01)
    data, depths, speeds = simulation.data, [0.0], []

    def see():
        depths.append(-data.contact.dist.min(initial=0.0))
        speeds.append(np.abs(data.qvel[: 4 * 30].reshape(30, 4)[:, :3]).max())

    simulation.watch_steps(see)
    speed = rng.choice([0.5, 0.5, -0.5], (30, 4)).repeat(20, axis=0)
    rate = rng.uniform(-1.5, 1.5, (30, 4)).repeat(20, axis=0)
    for k, _ in enumerate(simulation.ticks(60.0)):
        robots.drive(np.column_stack([speed[k], rate[k]]))
    gone = np.hypot(*(simulation.mover_poses()[:, :2] - places).T)
    assert np.median(gone) > 0.1
    assert max(depths) < 0.008
    assert max(speeds) < 1.5
    assert data.warning.number.sum() == 0


def test_two_discs_pass_a_push_on():
    world, robots, simulation = hall((0.0, 0.0, 0.2), (0.41, 0.0, 0.2), robots=[[-0.5, 0.0, 0.0]])
    for disc in world.props:
        assert isinstance(disc, Disc)
    for _ in simulation.ticks(3.0):
        robots.drive([[0.3, 0.0]])
    first, second = simulation.mover_poses()
    # 24 N of friction are more than one robot's 12 N: they do not get far
    assert 0.0 < second[0] - 0.41 < 0.1
    assert second[0] - first[0] == pytest.approx(0.4, abs=0.01)


@pytest.mark.parametrize("kind", BOTH)
def test_rays_meet_the_exact_circle(kind):
    world = World(bounds=[-5, -5, 5, 5], wall_height=0.3)
    world.add_disc(1.5, 0.2, 0.4, FORCE)
    robots = world.add_group(RoundPusher, [[0.0, 0.0, 0.0]])
    lidar = robots.mount(
        Lidar(beams=91, field_of_view=np.pi / 2, max_range=8.0, position=(0.0, 0.0, 0.2))
    )
    simulation = kind(world, control_period=0.1, dt_max=0.01)
    for _ in simulation.ticks(0.1):
        pass
    ranges = lidar.read()[0]
    angles = np.radians(np.arange(-45, 46))
    along = 1.5 * np.cos(angles) + 0.2 * np.sin(angles)
    across = 0.2 * np.cos(angles) - 1.5 * np.sin(angles)
    met = np.abs(across) < 0.4 - 0.01
    expected = along - np.sqrt(np.maximum(0.4**2 - across**2, 0.0))
    assert met.sum() > 20
    np.testing.assert_allclose(ranges[met], expected[met], atol=0.002)
    # whatever is seen beside it is further away than the wall's nearest point in this sector
    assert ranges[np.abs(across) > 0.4 + 0.01].min() > 3.9


@pytest.mark.parametrize("kind", BOTH)
def test_a_disc_is_in_the_line_of_sight(kind):
    world = World(bounds=[-5, -5, 5, 5], wall_height=0.3)
    world.add_disc(0.0, 0.0, 0.3, FORCE)
    robots = world.add_group(RoundPusher, [[-1.5, 0.0, 0.0], [1.5, 0.0, 0.0], [0.0, 2.0, 0.0]])
    simulation = kind(world, control_period=0.1, dt_max=0.01)
    seen = line_of_sight(simulation)
    assert robots.n == 3
    np.testing.assert_array_equal(seen, [[1, 0, 1], [0, 1, 1], [1, 1, 1]])


@pytest.mark.parametrize("kind", BOTH)
def test_recordings_have_it_where_it_was(kind):
    _, robots, simulation = hall((0.6, 0.1, 0.2), robots=[[0.0, 0.0, 0.0]], kind=kind)
    recording = Recording(simulation)
    for _ in simulation.ticks(2.0):
        robots.drive([[0.5, 0.0]])
    footage = recording.footage()
    first = footage.model.joint("disc0").qposadr[0]
    shown = footage.positions[:, first : first + 4]
    poses = recording.movers[:, 0]
    np.testing.assert_allclose(shown[:, :3], poses[:, :3], atol=1e-9)
    yaw = 2.0 * np.arctan2(poses[:, 6], poses[:, 3])
    np.testing.assert_allclose(shown[:, 3], yaw, atol=1e-9)
    way = np.hypot(*(poses[-1, :2] - poses[0, :2]))
    assert way > 0.2 if kind is Simulation else way == 0.0


def test_a_snapshot_goes_on_with_the_same_bits():
    _, robots, simulation = hall((0.6, 0.1, 0.2), robots=[[0.0, 0.0, 0.0]])

    def go():
        for _ in simulation.ticks(1.0):
            robots.drive([[0.5, 0.1]])
        return simulation.mover_poses().tobytes()

    go()
    snapshot = simulation.snapshot()
    once = go()
    simulation.restore(snapshot)
    assert go() == once


def shoved(sleep):
    """A robot shoves a disc into another; two more are out of the way. Simulation and robots."""
    world = World(bounds=[-5, -5, 5, 5], wall_height=0.3)
    for x, y in ((0.6, 0.1), (1.5, 0.1), (2.0, 3.0), (-2.0, 3.0)):
        world.add_disc(x, y, 0.2, 3.0)
    if sleep:
        world.edit(let_discs_sleep)
    robots = world.add_group(RoundPusher, [[0.0, 0.0, 0.0], [-3.0, 3.0, 0.0]])
    return Simulation(world, control_period=0.1, dt_max=0.01), robots


def test_sleeping_discs_wake_when_touched_and_go_as_far():
    ends, sleeping = [], []
    for sleep in (False, True):
        simulation, robots = shoved(sleep)
        asleep = []
        simulation.observe(lambda s=simulation, a=asleep: a.append((s.data.tree_asleep >= 0).sum()))
        for t in simulation.ticks(6.0):
            robots.drive([[0.5 if t < 4.0 else 0.0, 0.0], [0.0, 0.0]])
        ends.append(simulation.mover_poses())
        sleeping.append(asleep)
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-3)
    assert ends[1][1, 0] > 1.6
    assert max(sleeping[0]) == 0
    # all four soon sleep; while two are pushed the other two do; no robot ever does
    assert max(sleeping[1][:8]) == 4
    assert min(sleeping[1][1:]) == 2


def test_a_snapshot_with_sleepers_goes_on_with_the_same_bits():
    simulation, robots = shoved(True)

    def go():
        for _ in simulation.ticks(1.5):
            robots.drive([[0.5, 0.1], [0.5, 0.0]])
        return simulation.mover_poses().tobytes() + simulation.poses_of(robots).tobytes()

    go()
    snapshot = simulation.snapshot()
    once, asleep = go(), simulation.data.tree_asleep.copy()
    assert (asleep >= 0).any()
    simulation.restore(snapshot)
    assert go() == once
    fresh, robots = shoved(True)
    fresh.restore(snapshot)
    simulation = fresh
    assert go() == once


def test_a_lift_that_is_refused_wakes_nobody():
    """Nothing has happened: the same bits as where nobody tried, and who slept sleeps on."""
    ends = []
    for tries in (False, True):
        simulation, robots = shoved(True)
        for _ in simulation.ticks(1.5):
            robots.drive([[0.3, 0.1], [0.5, 0.0]])
        asleep = simulation.data.tree_asleep.copy()
        assert (asleep >= 0).any()
        if tries:
            x, y = simulation.mover_poses()[2, :2]
            with pytest.raises(InvalidInputError, match="put down where there is room; disc2"):
                simulation.lift(robots, [1], [[x, y, 0.0]])
            np.testing.assert_array_equal(simulation.data.tree_asleep, asleep)
        for _ in simulation.ticks(1.0):
            robots.drive([[0.3, 0.1], [0.5, 0.0]])
        ends.append(simulation.mover_poses().tobytes() + simulation.poses_of(robots).tobytes())
    assert ends[0] == ends[1]


def test_the_last_seconds_before_a_divergence_are_whole_snapshots():
    """Also among sleepers: put back, they go on with the bits they went on with."""
    simulation, robots = shoved(True)

    def see(seconds, until=None):
        seen = {}
        for _ in simulation.ticks(seconds):
            poses = simulation.mover_poses().tobytes() + simulation.poses_of(robots).tobytes()
            seen[simulation.step] = poses
            robots.drive([[0.5, 0.1], [0.5, 0.0]])
            if until is not None and simulation.time > until:
                simulation.data.qpos[0] = np.nan
        return seen

    seen = see(9.0)  # so long that the memory of old ones is used again
    with pytest.raises(SimulationDivergedError) as caught:
        see(1.0, until=9.05)
    assert len({snapshot.time for snapshot in caught.value.snapshots}) == 10
    for snapshot in caught.value.snapshots[:-1]:
        simulation.restore(snapshot)
        assert simulation.time == snapshot.time == pytest.approx(simulation.data.time)
        again = see(8.9 - simulation.time)
        assert len(again) > 2
        assert all(seen[step] == poses for step, poses in again.items())
    assert (simulation.data.tree_asleep >= 0).any()


def test_rays_meet_discs_that_sleep():
    world = World(bounds=[-5, -5, 5, 5], wall_height=0.3)
    world.add_disc(1.5, 0.0, 0.4, FORCE)
    world.edit(let_discs_sleep)
    robots = world.add_group(RoundPusher, [[0.0, 0.0, 0.0]])
    lidar = robots.mount(Lidar(beams=3, field_of_view=0.2, position=(0.0, 0.0, 0.2)))
    simulation = Simulation(world, control_period=0.1, dt_max=0.01)
    for _ in simulation.ticks(1.0):
        pass
    assert simulation.data.tree_asleep[0] >= 0
    assert lidar.read()[0, 1] == pytest.approx(1.1, abs=1e-3)


def test_discs_that_cannot_be_are_refused():
    world = World(bounds=[-1, -1, 1, 1])
    for name in ("radius", "height", "friction_force", "mass"):
        for value in (0.0, -1.0, np.nan, np.inf):
            given = {"radius": 0.1, "friction_force": 1.0} | {name: value}
            with pytest.raises(InvalidInputError, match=f"disc's {name} must be positive"):
                world.add_disc(0.0, 0.0, **given)
    with pytest.raises(InvalidInputError, match="place must be finite"):
        world.add_disc(np.nan, 0.0, 0.1, 1.0)
    with pytest.raises(InvalidInputError, match=r"must lie within x -0.9 to 0.9"):
        world.add_disc(0.95, 0.0, 0.1, 1.0)
    with pytest.raises(InvalidInputError, match="must be higher; got 0.05 m"):
        world.add_disc(0.0, 0.0, 0.1, 1.0, height=0.05)
    assert not world.props
    with pytest.raises(InvalidInputError, match="none of box, ball, cart, disc"):
        world.add_group(RoundPusher, [[0, 0, 0]], name="disc3")


def test_a_robot_cannot_start_in_a_disc():
    world = World(bounds=[-2, -2, 2, 2])
    world.add_disc(0.3, 0.0, 0.2, FORCE)
    world.add_group(RoundPusher, [[0.0, 0.0, 0.0]])
    with pytest.raises(InvalidInputError, match="disc0 and round_pusher0 by 1.. mm"):
        Simulation(world)
