import numpy as np
import pytest

from controllers.estimation import PoseFilter, PoseFilterConfig
from controllers.estimation.pose_filter import advance
from mjmr.errors import InvalidInputError
from mjmr.geometry import angle_difference

T = 1 / 60


def step(state, command, period=T):
    new, F, G = np.empty(6), np.empty((6, 6)), np.empty((6, 3))
    advance(state, command, period, new, F, G)
    return new, F, G


def integrate(state, command, pieces=4000, period=T):
    """Midpoint rule in tiny steps: body twist linear in time, heading follows it."""
    x, y, yaw = state[:3]
    dt = period / pieces
    for k in range(pieces):
        w = state[3:] + (command - state[3:]) * (k + 0.5) / pieces
        mid = yaw + 0.5 * dt * w[2]
        x += dt * (np.cos(mid) * w[0] - np.sin(mid) * w[1])
        y += dt * (np.sin(mid) * w[0] + np.cos(mid) * w[1])
        yaw += dt * w[2]
    return np.array([x, y, yaw, *command])


def random_cases(count, seed):
    rng = np.random.default_rng(seed)
    for _ in range(count):
        state = np.concatenate(
            [rng.uniform(-3, 3, 3), rng.uniform(-2, 2, 2), rng.uniform(-10, 10, 1)]
        )
        yield state, np.append(rng.uniform(-2, 2, 2), rng.uniform(-10, 10))


def test_the_process_follows_the_ramp():
    for state, command in random_cases(20, 1):
        np.testing.assert_allclose(step(state, command)[0], integrate(state, command), atol=1e-7)


def test_jacobians_agree_with_finite_differences():
    h = 1e-6
    for state, command in random_cases(50, 2):
        _, F, G = step(state, command, 0.1)
        for k in range(6):
            d = h * np.eye(6)[k]
            want = (step(state + d, command, 0.1)[0] - step(state - d, command, 0.1)[0]) / (2 * h)
            np.testing.assert_allclose(F[:, k], want, atol=1e-8)
        for k in range(3):
            d = h * np.eye(3)[k]
            want = (step(state, command + d, 0.1)[0] - step(state, command - d, 0.1)[0]) / (2 * h)
            np.testing.assert_allclose(G[:, k], want, atol=1e-8)


NOISE = PoseFilterConfig(
    position_noise=0.004, yaw_noise=0.02, speed_noise=0.05, turn_noise=0.3, start_speed=0.5
)


def simulate(n, cycles, seed, config=NOISE, drop=0.0):
    """Robots that miss their commands as the filter believes; yields truth, filter, report."""
    rng = np.random.default_rng(seed)
    c = config
    twist_sigma = [c.speed_noise, c.speed_noise, c.turn_noise]
    report_sigma = [c.position_noise, c.position_noise, c.yaw_noise]
    truth = np.zeros((n, 6))
    truth[:, :3] = rng.uniform(-2, 2, (n, 3))
    truth[:, 3:] = rng.normal(size=(n, 3)) * [c.start_speed, c.start_speed, c.start_turn]
    f = PoseFilter(n, config)
    f.update(truth[:, :3] + rng.normal(size=(n, 3)) * report_sigma)
    for k in range(cycles):
        phase = k * T + np.arange(n)
        command = np.column_stack([1.5 * np.sin(2 * phase), np.cos(3 * phase), 4 * np.sin(phase)])
        missed = command + rng.normal(size=(n, 3)) * twist_sigma
        truth = np.array([integrate(truth[i], missed[i], 8) for i in range(n)])
        report = truth[:, :3] + rng.normal(size=(n, 3)) * report_sigma
        report[rng.random(n) < drop] = np.nan
        f.predict(command, T)
        f.update(report)
        yield truth, f, report


def test_the_filter_is_consistent():
    """Squared innovations have mean 3 and squared errors mean 6, in units of the covariance."""
    surprise, error = [], []
    for truth, f, _ in simulate(20, 250, 3):
        surprise.extend(f.surprise)
        e = np.column_stack(
            [
                truth[:, :2] - f.pose[:, :2],
                angle_difference(truth[:, 2], f.pose[:, 2]),
                truth[:, 3:] - f.twist,
            ]
        )
        error.extend(np.einsum("ni,nij,nj->n", e, np.linalg.inv(f.covariance), e))
    # 5000 draws: chi-squared with 3 degrees has deviation sqrt(6 / 5000) of its mean; errors are
    # correlated over some cycles, hence the wider band.
    assert np.mean(surprise) == pytest.approx(3.0, abs=4 * np.sqrt(6 / 5000))
    assert np.mean(error) == pytest.approx(6.0, abs=0.6)


def test_it_beats_the_reports_and_their_differences():
    pose, raw, speed, difference, last = [], [], [], [], None
    for k, (truth, f, report) in enumerate(simulate(10, 200, 4)):
        if k > 20:
            pose.append(f.pose[:, :2] - truth[:, :2])
            raw.append(report[:, :2] - truth[:, :2])
            c, s = np.cos(truth[:, 2]), np.sin(truth[:, 2])
            true = np.column_stack(
                [c * truth[:, 3] - s * truth[:, 4], s * truth[:, 3] + c * truth[:, 4]]
            )
            speed.append(f.velocity - true)
            difference.append((report[:, :2] - last) / T - true)
        last = report[:, :2]
    assert np.std(pose) < 0.7 * np.std(raw)
    assert np.std(speed) < 0.2 * np.std(difference)


def test_without_a_report_it_predicts_only():
    for k, (truth, f, report) in enumerate(simulate(6, 120, 5, drop=0.5)):
        missing = np.isnan(report[:, 0])
        np.testing.assert_array_equal(np.isnan(f.surprise), missing)
        if k > 20:
            assert np.linalg.norm(f.pose[:, :2] - truth[:, :2], axis=1).max() < 0.04
    before, P = f.pose, f.covariance
    f.update(np.full((6, 3), np.nan))
    np.testing.assert_array_equal(f.pose, before)
    np.testing.assert_array_equal(f.covariance, P)
    f.predict(np.zeros((6, 3)), T)
    assert (np.linalg.det(f.covariance[:, :3, :3]) > np.linalg.det(P[:, :3, :3])).all()


def test_yaw_innovations_are_wrapped():
    f = PoseFilter(1, PoseFilterConfig())
    f.update([[0.0, 0.0, np.pi - 0.01]])
    f.predict(np.zeros((1, 3)), T)
    f.update([[0.0, 0.0, -np.pi + 0.01]])
    assert abs(angle_difference(f.pose[0, 2], np.pi)) < 0.0101
    assert f.surprise[0] < 3.0
    assert abs(f.twist[0, 2]) < 5.0


def test_turning_on_it_keeps_yaw_wrapped_and_follows():
    for truth, f, _ in simulate(3, 300, 6):
        assert (np.abs(f.pose[:, 2]) <= np.pi).all()
        assert np.abs(angle_difference(f.pose[:, 2], truth[:, 2])).max() < 0.15


def test_robots_are_independent_of_each_other():
    rng = np.random.default_rng(7)
    together = PoseFilter(3, PoseFilterConfig())
    alone = [PoseFilter(1, PoseFilterConfig()) for _ in range(3)]
    for _ in range(20):
        z, u = rng.normal(size=(3, 3)), rng.normal(size=(3, 3))
        together.update(z)
        together.predict(u, T)
        for i in range(3):
            alone[i].update(z[i : i + 1])
            alone[i].predict(u[i : i + 1], T)
    np.testing.assert_array_equal(together.pose, np.concatenate([f.pose for f in alone]))
    np.testing.assert_array_equal(together.twist, np.concatenate([f.twist for f in alone]))


def test_it_is_nan_until_the_first_report():
    f = PoseFilter(2, PoseFilterConfig())
    f.predict(np.zeros((2, 3)), T)
    f.update([[1.0, 2.0, 0.5], [np.nan, np.nan, np.nan]])
    np.testing.assert_array_equal(f.pose[0], [1.0, 2.0, 0.5])
    np.testing.assert_array_equal(f.velocity[0], [0.0, 0.0])
    assert np.isnan(f.pose[1]).all()
    assert np.isnan(f.velocity[1]).all()


def test_world_velocity_is_the_twist_turned_by_yaw():
    f = PoseFilter(1, PoseFilterConfig(speed_noise=0.0))
    f.update([[0.0, 0.0, np.pi / 2]])
    f.predict([[1.0, 0.5, 0.0]], T)
    np.testing.assert_allclose(f.velocity, [[-0.5, 1.0]], atol=1e-12)


def test_what_is_handed_out_is_a_copy():
    f = PoseFilter(1, PoseFilterConfig())
    f.update([[0.1, 0.2, 0.3]])
    f.predict([[0.5, 0.0, 0.0]], T)
    f.update([[0.1, 0.2, 0.3]])
    for name in ("pose", "twist", "velocity", "covariance", "surprise"):
        before = getattr(f, name).copy()
        getattr(f, name)[:] = 99.0
        np.testing.assert_array_equal(getattr(f, name), before)


def test_errors():
    f = PoseFilter(2, PoseFilterConfig())
    with pytest.raises(InvalidInputError, match="command of robot 1"):
        f.predict([[0, 0, 0], [0, np.nan, 0]], T)
    with pytest.raises(InvalidInputError, match="report of robot 0"):
        f.update([[0, np.nan, 0], [0, 0, 0]])
    with pytest.raises(InvalidInputError, match=r"report has shape \(1, 3\)"):
        f.update([[0, 0, 0]])
    with pytest.raises(InvalidInputError, match="period"):
        f.predict(np.zeros((2, 3)), 0.0)
    with pytest.raises(InvalidInputError, match="n is 0"):
        PoseFilter(0, PoseFilterConfig())
    for name in ("position_noise", "speed_noise"):
        with pytest.raises(InvalidInputError, match=name):
            PoseFilterConfig(**{name: -1.0})
    with pytest.raises(InvalidInputError, match="yaw_noise"):
        PoseFilterConfig(yaw_noise=0.0)
