"""Dead reckoning from wheel counts."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from controllers.estimation.odometry import Odometry, integrate_arcs
from mjmr.errors import InvalidInputError

TURN = 1000
RADIUS, TRACK = 0.1, 0.4


def odometry(start=((0.0, 0.0, 0.0),), **changes):
    numbers = {"radius": RADIUS, "track": TRACK, "counts_per_turn": TURN} | changes
    return Odometry(start, **numbers)


def test_straight_ahead():
    """One turn of both wheels is their circumference, along the heading."""
    found = odometry([[1.0, 2.0, math.pi / 2]])
    found.step([[50, 50]])
    np.testing.assert_allclose(
        found.step([[50 + TURN, 50 + TURN]]), [[1.0, 2.0 + 0.2 * math.pi, math.pi / 2]]
    )


def test_a_turn_in_place():
    """Opposite wheels: a turn of each is 2 pi R / (b / 2) = pi rad of the robot."""
    found = odometry()
    found.step([[0, 0]])
    np.testing.assert_allclose(
        found.step([[-TURN // 2, TURN // 2]]), [[0, 0, math.pi / 2]], atol=1e-12
    )
    # yaw stays in (-pi, pi]
    np.testing.assert_allclose(found.step([[-1100, 1100]])[0, 2], -0.9 * math.pi)


def test_one_arc_is_exact():
    """A quarter of a circle of 1 m around the left, in one reading."""
    inner, outer = (1.0 - TRACK / 2) * math.pi / 2, (1.0 + TRACK / 2) * math.pi / 2
    end = integrate_arcs(np.zeros((1, 3)), np.array([[inner, outer]]), np.array([TRACK]))
    np.testing.assert_allclose(end, [[1.0, 1.0, math.pi / 2]], atol=1e-12)


@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-3.0, 3.0), st.integers(2, 40))
def test_an_arc_in_parts_is_the_arc(left, right, yaw, parts):
    track = np.array([TRACK])
    start = np.array([[0.3, -0.2, yaw]])
    whole = integrate_arcs(start, np.array([[left, right]]), track)
    step = start
    for _ in range(parts):
        step = integrate_arcs(step, np.array([[left, right]]) / parts, track)
    np.testing.assert_allclose(step[:, :2], whole[:, :2], atol=1e-12)
    assert abs((step[0, 2] - whole[0, 2] + math.pi) % (2 * math.pi) - math.pi) < 1e-12


def test_every_robot_and_wheel_has_its_own_numbers():
    """Unequal wheels bend the path; robots do not mix."""
    found = odometry(
        [[0.0, 0.0, 0.0], [5.0, 0.0, 0.0]],
        radius=[[0.1, 0.1], [0.1, 0.11]],
        track=[0.4, 0.5],
    )
    found.step(np.zeros((2, 2), dtype=np.int64))
    poses = found.step(np.full((2, 2), TURN))
    np.testing.assert_allclose(poses[0], [0.2 * math.pi, 0.0, 0.0])
    assert poses[1, 2] == pytest.approx(0.01 * 2 * math.pi / 0.5)
    poses[:] = 9.0
    assert found.poses.max() < 9.0


def test_bad_input_is_refused():
    with pytest.raises(InvalidInputError, match=r"shape \(n, 3\)"):
        odometry([0.0, 0.0, 0.0])
    with pytest.raises(InvalidInputError, match="radius must be positive"):
        odometry(radius=0.0)
    with pytest.raises(InvalidInputError, match="track must be one number"):
        odometry(track=[0.4, 0.4])
    with pytest.raises(InvalidInputError, match="counts_per_turn"):
        odometry(counts_per_turn=math.nan)
    with pytest.raises(InvalidInputError, match="whole numbers"):
        odometry().step([[0.0, 1.0]])
    with pytest.raises(InvalidInputError, match=r"shape \(1, 2\)"):
        odometry().step([[0, 1], [0, 1]])
