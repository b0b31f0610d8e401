import numpy as np
import pytest

from mjmr.errors import InvalidInputError
from mjmr.faults import Fault
from mjmr.sensors.localizer import Localizer
from tests.mjmr.worlds import BOTH, soccer


def follow(kind, sensor, seconds=2.0, read=lambda k: True, fault=None):
    """One robot speeds up at 3 m/s^2 to 0.5 m/s; returns (times, reports, sampled_at)."""
    world, robots = soccer([[-2.0, 0.0, 0.0]])
    robots.mount(sensor)
    if fault:
        robots.faults.add(fault)
    simulation = kind(world, seed=11)
    times, reports, stamps = [], [], []
    for k, t in enumerate(simulation.ticks(seconds)):
        robots.drive([[min(0.05 * (k + 1), 0.5), 0.0, 0.0]])
        if read(k):
            times.append(t)
            reports.append(robots.localizer.read()[0].copy())
            stamps.append(robots.localizer.sampled_at)
    return np.array(times), np.array(reports), np.array(stamps)


@pytest.mark.parametrize("kind", BOTH)
def test_a_slow_late_sensor_delivers_exactly_that(kind):
    """10 Hz, 100 ms late: nothing before 0.1 s, then the sample taken 100 to 200 ms ago."""
    times, reports, stamps = follow(kind, Localizer(rate=10.0, latency=0.1))
    early = times < 0.1 - 1e-9
    assert np.isnan(reports[early]).all()
    assert np.isnan(stamps[early]).all()
    age = (times - stamps)[~early]
    assert age.min() == pytest.approx(0.1, abs=1e-9)
    assert age.max() == pytest.approx(0.2 - 1 / 60, abs=1e-9)
    np.testing.assert_allclose(np.round(stamps[~early] * 10) / 10, stamps[~early], atol=1e-9)
    # the robot is at -2 + 0.5 (t - 1/12) once it has sped up, for 1/6 s
    steady = stamps > 0.2
    expected = -2.0 + 0.5 * (stamps[steady] - 1 / 12)
    np.testing.assert_allclose(reports[steady, 0], expected, atol=5e-5)


@pytest.mark.parametrize("kind", BOTH)
def test_a_sensor_is_sampled_between_ticks_at_its_own_instants(kind):
    """50 Hz under a 60 Hz loop: samples on the first physics step at or after k / 50 s."""
    _, reports, stamps = follow(kind, Localizer(rate=50.0))
    unique = np.unique(stamps)
    due = np.arange(len(unique)) / 50
    assert (unique - due).min() > -1e-9
    assert (unique - due).max() < 1 / 240
    steady = stamps > 0.2
    np.testing.assert_allclose(
        reports[steady, 0], -2.0 + 0.5 * (stamps[steady] - 1 / 12), atol=5e-5
    )


@pytest.mark.parametrize("kind", BOTH)
def test_who_reads_and_how_often_changes_nothing(kind):
    def sensor():
        return Localizer(rate=60.0, position_noise=0.004, yaw_noise=0.01, loss=0.1)

    _, every, _ = follow(kind, sensor())
    _, some, _ = follow(kind, sensor(), read=lambda k: k % 7 == 3)
    assert every[3::7].tobytes() == some.tobytes()


def test_noise_and_loss_have_the_stated_size():
    world, robots = soccer([[-1.0, y, 0.0] for y in np.linspace(-1.8, 1.8, 10)])
    robots.mount(Localizer(rate=60.0, position_noise=0.004, yaw_noise=0.02, loss=0.2))
    simulation = BOTH[1](world, seed=2)
    reports = np.array([robots.localizer.read().copy() for _ in simulation.ticks(200.0)])
    error = reports - robots.start
    lost = np.isnan(error).all(axis=2)
    assert (np.isnan(error).any(axis=2) == lost).all()
    assert lost.mean() == pytest.approx(0.2, abs=0.005)
    found = error[~lost]
    np.testing.assert_allclose(found.std(axis=0), [0.004, 0.004, 0.02], rtol=0.02)
    assert np.abs(found.mean(axis=0) / [0.004, 0.004, 0.02]).max() < 0.02
    assert abs(np.corrcoef(found.T) - np.eye(3)).max() < 0.02


def test_drift_has_its_size_and_its_time_and_leaves_the_rest_alone():
    def reports(seconds, **options):
        world, robots = soccer([[-1.0, y, 0.0] for y in np.linspace(-1.8, 1.8, 10)])
        robots.mount(Localizer(rate=20.0, position_noise=0.004, loss=0.1, **options))
        simulation = BOTH[1](world, seed=2, control_period=0.05)
        return np.array([robots.localizer.read().copy() for _ in simulation.ticks(seconds)])

    plain, drifting = reports(600.0), reports(600.0, drift=0.5, drift_time=2.0)
    np.testing.assert_array_equal(np.isnan(plain), np.isnan(drifting))
    np.testing.assert_array_equal(plain[..., 2], drifting[..., 2])
    drift = (drifting - plain)[..., :2]
    kept = ~np.isnan(drift)
    assert drift[kept].std() == pytest.approx(0.5, rel=0.05)
    lag = 40  # 2 s: 1/e is left
    assert np.nanmean(drift[lag:] * drift[:-lag]) / 0.25 == pytest.approx(np.exp(-1), abs=0.06)
    assert np.nanmax(np.abs(np.diff(drift, axis=0))) < 0.5 * (1 - np.exp(-0.05)) ** 0.5 * 8
    across = np.nanmean(drift[..., 0] * drift[..., 1]) / 0.25
    assert abs(across) < 0.06, "x and y wander by themselves"


def test_drift_depends_on_the_sample_number_alone():
    from mjmr.randomness import Drift, Streams

    def drift():
        return Drift(Streams(3).sequence("x"), (2, 2), 0.9)

    every, picked = drift(), drift()
    wanted = np.array([every.sample(k).copy() for k in range(400)])
    for k in (5, 399, 64, 63, 200, 0, 320, 321, 128):
        np.testing.assert_array_equal(picked.sample(k), wanted[k])
    more = Drift(Streams(3).sequence("x"), (3, 2), 0.9)
    np.testing.assert_array_equal(more.sample(70)[:2], wanted[70]), "rows have their own numbers"


@pytest.mark.parametrize("kind", BOTH)
def test_a_reports_lost_fault_hides_the_robot(kind):
    fault = Fault(kind="reports-lost", robot=0, start=0.5, end=1.0)
    times, reports, _ = follow(kind, Localizer(rate=60.0), fault=fault)
    hidden = np.isnan(reports[:, 0])
    np.testing.assert_array_equal(hidden, (times > 0.5 - 1e-6) & (times < 1.0 - 1e-6))


def test_reports_are_read_only_and_need_a_simulation():
    world, robots = soccer([[-2.0, 0.0, 0.0]])
    with pytest.raises(InvalidInputError, match="simulation"):
        robots.localizer.read()
    BOTH[1](world)
    report = robots.localizer.read()
    with pytest.raises(ValueError, match="read-only"):
        report[0, 0] = 1.0


@pytest.mark.parametrize(
    "options",
    [
        {"rate": 0.0},
        {"rate": -1.0},
        {"rate": np.inf},
        {"latency": -0.1},
        {"position_noise": -1.0},
        {"loss": 1.5},
        {"phase": np.nan},
        {"drift": -1.0},
        {"drift_time": 0.0},
    ],
)
def test_bad_sensor_options_are_refused(options):
    with pytest.raises(InvalidInputError):
        Localizer(**options)


@pytest.mark.parametrize("kind", BOTH)
def test_a_sensor_faster_than_the_physics_is_refused(kind):
    """It would take fewer samples than it says; as often as the physics steps is possible."""
    for rate in (240.0, 250.0):
        world, robots = soccer([[0.0, 0.0, 0.0]])
        robots.mount(Localizer(rate=rate))
        if rate > 240.0:
            with pytest.raises(InvalidInputError, match="timesteps of at most 0.004 s"):
                kind(world)
        else:
            for _ in kind(world, dt_max=1 / 240).ticks(0.5):
                pass
            assert robots.localizer.sampled_at == pytest.approx(0.5)


@pytest.mark.parametrize("options", [{"latency": np.inf}, {"phase": np.inf}, {"phase": np.nan}])
def test_a_schedule_that_never_comes_is_refused(options):
    with pytest.raises(InvalidInputError, match="finite"):
        Localizer(**options)
