"""Sonars and infra-red rangers: edges of cones, slants, materials, schedule, bad input."""

import math

import mujoco
import numpy as np
import pytest

from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.kinematics import KinematicSimulation
from mjmr.robots import Pioneer2DX, SoccerBot
from mjmr.sensors.rangers import InfraredRanger, Sonar
from mjmr.simulation import Simulation
from mjmr.world import World
from tests.mjmr.rays import crowded, hall
from tests.mjmr.worlds import BOTH


def see(kind, robots, world, sensors, seed=0):
    """Mount sensors by name, take one sample, return what each reads (n, k)."""
    for name, sensor in sensors.items():
        robots.mount(sensor, name)
    simulation = kind(world, control_period=0.1, seed=seed)
    for _ in simulation.ticks(0.1):
        return {name: sensor.read().copy() for name, sensor in sensors.items()}
    raise AssertionError


def post(x, y, radius=0.05, height=0.5):
    """An edit that stands a post on the floor."""

    def add(spec):
        spec.worldbody.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CYLINDER, pos=[x, y, height / 2],
            size=[radius, height / 2, 0], group=0,
        )  # fmt: skip

    return add


@pytest.mark.parametrize("width", [20.0, 30.0])
@pytest.mark.parametrize("side", [1, -1])
def test_a_cone_ends_within_a_degree_of_where_it_should(width, side):
    """A post at 2 m is walked out of the cone in steps of a quarter of a degree."""
    bearings, seen = np.arange(width / 2 - 3, width / 2 + 5, 0.25), []
    for bearing in bearings:
        world = World.rectangle(20.0, 20.0, wall_height=0.5)
        robots = world.add_group(Pioneer2DX, [[0, 0, 0]])
        site = np.array([-0.225, -0.0217])  # of sonar11, which looks to -170 degrees
        angle = np.radians(-170.0 + side * bearing)
        world.edit(post(*(site + 2.0 * np.array([np.cos(angle), np.sin(angle)]))))
        sonar = Sonar(sites=("sonar11",), beam_width=math.radians(width), max_incidence=math.pi / 2)
        seen.append(np.isfinite(see(KinematicSimulation, robots, world, {"s": sonar})["s"][0, 0]))
    seen = np.array(seen)
    assert seen[0]
    last = bearings[seen].max()
    assert seen[bearings <= last].all()
    # the post is seen until its near side has left the cone
    edge = width / 2 + np.degrees(np.arcsin(0.05 / 2.0))
    assert last == pytest.approx(edge, abs=0.5)


@pytest.mark.parametrize("kind", BOTH)
def test_the_nearest_return_of_every_sonar_of_a_ring(kind):
    """In the middle of a room each sonar meets a wall; with no slant the nearest ray counts."""
    world = World.rectangle(4.0, 4.0, wall_height=0.5)
    robots = world.add_group(Pioneer2DX, [[0.0, 0.0, 0.0]])
    found = see(kind, robots, world, {"ring": Sonar(max_incidence=math.pi / 2, rays=31)})["ring"]
    assert found.shape == (1, 16)
    assert robots.ring.site_names == tuple(f"sonar{i}" for i in range(16))
    mounts = robots.ring.mounts
    assert np.degrees(mounts[:4, 2]) == pytest.approx([90, 50, 30, 10], abs=1e-3)
    for (x, y, yaw), measured in zip(mounts, found[0], strict=True):
        angles = yaw + np.radians(np.linspace(-15, 15, 31))
        with np.errstate(divide="ignore"):
            to_x = (np.copysign(2.0, np.cos(angles)) - x) / np.cos(angles)
            to_y = (np.copysign(2.0, np.sin(angles)) - y) / np.sin(angles)
        assert measured == pytest.approx(np.minimum(to_x, to_y).min(), abs=5e-4)


@pytest.mark.parametrize("turn", [0.0, 20.0, 38.0, 42.0, 60.0])
def test_a_slanted_wall_returns_nothing_beyond_the_limit(turn):
    """A wall is heard if some ray of the cone, 15 degrees wide each way, meets it within 25."""
    world = World.rectangle(20.0, 20.0, wall_height=0.5)
    world.add_box(2.0, 0.0, 0.1, 5.0, yaw=math.radians(turn), height=0.5)
    robots = world.add_group(SoccerBot, [[0, 0, 0]])
    sonar = Sonar(sites=("top",), rays=61, min_range=0.0)
    infrared = InfraredRanger(sites=("top",), max_range=4.0)
    # the site is at 153 mm, and looks forward
    found = see(KinematicSimulation, robots, world, {"sonar": sonar, "infrared": infrared})
    assert np.isfinite(found["sonar"][0, 0]) == (turn < 40.0)
    assert np.isfinite(found["infrared"][0, 0])


def test_mirrors_and_black_walls_are_heard_and_not_seen():
    for material in ("mirror", "black"):
        world = hall()
        world.add_box(1.0, 0.0, 0.2, 2.0, material=material)
        robots = world.add_group(SoccerBot, [[0, 0, 0]])
        sensors = {
            "sonar": Sonar(sites=("top",)),
            "infrared": InfraredRanger(sites=("top",), max_range=5.0),
        }
        found = see(KinematicSimulation, robots, world, sensors)
        assert found["sonar"][0, 0] == pytest.approx(0.9)
        assert np.isposinf(found["infrared"][0, 0])


def test_more_fans_see_what_is_below_the_first_one():
    """A sill of 80 mm, with sonars at 180 mm: outside the flat fan, inside the cone."""
    world = World.rectangle(20.0, 20.0, wall_height=0.5)
    world.add_box(1.0, 0.0, 0.1, 4.0, height=0.08)
    robots = world.add_group(Pioneer2DX, [[0, 0, 0]])
    sensors = {
        "flat": Sonar(max_incidence=math.radians(60.0)),
        "full": Sonar(max_incidence=math.radians(60.0), fans=4, rays=31),
    }
    found = see(KinematicSimulation, robots, world, sensors)
    assert np.isposinf(found["flat"][0, 3])
    assert 0.71 < found["full"][0, 3] < 0.85


@pytest.mark.parametrize("kind", BOTH)
def test_other_robots_are_seen_and_the_own_one_is_not(kind):
    world = World.rectangle(20.0, 20.0, wall_height=0.5)
    robots = world.add_group(Pioneer2DX, [[-0.5, 0, 0], [0.5, 0.0, math.pi]])
    found = see(kind, robots, world, {"sonar": Sonar()})["sonar"]
    # from the sonar at 225 mm to the other's hull
    assert found[:, 3:5] == pytest.approx(0.5 - 0.22 + 0.5 - 0.225, abs=6e-3)
    assert np.isposinf(np.delete(found, [2, 3, 4, 5], axis=1)).all()


def test_noise_loss_and_limits():
    world = World.rectangle(2.0, 30.0, wall_height=0.5)
    robots = world.add_group(SoccerBot, [[0, y, 0] for y in np.linspace(-12, 12, 50)])
    robots.mount(
        Sonar(sites=("top",), noise=0.01, proportional_noise=0.03, rate=60.0, drop_out=0.2)
    )
    robots.mount(Sonar(sites=("top",), min_range=1.5), "near")
    robots.mount(Sonar(sites=("top",), max_range=0.9), "far")
    simulation = KinematicSimulation(world, seed=2)
    seen = np.array([robots.sonar.read().copy() for _ in simulation.ticks(50.0)])
    assert seen.size >= 1e5
    assert np.isnan(seen).mean() == pytest.approx(0.2, rel=0.05)
    error = seen[np.isfinite(seen)] - 1.0
    assert abs(error.mean()) < 0.05 * 0.03
    assert error.std() == pytest.approx(0.03, rel=0.05)
    assert np.isneginf(robots.near.read()).all()
    assert np.isposinf(robots.far.read()).all()


def test_schedule_determinism_and_snapshots():
    def run(read):
        world, robots, _ = crowded(2)
        robots.mount(Sonar(rate=10.0, latency=0.1, noise=0.01))
        simulation = Simulation(world, seed=5)
        values, stamps, snapshot = [], [], None
        for k, _ in enumerate(simulation.ticks(0.6)):
            if k == 20:
                snapshot = simulation.snapshot()
            robots.drive(np.full((12, 2), 0.2))
            if read(k):
                values.append(robots.sonar.read().copy())
                stamps.append(robots.sonar.sampled_at)
        return simulation, robots, np.array(values), np.array(stamps), snapshot

    simulation, robots, every, stamps, snapshot = run(lambda k: True)
    late = np.isnan(stamps)
    np.testing.assert_array_equal(late, np.arange(36) < 6)
    assert np.isnan(every[late]).all()
    age = np.arange(36)[~late] / 60 - stamps[~late]
    assert age.min() == pytest.approx(0.1)
    assert age.max() == pytest.approx(0.2 - 1 / 60)
    assert run(lambda k: k % 5 == 2)[2].tobytes() == every[2::5].tobytes()
    simulation.restore(snapshot)
    again = []
    for _ in simulation.ticks(16 / 60):
        robots.drive(np.full((12, 2), 0.2))
        again.append(robots.sonar.read().copy())
    assert np.array(again).tobytes() == every[20:].tobytes()


@pytest.mark.parametrize(
    "options",
    [
        {"rate": 0.0},
        {"max_range": -1.0},
        {"min_range": 9.0},
        {"beam_width": 0.0},
        {"beam_width": 4.0},
        {"max_incidence": 0.0},
        {"max_incidence": 2.0},
        {"rays": 1},
        {"rays": 2.5},
        {"fans": 0},
        {"noise": -1.0},
        {"drop_out": -0.1},
        {"sites": ()},
    ],
)
@pytest.mark.parametrize("kind", [Sonar, InfraredRanger])
def test_bad_options_are_refused_in_one_sentence(kind, options):
    with pytest.raises(InvalidInputError) as caught:
        kind(**options)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("sites", "listed"), [("sonnar", "valid: sonar"), (("sonar16",), "sonar15")]
)
def test_unknown_sites_list_those_there_are(sites, listed):
    world = hall()
    robots = world.add_group(Pioneer2DX, [[0, 0, 0]])
    robots.mount(Sonar(sites=sites))
    with pytest.raises(UnknownNameError, match=listed):
        Simulation(world)
