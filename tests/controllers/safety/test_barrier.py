import subprocess
import sys

import numpy as np
import pytest
from scipy.optimize import minimize

from controllers.safety import BarrierConfig, BarrierFilter, keep_right
from mjmr.errors import InvalidInputError

RING = BarrierConfig(distance=0.55, rate=2.0, top_speed=0.5)


def ring(n, radius):
    angle = 2 * np.pi * np.arange(n) / n
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def test_a_free_wish_is_left_alone():
    filter = BarrierFilter(3, RING)
    position, wish = ring(3, 5.0), np.array([[0.2, 0], [0, -0.2], [0.1, 0.1]])
    assert filter.filter(position, wish) == pytest.approx(wish, abs=1e-3)


def test_the_speed_stays_inside_the_circle():
    filter = BarrierFilter(16, RING)
    wish = 3 * ring(16, 1.0)
    speed = np.hypot(*filter.filter(ring(16, 50.0), wish).T)
    assert speed.max() <= 0.5 + 1e-3
    assert speed.min() >= 0.5 * np.cos(np.pi / 8) - 1e-3


def test_it_is_the_nearest_safe_velocity():
    """Against scipy's SLSQP on random crowds."""
    rng = np.random.default_rng(0)
    bound = 0.0
    for _ in range(8):
        position = ring(4, 0.5) + rng.normal(0, 0.05, (4, 2))
        wish = rng.normal(0, 0.2, (4, 2))
        config = BarrierConfig(
            distance=0.55, rate=2.0, top_speed=5.0, clearance=0.3, obstacles=1, tolerance=1e-7
        )
        point = position + np.array([0.5, 0.1])
        found = BarrierFilter(4, config).filter(position, wish, point[:, None])

        i, j = np.triu_indices(4, 1)
        apart = position[i] - position[j]
        gap = (apart**2).sum(axis=1) - 0.55**2
        away = position - point

        def rows(x, apart=apart, gap=gap, away=away, i=i, j=j):
            u = x.reshape(4, 2)
            pairs = 2 * (apart * (u[i] - u[j])).sum(axis=1) + 2 * gap
            walls = 2 * (away * u).sum(axis=1) + 2 * ((away**2).sum(axis=1) - 0.3**2)
            return np.concatenate([pairs, walls])

        best = minimize(
            lambda x, wish=wish: ((x - wish.ravel()) ** 2).sum(), np.zeros(8),
            constraints={"type": "ineq", "fun": rows}, options={"ftol": 1e-12, "maxiter": 500},
        )  # fmt: skip
        assert best.success
        assert found.ravel() == pytest.approx(best.x, abs=1e-4)
        bound = max(bound, float(np.abs(found - wish).max()))
    assert bound > 0.05, "some constraint was felt"


def swap(n, turn, seconds=60.0, dt=0.02):
    """Antipodal swap of points that follow at once: least distance and time of arrival."""
    position, goal = ring(n, 3.0), -ring(n, 3.0)
    filter = BarrierFilter(n, RING)
    least, arrived = np.inf, np.inf
    for k in range(round(seconds / dt)):
        away = goal - position
        wish = away * np.minimum(1.0, 0.5 / np.maximum(np.hypot(*away.T), 1e-9))[:, None]
        wish = keep_right(position, wish, 2.5 * 0.55, turn) if turn else wish
        position = position + dt * filter.filter(position, wish)
        i, j = np.triu_indices(n, 1)
        least = min(least, float(np.hypot(*(position[i] - position[j]).T).min()))
        if np.hypot(*(goal - position).T).max() < 0.05:
            arrived = k * dt
            break
    return least, arrived, filter


def test_ten_robots_swap_places_without_coming_too_near():
    least, arrived, filter = swap(10, turn=0.5)
    assert least >= 0.55 - 1e-3
    assert arrived < 40.0
    assert filter.infeasible == 0


def test_the_symmetric_swap_stands_still_without_a_rule():
    least, arrived, _ = swap(10, turn=0.0, seconds=30.0)
    assert least >= 0.55 - 1e-3
    assert arrived == np.inf


def test_obstacles_are_kept_clear_of():
    config = BarrierConfig(distance=0.5, clearance=0.3, rate=2.0, top_speed=1.0, obstacles=2)
    filter = BarrierFilter(1, config)
    position, least = np.array([[-2.0, 0.05]]), np.inf
    for _ in range(600):
        velocity = filter.filter(position, np.array([[0.8, 0.0]]), np.zeros((1, 1, 2)))
        position = position + 0.02 * velocity
        least = min(least, float(np.hypot(*position[0])))
    assert least >= 0.3 - 2e-3
    assert least < 0.35  # it goes close by


def test_an_impossible_program_brakes_is_counted_and_goes_on():
    config = BarrierConfig(distance=0.5, clearance=0.3, rate=20.0, top_speed=0.1, obstacles=2)
    filter = BarrierFilter(1, config)
    squeezed = np.array([[[0.1, 0.0], [-0.1, 0.0]]])
    wish = np.array([[0.05, 0.0]])
    assert (filter.filter(np.zeros((1, 2)), wish, squeezed) == 0).all()
    assert (filter.solved, filter.infeasible) == (0, 1)
    assert filter.filter(np.zeros((1, 2)), wish) == pytest.approx(wish, abs=1e-3)
    assert (filter.solved, filter.infeasible) == (1, 1)


def test_one_pair_deep_in_each_other_makes_everybody_brake_and_is_counted():
    filter = BarrierFilter(3, RING)
    position = np.array([[0.0, 0.0], [0.05, 0.0], [5.0, 5.0]])
    wish = np.array([[0.0, 0.0], [0.0, 0.0], [0.2, 0.0]])
    # asked for: 2 |d| |u_i - u_j| >= gamma (D^2 - d^2) = 0.6, possible: 0.1
    for _ in range(3):
        assert (filter.filter(position, wish) == 0).all()
    assert (filter.solved, filter.infeasible) == (0, 3)
    assert filter.changed == pytest.approx([0, 0, 0.2])
    position[1, 0] = 0.5  # shallow: 0.1 against 1.0
    found = filter.filter(position, wish)
    assert (filter.solved, filter.infeasible) == (1, 3)
    assert found[1, 0] - found[0, 0] >= 0.105 - 2e-3
    assert found[2] == pytest.approx(wish[2], abs=1e-3)


def test_what_a_solver_out_of_time_found_counts_only_if_it_keeps_the_rows():
    rng = np.random.default_rng(0)
    config = BarrierConfig(distance=0.55, rate=2.0, top_speed=0.5, max_iterations=25)
    i, j = np.triu_indices(6, 1)
    taken = refused = 0
    for _ in range(100):
        position, wish = rng.uniform(-1, 1, (6, 2)), rng.uniform(-0.5, 0.5, (6, 2))
        filter = BarrierFilter(6, config)
        found = filter.filter(position, wish)
        if filter.infeasible:
            assert (found == 0).all()
            refused += 1
            continue
        apart = position[i] - position[j]
        gap = (apart**2).sum(axis=1) - 0.55**2
        rate = 2 * (apart * (found[i] - found[j])).sum(axis=1)
        assert (rate >= -2.0 * gap - 1.5e-3).all()
        taken += 1
    assert taken > 5
    assert refused > 5


def test_lists_are_accepted():
    config = BarrierConfig(distance=0.5, obstacles=1)
    filter = BarrierFilter(2, config)
    found = filter.filter([[0, 0], [3, 0]], [[0.1, 0], [0, 0.1]], [[[0, 9.0]], [[3, 9.0]]])
    assert found == pytest.approx(np.array([[0.1, 0], [0, 0.1]]), abs=1e-3)
    with pytest.raises(InvalidInputError, match="position must be finite"):
        filter.filter([[0, 0], [3]], [[0, 0], [0, 0]])
    with pytest.raises(InvalidInputError, match="obstacles have shape"):
        filter.filter([[0, 0], [3, 0]], [[0, 0], [0, 0]], [[[0, 9.0]], [[3]]])


def test_the_same_inputs_give_the_same_bits():
    runs = []
    for _ in range(2):
        rng = np.random.default_rng(1)
        filter = BarrierFilter(6, RING)
        runs.append([filter.filter(ring(6, 0.6), rng.normal(0, 0.3, (6, 2))) for _ in range(50)])
    np.testing.assert_array_equal(runs[0], runs[1])


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"distance": 0.0}, "must be positive"),
        ({"rate": -1.0}, "must be positive"),
        ({"clearance": -0.1}, "clearance is 0 or more"),
        ({"obstacles": 1.5}, "obstacles is a whole number, 0 or more; got 1.5"),
        ({"obstacles": -1}, "obstacles is a whole number"),
        ({"max_iterations": 10.5}, "max_iterations is a whole number"),
    ],
)
def test_numbers_are_checked(change, said):
    with pytest.raises(InvalidInputError, match=said):
        BarrierConfig(**({"distance": 0.5} | change))


def test_shapes_are_checked():
    filter = BarrierFilter(2, RING)
    with pytest.raises(InvalidInputError, match=r"position must be finite and of shape \(2, 2\)"):
        filter.filter(np.zeros((3, 2)), np.zeros((2, 2)))
    with pytest.raises(InvalidInputError, match="k at most 0"):
        filter.filter(ring(2, 1.0), np.zeros((2, 2)), np.zeros((2, 1, 2)))
    with pytest.raises(InvalidInputError, match="1 robot or more"):
        BarrierFilter(0, RING)


def test_importing_the_package_loads_no_solver():
    code = (
        "import sys\n"
        "import controllers.safety\n"
        "print([m for m in ('osqp', 'scipy.sparse') if m in sys.modules])\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
