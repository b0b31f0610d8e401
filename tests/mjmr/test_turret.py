"""The turret: round and round by the shorter way at a limited rate, alike in both simulations."""

import numpy as np
import pytest

from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.recording import Recording
from mjmr.robots.pioneer2dx import Pioneer2DX
from mjmr.robots.round_pusher import RoundPusher
from mjmr.sensors.camera import Camera
from mjmr.sensors.turret import Turret
from mjmr.simulation import Simulation
from mjmr.world import World
from tests.mjmr.worlds import BOTH

PERIOD = 0.1


def hall(kind=Simulation, poses=((-1.0, 0.0, 0.5), (1.0, 0.0, 2.0)), dt_max=0.01):
    """Round pushers; returns (robots, simulation)."""
    world = World(bounds=[-3, -3, 3, 3])
    robots = world.add_group(RoundPusher, poses)
    return robots, kind(world, control_period=PERIOD, dt_max=dt_max)


def follow(robots, simulation, aims, each=20):
    """Aim at each of ``aims`` in turn; true angles (k, n), turns counted, at control instants."""
    seen, turret = [], robots.turret
    simulation.observe(lambda: seen.append(turret.observe(simulation.time).copy()))
    for aim in aims:
        for _ in simulation.ticks(each * PERIOD):
            turret.aim(aim)
    return np.array(seen)


@pytest.mark.parametrize("dt_max", [0.01, 0.005])
@pytest.mark.parametrize("kind", BOTH)
def test_it_gets_there_no_faster_than_it_can_and_stays(kind, dt_max):
    robots, simulation = hall(kind, dt_max=dt_max)
    seen = follow(robots, simulation, [[2.0, -1.0]])
    assert robots.turret.top_rate == pytest.approx(np.pi)
    rates = np.abs(np.diff(seen, axis=0)) / PERIOD
    assert rates.max() < np.pi * (1.0 if kind is not Simulation else 1.02) + 1e-9
    assert rates.max() > 0.95 * np.pi
    # 2 rad take 0.64 s, and the servo some 0.1 s more
    np.testing.assert_allclose(seen[9:], np.tile([2.0, -1.0], (12, 1)), atol=2e-3)
    np.testing.assert_allclose(robots.turret.read(), [2.0, -1.0], atol=np.radians(0.06))


@pytest.mark.parametrize("kind", BOTH)
def test_it_goes_by_the_shorter_way_round_and_round(kind):
    robots, simulation = hall(kind)
    seen = follow(robots, simulation, [2.0, -2.5, -0.5, 1.5, 3.0, -2.0])
    assert (np.diff(seen, axis=0) > -1e-3).all()
    assert seen[-1, 0] == pytest.approx(4 * np.pi - 2.0, abs=2e-3)
    assert robots.turret.read()[0] == pytest.approx(-2.0, abs=2e-3)
    low, high = robots.turret.reading_bounds
    assert low < -np.pi < np.pi < high


def test_the_picture_turns_with_it():
    """A disc at 90 degrees is in the middle of the picture when the turret looks there."""
    world = World(bounds=[-3, -3, 3, 3])
    world.add_disc(0.0, 1.2, 0.15, 5.0)
    robots = world.add_group(RoundPusher, [[0.0, 0.0, 0.0]])
    camera = robots.mount(Camera(at="camera", width=160, height=120, rate=10.0,
                                 modality="segmentation"))  # fmt: skip
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
    disc = camera.label_names.index("disc0")
    for aim, where in ((0.0, None), (np.pi / 2, 79.5), (np.pi / 2 - 0.5, 79.5 - 80 * np.tan(0.5))):
        for _ in simulation.ticks(1.5):
            robots.turret.aim(aim)
        columns = np.flatnonzero((camera.read()[0] == disc).any(axis=0))
        if where is None:
            assert not len(columns)
        else:
            assert columns.mean() == pytest.approx(where, abs=1.5)
    own = camera.label_names.index("round_pusher0")
    # the horizon is free: it sees its own skirt alone, below
    assert not (camera.read()[0][:90] == own).any()
    assert (camera.read()[0][119] == own).any()


@pytest.mark.parametrize("kind", BOTH)
def test_films_have_it_where_it_was(kind):
    robots, simulation = hall(kind)
    recording = Recording(simulation)
    seen = follow(robots, simulation, [[2.0, -1.0]])
    footage = recording.footage()
    joints = [footage.model.joint(f"{p}pan").qposadr[0] for p in robots.prefixes]
    np.testing.assert_allclose(footage.positions[:, joints], seen, atol=1e-9)


@pytest.mark.parametrize("kind", BOTH)
def test_a_snapshot_goes_on_with_the_same_bits(kind):
    robots, simulation = hall(kind)

    def go(aim):
        for _ in simulation.ticks(0.5):
            robots.turret.aim(aim)
        return robots.turret.read().tobytes(), robots.turret.observe(simulation.time).tobytes()

    go(1.0)
    snapshot = simulation.snapshot()
    once = go(3.0)
    simulation.restore(snapshot)
    assert robots.turret.aimed == pytest.approx(1.0)
    assert go(3.0) == once


def test_what_it_refuses():
    with pytest.raises(InvalidInputError, match="step must lie between"):
        Turret(step=0.0)
    with pytest.raises(InvalidInputError, match="once its group is in a simulation"):
        Turret().aim(0.0)
    robots, _ = hall()
    with pytest.raises(InvalidInputError, match=r"shape \(2,\).*got \(3,\)"):
        robots.turret.aim([0.0, 0.0, 0.0])
    with pytest.raises(InvalidInputError, match="round_pusher1"):
        robots.turret.aim([0.0, np.nan])
    world = World(bounds=[-3, -3, 3, 3])
    world.add_group(Pioneer2DX, [[0.0, 0.0, 0.0]]).mount(Turret())
    with pytest.raises(UnknownNameError, match="joint of the robot's model 'pan'.*wheel_left"):
        world.spec()
