import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from controllers.motion import Limits, profile
from controllers.motion.trapezoid import velocity_after
from mjmr.errors import InvalidInputError

ROBOT = Limits(max_speed=2.0, acceleration=3.0, deceleration=6.0)
TABLE = [
    (1.0, 0.0, [(0.6667, 3), (0.3333, -6)], 1.0),
    (0.5, 0.0, [(0.4714, 3), (0.2357, -6)], 0.7071),
    (4.9, 0.0, [(0.6667, 3), (1.95, 0), (0.3333, -6)], 2.95),
    (1.0, -1.0, [(0.1667, 6), (0.6667, 3), (0.0417, 0), (0.3333, -6)], 1.2083),
    (0.1, 1.5, [(0.25, -6), (0.1972, -3), (0.0986, 6)], 0.5458),
    (2.0, 2.5, [(0.0833, -6), (0.7396, 0), (0.3333, -6)], 1.1562),
]


@pytest.mark.parametrize(("way", "speed", "segments", "total"), TABLE)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_card_s_unit_table_holds(way, speed, segments, total, sign):
    p = profile(sign * way, sign * speed, ROBOT)
    np.testing.assert_allclose(p.segments * [1.0, sign], segments, atol=1e-4)
    assert p.duration == pytest.approx(total, abs=1e-4)


def random_profiles(count):
    rng = np.random.default_rng(13)
    ways, speeds = rng.uniform(-5, 5, count), rng.uniform(-2.6, 2.6, count)
    ways[: count // 10] *= 1e-4
    slots = np.zeros((count, 4, 2))
    for i in range(count):
        s = profile(ways[i], speeds[i], ROBOT).segments
        slots[i, : len(s)] = s
    return ways, speeds, slots


def test_100_000_random_states_come_to_rest_on_the_target():
    ways, speeds, slots = random_profiles(100_000)
    dt, a = slots[..., 0], slots[..., 1]
    assert dt.min() >= 0.0
    x, v = np.zeros(len(ways)), speeds.copy()
    for k in range(4):
        before = v
        v = v + a[:, k] * dt[:, k]
        x += 0.5 * (before + v) * dt[:, k]
        change = np.abs(v) - np.abs(before)
        assert (change <= 3.0 * dt[:, k] + 1e-9).all()
        assert (change >= -6.0 * dt[:, k] - 1e-9).all()
        assert (np.abs(v) <= np.maximum(2.0, np.abs(speeds)) + 1e-9).all()
        # Within a segment the velocity keeps its sign, so bounds at its ends are bounds inside.
        assert (before * v >= -1e-9).all()
    assert np.abs(x - ways).max() <= 1e-9
    assert np.abs(v).max() <= 1e-9


@given(
    way=st.floats(-5, 5), speed=st.floats(-2.6, 2.6), t=st.floats(0, 4), step=st.floats(1e-6, 1e-3)
)
def test_position_is_the_integral_of_velocity(way, speed, t, step):
    p = profile(way, speed, ROBOT)
    mean = (p.position(t + step) - p.position(t)) / step
    ends = [p.velocity(t), p.velocity(t + step)]
    assert min(ends) - 6.0 * step - 1e-8 <= mean <= max(ends) + 6.0 * step + 1e-8
    assert p.velocity(0.0) == (speed if len(p.segments) else 0.0)
    assert p.velocity(p.duration + 1e-9) == 0.0


@given(way=st.floats(-5, 5), speed=st.floats(-2.6, 2.6), period=st.floats(1e-3, 0.5))
def test_the_command_is_the_profile_s_velocity_one_period_ahead(way, speed, period):
    p = profile(way, speed, ROBOT)
    command = velocity_after(way, speed, 2.0, 3.0, 6.0, period)
    assert command == pytest.approx(p.velocity(period), abs=1e-12)


def drive(way, speed, period, cycles):
    for _ in range(cycles):
        c = velocity_after(way, speed, 2.0, 3.0, 6.0, period)
        way -= 0.5 * (speed + c) * period
        speed = c
    return way, speed


@pytest.mark.parametrize(
    ("way", "speed", "cycles", "residual"), [(1.0, 0.0, 60, 0.0), (4.0, 0.0, 150, 0.0)]
)
def test_whole_moves_end_exactly_after_their_cycles(way, speed, cycles, residual):
    left, v = drive(way, speed, 1 / 60, cycles)
    assert abs(left) == pytest.approx(residual, abs=1e-9)
    assert v == pytest.approx(0.0, abs=1e-9)
    assert abs(drive(way, speed, 1 / 60, cycles - 2)[0]) > 1e-4


@pytest.mark.parametrize(("period", "residual"), [(1 / 60, 0.15e-3), (1 / 30, 0.75e-3)])
def test_residual_after_an_overshoot_is_the_card_s(period, residual):
    left, v = drive(0.1, 1.5, period, 200)
    assert v == 0.0
    assert abs(left) == pytest.approx(residual, abs=0.005e-3)


@pytest.mark.parametrize(("period", "zone"), [(1 / 60, 0.2778e-3), (1 / 30, 1.1111e-3)])
def test_moves_in_the_dead_zone_are_never_started(period, zone):
    assert velocity_after(0.999 * zone, 0.0, 2.0, 3.0, 6.0, period) == 0.0
    assert velocity_after(1.001 * zone, 0.0, 2.0, 3.0, 6.0, period) > 0.0


@pytest.mark.parametrize("name", ["max_speed", "acceleration", "deceleration"])
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_limits_reject_what_is_not_positive_and_finite(name, value):
    with pytest.raises(InvalidInputError, match=name):
        Limits(**{name: value})


@pytest.mark.parametrize(
    ("way", "speed", "name"), [(np.nan, 0.0, "displacement"), (1.0, np.inf, "velocity")]
)
def test_profile_names_the_number_that_is_not_finite(way, speed, name):
    with pytest.raises(InvalidInputError, match=name):
        profile(way, speed, ROBOT)
