"""A leader's pose and speeds, from two marks seen and one's own odometry."""

import numpy as np
import pytest

from controllers.consensus.leader_track import LeaderTrack
from mjmr.errors import InvalidInputError
from mjmr.geometry import rotate, wrap_angle

PERIOD, BEHIND, AHEAD = 0.1, -0.05, 0.30


def _arc(start, speed, turn, time):
    """Pose (3,) on an arc after a time."""
    yaw = start[2] + turn * time
    way = speed * time * np.sinc(turn * time / (2 * np.pi))
    chord = start[2] + turn * time / 2
    return np.array([start[0] + way * np.cos(chord), start[1] + way * np.sin(chord), yaw])


def _marks(leader, own):
    found = []
    for x in (BEHIND, AHEAD):
        place = leader[:2] + x * np.array([np.cos(leader[2]), np.sin(leader[2])])
        way = rotate((place - own[:2])[None], -own[2:])[0]
        found.append([np.hypot(*way), np.arctan2(way[1], way[0])])
    return np.array(found)


def _run(seconds, hides=lambda now: False, noise=0.0, seed=0):
    """Two followers that drive arcs of their own behind a leader on a circle of 10 m."""
    rng = np.random.default_rng(seed)
    track = LeaderTrack(2, behind=BEHIND, ahead=AHEAD, period=PERIOD)
    # each frame begins where that follower stood: the leader is elsewhere in each
    starts = np.array([[-1.7, 1.0, 0.1], [-1.7, -1.0, -0.2]])
    told, late = [], (np.full((2, 2, 2), np.nan), np.zeros((2, 3)))
    for k in range(round(seconds / PERIOD)):
        now = k * PERIOD
        leader = _arc(np.zeros(3), 0.8, 0.08, now)
        world = np.array([_arc(s, 0.8, 0.08, now) for s in starts])
        own = np.array(
            [[*rotate((w - s)[None, :2], -s[2:])[0], w[2] - s[2]]
             for w, s in zip(world, starts, strict=True)]
        )  # fmt: skip
        marks = np.array([_marks(leader, w) for w in world])
        marks += noise * rng.standard_normal(marks.shape)
        if hides(now):
            marks[:] = np.nan
        seen, speeds = track.step(*late, own)  # of the picture before
        late = marks, own
        way = np.array([rotate((leader - w)[None, :2], -w[2:])[0] for w in world])
        true = np.column_stack([way, wrap_angle(leader[2] - world[:, 2])])
        told.append((seen, speeds, true))
    return told


def test_a_leader_on_a_circle_is_placed_and_its_speeds_are_found():
    for seen, speeds, true in _run(20.0)[-50:]:
        np.testing.assert_allclose(seen, true, atol=2e-3)
        np.testing.assert_allclose(speeds, [[0.8, 0.08]] * 2, atol=2e-3)


def test_noise_of_sight_is_smoothed():
    told = _run(40.0, noise=0.01)[-200:]
    heading = np.array([s[:, 2] - t[:, 2] for s, _, t in told])
    # two marks 0.35 m apart, each off by 0.01 rad at 2 m: 0.08 rad in one picture
    assert heading.std() < 0.06
    speeds = np.array([v for _, v, _ in told])
    assert np.abs(speeds.mean(axis=0) - [0.8, 0.08]).max() < 0.01


def test_a_hidden_leader_goes_on_for_a_second_and_then_is_lost():
    told = _run(20.0, hides=lambda now: now >= 15.0)
    k = round(15.0 / PERIOD)
    soon = told[k + 8]
    np.testing.assert_allclose(soon[0], soon[2], atol=0.02)
    assert np.isnan(told[k + 12][0]).all()
    assert np.isnan(told[k + 12][1]).all()


def test_who_never_saw_anybody_knows_nobody():
    for seen, speeds, _ in _run(1.0, hides=lambda now: True):
        assert np.isnan(seen).all()
        assert np.isnan(speeds).all()


def test_marks_must_tell_front_from_rear():
    with pytest.raises(InvalidInputError, match="front mark must be ahead"):
        LeaderTrack(1, behind=0.3, ahead=0.3, period=0.1)
