"""The engine that walks, kicks and gets up: what begins and ends when, without physics."""

from types import SimpleNamespace

import numpy as np
import pytest

from controllers.legged.ers7_gaits import ERS7_HOME, ERS7_TROT
from controllers.legged.ers7_keyframes import ERS7_GET_UP, ERS7_KICKS
from controllers.legged.kicks import Kick
from controllers.legged.motion import (
    FALLEN,
    FRAME,
    GET_UP,
    GETTING_UP,
    GIVEN_UP,
    KICK_FORWARD,
    KICK_LEFT,
    KICK_RIGHT,
    KICKING,
    WALK,
    WALKING,
    AiboMotion,
)
from mjmr.errors import InvalidInputError

UP, BACK = np.array([0.0, 0.0, 9.81]), np.array([0.0, 0.0, -9.81])
KICK_FRAMES = round(ERS7_KICKS[KICK_FORWARD].keyframes.duration / FRAME)
TWIST = (0.2, 0.05, 0.4)
HEAD = (-0.3, 0.5, 0.1)


class Marching:
    """A gait that tells what it was told: legs (n, 12) are frames since the reset, and twists."""

    command_limits = np.array([[-0.3, 0.4], [-0.2, 0.2], [-3.0, 3.0]])

    def bind(self, n):
        gait = Marching()
        gait.frames = np.zeros(n)
        return gait

    def legs(self, command):
        self.frames = self.frames + 1
        return np.hstack([self.frames[:, None], command, np.zeros((len(command), 8))])

    def reset(self, mask):
        self.frames = np.where(mask, 0.0, self.frames)

    def state(self):
        return self.frames.copy()

    def set_state(self, state):
        self.frames = state.copy()


def engine(n=1, gait=None, **options):
    motion = AiboMotion(gait or Marching(), **options)
    return motion, motion.bind(n)


def run(bound, commands, readings, frames):
    sensed = SimpleNamespace(accelerometer=np.broadcast_to(readings, (len(commands), 3)))
    targets, status = [], []
    for _ in range(frames):
        targets.append(bound.targets(commands, sensed).copy())
        status.append(bound.status.copy())
    return np.array(targets), np.array(status)


def test_a_robot_that_walks_does_what_its_gait_and_its_head_are_told():
    motion, bound = engine()
    targets, status = run(bound, motion.command(TWIST, HEAD), UP, 3)
    np.testing.assert_array_equal(targets[:, 0, 0], [1, 2, 3])
    np.testing.assert_allclose(targets[:, 0, 1:4], [TWIST] * 3)
    np.testing.assert_allclose(targets[:, 0, 12:15], [HEAD] * 3)
    np.testing.assert_allclose(targets[0, 0, 15:], ERS7_HOME[15:])
    assert (status == WALKING).all()


@pytest.mark.parametrize("code", [KICK_FORWARD, KICK_LEFT, KICK_RIGHT])
def test_a_kick_plays_its_keyframes_once_and_walks_on_from_a_stand(code):
    motion, bound = engine()
    run(bound, motion.command(TWIST, HEAD), UP, 10)
    keyframes = ERS7_KICKS[code].keyframes
    frames = round(keyframes.duration / FRAME)
    targets, status = run(bound, motion.command(TWIST, HEAD, code), UP, frames + 5)
    assert (status[:frames, 0] == KICKING).all()
    assert (status[frames:, 0] == WALKING).all()
    for end, angles in zip(np.cumsum(keyframes.seconds), keyframes.angles, strict=True):
        nearest = np.abs(targets[:, 0] - angles).max(axis=1)
        assert nearest[max(round(end / FRAME) - 2, 0) :].min() < 0.2
    np.testing.assert_allclose(targets[frames - 1, 0], keyframes.angles[-1], atol=0.01)
    # the gait began anew, with the commanded twist; the code that is still there does nothing
    np.testing.assert_array_equal(targets[frames:, 0, 0], [1, 2, 3, 4, 5])
    # once another code was between it kicks again
    run(bound, motion.command(TWIST), UP, 1)
    assert run(bound, motion.command(TWIST, action=code), UP, 1)[1][0, 0] == KICKING


def test_an_action_runs_to_its_end_whatever_is_commanded():
    motion, bound = engine()
    run(bound, motion.command(action=KICK_FORWARD), UP, 1)
    _, status = run(bound, motion.command(action=WALK), UP, KICK_FRAMES - 1)
    assert (status == KICKING).all()


def test_a_target_never_jumps_when_a_kick_begins():
    motion, bound = engine(gait=ERS7_TROT)
    before, _ = run(bound, motion.command(), UP, 2)
    after, _ = run(bound, motion.command(action=KICK_LEFT), UP, 1)
    longest = FRAME / ERS7_KICKS[KICK_LEFT].keyframes.seconds[0] * np.pi
    assert np.abs(after[0] - before[-1]).max() < longest


def test_fallen_robots_get_up_by_themselves_after_their_patience():
    motion, bound = engine(2, patience=0.4)
    readings = np.array([BACK, UP])
    _, status = run(bound, motion.command(np.array([TWIST, TWIST])), UP, 5)
    targets, status = run(bound, motion.command(np.array([TWIST, TWIST])), readings, 80)
    fell = int(np.argmax(status[:, 0] == GETTING_UP))
    # the low pass takes some 0.1 s before it sees it
    assert 0.4 <= fell * FRAME <= 0.6
    assert (status[:, 1] == WALKING).all()
    back = ERS7_GET_UP.off_back_left
    np.testing.assert_allclose(targets[fell, 0], back.angles[0])
    # once it feels upright it stands up and walks
    whole = round((back.duration + ERS7_GET_UP.stand.duration) / FRAME)
    _, status = run(bound, motion.command(np.array([TWIST, TWIST])), UP, whole + 2)
    assert status[-1].tolist() == [WALKING, WALKING]
    assert bound.tries.tolist() == [1, 0]


def test_robots_that_are_not_automatic_wait_and_do_not_kick_while_fallen():
    motion, bound = engine(automatic=False)
    _, status = run(bound, motion.command(TWIST), BACK, 80)
    assert status[-1, 0] == FALLEN
    targets, status = run(bound, motion.command(TWIST, action=KICK_LEFT), BACK, 5)
    assert (status == FALLEN).all()
    # nor does its gait walk
    assert (targets[:, 0, 1:4] == 0).all()
    _, status = run(bound, motion.command(action=GET_UP), BACK, 1)
    assert status[0, 0] == GETTING_UP
    # stood up by hand before it was told, it walks on
    _, other = engine(automatic=False)
    run(other, motion.command(), BACK, 80)
    assert run(other, motion.command(), UP, 40)[1][-1, 0] == WALKING


def test_a_robot_that_never_comes_up_gives_up_until_told_again():
    motion, bound = engine()
    frames = round(5 * ERS7_GET_UP.off_back_left.duration / FRAME) + 60
    _, status = run(bound, motion.command(), BACK, frames)
    assert status[-1, 0] == GIVEN_UP
    assert bound.tries[0] == 5
    assert (run(bound, motion.command(), BACK, 200)[1] == GIVEN_UP).all()
    assert run(bound, motion.command(action=GET_UP), BACK, 1)[1][0, 0] == GETTING_UP


def test_robots_do_not_depend_on_each_other():
    motion, bound = engine(3)
    codes = np.array([WALK, KICK_RIGHT, WALK])
    readings = np.array([UP, UP, BACK])
    together, _ = run(bound, motion.command([TWIST] * 3, HEAD, codes), readings, 90)
    for robot in range(3):
        _, alone = engine(1)
        command = motion.command(TWIST, HEAD, codes[robot])
        got, _ = run(alone, command, readings[robot], 90)
        np.testing.assert_array_equal(together[:, robot], got[:, 0])


@pytest.mark.parametrize("frames", [20, 70, 150])
def test_a_state_put_back_gives_the_same_targets(frames):
    motion, bound = engine(3)
    command = motion.command([TWIST] * 3, HEAD, np.array([WALK, KICK_RIGHT, WALK]))
    readings = np.array([UP, UP, BACK])
    run(bound, command, readings, frames)
    state = bound.state()
    first = run(bound, command, readings, 200)
    run(bound, motion.command([TWIST] * 3, HEAD, GET_UP), BACK, 30)
    bound.set_state(state)
    for a, b in zip(first, run(bound, command, readings, 200), strict=True):
        np.testing.assert_array_equal(a, b)


def test_commands_are_put_together_and_limits_go_with_their_names():
    motion, _ = engine()
    assert motion.command_limits.shape == (len(motion.command_names), 2)
    np.testing.assert_array_equal(motion.command_limits[:3], Marching.command_limits)
    assert motion.command_limits[-1].tolist() == [WALK, GET_UP]
    command = motion.command([TWIST, TWIST], action=[WALK, KICK_LEFT])
    assert command.shape == (2, 7)
    np.testing.assert_allclose(command[1, 3:6], ERS7_HOME[12:15])


def test_a_kick_is_ready_where_its_ball_lies():
    kick = ERS7_KICKS[KICK_LEFT]
    balls = np.array([kick.ball, np.add(kick.ball, [0.01, 0.01]), [np.nan, np.nan]])
    assert kick.ready(balls, 0.012).tolist() == [True, False, False]
    other = ERS7_KICKS[KICK_RIGHT]
    assert other.ball == (kick.ball[0], -kick.ball[1])
    assert other.direction == -kick.direction


def test_bad_kicks_are_refused():
    with pytest.raises(InvalidInputError, match="codes 1, 2 and 3"):
        AiboMotion(kicks={1: ERS7_KICKS[1]})
    with pytest.raises(InvalidInputError, match="place"):
        Kick(keyframes=ERS7_KICKS[1].keyframes, ball=(np.nan, 0.0), direction=0.0, distance=2.0)
