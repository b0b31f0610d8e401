"""ConeSight: cone, range, what is in the way, and the frame of what is told."""

import math
from typing import Any

import numpy as np
import pytest

from mjmr.errors import InvalidInputError
from mjmr.robots.pioneer2dx import Pioneer2DX
from mjmr.sensors.cone_sight import ConeSight
from mjmr.simulation import Simulation
from mjmr.world import World

EYE, MARK = (0.2, 0.0, 0.3), (0.1, 0.0, 0.4)


def look(poses, box=None, **changes: Any):
    world = World(bounds=[-8, -8, 8, 8], wall_height=0.5)
    if box is not None:
        world.add_box(box[0], box[1], 0.2, 0.2, height=0.6)
    world.add_group(Pioneer2DX, poses)
    options: dict[str, Any] = {"cone": math.radians(90), "range": 6.0, "eye": EYE, "mark": MARK}
    sight = world.mount(ConeSight(**(options | changes)))
    simulation = Simulation(world, control_period=0.1)
    next(simulation.ticks(0.1))
    return sight.read()


def test_it_tells_distance_and_bearing_of_the_mark_from_the_robots_origin():
    seen = look([[0.0, 0.0, np.pi / 2], [1.0, 3.0, np.pi]])
    # the mark of robot 1 is at (0.9, 3.0), robot 0 looks along y
    np.testing.assert_allclose(seen[0, 1], [math.hypot(0.9, 3.0), -math.atan2(0.9, 3.0)], atol=1e-3)
    assert np.isnan(seen[1, 0]).all()
    assert np.isnan(seen[[0, 1], [0, 1]]).all()


@pytest.mark.parametrize(("degrees", "sees"), [(44.0, True), (46.0, False), (-46.0, False)])
def test_the_cone_is_measured_at_the_eye(degrees, sees):
    way = np.radians(degrees)
    mark = np.array([EYE[0], 0.0]) + 3.0 * np.array([np.cos(way), np.sin(way)])
    seen = look([[0.0, 0.0, 0.0], [mark[0] - MARK[0], mark[1], 0.0]])
    assert np.isfinite(seen[0, 1]).all() == sees


@pytest.mark.parametrize(("reach", "sees"), [(2.91, True), (2.89, False)])
def test_the_range_is_measured_at_the_eye(reach, sees):
    seen = look([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]], range=reach)
    assert np.isfinite(seen[0, 1]).all() == sees


def test_what_stands_between_is_in_the_way():
    poses = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0]]
    assert np.isfinite(look(poses)[0, 1]).all()
    assert np.isnan(look(poses, (2.0, 0.0))[0, 1]).all()
    assert np.isfinite(look(poses, (2.0, 0.5))[0, 1]).all()


def test_another_robots_hull_is_in_the_way_of_a_low_line():
    poses = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [2.0, 0.0, 0.0]]
    high, low = look(poses), look(poses, eye=(0.3, 0.0, 0.15), mark=(0.1, 0.0, 0.15))
    assert np.isfinite(high[0, 1]).all()
    assert np.isnan(low[0, 1]).all()
    assert np.isfinite(low[0, 2]).all()


@pytest.mark.parametrize(
    ("changes", "message"),
    [({"cone": 0.0}, "a cone is more than 0"), ({"range": -1.0}, "a range is positive"),
     ({"eye": (0.0, 0.0)}, "eye is a point")],
)  # fmt: skip
def test_numbers_that_cannot_be_are_refused(changes, message):
    options = {"cone": 1.0, "range": 6.0, "eye": EYE, "mark": MARK}
    with pytest.raises(InvalidInputError, match=message):
        ConeSight(**(options | changes))
