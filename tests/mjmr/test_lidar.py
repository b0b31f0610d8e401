"""Lidars: against plain geometry, MuJoCo's own rays, and what their docstrings promise."""

import math

import mujoco
import numpy as np
import pytest
from scipy.stats import qmc

from mjmr.cart import Cart
from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.kinematics import KinematicSimulation
from mjmr.robots import Pioneer2DX, SoccerBot
from mjmr.sensors.lidar import Lidar
from mjmr.sensors.line_of_sight import LineOfSight
from mjmr.sensors.rangers import Sonar
from mjmr.simulation import Simulation
from mjmr.world import Box, World
from tests.mjmr.rays import crowded, hall, rectangle, to_edges
from tests.mjmr.worlds import BOTH

INSIDE = (0.05, 0.02, 0.12)  # within a Pioneer's hull, beside its wheels


def tick(simulation, count=1):
    for _ in simulation.ticks(count * simulation.control_period):
        pass


@pytest.mark.parametrize("kind", BOTH)
def test_ranges_equal_plain_geometry(kind):
    """Walls, boxes, a cart, balls, discs and other Pioneers, within 0.1 mm."""
    world = hall()
    pioneers = world.add_group(Pioneer2DX, [[0, 0, 0.4], [2.0, 0.5, 1.0], [-1.5, -1.5, -2.0]])
    bots = world.add_group(SoccerBot, [[0.6, -0.8, 0.0], [-1.0, 0.9, 1.0]])
    boxes = [world.add_box(1.0, 1.6, 0.5, 0.3, yaw=0.7), world.add_box(-3, 1, 0.4, 0.4)]
    world.add_box(0.0, -2.0, 0.4, 0.4, height=0.05)  # the beams pass over it
    cart = world.add_cart(3.0, -1.0, 0.3, 0.5, travel=1.0, speed=0.2, yaw=1.0)
    height = 0.1
    options = {"rate": 1.0, "max_range": 20.0}
    pioneers.mount(Lidar(position=(0.2, 0.1, height), yaw=0.3, beams=361, **options))
    bots.mount(Lidar(position=(0, 0, height), beams=720, field_of_view=2 * np.pi, **options))
    simulation = kind(world, control_period=0.1)
    tick(simulation)
    seen = [pioneers.lidar.read(), bots.lidar.read()]
    walls = rectangle(0, 0, 0, 4, 3)
    shapes = [rectangle(b.x, b.y, b.yaw, b.length / 2, b.width / 2) for b in boxes]
    # the samples are of time 0, when everything is where it was put
    shapes.append(rectangle(*cart.box(cart.along(0.0)[0])))
    # a Pioneer stands pitched by a milliradian: where its axis is at the height of the beams
    places, turns = simulation.rays.bases()
    there = places[:, :2] + height * turns[:, :2, 2]
    np.testing.assert_allclose(there[:3], pioneers.start[:, :2], atol=2e-4)
    hulls = [
        rectangle(*xy, yaw, 0.22, 0.19)
        for xy, yaw in zip(there, pioneers.start[:, 2], strict=False)
    ]
    discs = [(x, y, 0.09) for x, y in there[3:]]
    for group, ranges, (dx, dy), turn in (
        (pioneers, seen[0], (0.2, 0.1), 0.3),
        (bots, seen[1], (0.0, 0.0), 0.0),
    ):
        assert np.isfinite(ranges).all()
        rows = there[:3] if group is pioneers else there[3:]
        for i, (x, y) in enumerate(rows):
            yaw = group.start[i, 2]
            c, s = np.cos(yaw), np.sin(yaw)
            origin = np.array([x + c * dx - s * dy, y + s * dx + c * dy])
            others = [h for k, h in enumerate(hulls) if group is not pioneers or k != i]
            round_ones = [d for k, d in enumerate(discs) if group is not bots or k != i]
            truth = to_edges(
                origin, yaw + turn + group.lidar.angles, [walls, *shapes, *others], round_ones
            )
            # a beam that grazes a corner may go either way
            error = np.sort(np.abs(ranges[i] - truth))
            assert error[:-2].max() < 1e-4
    np.testing.assert_allclose(pioneers.lidar.mount, [0.2, 0.1, 0.3], atol=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_both_casters_agree_in_random_worlds(seed):
    """Driven about for a second: ranges, geoms and angles of incidence, tilt and all."""
    world, pioneers, bots = crowded(seed)
    pioneers.mount(Lidar(position=INSIDE, beams=91, field_of_view=2 * np.pi, max_range=9.0))
    pioneers.mount(Lidar.lms200(), "high")
    bots.mount(Lidar(position=(0.0, 0.0, 0.03), beams=181, field_of_view=4.0, max_range=5.0))
    simulation = Simulation(world, control_period=0.1)
    rng = np.random.default_rng(seed)
    for _ in simulation.ticks(1.0):
        pioneers.drive(rng.uniform(-1, 1, (12, 2)))
        bots.drive(rng.uniform(-1, 1, (12, 3)))
    scene = simulation.rays
    scene.show(simulation.visible_state())
    for lidar in (pioneers.lidar, pioneers.high, bots.lidar):
        arguments = (*scene.frames(lidar._sites()), lidar._rows, lidar.angles, lidar.max_range)
        ours, our_hits, our_cosines = scene.cast(*arguments, "compiled", cosines=True)
        theirs, their_hits, their_cosines = scene.cast(*arguments, "mujoco", cosines=True)
        np.testing.assert_array_equal(np.isinf(ours), np.isinf(theirs))
        some = np.isfinite(ours)
        assert some.mean() > 0.2
        np.testing.assert_allclose(ours[some], theirs[some], atol=1e-9)
        np.testing.assert_array_equal(our_hits, their_hits)
        np.testing.assert_allclose(our_cosines, their_cosines, atol=1e-6)
        # nothing but collision geometry, and never the robot's own
        own = scene._owners[our_hits] == lidar._rows[:, None]
        assert not (own & some).any()
        assert (simulation.model.geom_group[our_hits[some]] == 0).all()


@pytest.mark.parametrize("seed", range(3))
def test_both_casters_agree_on_every_shape_however_it_lies(seed):
    rng = np.random.default_rng(seed)
    world = hall()
    kinds = ("SPHERE", "CAPSULE", "ELLIPSOID", "CYLINDER", "BOX")

    def clutter(spec):
        for kind in kinds * 12:
            spec.worldbody.add_geom(
                type=getattr(mujoco.mjtGeom, f"mjGEOM_{kind}"),
                pos=rng.uniform([-4, -3, 0], [4, 3, 0.6]),
                quat=rng.normal(size=4),
                size=rng.uniform(0.05, 0.4, 3),
                group=0,
            )

    world.edit(clutter)
    robots = world.add_group(SoccerBot, [[x, 0, 0] for x in (-3, -1, 1, 3)])
    simulation = KinematicSimulation(world)
    scene = simulation.rays
    scene.show(simulation.visible_state())
    count = 40
    origins = rng.uniform([-4, -3, 0.0], [4, 3, 0.7], (count, 3))
    frames = np.linalg.qr(rng.normal(size=(count, 3, 3)))[0]
    frames[:, :, 2] = np.cross(frames[:, :, 0], frames[:, :, 1])
    nobody = np.full(count, -1)
    for beams, width in ((200, 2 * np.pi * 199 / 200), (100, 2.0), (1, 0.0), (2, 0.1)):
        angles = np.linspace(-width / 2, width / 2, beams) if beams > 1 else np.zeros(1)
        ours, our_hits, our_cosines = scene.cast(
            origins, frames, nobody, angles, 6.0, "compiled", True
        )
        theirs, their_hits, their_cosines = scene.cast(
            origins, frames, nobody, angles, 6.0, "mujoco", True
        )
        assert (our_hits == their_hits).mean() > 0.999
        same = (our_hits == their_hits) & (our_hits >= 0)
        assert same.mean() > 0.5
        np.testing.assert_allclose(ours[same], theirs[same], atol=1e-9)
        assert (np.abs(our_cosines - their_cosines)[same] < 1e-5).mean() > 0.995
    assert robots.n == 4


def test_a_robot_that_tips_still_sees_what_is_there():
    """Thrown on its side among others: the compiled rays need no upright robots."""
    world, pioneers, _ = crowded(5)
    pioneers.mount(Lidar(position=INSIDE, beams=181, field_of_view=6.0))
    simulation = Simulation(world, control_period=0.1)
    data = simulation.data
    for i in range(12):
        data.qvel[simulation.model.joint(f"pioneer2dx{i}/free").dofadr[0] + 2 :][:3] = 3, 9, 4
    tick(simulation, 4)
    tilts = simulation.base_poses_of(pioneers)[:, 4:6]
    assert (np.abs(tilts).max(axis=1) > 0.2).sum() > 3
    scene = simulation.rays
    scene.show(simulation.visible_state())
    arguments = (*scene.frames(pioneers.lidar._sites()), np.arange(12), pioneers.lidar.angles, 8.0)
    ours, our_hits, _ = scene.cast(*arguments, "compiled")
    theirs, their_hits, _ = scene.cast(*arguments, "mujoco")
    np.testing.assert_array_equal(our_hits, their_hits)
    some = our_hits >= 0
    np.testing.assert_allclose(ours[some], theirs[some], atol=1e-9)


def test_a_mesh_is_seen_by_auto_and_mujoco_and_refused_by_compiled():
    world = hall()

    def add(spec):
        corners = [[2, -1, 0], [2, 1, 0], [3, 0, 0], [2, 0, 1.0]]
        spec.add_mesh(name="tent", uservert=np.ravel(corners))
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="tent", group=0)

    world.edit(add)
    robots = world.add_group(Pioneer2DX, [[0, 0, 0]])
    for method in ("auto", "mujoco", "compiled"):
        robots.mount(Lidar(position=(0, 0, 0.15), method=method), method)
    robots.mount(Sonar())
    tick(Simulation(world, control_period=0.1))
    # its front is upright, and met within the sonar's 25 degrees
    assert robots.sonar.read()[0, 3:5] == pytest.approx(1.77, abs=0.01)
    assert robots.auto.read()[0, 90] == pytest.approx(2.0, abs=1e-3)
    np.testing.assert_allclose(robots.auto.read(), robots.mujoco.read(), atol=1e-12)
    with pytest.raises(InvalidInputError, match="mjGEOM_MESH"):
        robots.compiled.read()


def test_beams_pass_over_what_is_lower_than_they_are():
    world = World.rectangle(4.0, 4.0)  # walls of 0.1 m
    robots = world.add_group(Pioneer2DX, [[0, 0, 0]])
    robots.mount(Lidar(position=(0, 0, 0.105)), "over")
    robots.mount(Lidar(position=(0, 0, 0.095)), "against")
    tick(KinematicSimulation(world))
    assert np.isinf(robots.over.read()).all()
    assert robots.against.read()[0, 90] == pytest.approx(2.0, abs=2e-4)


def test_a_housing_is_seen_and_touched_and_holds_the_optics():
    world = hall()
    robots = world.add_group(Pioneer2DX, [[-1, 0, 0], [1, 0, 0]])
    robots.mount(Lidar.lms200(noise=0.0, latency=0.0))
    simulation = Simulation(world, control_period=0.1)
    tick(simulation)
    # from the middle of one housing to the back of the other
    assert robots.lidar.read()[0, 90] == pytest.approx(2.0 - 0.078, abs=1e-4)
    model = simulation.model
    housing = model.geom("pioneer2dx0/lidar_housing")
    assert housing.contype[0] == 1
    np.testing.assert_allclose(2 * housing.size, [0.156, 0.155, 0.210])
    np.testing.assert_allclose(housing.pos, [0.1, 0.0, 0.22 + 0.105])
    assert model.body_subtreemass[model.body("pioneer2dx0/base").id] == pytest.approx(9.0)


def test_robots_with_lidars_on_top_see_each_other_without_options():
    world = hall()
    robots = world.add_group(Pioneer2DX, [[-1, 0, 0], [1, 0, np.pi]])
    robots.mount(Lidar())
    tick(Simulation(world, control_period=0.1))
    assert robots.lidar.read()[:, 90] == pytest.approx(2.0 - 2 * 0.1 - 0.05, abs=1e-3)


@pytest.mark.parametrize("material", ["mirror", "black"])
def test_what_returns_no_light_hides_what_is_behind_it(material):
    world = hall()
    world.add_box(1.0, 0.0, 0.2, 0.6, material=material)
    cart = world.add_cart(-1, 0, 0.2, 0.6, travel=0.1, speed=0.1, material=material, yaw=0.1)
    assert cart.material == material
    robots = world.add_group(SoccerBot, [[0, 0, 0]])
    robots.mount(Lidar(position=(0, 0, 0.1), beams=360, field_of_view=2 * np.pi))
    tick(Simulation(world, control_period=0.1))
    ranges = robots.lidar.read()[0]
    angles = robots.lidar.angles
    for side in (np.abs(angles), np.pi - np.abs(angles)):
        assert np.isinf(ranges[side < np.arctan(0.3) - 0.1]).all()
        assert np.isfinite(ranges[np.abs(side - 0.6) < 0.1]).all()
    dark = hall(wall_material=material)
    robots = dark.add_group(SoccerBot, [[0, 0, 0]])
    robots.mount(Lidar(position=(0, 0, 0.1)))
    tick(KinematicSimulation(dark))
    assert np.isinf(robots.lidar.read()).all()


def test_noise_has_the_stated_mean_and_deviation():
    """1e5 returns and more of each kind, within 5 %."""
    world = World.rectangle(2.0, 16.0, wall_height=0.5)
    robots = world.add_group(SoccerBot, [[0, y, 0] for y in np.arange(-4.5, 5)])
    robots.mount(Lidar(position=(0, 0, 0.2), noise=0.01, rate=60.0, beams=31, field_of_view=1.2))
    robots.mount(
        Lidar(position=(0, 0, 0.2), noise=0.01, proportional_noise=0.02, rate=60.0, drop_out=0.1,
              beams=31, field_of_view=2.4), "far",
    )  # fmt: skip
    simulation = KinematicSimulation(world, seed=4)
    near, far = [], []
    for _ in simulation.ticks(8.0):
        near.append(robots.lidar.read().copy())
        far.append(robots.far.read().copy())
    error = np.array(near) - 1.0 / np.cos(robots.lidar.angles)
    assert error.size > 1e5
    assert abs(error.mean()) < 0.05 * 0.01
    assert error.std() == pytest.approx(0.01, rel=0.05)
    assert abs(np.corrcoef(error[:, :, :6].reshape(len(error), -1).T) - np.eye(60)).max() < 0.25
    truth = np.broadcast_to(1.0 / np.cos(robots.far.angles), np.shape(far))
    error = np.array(far) - truth
    kept = np.isfinite(error)
    assert (~kept).mean() == pytest.approx(0.1, rel=0.05)
    assert np.isnan(np.array(far)[~kept]).all()
    # the larger of 10 mm and 2 %
    size = np.maximum(0.01, 0.02 * truth)
    scaled = (error / size)[kept]
    assert scaled.size > 1e5
    assert abs(scaled.mean()) < 0.05
    assert scaled.std() == pytest.approx(1.0, rel=0.05)
    assert 1.9 < size.max() / size.min() < 3.0


def test_too_near_and_too_far_follow_rep_117():
    world = hall()
    robots = world.add_group(SoccerBot, [[3.5, 0, 0]])
    robots.mount(Lidar(position=(0, 0, 0.1), min_range=0.6, max_range=1.01, noise=0.1))
    tick(KinematicSimulation(world))
    ranges, across = robots.lidar.read()[0], 0.5 / np.cos(robots.lidar.angles)
    np.testing.assert_array_equal(np.isneginf(ranges), (across > 0) & (across < 0.6))
    np.testing.assert_array_equal(np.isposinf(ranges), (across > 1.01) | (across < 0))
    assert not np.isnan(ranges).any()


@pytest.mark.parametrize("kind", BOTH)
def test_ten_hertz_and_a_tenth_late_is_exactly_that(kind):
    """Driving at a wall: what is read is how far it was at the instant it is stamped with."""
    world = hall()
    robots = world.add_group(SoccerBot, [[-2.0, 0.0, 0.0]])
    robots.mount(Lidar(position=(0, 0, 0.1), rate=10.0, latency=0.1, beams=3, field_of_view=0.2))
    simulation = kind(world)
    truth = [-2.0]
    simulation.observe(lambda: truth.append(float(simulation.truth.poses(robots)[0, 0])))
    times, stamps, seen = [], [], []
    for t in simulation.ticks(2.0):
        robots.drive([[min(0.5, t), 0.0, 0.0]])
        times.append(t)
        stamps.append(robots.lidar.sampled_at)
        seen.append(robots.lidar.read()[0, 1])
    times, stamps, seen = np.array(times), np.array(stamps), np.array(seen)
    early = times < 0.1 - 1e-9
    assert np.isnan(seen[early]).all()
    age = (times - stamps)[~early]
    assert age.min() == pytest.approx(0.1, abs=1e-9)
    assert age.max() == pytest.approx(0.2 - 1 / 60, abs=1e-9)
    np.testing.assert_allclose(np.round(10 * stamps[~early]), 10 * stamps[~early], atol=1e-9)
    rows = np.round(stamps[~early] * 60).astype(int) + 1  # observers see the start too
    np.testing.assert_allclose(seen[~early], 4.0 - np.array(truth)[rows], atol=1e-6)


def watch(simulation, robots, read=lambda k: True, ticks=30):
    found = []
    for k, _ in enumerate(simulation.ticks(ticks / 60)):
        robots.drive(np.full((robots.n, 2), 0.3))
        if read(k):
            found.append(robots.lidar.read().copy())
    return np.array(found)


def spoiled():
    world, robots, _ = crowded(1)
    robots.mount(Lidar.lms200(rate=40.0, drop_out=0.05))
    return world, robots


def test_same_seed_same_bits_whoever_reads_and_after_a_restore():
    world, robots = spoiled()
    every = watch(Simulation(world, seed=3), robots)
    assert np.isnan(every[10:]).mean() == pytest.approx(0.05, abs=0.01)
    np.random.seed(0)  # noqa: NPY002
    again, robots = spoiled()
    some = watch(Simulation(again, seed=3), robots, read=lambda k: k % 7 == 3)
    assert every[3::7].tobytes() == some.tobytes()
    other, robots = spoiled()
    simulation = Simulation(other, seed=3)
    watch(simulation, robots, ticks=10, read=lambda k: False)
    snapshot = simulation.snapshot()
    first = watch(simulation, robots, ticks=20)
    simulation.restore(snapshot)
    assert first.tobytes() == watch(simulation, robots, ticks=20).tobytes() == every[10:].tobytes()
    robots.lidar.read()
    third, robots = spoiled()
    assert every.tobytes() != watch(Simulation(third, seed=4), robots).tobytes()


def test_ray_sensors_survive_halton_noise_on_all_actuators():
    """1 s, housings on top, pushed about: zero warnings, and every sample is one."""
    world, pioneers, bots = crowded(3)
    pioneers.mount(Lidar.lms200())
    pioneers.mount(Sonar(rate=60.0))
    pioneers.mount(LineOfSight())
    bots.mount(Lidar.urg04lx(site="top", latency=0.0))
    simulation = Simulation(world, control_period=0.25)
    data = simulation.data
    noise = iter(qmc.Halton(simulation.model.nu, rng=3).random(400))

    def shake():
        data.ctrl[:] = 400.0 * (next(noise) - 0.5)

    simulation.watch_steps(shake)
    for _ in simulation.ticks(1.0):
        for sensor in (pioneers.lidar, pioneers.sonar, bots.lidar):
            ranges = sensor.read()
            late = np.isnan(sensor.sampled_at)
            assert np.isnan(ranges).all() if late else not np.isnan(ranges).any()
        assert pioneers.line_of_sight.read()[np.arange(12), np.arange(12)].all()
    assert data.warning.number.sum() == 0
    assert np.hypot(*simulation.truth.twists(pioneers).T[:2]).max() > 0.05


def test_presets_have_the_numbers_of_their_sources():
    sick, fine, hokuyo = Lidar.lms200(), Lidar.lms200(beams=361), Lidar.urg04lx()
    np.testing.assert_allclose(np.degrees(np.diff(sick.angles)), 1.0)
    np.testing.assert_allclose(np.degrees(np.diff(fine.angles)), 0.5)
    assert np.degrees([sick.angles[0], sick.angles[-1]]) == pytest.approx([-90, 90])
    assert (sick.rate, fine.rate, sick.max_range) == (75.0, 37.5, 8.0)
    assert np.degrees(hokuyo.angles[-1] - hokuyo.angles[0]) == pytest.approx(240, abs=0.7)
    assert np.degrees(np.diff(hokuyo.angles)).mean() == pytest.approx(0.36, abs=0.01)
    assert (hokuyo.errors.min_range, hokuyo.max_range, hokuyo.rate) == (0.02, 4.0, 10.0)
    assert Lidar.lms200(rate=10.0).rate == 10.0
    with pytest.raises(InvalidInputError, match="181 or 361"):
        Lidar.lms200(beams=180)


@pytest.mark.parametrize(
    "options",
    [
        {"beams": 0},
        {"beams": -3},
        {"beams": 1.5},
        {"rate": 0.0},
        {"rate": -10.0},
        {"max_range": 0.0},
        {"max_range": -1.0},
        {"max_range": math.inf},
        {"min_range": -0.1},
        {"min_range": 8.0},
        {"field_of_view": 0.0},
        {"field_of_view": 7.0},
        {"noise": -0.1},
        {"noise": math.nan},
        {"proportional_noise": -1.0},
        {"drop_out": 1.1},
        {"latency": -0.1},
        {"position": (1.0, 2.0)},
        {"position": (math.nan, 0.0, 0.0)},
        {"position": (0.0, 0.0, 0.1), "site": "lidar"},
        {"yaw": 1.0},
        {"housing": (0.1, 0.1)},
        {"housing": (0.1, 0.0, 0.1)},
        {"method": "planar"},
    ],
)
def test_bad_options_are_refused_in_one_sentence(options):
    with pytest.raises(InvalidInputError) as caught:
        Lidar(**options)
    assert "\n" not in str(caught.value)


def test_bad_places_and_materials_are_refused():
    world = hall()
    robots = world.add_group(Pioneer2DX, [[0, 0, 0]])
    robots.mount(Lidar(site="lidarr"))
    with pytest.raises(UnknownNameError, match="valid: lidar, "):
        Simulation(world)
    with pytest.raises(InvalidInputError, match="mounted on robots"):
        world.mount(Lidar())
    for make in (
        lambda: Box(x=0, y=0, length=1, width=1, material="glass"),
        lambda: Cart(x=0, y=0, length=1, width=1, travel=1, speed=1, material="glass"),
        lambda: World.rectangle(2, 2, wall_material="glass"),
    ):
        with pytest.raises(UnknownNameError, match="valid: "):
            make()
    twice = robots.mount(Lidar(position=INSIDE), "second")
    with pytest.raises(InvalidInputError, match="already"):
        robots.mount(twice, "second")


@pytest.mark.parametrize("rise", [0.0, 0.05])
def test_housings_that_cover_each_other_are_still_seen(rise):
    """Two scanners on one mount, the second as high or partly above: neither hides the other."""
    world = World.rectangle(6.0, 6.0, wall_height=0.05)
    seer = world.add_group(Pioneer2DX, [[-1.0, 0.0, 0.0]])
    seen = world.add_group(Pioneer2DX, [[1.0, 0.0, math.pi]])
    place = np.array([0.0, 0.0, 0.5])
    for k in range(2):
        housing = {"housing": (0.02, 0.02, 0.1), "position": place + [0.0, 0.0, k * rise]}
        seen.mount(Lidar(**housing), f"lidar{k}")
    # a site at a position is a housing's foot
    eye = {"beams": 1, "max_range": 4.0}
    heights = (0.51, 0.55, 0.59)
    lidars = [
        seer.mount(Lidar(position=[0, 0, z], **eye), f"eye{i}") for i, z in enumerate(heights)
    ]
    tick(Simulation(world, control_period=0.1))
    for lidar in lidars:
        assert lidar.read()[0, 0] == pytest.approx(1.99, abs=0.01)


def test_both_casters_agree_beam_by_beam_around_a_full_turn():
    """Where mj_multiRay misses hulls that beams pass near the edge of (one in 400)."""
    rng = np.random.default_rng(0)
    cells = [(x, y) for x in (-3, -1, 1, 3) for y in (-3, -1, 1, 3)]
    for _ in range(3):
        world = World.rectangle(8.0, 8.0, wall_height=0.5)
        places = rng.permutation(cells)[:8]
        robots = world.add_group(Pioneer2DX, np.column_stack([places, rng.uniform(-3, 3, 8)]))
        options = {"position": (0.0, 0.0, 0.15), "field_of_view": 2 * math.pi, "max_range": 12.0}
        methods = ("compiled", "mujoco")
        lidars = [robots.mount(Lidar(method=m, **options), m) for m in methods]
        tick(KinematicSimulation(world, control_period=0.1))
        assert np.isfinite(lidars[0].read()).all()
        np.testing.assert_allclose(lidars[0].read(), lidars[1].read(), atol=1e-9)
