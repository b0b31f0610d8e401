import numpy as np
import pytest

from controllers.motion import Limits, along_perpendicular, profile, synchronised
from controllers.motion.plane import synchronising_angle
from mjmr.errors import InvalidInputError

ROBOT = Limits(max_speed=2.0, acceleration=3.0, deceleration=6.0)
T = 1 / 60


def drive(x, v, g, cycles=400):
    e = np.zeros(2)
    path = [(x, v)]
    for _ in range(cycles):
        c, e = along_perpendicular(x, v, g, ROBOT, T, e)
        x, v = x + 0.5 * (v + c) * T, c
        path.append((x, v))
    return path


def random_states(count, seed):
    rng = np.random.default_rng(seed)
    angle, speed = rng.uniform(0, 2 * np.pi, count), rng.uniform(0, 2, count)
    velocity = speed[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    return rng.uniform(-2, 2, (count, 2)), velocity, rng.uniform(-2, 2, (count, 2))


def test_random_states_converge():
    for x, v, g in zip(*random_states(150, 1), strict=True):
        end, speed = drive(x, v, g)[-1]
        assert np.linalg.norm(end - g) < 0.002
        assert np.linalg.norm(speed) < 0.02


def test_each_axis_of_the_rule_keeps_its_bounds():
    for x, v, g in zip(*random_states(500, 2), strict=True):
        c, e = along_perpendicular(x, v, g, ROBOT, T)
        np.testing.assert_allclose(e, (g - x) / np.linalg.norm(g - x), atol=1e-12)
        n = np.array([-e[1], e[0]])
        for axis in (e, n):
            was, now = v @ axis, c @ axis
            assert abs(now) - abs(was) <= 3.0 * T + 1e-12
            assert abs(now - was) <= 6.0 * T + 1e-12
        assert c @ e == pytest.approx(
            profile(float(np.linalg.norm(g - x)), float(v @ e), ROBOT).velocity(T), abs=1e-12
        )
        assert (c @ n) * (v @ n) >= -1e-15
        assert abs(c @ n) == pytest.approx(max(0.0, abs(v @ n) - 6.0 * T), abs=1e-12)


def test_near_the_target_the_last_direction_is_kept():
    last = np.array([0.6, 0.8])
    for offset in ([0.0099, 0.0], [0.0, 0.0], [-0.005, 0.002]):
        _, e = along_perpendicular(offset, [0.1, 0.0], [0.0, 0.0], ROBOT, T, last)
        np.testing.assert_array_equal(e, last)
    _, e = along_perpendicular([0.0101, 0.0], [0.1, 0.0], [0.0, 0.0], ROBOT, T, last)
    np.testing.assert_allclose(e, [-1.0, 0.0])


def test_an_overshoot_inside_the_near_zone_turns_back():
    c, _ = along_perpendicular([0.008, 0.0], [0.0, 0.0], [0.0, 0.0], ROBOT, T, [1.0, 0.0])
    assert c[0] < 0.0


def test_on_the_target_without_a_last_direction_it_brakes():
    c, _ = along_perpendicular([1.0, 1.0], [0.3, -0.2], [1.0, 1.0], ROBOT, T)
    assert np.linalg.norm(c) < np.linalg.norm([0.3, -0.2])


def test_bisection_makes_both_axes_arrive_together():
    for x, v, g in zip(*random_states(500, 3), strict=True):
        d = g - x
        alpha = synchronising_angle(d[0], d[1], v[0], v[1], 2.0, 3.0, 6.0)
        times = [
            profile(
                float(d[k]),
                float(v[k]),
                Limits(max_speed=2 * f, acceleration=3 * f, deceleration=6 * f),
            ).duration
            for k, f in enumerate((np.cos(alpha), np.sin(alpha)))
        ]
        assert abs(times[0] - times[1]) <= 1e-9


def test_bisection_keeps_the_acceleration_bound_as_a_vector_and_arrives():
    for x, v, g in zip(*random_states(60, 4), strict=True):
        for _ in range(400):
            c = synchronised(x, v, g, ROBOT, T)
            assert np.linalg.norm(c - v) <= 6.0 * T + 1e-9
            x, v = x + 0.5 * (v + c) * T, c
        assert np.linalg.norm(x - g) < 0.002


@pytest.mark.parametrize("name", ["position", "velocity", "target", "direction", "period"])
def test_errors_name_the_argument(name):
    given = {
        "position": [0, 0],
        "velocity": [0, 0],
        "target": [1, 1],
        "limits": ROBOT,
        "period": T,
        "direction": [0, 0],
    }
    for wrong in (np.nan, [np.nan, 0.0]):
        if name == "period" and isinstance(wrong, list):
            continue
        with pytest.raises(InvalidInputError, match=name):
            along_perpendicular(**{**given, name: wrong})
