import numpy as np
import pytest

from controllers.consensus import (
    SeparationBearing,
    command_of_velocity,
    command_rates,
    hand_position,
    hand_velocity,
)
from mjmr.errors import InvalidInputError


def unicycle(pose, command, dt):
    """Exact motion of unicycles under constant commands."""
    x, y, yaw = pose.T
    v, w = command.T
    middle = yaw + w * dt / 2
    chord = v * dt * np.sinc(w * dt / 2 / np.pi)
    return np.column_stack([x + chord * np.cos(middle), y + chord * np.sin(middle), yaw + w * dt])


def test_hand_points_move_as_asked():
    rng = np.random.default_rng(0)
    yaw, velocity = rng.uniform(-3, 3, 20), rng.normal(size=(20, 2))
    command = command_of_velocity(yaw, velocity, 0.2)
    assert hand_velocity(yaw, command, 0.2) == pytest.approx(velocity)
    pose = np.column_stack([rng.normal(size=(20, 2)), yaw])
    dt = 1e-6
    moved = hand_position(unicycle(pose, command, dt), 0.2) - hand_position(pose, 0.2)
    assert moved / dt == pytest.approx(velocity, abs=1e-4)


def test_hand_points_accelerate_as_asked():
    rng = np.random.default_rng(1)
    pose = rng.normal(size=(20, 3))
    command, wanted = rng.normal(size=(20, 2)), rng.normal(size=(20, 2))
    rates = command_rates(pose[:, 2], command, wanted, 0.2)
    dt = 1e-5
    after = unicycle(pose, command + rates * dt / 2, dt)
    change = hand_velocity(after[:, 2], command + rates * dt, 0.2) - hand_velocity(
        pose[:, 2], command, 0.2
    )
    assert change / dt == pytest.approx(wanted, abs=1e-3)


@pytest.mark.parametrize("turn", [0.0, 0.15, -0.15])
def test_followers_settle_at_separation_and_bearing(turn):
    law = SeparationBearing(separation=2.0, bearing=np.pi - 0.5)
    leader, follower = np.zeros((1, 3)), np.array([[-3.0, -1.0, 0.4]])
    given = np.array([[0.5, turn]])
    errors = []
    for _ in range(6000):
        c, s = np.cos(follower[0, 2]), np.sin(follower[0, 2])
        away = leader[0, :2] - follower[0, :2]
        seen = np.array(
            [[c * away[0] + s * away[1], c * away[1] - s * away[0], leader[0, 2] - follower[0, 2]]]
        )
        command = law.command(seen, given)
        point = hand_position(follower, law.ahead)[0] - leader[0, :2]
        psi = np.arctan2(point[1], point[0]) - leader[0, 2]
        errors.append([np.hypot(*point) - 2.0, np.angle(np.exp(1j * (psi - law.bearing)))])
        leader, follower = unicycle(leader, given, 0.01), unicycle(follower, command, 0.01)
    errors = np.abs(errors)
    assert errors[-1] == pytest.approx([0, 0], abs=2e-3)
    # l' = a1 (l_d - l): the separation's error falls as exp(-t / 2)
    assert errors[200, 0] == pytest.approx(errors[0, 0] * np.exp(-1.0), rel=0.05)


def test_numbers_of_the_laws_are_checked():
    with pytest.raises(InvalidInputError, match="must be positive"):
        SeparationBearing(separation=0.0, bearing=0.0)
    with pytest.raises(InvalidInputError, match="length must be > 0"):
        hand_position(np.zeros((1, 3)), 0.0)
