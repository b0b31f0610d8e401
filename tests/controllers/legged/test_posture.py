"""Postures from an accelerometer alone."""

import numpy as np
import pytest

from controllers.legged.posture import BACK, FRONT, LEFT, RIGHT, STANDING, Posture, classify

FRAME = 0.008


def rolled(degrees):
    """What an accelerometer reads at rest when rolled to the right, about x."""
    angle = np.radians(degrees)
    return 9.81 * np.array([0.0, np.sin(angle), np.cos(angle)])


@pytest.mark.parametrize(
    ("up", "posture"),
    [
        (rolled(0), STANDING),
        (rolled(30), STANDING),
        (rolled(50), FRONT),
        (rolled(90), RIGHT),
        (rolled(-90), LEFT),
        (rolled(120), RIGHT),
        (rolled(135), BACK),
        (rolled(180), BACK),
        ([9.81, 0.0, 1.0], FRONT),
        ([-9.81, 0.0, 1.0], FRONT),
        ([0.0, 0.0, 0.5], STANDING),
    ],
)
def test_directions_of_up_are_classified(up, posture):
    assert classify(np.array([up])) == posture


def test_a_side_is_the_one_that_is_down():
    # its left points at the floor, so up is to its right
    assert classify(np.array([[0.0, -9.81, 0.0]])) == LEFT


def test_the_first_reading_counts_at_once_and_a_strike_is_no_tilt():
    posture = Posture(2, frame=FRAME)
    assert posture.update(np.array([rolled(90), rolled(0)])).tolist() == [RIGHT, STANDING]
    strike = np.array([rolled(90), [300.0, 0.0, -300.0]])
    assert posture.update(strike).tolist() == [RIGHT, STANDING]


def test_a_fall_is_noticed_within_a_third_of_a_second():
    posture = Posture(1, frame=FRAME)
    for _ in range(20):
        posture.update(rolled(0)[None])
    seen = [int(posture.update(rolled(90)[None])[0]) for _ in range(40)]
    assert seen[5] == STANDING
    assert seen[-1] == RIGHT
    # on the way it is seen as neither the left side nor the back
    assert set(seen) == {STANDING, FRONT, RIGHT}


def test_a_state_put_back_gives_the_same_postures():
    posture = Posture(1, frame=FRAME)
    posture.update(rolled(0)[None])
    state = posture.state()
    for _ in range(30):
        posture.update(rolled(180)[None])
    posture.set_state(state)
    assert posture.update(rolled(180)[None]) == STANDING
