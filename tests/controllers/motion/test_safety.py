import numpy as np
import pytest

from controllers.motion import Navigator, NavigatorConfig
from controllers.motion.clearance import prepare_boxes
from controllers.motion.depth import static_depth
from controllers.motion.prediction import PIECES, fill_prediction
from controllers.motion.safety import braking_command, reachable_box
from tests.controllers.motion.scenes import BOUNDS, PERIOD, RADIUS, box_distance, stop_path

B, A, T = 6.0, 3.0, PERIOD
BOX = np.array([[0.3, 0.1, 0.4, 0.3, 0.2]])
N = 5
STILL = np.zeros((1, 2))


def brake(v):
    return np.array(braking_command(v[0], v[1], B, T))


def least_pair(one, two):
    return np.linalg.norm(one - two, axis=1).min() - 2 * RADIUS


def least_static(path):
    walls = np.minimum(path - BOUNDS[:2], BOUNDS[2:] - path).min()
    return min(walls, box_distance(path, BOX[0]).min()) - RADIUS


def crowded_states(count, seed):
    """States of five robots that drive to and fro close to one box; their braking is clear."""
    rng = np.random.default_rng(seed)
    navigator = make(seed)
    p = np.column_stack([np.linspace(-1, 1, N), [-0.8, 0.8, -0.8, 0.8, -0.8]])
    v, cycle = np.zeros((N, 2)), 0
    goals = p
    while count:
        if cycle % 30 == 0:
            goals = rng.uniform(-1, 1, (N, 2))
        if cycle % 4 == 3:
            count -= 1
            yield p, v, goals
        cycle += 1
        c = navigator.step(p, v, goals)
        p, v = p + 0.5 * (v + c) * T, c


def make(seed=0, n=N, boxes=BOX, **settings):
    config = NavigatorConfig(planner="straight", **settings)
    return Navigator(BOUNDS, boxes, n, config, np.random.default_rng(seed))


def test_braking_is_clear_in_the_states_these_tests_start_from():
    for p, v, _ in crowded_states(60, 21):
        paths = [stop_path(p[i], v[i], brake(v[i])) for i in range(N)]
        assert min(least_static(q) for q in paths) >= -1e-11
        assert min(least_pair(paths[i], paths[j]) for i in range(N) for j in range(i)) >= -1e-11


@pytest.mark.parametrize("fail_safe", [False, True])
def test_chosen_commands_are_clear_reachable_and_never_needlessly_changed(fail_safe):
    changed = 0
    for k, (p, v, goals) in enumerate(crowded_states(60, 21)):
        navigator = make(k, fail_safe=fail_safe)
        c = navigator.step(p, v, goals)
        chosen = [stop_path(p[i], v[i], c[i]) for i in range(N)]
        braking = [stop_path(p[i], v[i], brake(v[i])) for i in range(N)]
        for i in range(N):
            assert least_static(chosen[i]) >= -1e-11
            for j in range(N):
                if j < i:
                    assert least_pair(chosen[i], chosen[j]) >= -1e-11
                if fail_safe and j != i:
                    assert least_pair(chosen[i], braking[j]) >= -1e-11
            if not navigator.sampled[i]:
                np.testing.assert_array_equal(c[i], navigator.desired[i])
                continue
            changed += 1
            assert np.hypot(*c[i]) <= max(2.0, np.hypot(*v[i])) + 1e-9
            speed = np.hypot(*v[i])
            e = v[i] / speed if speed > 0 else np.array([1.0, 0.0])
            along, across = (c[i] - v[i]) @ e, (c[i] - v[i]) @ [-e[1], e[0]]
            assert along <= A * T + 1e-9
            assert abs(across) <= A * T + 1e-9
            assert along >= -B * T - 1e-9
    assert changed > 30


def test_the_desired_command_is_replaced_only_where_it_would_hit():
    """Robot 0 chooses first: its desired command is refused iff it meets the others' braking."""
    refused = 0
    for k, (p, v, goals) in enumerate(crowded_states(80, 22)):
        for first in range(N):
            p, v, goals = (np.roll(a, 1, axis=0) for a in (p, v, goals))
            navigator = make(k)
            navigator.step(p, v, goals)
            mine = stop_path(p[0], v[0], navigator.desired[0])
            gaps = [least_static(mine)]
            gaps += [least_pair(mine, stop_path(p[j], v[j], brake(v[j]))) for j in range(1, N)]
            # Within a quarter of a millimetre the triangle of the ramp may refuse what is clear.
            if abs(min(gaps)) > 2.5e-4:
                assert navigator.sampled[0] == (min(gaps) < 0.0), (k, first)
                refused += int(navigator.sampled[0])
    assert refused > 5


def test_more_samples_come_nearer_to_the_desired_command():
    def shortfall(samples):
        total = 0.0
        for k, (p, v, goals) in enumerate(crowded_states(30, 23)):
            navigator = make(k, samples=samples)
            total += np.linalg.norm(navigator.step(p, v, goals) - navigator.desired)
        return total

    assert shortfall(200) < shortfall(5)


def test_static_depth_is_conservative_by_at_most_the_ramp_s_sag():
    rng = np.random.default_rng(24)
    prepared, rows, hits = prepare_boxes(BOX), np.empty((PIECES, 7)), 0
    for _ in range(400):
        p, v = rng.uniform(-0.6, 0.9, 2), rng.uniform(-2, 2, 2)
        c = v + rng.uniform(-0.1, 0.1, 2)
        reach = fill_prediction(*p, *v, *c, B, T, rows)
        got = static_depth(rows, reach, RADIUS, 1e-12, BOUNDS, prepared, STILL, 0.7)
        true = max(0.0, RADIUS - box_distance(stop_path(p, v, c, inside=400), BOX[0]).min())
        assert got >= true - 1e-12
        # 400 samples a cycle miss the nearest point by at most 0.05 mm.
        assert got <= true + np.hypot(*(c - v)) * T / 8 + 5e-5
        hits += 0.0 < true < RADIUS
    assert hits > 50


def test_static_depth_adds_up_sides_that_are_passed():
    rows = np.empty((PIECES, 7))
    reach = fill_prediction(2.70, 2.15, 0.0, 0.0, 0.0, 0.0, B, T, rows)
    depth = static_depth(
        rows, reach, RADIUS, 1e-12, BOUNDS, prepare_boxes(None), np.zeros((0, 2)), 0.7
    )
    assert depth == pytest.approx(0.04 + 0.04, abs=1e-12)


@pytest.mark.parametrize("speed", [0.0, 0.03, 0.1, 1.5])
def test_reachable_box_is_what_bounded_acceleration_reaches(speed):
    least, most, side = reachable_box(speed, A, B, T)
    v = speed
    for _ in range(20_000):
        v -= (B if v > 0.0 else A) * T / 20_000
    assert speed + least == pytest.approx(v, abs=1e-5)
    assert (most, side) == (A * T, A * T)


def settle(p, goals, seconds, boxes=None, **settings):
    navigator = make(1, len(p), boxes, **settings)
    v = np.zeros_like(p)
    for _ in range(round(seconds / T)):
        c = navigator.step(p, v, goals)
        p, v = p + 0.5 * (v + c) * T, c
    return p, v


@pytest.mark.parametrize("apart", [True, False])
def test_an_overlapped_start_separates_within_a_second(apart):
    p = np.array([[-0.06, 0.0], [0.06, 0.01]])
    goals = np.array([[-1.5, 0.0], [1.5, 0.0]]) * (1 if apart else -1)
    p, _ = settle(p, goals, 1.0)
    assert np.linalg.norm(p[0] - p[1]) >= 2 * RADIUS


def test_a_heap_of_robots_separates_within_a_second():
    rng = np.random.default_rng(3)
    for _ in range(5):
        p = rng.uniform(-0.12, 0.12, (4, 2))
        goals = 1.5 * p / np.linalg.norm(p, axis=1, keepdims=True)
        p, _ = settle(p, goals, 1.0)
        i, j = np.triu_indices(4, 1)
        assert np.linalg.norm(p[i] - p[j], axis=1).min() >= 2 * RADIUS


def test_a_robot_inside_the_margin_of_a_box_is_not_frozen():
    box = np.array([[0.0, 0.0, 0.0, 1.0, 0.5]])
    start = np.array([[-0.8, 0.5 + RADIUS + 0.002]])
    p, _ = settle(start, np.array([[0.8, 0.5 + RADIUS + 0.002]]), 2.0, box, margin=0.004)
    assert p[0, 0] > 0.7
    assert p[0, 1] >= 0.5 + RADIUS - 1e-9
