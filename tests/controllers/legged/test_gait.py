"""The trot engine: what feet and joints do, no physics."""

import dataclasses

import numpy as np
import pytest

from controllers.legged.ers7_gaits import ERS7_HOME, ERS7_TROT
from controllers.legged.gait import SETS, Trot
from controllers.legged.gait_set import feet
from controllers.legged.leg import ERS7, UnreachableError
from controllers.legged.walk import Walk
from mjmr.errors import InvalidInputError
from mjmr.robots.aibo_ers7 import FRAME, AiboERS7
from mjmr.robots.motion import Proprioception

LIMIT = np.tile(ERS7_TROT.rates, 4) * ERS7_TROT.frame
MIRROR = [1, 0, 3, 2]  # legs


def walk(commands, frames, trot=ERS7_TROT):
    """Leg joints' angles (frames, n, 12) under one command (n, 3) or one a frame."""
    commands = np.asarray(commands, dtype=float)
    bound = trot.bind(commands.shape[-2])
    each = commands if commands.ndim == 3 else [commands] * frames
    return np.array([bound.legs(command) for command in each]), bound


def steady(name, command, phases):
    row = getattr(ERS7_TROT, name).row()[None]
    return feet(ERS7, row, np.asarray(phases), np.array([command], dtype=float))


def test_numbers_are_the_platforms():
    np.testing.assert_allclose(ERS7_HOME, AiboERS7.home)
    np.testing.assert_allclose(np.tile(ERS7_TROT.rates, 4), AiboERS7.joint_rates[:12])
    assert ERS7_TROT.frame == FRAME
    assert (ERS7_TROT.full[0], ERS7_TROT.full[3]) == AiboERS7.max_twist


def test_commanded_nothing_it_stands_at_home():
    angles, _ = walk(np.zeros((2, 3)), 200)
    np.testing.assert_allclose(angles, np.tile(ERS7_HOME[:12], (200, 2, 1)), atol=1e-9)


@pytest.mark.parametrize(("name", "command"), list(zip(SETS, ERS7_TROT.full_commands, strict=True)))
def test_feet_on_the_floor_carry_the_body_as_commanded(name, command):
    gait = getattr(ERS7_TROT, name)
    tiny = 1e-5
    phases = np.linspace(0.0213, 0.9137, 23)
    now, then = steady(name, command, phases), steady(name, command, phases + tiny)
    speed = (then - now) / (tiny * gait.period)
    middle = steady(name, [0, 0, 0], phases)
    floor = -np.array(gait.height)[[0, 0, 1, 1]]
    stands = now[..., 2] < floor + 1e-9
    assert 0.3 < stands.mean() < 0.7
    hips = np.broadcast_to(command[:2], (*middle.shape[:2], 2)) + command[2] * np.stack(
        [-middle[..., 1], middle[..., 0]], axis=-1
    )
    np.testing.assert_allclose(speed[stands][:, :2], -gait.gain * hips[stands], atol=1e-6)
    assert now[..., 2].max() > floor.max()


def test_swings_are_of_constant_speed_and_rise_to_the_lift():
    gait = ERS7_TROT.forward
    phases = np.linspace(gait.duty[0] + 0.01, 0.99, 50)
    foot = steady("forward", [0.3, 0, 0], phases)[:, 0]
    np.testing.assert_allclose(np.diff(foot[:, 0], 2), 0.0, atol=1e-12)
    assert foot[:, 2].max() + gait.height[0] == pytest.approx(gait.lift[0], rel=1e-2)


def test_mirrored_commands_are_mirrored_half_a_period_later():
    command = np.array([0.2, 0.05, 0.5])
    row = ERS7_TROT.forward.row()[None]
    phases = np.linspace(0, 0.99, 20)
    one = feet(ERS7, row, phases, command[None])
    other = feet(ERS7, row, phases + 0.5, (command * [1, -1, -1])[None])
    np.testing.assert_allclose(one, other[:, MIRROR] * [1, -1, 1], atol=1e-12)


def test_it_starts_and_stops_smoothly_and_ends_at_home():
    commands = np.zeros((400, 1, 3))
    commands[20:200] = [0.3, 0.0, 0.5]
    angles, bound = walk(commands, 400)
    steps = np.abs(np.diff(angles, axis=0)) / LIMIT
    running = steps[120:190].max()
    assert steps.max() < 1.5 * running
    np.testing.assert_allclose(angles[-1, 0], ERS7_HOME[:12], atol=1e-9)
    assert not bound.unreachable.any()


def test_commands_that_jump_never_send_feet_out_of_reach_nor_joints_far():
    rng = np.random.default_rng(2)
    low, high = ERS7_TROT.command_limits.T
    commands = np.repeat(rng.uniform(low, high, (40, 6, 3)), 30, axis=0)
    angles, bound = walk(commands, 1200)
    assert not bound.unreachable.any()
    assert (np.abs(np.diff(angles, axis=0)) / LIMIT).max() < 2.5
    assert bound.clamped.sum() > 0


def test_robots_do_not_know_of_each_other():
    commands = [[0.42, 0, 0], [0, 0.1, 0], [0.1, 0, -1.0], [-0.2, 0, 0]]
    together, _ = walk(commands, 150)
    for k, command in enumerate(commands):
        np.testing.assert_array_equal(walk([command], 150)[0][:, 0], together[:, k])


def test_commands_beyond_are_scaled_down_and_counted():
    beyond, bound = walk([[0.84, 0, 0], [0.3, 0, 0]], 100)
    np.testing.assert_allclose(beyond, walk([[0.42, 0, 0], [0.3, 0, 0]], 100)[0], atol=1e-12)
    assert bound.clamped.tolist() == [100, 0]


def test_state_goes_back_and_reset_stands():
    commands = np.array([[0.3, 0, 0.4], [0, -0.1, 0]])
    bound = ERS7_TROT.bind(2)
    for _ in range(90):
        bound.legs(commands)
    state = bound.state()
    then = [bound.legs(commands) for _ in range(30)]
    bound.reset(np.array([True, False]))
    still = bound.legs(np.zeros((2, 3)))
    np.testing.assert_allclose(still[0], ERS7_HOME[:12], atol=1e-9)
    assert np.abs(still[1] - ERS7_HOME[:12]).max() > 0.05
    bound.set_state(state)
    again = [bound.legs(commands) for _ in range(30)]
    np.testing.assert_array_equal(again, then)


def test_tables_over_the_servos_rates_must_say_so():
    rates = ERS7_TROT.table_rates([0.42, 0, 0])
    assert 1.0 < rates.peak < 2.3
    assert 0.0 < rates.clipped < 0.35
    with pytest.raises(InvalidInputError, match="gait forward needs .* of the servos' rates"):
        changed(forward=dataclasses.replace(ERS7_TROT.forward, clipped=False))
    for name, command in zip(SETS[1:], ERS7_TROT.full_commands[1:], strict=True):
        assert not getattr(ERS7_TROT, name).clipped
        assert ERS7_TROT.table_rates(command).peak <= 1.0


def test_a_gait_whose_feet_cannot_reach_is_refused():
    long = dataclasses.replace(ERS7_TROT.sideways, height=(0.135, 0.135))
    with pytest.raises(UnreachableError, match="gait sideways at its full command: foot fl"):
        changed(sideways=long)


def test_senseless_parameters_are_refused():
    with pytest.raises(InvalidInputError, match="positive period"):
        dataclasses.replace(ERS7_TROT.forward, period=0.0)
    with pytest.raises(InvalidInputError, match="lifted"):
        dataclasses.replace(ERS7_TROT.forward, lift=(0.01, -0.01))
    with pytest.raises(InvalidInputError, match="positive full commands"):
        changed(full=(0.42, 0.0, 0.185, 2.8))
    with pytest.raises(InvalidInputError, match="12 leg joints"):
        changed(home=ERS7_HOME)
    with pytest.raises(InvalidInputError, match=r"shape \(2, 3\)"):
        ERS7_TROT.bind(2).legs(np.zeros((1, 3)))
    with pytest.raises(InvalidInputError, match="no gait"):
        ERS7_TROT.table_rates([0, 0, 0])


def test_the_walk_holds_the_head_and_the_rest_at_home():
    engine = Walk()
    assert AiboERS7(engine).command_names == ("forward", "left", "turn", "tilt", "pan", "nod")
    bound = engine.bind(1)
    sensed = Proprioception(np.zeros((1, 20)), np.zeros((1, 3)), 0.0)
    targets = bound.targets(np.array([[0, 0, 0, -0.5, 1.0, 0.2]]), sensed)
    np.testing.assert_allclose(targets[0, :12], ERS7_HOME[:12], atol=1e-9)
    np.testing.assert_allclose(targets[0, 12:15], [-0.5, 1.0, 0.2])
    np.testing.assert_allclose(targets[0, 15:], ERS7_HOME[15:])


def changed(**parts) -> Trot:
    return dataclasses.replace(ERS7_TROT, **parts)
