"""Keyframe player: lines and steps between keyframes, each robot in its own time."""

import numpy as np
import pytest

from controllers.legged.ers7_keyframes import ERS7_KICKS, ERS7_OFF_BACK, mirrored
from controllers.legged.keyframes import IDLE, KeyframePlayer, Keyframes
from mjmr.errors import InvalidInputError
from mjmr.robots.aibo_ers7 import JOINTS, AiboERS7

FRAME = 0.008
LINE = Keyframes(angles=[[1.0, -2.0], [3.0, 0.0]], seconds=[0.08, 0.16])
STEP = Keyframes(angles=[[1.0], [2.0]], seconds=[0.024, 0.016], stepped=True)


def play(player, frames):
    return np.array([player.targets() for _ in range(frames)])


def test_targets_go_along_lines_and_are_at_each_keyframe_when_its_time_is_over():
    player = KeyframePlayer([LINE], 1, frame=FRAME)
    player.start(np.array([True]), 0, np.array([[0.5, 1.0]]))
    got = play(player, 40)[:, 0]
    times = FRAME * np.arange(1, 41)
    for joint, (begin, first, second) in enumerate([(0.5, 1.0, 3.0), (1.0, -2.0, 0.0)]):
        line = np.interp(times, [0, 0.08, 0.24], [begin, first, second])
        np.testing.assert_allclose(got[:, joint], line, atol=1e-12)


def test_steps_are_targets_from_their_first_frame_on():
    player = KeyframePlayer([STEP], 1, frame=FRAME)
    player.start(np.array([True]), 0, np.array([[0.0]]))
    np.testing.assert_array_equal(play(player, 6)[:, 0, 0], [1, 1, 1, 2, 2, 2])


def test_a_sequence_ends_with_its_time_and_its_last_keyframe_is_held():
    player = KeyframePlayer([LINE], 1, frame=FRAME)
    player.start(np.array([True]), 0, np.zeros((1, 2)))
    play(player, 29)
    assert player.playing.all()
    play(player, 1)
    assert player.ended.all()
    assert not player.playing.any()
    np.testing.assert_allclose(play(player, 5)[-1], [[3.0, 0.0]])
    player.stop(np.array([True]))
    assert player.sequence[0] == IDLE
    assert not player.ended.any()


def test_robots_play_their_own_sequences_in_their_own_time_as_if_alone():
    other = Keyframes(angles=[[5.0, 5.0]], seconds=[0.04])
    both = KeyframePlayer([LINE, other], 3, frame=FRAME)
    start = np.array([[0.5, 1.0], [0.0, 0.0], [-1.0, 1.0]])
    both.start(np.array([True, False, False]), 0, start)
    play(both, 7)
    both.start(np.array([False, True, True]), [0, 1, 0], start)
    got = play(both, 12)
    for robot, sequence, late in ((0, LINE, 7), (1, other, 0), (2, LINE, 0)):
        alone = KeyframePlayer([sequence], 1, frame=FRAME)
        alone.start(np.array([True]), 0, start[robot : robot + 1])
        np.testing.assert_array_equal(got[:, robot], play(alone, late + 12)[late:, 0])


def test_a_state_put_back_gives_the_same_targets():
    player = KeyframePlayer([LINE], 2, frame=FRAME)
    player.start(np.array([True, False]), 0, np.ones((2, 2)))
    play(player, 4)
    state = player.state()
    first = play(player, 10)[:, 0]
    player.start(np.array([True, True]), 0, np.zeros((2, 2)))
    player.set_state(state)
    np.testing.assert_array_equal(play(player, 10)[:, 0], first)
    assert player.sequence.tolist() == [0, IDLE]


@pytest.mark.parametrize("name", ["left", "back"])
def test_mirrored_keyframes_exchange_sides(name):
    keyframes = {"left": ERS7_KICKS[2].keyframes, "back": ERS7_OFF_BACK}[name]
    other = mirrored(keyframes)
    columns = {joint.name: k for k, joint in enumerate(JOINTS)}
    swap = {"fl": "fr", "fr": "fl", "hl": "hr", "hr": "hl"}
    for name, k in columns.items():
        leg = name.split("_")[0]
        twin = name.replace(leg, swap.get(leg, leg), 1)
        if name.startswith("ear"):
            twin = {"ear_left": "ear_right", "ear_right": "ear_left"}[name]
        sign = -1 if name in ("pan", "tail_pan") else 1
        np.testing.assert_array_equal(
            other.angles[:, k], sign * keyframes.angles[:, columns[twin]], err_msg=name
        )
    np.testing.assert_array_equal(mirrored(other).angles, keyframes.angles)


def test_all_keyframes_are_within_the_joints_limits():
    low, high = AiboERS7.joint_limits.T
    from controllers.legged.ers7_keyframes import ERS7_GET_UP

    for keyframes in (*ERS7_GET_UP.sequences, *(k.keyframes for k in ERS7_KICKS.values())):
        assert (keyframes.angles >= low - 1e-9).all()
        assert (keyframes.angles <= high + 1e-9).all()


@pytest.mark.parametrize(
    ("angles", "seconds", "said"),
    [
        ([[1.0]], [0.1, 0.2], "seconds"),
        ([[np.nan]], [0.1], "finite"),
        ([[1.0]], [0.0], "positive"),
        ([], [], "angles"),
    ],
)
def test_bad_keyframes_are_refused(angles, seconds, said):
    with pytest.raises(InvalidInputError, match=said):
        Keyframes(angles=angles, seconds=seconds)


def test_a_player_refuses_sequences_of_different_joints():
    with pytest.raises(InvalidInputError, match="number of joints"):
        KeyframePlayer([LINE, STEP], 1, frame=FRAME)
