import numpy as np
import pytest

from controllers.motion.approach import closest_approach, interval_minimum
from controllers.motion.prediction import PIECES, fill_prediction

B, T = 6.0, 1 / 60


def random_prediction(rng, spread, slowest=0.0):
    rows = np.empty((PIECES, 7))
    p = rng.uniform(-spread, spread, 2)
    v = rng.uniform(-2, 2, 2) * (rng.random() > slowest)
    c = v + rng.uniform(-0.1, 0.1, 2)
    reach = fill_prediction(*p, *v, *c, B, T, rows)
    return rows, reach


def position(rows, t):
    k = np.searchsorted(rows[:, 0], t, side="right") - 1
    s = (t - rows[k, 0])[:, None]
    return rows[k, 1:3] + rows[k, 3:5] * s + 0.5 * rows[k, 5:7] * s * s


def dense_minimum(distance, end):
    """Least value over [0, end]: 2001 samples, then each low dip sampled 2001 times more."""
    t = np.linspace(0.0, end, 2001)
    d = distance(t)
    inner = np.flatnonzero((d[1:-1] < d[:-2]) & (d[1:-1] <= d[2:])) + 1
    best = min(d[0], d[-1])
    for k in inner:
        best = min(best, distance(np.linspace(t[k - 1], t[k + 1], 2001)).min())
    return best


def test_closest_approach_agrees_with_dense_sampling():
    rng = np.random.default_rng(8)
    inside = 0
    for _ in range(400):
        one, _ = random_prediction(rng, 0.4, slowest=0.2)
        two, _ = random_prediction(rng, 0.4, slowest=0.2)
        got = closest_approach(one, two, np.inf)
        end = max(one[-1, 0], two[-1, 0])
        want = dense_minimum(
            lambda t, a=one, b=two: np.linalg.norm(position(a, t) - position(b, t), axis=1), end
        )
        assert got == pytest.approx(want, abs=1e-5)
        assert got == closest_approach(two, one, np.inf)
        ends = np.linalg.norm(one[[0, -1], 1:3] - two[[0, -1], 1:3], axis=1)
        inside += got < ends.min() - 1e-3
    assert inside > 50


def test_enough_never_changes_the_verdict():
    rng = np.random.default_rng(9)
    near = 0
    for _ in range(2000):
        one, _ = random_prediction(rng, 0.4)
        two, _ = random_prediction(rng, 0.4)
        exact, quick = closest_approach(one, two, np.inf), closest_approach(one, two, 0.18)
        if exact < 0.18:
            assert quick == exact
            near += 1
        else:
            assert quick >= 0.18
    assert near > 200


def test_reach_bounds_the_motion():
    rng = np.random.default_rng(10)
    for _ in range(300):
        rows, reach = random_prediction(rng, 1.0)
        path = position(rows, np.linspace(0, rows[-1, 0] + 0.01, 500))
        assert np.linalg.norm(path - rows[0, 1:3], axis=1).max() <= reach + 1e-12


@pytest.mark.parametrize("kind", ["both", "velocity", "acceleration", "tiny", "none", "collinear"])
def test_interval_minimum_in_every_degenerate_case(kind):
    rng = np.random.default_rng(11)
    for _ in range(200):
        r, u, a = rng.normal(size=2), 3 * rng.normal(size=2), 8 * rng.normal(size=2)
        if kind == "velocity":
            a[:] = 0
        elif kind == "acceleration":
            u[:] = 0
        elif kind == "tiny":
            a *= 1e-14
        elif kind == "none":
            u[:], a[:] = 0, 0
        elif kind == "collinear":
            u, a = r * rng.normal() * 3, r * rng.normal() * 8
        h = rng.uniform(0.05, 1.5)

        def length(t, r=r, u=u, a=a):
            return np.linalg.norm(r + np.outer(t, u) + 0.5 * np.outer(t * t, a), axis=1)

        got = np.sqrt(interval_minimum(*r, *u, *a, h))
        assert got == pytest.approx(dense_minimum(length, h), abs=1e-5)
