"""Lines of sight: against MuJoCo's rays, one by one."""

import mujoco
import numpy as np
import pytest

from mjmr.errors import InvalidInputError
from mjmr.kinematics import KinematicSimulation
from mjmr.robots import Pioneer2DX, SoccerBot
from mjmr.sensors.line_of_sight import LineOfSight, clear_lines, line_of_sight, robot_points
from mjmr.simulation import Simulation
from mjmr.world import World
from tests.mjmr.rays import crowded, hall
from tests.mjmr.worlds import BOTH


def one_by_one(simulation, starts, ends, start_robots, end_robots):
    """The same by mj_ray, which steps through the two robots' own geoms."""
    model, names = simulation.model, simulation.team.names
    data = mujoco.MjData(model)
    data.qpos[:] = simulation.data.qpos
    mujoco.mj_kinematics(model, data)
    group = np.array([1, 0, 0, 0, 0, 0], dtype=np.uint8)
    clear = np.ones((len(starts), len(ends)), dtype=bool)
    for i, start in enumerate(starts):
        for j, end in enumerate(ends):
            own = {names[r] for r in (start_robots[i], end_robots[j]) if r >= 0}
            way = end - start
            length = np.linalg.norm(way)
            gone, hit = 0.0, np.zeros(1, dtype=np.int32)
            while gone < length:
                unit = way / length
                step = mujoco.mj_ray(model, data, start + gone * unit, unit, group, 1, -1, hit)
                if step < 0 or gone + step >= length:
                    break
                if model.body(model.geom_bodyid[hit[0]]).name.split("/")[0] not in own:
                    clear[i, j] = False
                    break
                gone += step + 1e-9
    return clear


@pytest.mark.parametrize("seed", range(2))
def test_lines_are_what_single_rays_say(seed):
    world, _, _ = crowded(seed)
    simulation = Simulation(world, control_period=0.1)
    for _ in simulation.ticks(0.3):
        for group in world.groups:
            group.drive(np.full((12, len(group.platform.command_names)), 0.3))
    found = line_of_sight(simulation)
    points = robot_points(simulation)
    np.testing.assert_allclose(points[:12, 2], 0.11, atol=2e-3)
    np.testing.assert_allclose(points[12:, 2], 0.075, atol=2e-3)
    robots = np.arange(24)
    expected = one_by_one(simulation, points, points, robots, robots)
    np.fill_diagonal(expected, True)
    np.testing.assert_array_equal(found, expected)
    np.testing.assert_array_equal(found, found.T)
    assert 0.1 < found.mean() < 0.9
    rng = np.random.default_rng(seed)
    free = rng.uniform([-6, -4, 0.05], [6, 4, 0.3], (60, 3))
    nobody = np.full(60, -1)
    np.testing.assert_array_equal(
        clear_lines(points, free, simulation.rays, from_robots=robots),
        one_by_one(simulation, points, free, robots, nobody),
    )


@pytest.mark.parametrize("kind", BOTH)
def test_boxes_and_robots_are_in_the_way_and_the_two_concerned_are_not(kind):
    world = hall()
    world.add_box(-1.5, 0.0, 0.2, 0.2, height=0.3)
    robots = world.add_group(Pioneer2DX, [[-3, 0, 0], [0, 0, 1], [0, 1, 2]])
    others = world.add_group(SoccerBot, [[3, 0, 0], [3, 1, 0]])
    robots.mount(LineOfSight())
    robots.mount(LineOfSight(points=[[-1.5, 1.0, 0.1], [-1.5, 0.0, 0.1], [9, 0, 0.1]]), "beacons")
    robots.mount(LineOfSight(height=0.35), "masts")
    world.mount(LineOfSight(), "everybody")
    simulation = kind(world, control_period=0.1)
    for _ in simulation.ticks(0.1):
        expected = [[1, 0, 1, 0, 1], [0, 1, 1, 1, 1], [1, 1, 1, 1, 1]]
        np.testing.assert_array_equal(robots.line_of_sight.read(), np.array(expected, dtype=bool))
        # the second beacon is inside the box, the third behind the wall
        np.testing.assert_array_equal(robots.beacons.read(), [[1, 0, 0]] * 3)
        assert robots.masts.read().all()
        everybody = world.sensors["everybody"].read()
        assert everybody.shape == (5, 5)
        np.testing.assert_array_equal(everybody[:3], robots.line_of_sight.read())
        np.testing.assert_array_equal(everybody, line_of_sight(simulation))
    assert others.n == 2


def test_it_is_late_like_every_sensor():
    world = hall()
    world.add_box(0.0, 0.5, 0.1, 1.0, height=0.3)
    robots = world.add_group(SoccerBot, [[-1, -0.1, 0], [1, -0.1, 0]])
    robots.mount(LineOfSight(rate=10.0, latency=0.2))
    simulation = KinematicSimulation(world, control_period=0.1)
    seen = []
    for _ in simulation.ticks(1.0):
        robots.drive([[0.0, 1.0, 0.0]] * 2)
        seen.append(bool(robots.line_of_sight.read()[0, 1]))
    # at 1 m/s, reached within the first tick, the box is between them from y = 0, 0.15 s, on
    assert seen == [False, False, True, True] + [False] * 6


def test_bad_points_are_refused():
    for points in ([[0, 0]], [0, 0, 0], [[0, 0, np.nan]]):
        with pytest.raises(InvalidInputError, match="shape"):
            LineOfSight(points=points)
    with pytest.raises(InvalidInputError, match="height"):
        LineOfSight(height=np.inf)
    with pytest.raises(InvalidInputError, match="rate"):
        LineOfSight(rate=0.0)
    world = hall()
    world.add_group(SoccerBot, [[0, 0, 0]])
    simulation = KinematicSimulation(world)
    with pytest.raises(InvalidInputError, match="one robot a point"):
        clear_lines([[0, 0, 0]], [[1, 0, 0]], simulation.rays, from_robots=[0, 1])


def test_no_points_are_seen_by_anybody_even_past_a_mesh():
    world = World.rectangle(6.0, 6.0)
    corners = [0, 0, 0, 0.3, 0, 0, 0, 0.3, 0, 0, 0, 0.3]

    def add_mesh(spec):
        spec.add_mesh(name="wedge", uservert=corners)
        mesh = mujoco.mjtGeom.mjGEOM_MESH
        spec.worldbody.add_geom(type=mesh, meshname="wedge", pos=[2, 2, 0], group=0)

    world.edit(add_mesh)
    robots = world.add_group(Pioneer2DX, [[0.0, 0.0, 0.0]])
    sight = robots.mount(LineOfSight(points=np.zeros((0, 3))))
    for _ in Simulation(world, control_period=0.1).ticks(0.1):
        assert sight.read().shape == (1, 0)
