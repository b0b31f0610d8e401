"""Lifting robots by hand: an operator's act, of which no controller is capable."""

import numpy as np
import pytest

from controllers.legged.ers7_gaits import ERS7_TROT
from controllers.legged.motion import AiboMotion
from mjmr import replay
from mjmr.errors import InvalidInputError, LiftError
from mjmr.geometry import Pinhole, look_at
from mjmr.overlay import draw_trails
from mjmr.robots.aibo_ers7 import AiboERS7
from mjmr.robots.koala import Koala
from mjmr.robots.nims import Nims
from mjmr.robots.pioneer2dx import Pioneer2DX
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.robots.tamiya_txt1 import TamiyaTXT1
from mjmr.robots.tj_pro import TJPro
from mjmr.sensors.bumper import Bumper
from mjmr.sensors.compass import Compass
from mjmr.sensors.encoders import WheelEncoders
from mjmr.simulation import Simulation
from mjmr.trace import Trace
from mjmr.world import World
from tests.mjmr.worlds import BOTH

PERIOD = 0.1
POSES = [[-1.5, -1.0, 0.0], [-1.5, 0.0, 0.5], [-1.5, 1.0, -0.5]]
COMMAND = np.array([[0.15, 0.0], [0.14, 0.4], [0.1, -0.8]])


def build(kind=Simulation, platform=TJPro, poses=POSES, **options):
    world = World(bounds=[-3, -3, 3, 3], wall_height=0.3)
    world.add_box(2.0, 2.0, 0.4, 0.4)
    robots = world.add_group(platform, poses, **options)
    return kind(world, seed=3, control_period=PERIOD, dt_max=0.01), robots


def go(simulation, robots, seconds, command=COMMAND):
    """Drive; true poses after every period (k, n, 3)."""
    seen = []
    for _ in simulation.ticks(seconds):
        seen.append(simulation.poses_of(robots))
        robots.drive(command)
    return np.array([*seen[1:], simulation.truth.poses(robots)])


@pytest.mark.parametrize("kind", BOTH)
def test_who_is_lifted_is_at_rest_elsewhere_and_nobody_else_notices(kind):
    one, robots = build(kind)
    two, others = build(kind)
    go(one, robots, 1.0)
    go(two, others, 1.0)
    one.lift(robots, [2, 0], [[1.0, -2.0, 2.5], [1.0, 2.0, -3.0]])
    now = one.truth.poses(robots)
    np.testing.assert_allclose(now[[2, 0]], [[1.0, -2.0, 2.5], [1.0, 2.0, -3.0]], atol=1e-9)
    assert np.abs(one.truth.twists(robots)[[0, 2]]).max() < 1e-12
    np.testing.assert_array_equal(now[1], two.truth.poses(others)[1])
    assert not robots.command[[0, 2]].any()
    assert not robots.executed[[0, 2]].any()
    np.testing.assert_array_equal(robots.executed[1], COMMAND[1])
    still = [[0.0, 0.0], COMMAND[1], [0.0, 0.0]]
    after, before = go(one, robots, 1.0, still), go(two, others, 1.0)
    np.testing.assert_allclose(after[:, 1], before[:, 1], atol=1e-9)
    np.testing.assert_allclose(after[:, [0, 2]], now[[0, 2]][None].repeat(10, 0), atol=1e-6)


@pytest.mark.parametrize("kind", BOTH)
def test_it_drives_on_from_there_as_a_fresh_one(kind):
    simulation, robots = build(kind)
    go(simulation, robots, 1.0)
    simulation.lift(robots, [0], [[0.5, -1.5, 0.0]])
    lifted = go(simulation, robots, 1.5)[:, 0]
    fresh, others = build(kind, poses=[[0.5, -1.5, 0.0]])
    expected = go(fresh, others, 1.5, COMMAND[:1])[:, 0]
    np.testing.assert_allclose(lifted, expected, atol=2e-5)


@pytest.mark.parametrize("kind", BOTH)
def test_a_controller_cannot_lift(kind):
    simulation, robots = build(kind)
    for _ in simulation.ticks(0.2):
        with pytest.raises(LiftError, match="lift them in an observer, or between"):
            simulation.lift(robots, [0], [[0.0, 0.0, 0.0]])
    np.testing.assert_allclose(simulation.truth.poses(robots), POSES, atol=1e-6)


@pytest.mark.parametrize("kind", BOTH)
def test_an_operator_lifts_as_an_observer_and_a_snapshot_goes_on(kind):
    """The same bits from a restored state on, lifts included, and in a fresh run."""

    def run():
        world = World(bounds=[-3, -3, 3, 3], wall_height=0.3)
        robots = world.add_group(TJPro, POSES)
        robots.mount(Compass(rate=10.0, noise=0.01))
        simulation = kind(world, seed=3, control_period=PERIOD, dt_max=0.01)
        lifts = []
        simulation.lift_followers.append(lambda rows, poses: lifts.append(simulation.time))

        def operator():
            for row in np.flatnonzero(simulation.truth.poses(robots)[:, 0] > -1.4):
                simulation.lift(robots, [row], [[-1.5, robots.start[row, 1], 0.1 * row]])

        simulation.observe(operator)
        return simulation, robots, lifts

    simulation, robots, lifts = run()
    first = go(simulation, robots, 2.0)
    snapshot = simulation.snapshot()
    once, read = go(simulation, robots, 2.0), robots.compass.read().copy()
    assert len(lifts) >= 4
    simulation.restore(snapshot)
    np.random.seed(7)  # noqa: NPY002 - nothing may depend on the global state
    assert go(simulation, robots, 2.0).tobytes() == once.tobytes()
    assert robots.compass.read().tobytes() == read.tobytes()
    other, again, _ = run()
    assert go(other, again, 2.0).tobytes() == first.tobytes()


def test_a_snapshot_right_after_a_lift_goes_on_with_the_same_bits():
    """The warm start of the solver is part of it: robots that touch, one lifted to them."""
    simulation, robots = build(poses=[[0.0, 0.0, 0.0], [0.181, 0.0, 0.0], [-1.5, 1.0, -0.5]])
    push = np.full((3, 2), [0.15, 0.2])
    go(simulation, robots, 1.0, push)
    x, y, _ = simulation.truth.poses(robots)[1]
    simulation.lift(robots, [2], [[x + 0.181, y, 1.0]])
    snapshot = simulation.snapshot()
    once = go(simulation, robots, 1.0, push)
    simulation.restore(snapshot)
    assert go(simulation, robots, 1.0, push).tobytes() == once.tobytes()


def test_a_lift_that_is_refused_moves_nothing():
    one, robots = build()
    two, others = build()
    go(one, robots, 1.0)
    go(two, others, 1.0)
    x, y, _ = one.truth.poses(robots)[1]
    for poses, words in (
        ([[x + 0.1, y, 0.0]], r"put down where there is room; tj_pro0 and tj_pro1 by \d+ mm"),
        ([[2.0, 1.8, 0.0]], "put down where there is room; box0 and tj_pro0 by"),
        ([[2.95, 0.0, 0.0]], "are put down outside the walls or touch them: tj_pro0 by 40 mm"),
        ([[0.0, 0.0]], r"shape \(1, 3\) and is finite; got shape \(1, 2\)"),
        ([[0.0, np.nan, 0.0]], "is finite"),
    ):
        with pytest.raises(InvalidInputError, match=words):
            one.lift(robots, [0], poses)
    for rows, words in (
        ([3], "distinct indices from 0 to 2; got \\[3\\]"),
        ([1, 1], "distinct indices"),
        ([-1], "distinct indices"),
        ([0.5], "a list of their indices"),
        ([True, False], "a list of their indices"),
    ):
        with pytest.raises(InvalidInputError, match=words):
            one.lift(robots, rows, np.zeros((len(rows), 3)))
    one.lift(robots, [], np.empty((0, 3)))
    assert go(one, robots, 1.0).tobytes() == go(two, others, 1.0).tobytes()


def test_where_overlap_is_allowed_it_is_allowed_here():
    world = World(bounds=[-3, -3, 3, 3], overlap=True)
    robots = world.add_group(TJPro, POSES)
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
    simulation.lift(robots, [0], [[-1.42, 0.0, 0.0]])
    go(simulation, robots, 1.0, np.zeros((3, 2)))
    poses = simulation.truth.poses(robots)
    assert np.hypot(*(poses[0] - poses[1])[:2]) > 0.17


def test_wheels_keep_what_encoders_count():
    world = World(bounds=[-3, -3, 3, 3])
    robots = world.add_group(TJPro, POSES)
    encoders = robots.mount(WheelEncoders(rate=10.0, counts_per_turn=1000.0))
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
    go(simulation, robots, 2.0)
    before = encoders.read()[0].copy()
    simulation.lift(robots, [0], [[1.0, 1.0, 1.0]])
    go(simulation, robots, 0.3, np.zeros((3, 2)))
    assert before.min() > 500
    assert np.abs(encoders.read()[0] - before).max() < 60, "but for the last period before"


@pytest.mark.parametrize("platform", [SoccerBot, SoccerBot("omni"), Pioneer2DX, TamiyaTXT1])
def test_other_platforms_are_put_down_at_rest(platform):
    simulation, robots = build(platform=platform, poses=[[-1.5, -1.5, 0.3], [-1.0, 1.0, 0.0]])
    command = np.zeros((2, len(robots.platform.command_names)))
    command[:, 0] = 0.4
    go(simulation, robots, 1.0, command)
    simulation.lift(robots, [1], [[1.0, -1.0, 2.0]])
    seen = go(simulation, robots, 1.0, np.zeros_like(command))
    # a rover on springs settles within a millimetre
    np.testing.assert_allclose(seen[:, 1], np.tile([1.0, -1.0, 2.0], (10, 1)), atol=2e-3)
    assert seen[0, 0, 0] > -1.3


@pytest.mark.parametrize(
    ("platform", "words"),
    [
        (Koala, "koala: robots whose firmware runs at a rate of its own cannot be lifted"),
        (AiboERS7(AiboMotion(ERS7_TROT)), "aibo_ers7: robots whose firmware"),
        (Nims, "nims: a rig stands where its world was built"),
    ],
)
def test_robots_that_cannot_be_lifted_say_so(platform, words):
    world = World(bounds=[-15, -15, 15, 15])
    robots = world.add_group(platform, [[0.0, 0.0, 0.0]])
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.004)
    with pytest.raises(InvalidInputError, match=words):
        simulation.lift(robots, [0], [[1.0, 1.0, 0.0]])


def test_what_was_commanded_with_latency_is_forgotten_too():
    simulation, robots = build(command_latency=3)
    go(simulation, robots, 1.0)
    simulation.lift(robots, [0], [[1.0, -2.0, 0.0]])
    seen = go(simulation, robots, 0.3, np.zeros((3, 2)))
    np.testing.assert_allclose(seen[:, 0], np.tile([1.0, -2.0, 0.0], (3, 1)), atol=1e-6)
    assert seen[-1, 1, 0] > seen[0, 1, 0] + 0.015, "the others' are still on their way"


def test_a_lifted_robot_feels_nothing_of_the_wall_it_left():
    world = World(bounds=[-3, -3, 3, 3], wall_height=0.3)
    robots = world.add_group(TJPro, [[2.89, 0.0, 0.0]])
    bumper = robots.mount(Bumper(sectors=6, threshold=0.5, rate=10.0, latch=False))
    simulation = Simulation(world, control_period=PERIOD, dt_max=0.01)
    go(simulation, robots, 1.0, [[0.15, 0.0]])
    assert bumper.read()[0, 0]
    simulation.lift(robots, [0], [[0.0, 0.0, 0.0]])
    go(simulation, robots, 0.1, [[0.0, 0.0]])
    assert not bumper.read().any()


@pytest.mark.parametrize("kind", BOTH)
def test_traces_have_every_lift(kind, tmp_path):
    simulation, robots = build(kind)
    trace = Trace(simulation)
    go(simulation, robots, 0.5)
    simulation.lift(robots, [2, 0], [[1.0, -2.0, 2.5], [1.0, 2.0, -3.0]])
    go(simulation, robots, 0.5)
    simulation.lift(robots, [1], [[1.0, 0.0, 0.0]])
    go(simulation, robots, 0.2)
    trace.save(tmp_path / "a.npz", {})
    with np.load(tmp_path / "a.npz") as found:
        np.testing.assert_allclose(found["lift_times"], [0.5, 0.5, 1.0])
        np.testing.assert_array_equal(found["lift_robots"], [2, 0, 1])
        np.testing.assert_allclose(
            found["lift_poses"], [[1.0, -2.0, 2.5], [1.0, 2.0, -3.0], [1.0, 0.0, 0.0]]
        )
    parquet = pytest.importorskip("pyarrow.parquet")
    trace.save(tmp_path / "a.parquet", {})
    rows = parquet.read_table(tmp_path / "a.parquet", filters=[("kind", "==", "lift")])
    assert rows["robot"].to_pylist()[::3] == ["tj_pro2", "tj_pro0", "tj_pro1"]
    assert rows["value"].to_pylist()[:3] == [1.0, -2.0, 2.5]


@pytest.mark.parametrize("kind", BOTH)
@pytest.mark.parametrize("observed", [False, True])
def test_films_know_who_was_lifted_when(kind, observed, tmp_path):
    """Lifted between two runs of ticks, and in an observer before or after the recording's."""
    simulation, robots = build(kind)
    to = [[1.0, -2.0, 2.5]]
    if observed:
        simulation.observe(
            lambda: simulation.lift(robots, [2], to) if simulation.step == 50 else None
        )
    trace = Trace(simulation)
    go(simulation, robots, 0.5)
    if not observed:
        simulation.lift(robots, [2], to)
    go(simulation, robots, 0.5)
    footage = trace.recording.footage()
    # in the picture of 0.5 s it stands here or there
    first = int(np.argmax(footage.poses[:, 2, 0] > 0.5))
    assert first == (5 if observed else 6)
    assert footage.lifts is not None
    np.testing.assert_array_equal(footage.lifts[:, 2], np.arange(11) >= first)
    assert not footage.lifts[:, :2].any()
    trace.save(tmp_path / "a.npz", {"study": "none", "condition": {}, "seed": 0})
    again = replay.load(tmp_path / "a.npz").footage
    np.testing.assert_array_equal(again.lifts, footage.lifts)


def test_a_trail_is_cut_where_the_robot_was_picked_up():
    view = Pinhole(np.array([0.0, 0.0, 10.0]), look_at([0, 0, 10.0], [0, 0, 0.0]), 100.0, 100, 100)
    x = np.array([-3.0, -2.0, 2.0, 3.0])
    track = np.stack([x, np.zeros(4)], axis=1)[:, None]
    whole, cut = (np.zeros((100, 100, 3), dtype=np.uint8) for _ in range(2))
    draw_trails(whole, view, track, [(255, 255, 255)])
    draw_trails(cut, view, track, [(255, 255, 255)], np.array([[0], [0], [1], [1]]))
    for picture, middle in ((whole, True), (cut, False)):
        assert picture[:, 22:28].any()
        assert picture[:, 72:78].any()
        assert picture[:, 40:60].any() == middle
