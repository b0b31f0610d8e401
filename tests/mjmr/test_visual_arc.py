"""Visual arcs against geometry: limits of field and range, occlusion, kinds, turning, errors."""

import math

import numpy as np
import pytest

from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.robots.round_pusher import RoundPusher
from mjmr.sensors.beacon import Beacon
from mjmr.sensors.visual_arc import FIXED, MOVER, NOTHING, ROBOT, VisualArc
from mjmr.simulation import Simulation
from mjmr.world import World


def look(poses, discs=(), pan=0.0, ticks=1, seed=0, **options):
    """First look of all robots (n, c, 2), and the arc."""
    world = World(bounds=[-5, -5, 5, 5], wall_height=0.3)
    for x, y, radius in discs:
        world.add_disc(x, y, radius, 5.0, height=0.17)
    robots = world.add_group(RoundPusher, poses)
    arc = robots.mount(VisualArc(**({"site": "turret", "height": 0.1} | options)))
    simulation = Simulation(world, control_period=0.1, dt_max=0.01, seed=seed)
    for _ in simulation.ticks(0.1 * ticks):
        robots.turret.aim(pan)
        seen = arc.read().copy()
    return seen, arc


def test_ranges_and_kinds_are_those_of_circles_and_walls():
    seen, arc = look([[0, 0, 0.3]], discs=[(1.5, 0.6, 0.25)])
    beams = arc.angles + 0.3
    for angle, (distance, kind) in zip(beams, seen[0], strict=True):
        along = 1.5 * math.cos(angle) + 0.6 * math.sin(angle)
        across = 1.5 * math.sin(angle) - 0.6 * math.cos(angle)
        if abs(across) < 0.25:
            expected = along - math.sqrt(0.25**2 - across**2)
            assert distance == pytest.approx(expected, abs=2e-3)
            assert kind == MOVER
        elif abs(across) > 0.252:
            assert distance == np.inf
            assert kind == NOTHING


def test_nothing_is_seen_beyond_range_or_field():
    # nearest surfaces at 3.05 m ahead, and at 50 degrees to the side of 45
    side = np.radians(50.0 + np.degrees(math.asin(0.1 / 2.0)))
    seen, _ = look(
        [[0, 0, 0]], discs=[(3.15, 0, 0.1), (2 * math.cos(side), 2 * math.sin(side), 0.1)]
    )
    assert (seen[0, :, 1] == NOTHING).all()
    seen, _ = look([[0, 0, 0]], discs=[(3.05, 0, 0.1)])
    assert (seen[0, :, 1] == MOVER).any()


def test_what_is_behind_something_else_is_hidden():
    seen, _ = look([[0, 0, 0]], discs=[(1.0, 0, 0.1), (2.0, 0, 0.12)])
    ranges = seen[0, seen[0, :, 1] == MOVER, 0]
    assert ranges.max() < 1.1


def test_robots_see_each_other_and_walls_but_not_themselves():
    seen, arc = look([[3.0, 0, 0], [4.2, 0.0, np.pi]])
    middle = len(arc.angles) // 2
    assert seen[0, middle, 1] == ROBOT
    assert seen[0, middle, 0] == pytest.approx(1.2 - RoundPusher.radius, abs=3e-3)
    assert FIXED in seen[0, :, 1]
    # what it sees of the wall is where the wall is
    walls = seen[0, :, 1] == FIXED
    x = 3.0 + seen[0, walls, 0] * np.cos(arc.angles[walls])
    assert x == pytest.approx(5.0, abs=5e-3)


def test_the_arc_turns_with_the_turret():
    still, _ = look([[0, 0, 0]], discs=[(0, 1.5, 0.2)])
    assert (still[0, :, 1] == NOTHING).all()
    turned, arc = look([[0, 0, 0]], discs=[(0, 1.5, 0.2)], pan=np.pi / 2, ticks=15)
    hit = turned[0, :, 1] == MOVER
    assert arc.angles[hit].mean() == pytest.approx(0.0, abs=0.02)


def test_noise_depends_on_the_seed_and_is_as_large_as_stated():
    options = {"noise": 0.05, "columns": 400, "field_of_view": 0.2}
    exact, _ = look([[0, 0, 0]], discs=[(2, 0, 0.5)], columns=400, field_of_view=0.2)
    first, _ = look([[0, 0, 0]], discs=[(2, 0, 0.5)], **options)
    again, _ = look([[0, 0, 0]], discs=[(2, 0, 0.5)], **options)
    other, _ = look([[0, 0, 0]], discs=[(2, 0, 0.5)], **options, seed=1)
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)
    assert (first - exact)[0, :, 0].std() == pytest.approx(0.05, rel=0.15)


@pytest.mark.parametrize(
    ("options", "error"),
    [
        ({"site": "nose"}, UnknownNameError),
        ({"columns": 1}, InvalidInputError),
        ({"field_of_view": 7.0}, InvalidInputError),
        ({"height": 0.0}, InvalidInputError),
        ({"max_range": -1.0}, InvalidInputError),
    ],
)
def test_bad_input_is_refused(options, error):
    with pytest.raises(error):
        look([[0, 0, 0]], **options)


def test_a_beacon_tells_bearing_and_distance():
    world = World(bounds=[-5, -5, 5, 5])
    robots = world.add_group(RoundPusher, [[3, 0, 0], [0, -2, np.pi / 2], [-3, 4, 0.5]])
    robots.mount(Beacon(position=(0.0, 0.0)))
    robots.mount(Beacon(bearing_noise=0.1, distance_noise=0.1), "rough")
    simulation = Simulation(world, control_period=0.1, dt_max=0.01)
    rough = []
    for _ in simulation.ticks(20.0):
        exact = robots.beacon.read()
        rough.append(robots.rough.read())
    assert exact[:, 1] == pytest.approx([3, 2, 5], abs=1e-3)
    bearing = [np.pi, 0.0, math.atan2(-4, 3) - 0.5]
    assert np.cos(exact[:, 0] - bearing) == pytest.approx(1.0, abs=1e-4)
    off = np.array(rough)[:, 1:] - exact[1:]
    assert off[..., 0].std() == pytest.approx(0.1, rel=0.2)
    assert off[:, 1, 1].std() == pytest.approx(0.5, rel=0.2)
    with pytest.raises(InvalidInputError):
        Beacon(position=(1.0, 2.0, 3.0))
    with pytest.raises(InvalidInputError):
        Beacon(bearing_noise=-0.1)
