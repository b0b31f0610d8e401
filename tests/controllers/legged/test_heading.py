"""Heading loop and straight walk, on a robot that goes as commanded but drifts."""

import numpy as np
import pytest

from controllers.legged.heading import HeadingLoop, StraightWalk
from mjmr.errors import InvalidInputError
from mjmr.geometry import rotate, wrap_angle

PERIOD = 0.1


def test_it_turns_the_short_way_and_no_faster_than_its_limit():
    loop = HeadingLoop(gain=2.0, limit=0.5)
    turn = loop.turn([0.0, np.pi - 0.05, -3.0, 1.0], [0.1, -np.pi + 0.05, 3.0, 1.0])
    np.testing.assert_allclose(turn, [0.2, 0.2, -0.5, 0.0], atol=1e-12)


def test_a_heading_not_reported_turns_nowhere():
    np.testing.assert_array_equal(HeadingLoop().turn([np.nan, 0.0], 0.1) > 0, [False, True])
    walk = StraightWalk().twist(np.full((1, 3), np.nan), [0.0, 0.0], 0.0, 0.3)
    np.testing.assert_array_equal(walk, [[0.3, 0.0, 0.0]])


def drifting(walk, poses, heading, speed, drift, periods):
    poses = np.array(poses, dtype=float)
    track = [poses.copy()]
    for _ in range(periods):
        twist = walk.twist(poses, [0.0, 0.0], heading, speed) + [0.0, 0.005, drift]
        poses[:, :2] += rotate(twist[:, :2], poses[:, 2]) * PERIOD
        poses[:, 2] = wrap_angle(poses[:, 2] + twist[:, 2] * PERIOD)
        track.append(poses.copy())
    return np.array(track)


@pytest.mark.parametrize("speed", [0.3, -0.2])
@pytest.mark.parametrize("heading", [0.0, 2.5])
def test_it_comes_back_to_the_line_in_spite_of_drift(speed, heading):
    aside = rotate(np.array([[0.0, 0.3], [0.0, -0.2], [0.0, 0.0]]), heading)
    start = np.column_stack([aside, heading + np.array([0.2, -0.3, 0.0])])
    end = drifting(StraightWalk(), start, heading, speed, 0.03, 150)
    along, off = np.moveaxis(rotate(end[..., :2], -heading), -1, 0)
    assert (np.abs(off[-1]) < 0.03).all()
    assert (np.abs(wrap_angle(end[-1, :, 2] - heading)) < 0.05).all()
    assert (np.sign(speed) * along[-1] > 0.8 * abs(speed) * 15).all()
    # the one that begins on the line stays near it
    assert np.abs(off[:, 2]).max() < 0.03


def test_senseless_input_is_refused():
    with pytest.raises(InvalidInputError, match="positive gain"):
        HeadingLoop(gain=0.0)
    with pytest.raises(InvalidInputError, match=r"shape \(n, 3\)"):
        StraightWalk().twist([0.0, 0.0, 0.0], [0.0, 0.0], 0.0, 0.3)
