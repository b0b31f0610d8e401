import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from controllers.motion import forward_predict, predict
from mjmr.errors import InvalidInputError

B, T = 6.0, 1 / 60
speeds = st.floats(-2.2, 2.2)


def execute(p, v, command, fraction):
    """Positions after every cycle and after ``fraction`` of each, braking from the second on."""
    whole, inside, c = [p], [], command
    for _ in range(40):
        t = fraction * T
        inside.append(p + v * t + (c - v) * t * t / (2 * T))
        p, v = p + 0.5 * (v + c) * T, c
        whole.append(p)
        speed = np.hypot(*v)
        c = v * max(0.0, 1.0 - B * T / speed) if speed > 0.0 else v
    return np.array(whole), np.array(inside), v


def at(pieces, t):
    piece = [q for q in pieces if q.start <= t][-1]
    s = t - piece.start
    return piece.position + piece.velocity * s + 0.5 * piece.acceleration * s * s


@given(vx=speeds, vy=speeds, cx=speeds, cy=speeds, fraction=st.floats(0.05, 0.95))
def test_prediction_is_what_braking_in_whole_cycles_executes(vx, vy, cx, cy, fraction):
    p, v, c = np.array([0.3, -0.7]), np.array([vx, vy]), np.array([cx, cy])
    pieces = predict(p, v, c, B, T)
    whole, inside, last = execute(p, v, c, fraction)
    assert np.hypot(*last) < 1e-12
    for k in range(40):
        np.testing.assert_allclose(at(pieces, k * T), whole[k], atol=1e-12)
        np.testing.assert_allclose(at(pieces, (k + fraction) * T), inside[k], atol=1e-12)


def test_whole_cycles_go_further_than_continuous_braking():
    excess = []
    for speed in np.linspace(0.001, 2.0, 400):
        stop = predict([0, 0], [speed, 0], [speed, 0], B, T)[-1].position[0] - speed * T
        excess.append(stop - speed**2 / (2 * B))
    assert min(excess) > -1e-12
    assert max(excess) == pytest.approx(B * T**2 / 8, rel=0.02)


def test_the_last_piece_is_rest_and_starts_increase():
    pieces = predict([1, 2], [0.5, 0], [0.45, 0.02], B, T)
    assert [p.start for p in pieces] == sorted({p.start for p in pieces})
    assert not pieces[-1].velocity.any()
    assert not pieces[-1].acceleration.any()
    assert len(predict([1, 2], [0, 0], [0, 0], B, T)) == 2


def test_forward_prediction_goes_through_the_pending_commands_in_order():
    rng = np.random.default_rng(3)
    p, v, pending = rng.normal(size=(3, 2)), rng.normal(size=(3, 2)), rng.normal(size=(2, 3, 2))
    got_p, got_v = forward_predict(p, v, pending, T)
    fine = 1000
    want = p.copy()
    for a, b in ((v, pending[0]), (pending[0], pending[1])):
        for k in range(fine):
            want = want + (a + (b - a) * (k + 0.5) / fine) * T / fine
    np.testing.assert_allclose(got_p, want, atol=1e-12)
    np.testing.assert_array_equal(got_v, pending[1])
    got_p, got_v = forward_predict(p, v, np.zeros((0, 3, 2)), T)
    np.testing.assert_array_equal(got_p, p)
    np.testing.assert_array_equal(got_v, v)
    assert not np.shares_memory(got_p, p)


def test_errors():
    with pytest.raises(InvalidInputError, match="velocity"):
        predict([0, 0], [0, np.nan], [0, 0], B, T)
    with pytest.raises(InvalidInputError, match="period"):
        predict([0, 0], [0, 0], [0, 0], B, 0.0)
    with pytest.raises(InvalidInputError, match="pending"):
        forward_predict(np.zeros((3, 2)), np.zeros((3, 2)), np.zeros((2, 4, 2)), T)
    with pytest.raises(InvalidInputError, match="position"):
        forward_predict(np.zeros(2), np.zeros(2), np.zeros((0, 2)), T)
