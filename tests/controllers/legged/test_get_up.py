"""Getting up: which sequence when, tries, giving up."""

import numpy as np
import pytest

from controllers.legged.get_up import GetUp, GetUpPlan
from controllers.legged.keyframes import KeyframePlayer, Keyframes
from controllers.legged.posture import BACK, FRONT, LEFT, RIGHT, STANDING
from mjmr.errors import InvalidInputError

FRAME = 0.008
NAMES = ("stand", "off_left", "off_right", "off_back_left", "off_back_right")
STAND, OFF_LEFT, OFF_RIGHT, OFF_BACK, OFF_BACK_RIGHT = range(1, 6)  # in the player below


def robots(n, tries=5):
    kick, *rest = (
        Keyframes(angles=[[float(k)]], seconds=[5 * FRAME], stepped=True) for k in range(6)
    )
    plan = GetUpPlan(**dict(zip(NAMES, rest, strict=True)))
    player = KeyframePlayer([kick, *plan.sequences], n, frame=FRAME)
    return GetUp(player, 1, n, tries), player


def run(get_up, player, postures, right=False):
    """What is played in each frame while postures are as told, and who stands or gave up."""
    played, up, over = [], [], []
    angles = np.zeros((len(postures[0]), 1))
    for posture in postures:
        stands, given_up = get_up.decide(np.array(posture), np.full(len(posture), right), angles)
        up.append(stands)
        over.append(given_up)
        played.append(player.sequence.copy())
        player.targets()
    return np.array(played), np.array(up), np.array(over)


@pytest.mark.parametrize(
    ("posture", "first"),
    [(STANDING, STAND), (FRONT, STAND), (LEFT, OFF_LEFT), (RIGHT, OFF_RIGHT), (BACK, OFF_BACK)],
)
def test_the_first_sequence_is_for_how_it_lies(posture, first):
    get_up, player = robots(1)
    get_up.start(np.array([True]))
    played, *_ = run(get_up, player, [[posture]])
    assert played[0, 0] == first
    assert get_up.tries.tolist() == [1]


@pytest.mark.parametrize(
    ("posture", "first"), [(BACK, OFF_BACK_RIGHT), (LEFT, OFF_LEFT), (STANDING, STAND)]
)
def test_a_robot_on_its_back_rolls_to_where_it_leans(posture, first):
    get_up, player = robots(1)
    get_up.start(np.array([True]))
    played, *_ = run(get_up, player, [[posture]], right=True)
    assert played[0, 0] == first


def test_a_robot_on_its_back_rolls_stands_up_and_is_done_in_one_try():
    get_up, player = robots(2)
    get_up.start(np.array([True, False]))
    postures = [[BACK, BACK]] * 5 + [[STANDING, BACK]] * 6
    played, up, over = run(get_up, player, postures)
    assert played[:, 0].tolist() == [OFF_BACK] * 5 + [STAND] * 6
    assert up[:, 0].tolist() == [False] * 10 + [True]
    assert not over.any()
    assert get_up.tries.tolist() == [1, 0]
    assert not get_up.active.any()
    # the other was never told to
    assert (played[:, 1] == -1).all()


def test_a_roll_to_the_wrong_side_is_another_try_from_there():
    get_up, player = robots(1)
    get_up.start(np.array([True]))
    played, up, _ = run(get_up, player, [[BACK]] * 5 + [[RIGHT]] * 5 + [[FRONT]] * 5 + [[STANDING]])
    assert played[[0, 5, 10], 0].tolist() == [OFF_BACK, OFF_RIGHT, STAND]
    assert up[-1, 0]
    assert get_up.tries.tolist() == [2]


@pytest.mark.parametrize("posture", [FRONT, BACK])
def test_it_gives_up_after_its_tries(posture):
    get_up, player = robots(1, tries=3)
    get_up.start(np.array([True]))
    _, up, over = run(get_up, player, [[posture]] * 20)
    assert np.flatnonzero(over[:, 0]).tolist() == [15]
    assert not up.any()
    assert get_up.tries.tolist() == [3]
    # and begins afresh when told again
    get_up.start(np.array([True]))
    run(get_up, player, [[posture]])
    assert get_up.tries.tolist() == [1]


def test_a_plan_without_tries_is_refused():
    sequence = Keyframes(angles=[[0.0]], seconds=[0.1])
    with pytest.raises(InvalidInputError, match="1 or more"):
        GetUpPlan(**dict.fromkeys(NAMES, sequence), tries=0)
