"""Steering and yielding, against geometry."""

import math

import numpy as np
import pytest

from controllers.motion.steering import Steering, SteeringConfig
from controllers.motion.yielding import give_way
from mjmr.errors import InvalidInputError

ANGLES = np.radians(np.arange(-180.0, 180.0))
NOBODY = np.full((1, 1, 2), np.nan)


def room(x0: float, y0: float, x1: float, y1: float) -> np.ndarray:
    """Scan (1, 360) from the origin of a rectangle around it."""
    with np.errstate(divide="ignore"):
        along = np.where(np.cos(ANGLES) > 0, x1, x0) / np.cos(ANGLES)
        across = np.where(np.sin(ANGLES) > 0, y1, y0) / np.sin(ANGLES)
    return np.minimum(np.where(along > 0, along, np.inf), np.where(across > 0, across, np.inf))[
        None
    ]


def test_full_speed_ahead_where_free():
    command = Steering().step([0.0], [5.0], room(-4, -4, 4, 4), ANGLES, NOBODY)
    np.testing.assert_allclose(command, [[0.5, 0.0]], atol=1e-12)


def test_turns_in_place_to_what_lies_behind():
    command = Steering().step([3.0], [5.0], room(-4, -4, 4, 4), ANGLES, NOBODY)
    assert command[0, 0] == 0.0
    assert command[0, 1] == SteeringConfig().max_turn


def test_nan_stands_still():
    command = Steering().step([math.nan], [5.0], room(-4, -4, 4, 4), ANGLES, NOBODY)
    np.testing.assert_array_equal(command, [[0.0, 0.0]])


def test_slows_to_stop_short_of_a_wall():
    """No wall comes nearer than the radius: v^2 / 2a is at most what is left."""
    config = SteeringConfig()
    for wall in (0.33, 0.4, 0.5, 0.8):
        # a dead end: nowhere else to go
        scan = room(-0.34, -0.34, wall, 0.34)
        forward = Steering().step([0.0], [5.0], scan, ANGLES, NOBODY)[0, 0]
        assert forward**2 / (2 * config.braking) <= wall - config.radius + 1e-9


def test_goes_around_a_robot_ahead():
    others = np.array([[[0.75, 0.05]]])
    command = Steering().step([0.0], [5.0], room(-4, -4, 4, 4), ANGLES, others)
    assert command[0, 1] < -0.3  # it stands a little to the left, so to the right


def test_slides_along_a_wall_it_is_sent_into():
    scan = room(-4, -4, 0.36, 4)
    command = Steering().step([0.6], [5.0], scan, ANGLES, NOBODY)
    assert command[0, 1] > 0.0


def test_goes_straight_before_a_corner_swings_into_a_jamb():
    """A jamb beside the rear wheel, so near that the hull cannot turn there: forward first."""
    scan = room(-4, -4, 4, 4)
    jamb = np.abs(ANGLES - 2.2) < 0.05
    scan[0, jamb] = 0.285
    command = Steering().step([-2.0], [5.0], scan, ANGLES, NOBODY)
    assert command[0, 0] > 0.0
    assert command[0, 1] == 0.0


def test_refuses_what_cannot_be():
    with pytest.raises(InvalidInputError, match="speed must be positive"):
        SteeringConfig(speed=0.0)


def test_steps_out_of_the_lane():
    """In the open, who is in the way of one that comes from behind goes sideways."""
    others, travel = np.array([[[-1.0, 0.1]]]), np.array([[0.0]])
    way = give_way(others, travel, np.array([[True]]), room(-4, -4, 4, 4), ANGLES)
    assert way[0] == pytest.approx(-math.pi / 2, abs=math.pi / 6)


def test_backs_out_of_a_doorway():
    """Between jambs there is no sideways: it goes where the other goes, ahead of it."""
    others, travel = np.array([[[-1.0, 0.0]]]), np.array([[0.0]])
    way = give_way(others, travel, np.array([[True]]), room(-4, -0.45, 4, 0.45), ANGLES)
    assert abs(way[0]) < math.pi / 6


def test_stays_where_nobody_comes():
    free = room(-4, -4, 4, 4)
    others = np.array([[[-1.0, 0.1]]])
    away, apart, later = np.array([[math.pi]]), np.array([[[-1.0, 0.9]]]), np.array([[False]])
    yes, ahead = np.array([[True]]), np.array([[0.0]])
    assert np.isnan(give_way(others, away, yes, free, ANGLES))  # it goes away
    assert np.isnan(give_way(apart, ahead, yes, free, ANGLES))  # it passes
    assert np.isnan(give_way(others, ahead, later, free, ANGLES))  # it is later
