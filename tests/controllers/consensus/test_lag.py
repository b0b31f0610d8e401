"""The lag behind a moving leader, against the closed loop integrated step by step."""

import numpy as np
import pytest

from controllers.consensus import harmonic_error, neighbour_gains, ramp_lag
from mjmr.errors import InvalidInputError

CHAIN = np.array([[1, 0, 0], [1, 1, 0], [0, 1, 1]], dtype=bool)
BOTH = np.array([[1, 0, 0, 0], [1, 1, 1, 0], [1, 1, 1, 1], [0, 0, 1, 1]], dtype=bool)
STEP = 0.01


def integrate(gains, path, offsets, seconds, delay=0.0, told=False):
    """Outputs less the path (k, n, 2) of followers of robot 0, by small steps.

    ``path`` and ``offsets`` give place, velocity and acceleration at a time.
    """
    n, late = len(gains), round(delay / STEP)
    others = gains - np.diag(np.diag(gains))
    place = np.zeros((n, 2)) + offsets(0.0)[0]
    speed, known = np.zeros((n, 2)), np.zeros((2, n, 2))
    outputs, relayed, errors = [], [], []
    for k in range(round(seconds / STEP)):
        p, d = path(k * STEP), offsets(k * STEP)
        place[0], speed[0] = p[0] + d[0, 0], p[1] + d[1, 0]
        outputs.append(place - d[0])
        known = known.copy()
        if k >= late:
            before = relayed[k - late] if late else known
            known = np.einsum("ij,ajk->aik", others, before) / np.maximum(
                others.sum(axis=1), 1e-9
            ).reshape(1, -1, 1)
        known[:, 0] = p[1:]
        relayed.append(known)
        errors.append(outputs[-1] - p[0])
        heard = outputs[max(0, k - late)]
        pull = np.einsum("ij,ijm->im", others, heard[None] - outputs[-1][:, None])
        extra = (known + d[1:]) if told else np.zeros((2, n, 2))
        speed = speed + STEP * (extra[1] - 2 * (speed - extra[0]) + pull)
        place = place + STEP * speed
    return np.array(errors)


def still(n):
    return lambda time: np.zeros((3, n, 2))


def test_in_a_chain_each_link_is_two_speeds_over_the_gain_long():
    lag = ramp_lag(neighbour_gains(CHAIN, 0.2), 0, [0.2, 0.1])
    assert lag == pytest.approx(np.array([[0, 0], [2, 1], [4, 2]]), abs=1e-12)
    late = ramp_lag(neighbour_gains(CHAIN, 0.8), 0, [0.2, 0.0], delay=0.5, told=True)
    assert late[:, 0] == pytest.approx([0, 0.1, 0.2], abs=1e-12)


@pytest.mark.parametrize("graph", [CHAIN, BOTH], ids=["chain", "both ways"])
@pytest.mark.parametrize(("delay", "told"), [(0.0, False), (0.5, False), (0.5, True)])
def test_the_lag_on_a_line_is_what_the_loop_ends_with(graph, delay, told):
    gains, v = neighbour_gains(graph, 0.6), np.array([0.2, -0.1])
    errors = integrate(
        gains, lambda t: np.array([v * t, v, 0 * v]), still(len(gains)), 80.0, delay, told
    )
    lag = ramp_lag(gains, 0, v, delay=delay, told=told)
    assert errors[-1] == pytest.approx(-lag, abs=0.01)
    assert np.abs(lag[1:]).max() > 0.05


@pytest.mark.parametrize("graph", [CHAIN, BOTH], ids=["chain", "both ways"])
@pytest.mark.parametrize(("delay", "told"), [(0.0, False), (0.5, False), (0.5, True)])
def test_what_turns_and_swings_ends_with_the_amplitudes_of_the_loop(graph, delay, told):
    gains, rate, n = neighbour_gains(graph, 0.6), 0.4, len(graph)
    path = np.array([1.0, -1j])
    swing = np.arange(n)[:, None] * np.array([0.3, 0.2j])

    def at(amplitude):
        def wave(time):
            z = amplitude * np.exp(1j * rate * time)
            return np.array([z.real, (1j * rate * z).real, (-(rate**2) * z).real])

        return wave

    errors = integrate(gains, at(path), at(swing), 120.0, delay, told)
    turn = round(2 * np.pi / rate / STEP)
    measured = (errors[-turn:] ** 2).sum(axis=2).mean(axis=0)
    found = harmonic_error(gains, 0, rate, path, swing, delay=delay, told=told)
    wanted = (np.abs(found) ** 2).sum(axis=1) / 2
    assert measured == pytest.approx(wanted, rel=0.05, abs=1e-3)
    assert wanted[1:].min() > 1e-3


def test_told_without_delay_nothing_lags():
    gains = neighbour_gains(CHAIN, 0.2)
    found = harmonic_error(gains, 0, 0.3, [1, 1j], np.ones((3, 2)), told=True)
    assert np.abs(found).max() < 1e-12


def test_who_does_not_hear_the_leader_is_named():
    alone = np.array([[1, 0, 0], [1, 1, 0], [0, 0, 1]], dtype=bool)
    with pytest.raises(InvalidInputError, match="robot 2 does not hear robot 0"):
        ramp_lag(neighbour_gains(alone, 0.2), 0, [0.2])
    with pytest.raises(InvalidInputError, match="one of 0 to 2; got 3"):
        ramp_lag(neighbour_gains(CHAIN, 0.2), 3, [0.2])
    with pytest.raises(InvalidInputError, match="above 0; got 0"):
        harmonic_error(neighbour_gains(CHAIN, 0.2), 0, 0.0, [1.0], np.zeros((3, 1)))


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"velocity": 0.2}, "a velocity is finite numbers"),
        ({"velocity": ["a"]}, "a velocity is finite numbers .* got .'a'"),
        ({"velocity": [np.nan, 0.0]}, "a velocity is finite numbers"),
        ({"leader": 0.0}, r"one of 0 to 2; got 0\.0"),
        ({"delay": -1.0}, r"0 or more and finite; got -1\.0 s"),
        ({"delay": np.inf}, "0 or more and finite; got inf s"),
        ({"delay": "late"}, "0 or more and finite; got late s"),
        ({"gains": [["a"]]}, "gains are numbers"),
    ],
)
def test_lags_of_what_cannot_be_are_told_in_a_sentence(given, told):
    fit = {"gains": neighbour_gains(CHAIN, 0.2), "leader": 0, "velocity": [0.2, 0.0]}
    ramp_lag(**fit)
    with pytest.raises(InvalidInputError, match=told):
        ramp_lag(**{**fit, **given})


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"rate": "fast"}, "above 0; got fast"),
        ({"rate": np.inf}, "above 0; got inf"),
        ({"path": 1.0}, "amplitudes of a path are finite numbers"),
        ({"path": [np.nan, 0.0]}, "amplitudes of a path are finite numbers"),
        ({"offsets": np.zeros((4, 2))}, r"of shape \(3, 2\) .m.; got shape \(4, 2\)"),
        ({"offsets": np.zeros((3, 1))}, r"of shape \(3, 2\) .m.; got shape \(3, 1\)"),
        ({"offsets": "none"}, "got no numbers"),
        ({"leader": 0.0}, r"one of 0 to 2; got 0\.0"),
        ({"delay": -1.0}, r"0 or more and finite; got -1\.0 s"),
    ],
)
def test_swings_of_what_cannot_be_are_told_in_a_sentence(given, told):
    fit = {"gains": neighbour_gains(CHAIN, 0.2), "leader": 0, "rate": 0.3, "path": [1.0, 1j],
           "offsets": np.zeros((3, 2))}  # fmt: skip
    harmonic_error(**fit)
    with pytest.raises(InvalidInputError, match=told):
        harmonic_error(**{**fit, **given})
