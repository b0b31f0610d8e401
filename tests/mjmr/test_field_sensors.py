"""Compass errors by time and by place, and the detector of floor patches."""

import numpy as np
import pytest

from mjmr.errors import InvalidInputError
from mjmr.geometry import angle_difference
from mjmr.kinematics import KinematicSimulation
from mjmr.randomness import SampleNoise, Streams
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.robots.tj_pro import TJPro
from mjmr.sensors.ambient_field import AmbientField
from mjmr.sensors.compass import Compass
from mjmr.sensors.floor_patch import FloorPatch
from mjmr.world import World
from tests.mjmr.worlds import BOTH

DEG = np.radians(1.0)


def errors_of(n=400, seconds=60.0, seed=5, **options):
    """Errors of standing robots' compasses (k, n) [rad]."""
    yaws = np.linspace(-3.1, 3.1, n)
    world = World(bounds=[-80, -8, 80, 8])
    poses = np.column_stack([np.linspace(-70, 70, n), np.linspace(-7, 7, n), yaws])
    robots = world.add_group(SoccerBot, poses)
    robots.mount(Compass(rate=10.0, **options))
    simulation = KinematicSimulation(world, seed=seed, control_period=0.1, dt_max=0.0125)
    found = [robots.compass.read().copy() for _ in simulation.ticks(seconds)]
    return angle_difference(np.array(found), yaws)


def test_drift_has_its_size_and_its_time():
    errors = errors_of(drift=DEG, drift_time=2.0, seconds=40.0)
    assert errors.std() == pytest.approx(DEG, rel=0.05)
    for lag, kept in ((1, np.exp(-0.05)), (20, np.exp(-1.0)), (100, np.exp(-5.0))):
        correlation = (errors[lag:] * errors[:-lag]).mean() / DEG**2
        assert correlation == pytest.approx(kept, abs=0.06)
    between = np.corrcoef(errors[:, ::40].T)
    off = between[~np.eye(len(between), dtype=bool)]
    assert abs(off.mean()) < 0.08, "each robot's by itself"


def test_the_field_is_bounded_smooth_and_the_rooms_own():
    errors = errors_of(place_bias=5 * DEG, seconds=1.0)
    assert np.ptp(errors, axis=0).max() < 1e-12, "it does not change with time"
    room = AmbientField(Streams(5).generator("ambient field"), 5 * DEG, 2.0)
    places = np.random.default_rng(0).uniform(-40, 40, (20000, 2))
    field = room.at(places)
    assert 4.5 * DEG < np.abs(field).max() <= 5 * DEG
    assert field.std() == pytest.approx(5 * DEG / np.sqrt(6), rel=0.05)
    assert abs(field.mean()) < 0.1 * DEG
    # 10 cm further on it is all but the same: the shortest wave has 1 m
    step = room.at(places + [0.1, 0.0]) - field
    assert np.abs(step).max() <= 5 * DEG * 2 * np.pi * 0.1 / 1.0
    # along the diagonal the robots stand on
    diagonal = np.column_stack([np.linspace(-70, 70, 400), np.linspace(-7, 7, 400)])
    np.testing.assert_allclose(errors[0], room.at(diagonal), atol=1e-12)


def test_every_compass_of_a_room_is_bent_alike_and_another_seed_is_another_room():
    found = []
    for seed in (1, 2):
        world = World(bounds=[-4, -4, 4, 4])
        groups = [
            world.add_group(kind, [[x, 1.0, 0.3]]) for kind, x in ((SoccerBot, 1), (TJPro, 2))
        ]
        for group in groups:
            group.mount(Compass(rate=10.0, place_bias=5 * DEG))
        simulation = KinematicSimulation(world, seed=seed, control_period=0.1)
        for _ in simulation.ticks(0.1):
            pass
        room = AmbientField(simulation.rng("ambient field"), 5 * DEG, 2.0)
        expected = room.at(np.array([[1.0, 1.0], [2.0, 1.0]]))
        read = np.array([group.compass.read()[0] for group in groups]) - 0.3
        np.testing.assert_allclose(read, expected, atol=1e-12)
        found.append(read)
    assert np.abs(found[0] - found[1]).max() > 0.1 * DEG


def test_without_the_new_errors_a_compass_reads_the_bits_it_did():
    """Noise and biases come from the first two children of the sensor's stream, as ever."""
    options = {"noise": 0.03, "bias": 0.1}
    errors = errors_of(n=5, seconds=2.0, seed=9, **options)
    noise, bias = Streams(9).sequence("soccer_bot/compass").spawn(2)
    drawn = SampleNoise(noise, (5,), "normal")
    stays = 0.1 * SampleNoise(bias, (5,), "normal").sample(0)
    expected = np.array([stays + 0.03 * drawn.sample(k) for k in range(len(errors))])
    np.testing.assert_allclose(errors, expected, atol=1e-12)
    # and what is added changes neither
    more = errors_of(n=5, seconds=2.0, seed=9, drift=0.02, **options)
    alone = errors_of(n=5, seconds=2.0, seed=9, drift=0.02)
    np.testing.assert_allclose(more, expected + alone, atol=1e-12)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"drift": -0.1}, "drift must be 0 or more"),
        ({"place_bias": np.inf}, "place_bias must be 0 or more and finite"),
        ({"drift_time": 0.0}, "drift_time must be positive and finite; got 0.0 s"),
        ({"place_scale": np.nan}, "place_scale must be positive and finite; got nan m"),
    ],
)
def test_bad_compass_errors_are_refused(options, words):
    with pytest.raises(InvalidInputError, match=words):
        Compass(**options)


@pytest.mark.parametrize("kind", BOTH)
def test_a_patch_is_seen_from_where_it_is(kind):
    poses = [[0.0, 0.0, 0.0], [1.149, 0.0, 0.0], [1.151, 1.0, 0.0], [1.0, -1.25, np.pi / 2]]
    world = World(bounds=[-3, -3, 3, 3])
    robots = world.add_group(TJPro, poses)
    patches = [[1.0, 0.0, 0.15], [1.0, 1.0, 0.15], [1.0, -1.0, 0.15]]
    below = robots.mount(FloorPatch(patches))
    before = robots.mount(FloorPatch(patches, ahead=0.15), "before")
    simulation = kind(world, control_period=0.1, dt_max=0.01)
    assert not below.read().any()
    for _ in simulation.ticks(0.1):
        pass
    np.testing.assert_array_equal(
        below.read(), np.array([[0, 0, 0], [1, 0, 0], [0, 0, 0], [0, 0, 0]], dtype=bool)
    )
    np.testing.assert_array_equal(before.read()[3], [False, False, True])
    assert not before.read()[1].any()


def test_a_robot_finds_a_patch_when_it_gets_there():
    world = World(bounds=[-3, -3, 3, 3])
    robots = world.add_group(TJPro, [[0.0, 0.0, 0.0]])
    patch = robots.mount(FloorPatch([[1.0, 0.0, 0.15]], rate=10.0))
    simulation = KinematicSimulation(world, control_period=0.1)
    for t in simulation.ticks(12.0):
        robots.drive([[0.1, 0.0]])
        if patch.read().any():
            # 0.85 m, half a ramp of 0.1 s later
            assert t == pytest.approx(8.5 + 0.05, abs=0.1)
            break
    else:
        pytest.fail("it was never found")


@pytest.mark.parametrize(
    ("patches", "words"),
    [
        ([[0.0, 0.0]], r"shape \(k, 3\): x, y, radius; got \(1, 2\)"),
        ([], r"shape \(k, 3\)"),
        ([[0.0, np.nan, 1.0]], "must be finite"),
        ([[0.0, 0.0, 0.0]], "radius must be positive; got 0.0"),
    ],
)
def test_bad_patches_are_refused(patches, words):
    with pytest.raises(InvalidInputError, match=words):
        FloorPatch(patches)
