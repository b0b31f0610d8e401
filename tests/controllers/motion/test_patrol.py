"""Loops of waypoints."""

import numpy as np
import pytest

from controllers.motion.patrol import Patrol
from mjmr.errors import InvalidInputError

SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4]]


def test_goes_round_in_order():
    patrol, at, seen = Patrol([SQUARE], phase=[1]), np.array([[0.0, 0.0]]), []
    for k in range(350):
        goal = patrol.step(at, 0.1 * k)
        if not seen or tuple(goal[0]) != seen[-1]:
            seen.append(tuple(goal[0]))
        at += 0.05 * (goal - at) / np.linalg.norm(goal - at)
    assert seen == [(4, 0), (4, 4), (0, 4), (0, 0), (4, 0)]
    assert patrol.skipped[0] == 0


def test_gives_up_what_does_not_come_nearer():
    patrol = Patrol([SQUARE], phase=[1], patience=5.0)
    at = np.array([[1.0, 1.0]])
    goals = [patrol.step(at, t)[0] for t in np.arange(0.0, 6.0, 0.1)]
    np.testing.assert_array_equal(goals[0], [4, 0])
    np.testing.assert_array_equal(goals[-1], [4, 4])
    assert patrol.skipped[0] == 1


def test_goes_back_to_the_last_waypoint_in_sight():
    patrol = Patrol([SQUARE], phase=[2])
    goal = patrol.step([[1.0, 0.5]], 0.0, lambda i, p: p[1] < 1.0)
    np.testing.assert_array_equal(goal, [[4, 0]])


def test_phases_are_spread():
    np.testing.assert_array_equal(Patrol([SQUARE] * 4).index, [0, 1, 2, 3])


def test_refuses_an_empty_loop():
    with pytest.raises(InvalidInputError, match="at least one waypoint"):
        Patrol([np.empty((0, 2))])
