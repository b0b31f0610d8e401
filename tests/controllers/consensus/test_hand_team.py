"""Hand control of a team against the linear model it should be, and the scan."""

import numpy as np
import pytest

from controllers.consensus import (
    CanonicalModel,
    HandTeam,
    Scan,
    hand_position,
    hand_velocity,
    neighbour_gains,
)
from controllers.safety import BarrierConfig, BarrierFilter
from mjmr.errors import InvalidInputError

LENGTH, PERIOD = 0.2, 0.01
START = np.array([[6.0, 3.0], [2.0, 5.0], [4.0, 2.0]])
CHAIN = np.array([[1, 0, 0], [1, 1, 0], [0, 1, 1]], dtype=bool)


def run(team, seconds, gains, yaw):
    """Integrate unicycles; hand points at the end and the least distance on the way."""
    poses = np.column_stack([START, yaw])
    poses[:, :2] -= LENGTH * np.column_stack([np.cos(yaw), np.sin(yaw)])
    command, closest = np.zeros((3, 2)), np.inf
    for _ in range(round(seconds / PERIOD)):
        hands = hand_position(poses, LENGTH)
        relative = hands[None] - hands[:, None]
        closest = min(closest, np.linalg.norm(relative[np.triu_indices(3, 1)], axis=1).min())
        command = team.step(poses[:, 2], command, relative, gains, hands)
        middle = poses[:, 2] + command[:, 1] * PERIOD / 2
        poses[:, 0] += command[:, 0] * np.cos(middle) * PERIOD
        poses[:, 1] += command[:, 0] * np.sin(middle) * PERIOD
        poses[:, 2] += command[:, 1] * PERIOD
    return hand_position(poses, LENGTH), closest


@pytest.mark.parametrize("seconds", [3.0, 20.0])
def test_unicycles_under_hand_control_move_as_the_linear_model(seconds):
    """Whatever way they face; exact but for the integration's step."""
    gains = neighbour_gains(CHAIN, 0.2)
    hands, _ = run(HandTeam(LENGTH, PERIOD), seconds, gains, np.array([0.3, 2.0, -2.5]))
    model = CanonicalModel([2, 2, 2])
    wanted = model.advance(model.start(START), gains, seconds)[model.outputs]
    np.testing.assert_allclose(hands, wanted, atol=0.03)
    assert np.abs(wanted - START).max() > 0.3


def test_a_barrier_keeps_hands_apart_that_would_meet():
    gains = neighbour_gains(CHAIN, 0.2)
    yaw = np.array([3.0, 0.0, 1.0])
    _, closest = run(HandTeam(LENGTH, PERIOD), 15.0, gains, yaw)
    assert closest < 1.0
    barrier = BarrierFilter(3, BarrierConfig(distance=1.5))
    _, closest = run(HandTeam(LENGTH, PERIOD, barrier), 15.0, gains, yaw)
    assert closest > 1.49
    assert barrier.infeasible == 0


def test_who_hears_nobody_brakes():
    nobody = np.full((1, 1, 2), np.nan)
    yaw, fast = np.array([0.4]), np.array([[0.5, 0.0]])
    command = HandTeam(LENGTH, PERIOD).step(yaw, fast, nobody, np.eye(1))
    before = hand_velocity(yaw, fast, LENGTH)
    after = hand_velocity(yaw, command, LENGTH)
    np.testing.assert_allclose(after, before * (1 - 2 * PERIOD), atol=1e-12)


def test_numbers_that_cannot_be_are_refused():
    with pytest.raises(InvalidInputError, match="length and period are positive; got 0.0 m"):
        HandTeam(0.0, PERIOD)
    barrier = BarrierFilter(1, BarrierConfig(distance=1.0))
    with pytest.raises(InvalidInputError, match="needs to know where the hands are"):
        HandTeam(LENGTH, PERIOD, barrier).step(
            np.zeros(1), np.zeros((1, 2)), np.zeros((1, 1, 2)), np.eye(1)
        )


def test_scan_turns_who_sees_nobody_and_has_not_agreed():
    scan = Scan(3, patience=1.0, rate=0.5, settled=0.1)
    command = np.tile([0.3, 0.1], (3, 1))
    relative = np.full((3, 3, 2), np.nan)
    seen = np.eye(3, dtype=bool)
    seen[0, 1] = seen[2, 1] = True
    relative[0, 1], relative[2, 1] = [2.0, 0.0], [0.05, 0.0]
    bearing = np.full((3, 3), np.nan)
    bearing[0, 1], bearing[2, 1] = -0.5, 0.3
    first = scan.step(0.0, relative, seen, bearing, command)
    # robot 1 has never seen anybody
    np.testing.assert_array_equal(first, [[0.3, 0.1], [0.0, 0.5], [0.3, 0.1]])
    alone = np.eye(3, dtype=bool)
    blind = np.full((3, 3), np.nan)
    soon = scan.step(0.9, relative, alone, blind, command)
    np.testing.assert_array_equal(soon[[0, 2]], command[:2])
    later = scan.step(1.1, relative, alone, blind, command)
    # robot 0 saw somebody on its right; robot 2 had agreed to 5 cm and stays as it is
    np.testing.assert_array_equal(later, [[0.0, -0.5], [0.0, 0.5], [0.3, 0.1]])
