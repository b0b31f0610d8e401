"""The planar field: blocked and sliding discs, detectors, compass; and the run in it."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from controllers.scouting import LOOP, UNIT, Behaviour, ScoutTeam
from experiments.scout_workers.bug2 import bug2
from experiments.scout_workers.bug2 import of_maze as bug2_of
from experiments.scout_workers.field import EXACT, CompassErrors, Setting
from experiments.scout_workers.mazes import REACH, maze
from experiments.scout_workers.planar import PlanarField
from experiments.scout_workers.run import WORKER_LIMIT, Plan, run
from experiments.scout_workers.shortest import of_maze, shortest
from mjmr.byte_channel import ByteTiming
from mjmr.errors import InvalidInputError
from mjmr.randomness import Streams
from mjmr.robots.tj_pro import TJPro

OPEN = {"size": 2.5, "blocks": np.empty((0, 4)), "nest": [1.25, 1.25], "goal": [2.2, 2.2]}
V = UNIT / LOOP
RADIUS, TRACK, TRIP = TJPro.radius, TJPro.track, TJPro.trip


def field(poses, seed=1000, **options):
    chosen = {"compass": EXACT, "servo_spread": 0.0} | OPEN | options
    f = PlanarField(Setting(n=len(poses), seed=seed, **chosen))
    f.pose[:] = poses
    f.present[:] = True
    return f


def test_a_setting_that_cannot_be_is_refused():
    with pytest.raises(InvalidInputError, match="a spread of servos' speeds is 0 to below 1"):
        field([[1.0, 1.0, 0.0]], servo_spread=1.5)
    with pytest.raises(InvalidInputError, match=r"blind are 1 flags; got shape \(2,\)"):
        field([[1.0, 1.0, 0.0]], blind=[True, False])


def test_a_unit_forward_is_three_inches_and_turns_stay_in_place():
    f = field([[1.0, 1.0, 0.3]])
    f.advance(np.array([[V, 0.0]]))
    np.testing.assert_allclose(
        f.pose[0], [1 + UNIT * math.cos(0.3), 1 + UNIT * math.sin(0.3), 0.3], atol=1e-12
    )
    f.advance(np.array([[0.0, 2.0]]))
    np.testing.assert_allclose(f.pose[0, 2], 1.3, atol=1e-12)
    f.advance(np.array([[-V, 0.0]]))
    assert f.tally().way[0] == pytest.approx(2 * UNIT)
    assert f.time == 3 * LOOP
    assert not f.sense().bump.any()


def test_servos_that_differ_drive_an_arc():
    f = field([[1.0, 1.0, 0.0]])
    f._robots = TJPro(servo_gains=[[0.95, 1.05]])
    for _ in range(5):
        f.advance(np.array([[V, 0.0]]))
    assert f.pose[0, 2] == pytest.approx(0.1 / TRACK * 5 * UNIT)
    assert f.tally().way[0] == pytest.approx(5 * UNIT, rel=1e-3)


def test_a_wall_ahead_blocks_and_one_aslant_lets_slide():
    f = field([[0.12, 1.0, math.pi], [1.0, 0.1, -0.5]])
    for _ in range(3):
        f.advance(np.full((2, 2), [V, 0.0]))
    np.testing.assert_allclose(f.pose[0, :2], [RADIUS, 1.0], atol=1e-9)
    assert f.pose[1, 1] == pytest.approx(RADIUS, abs=1e-9)
    assert f.pose[1, 0] == pytest.approx(1 + 3 * UNIT * math.cos(0.5), abs=1e-3)
    bump = f.sense().bump
    assert bump.tolist() == [[True, True], [False, True]], "ahead both, to the right the right one"
    assert not f.sense().bump.any(), "read once"
    assert f.tally().way[0] == pytest.approx(0.03, abs=1e-9)
    assert f.tally().bumps.tolist() == [1, 1]


def test_what_is_hit_while_backing_is_not_felt():
    f = field([[0.1, 1.0, 0.0]])
    f.advance(np.array([[-V, 0.0]]))
    assert not f.sense().bump.any()
    assert f.pose[0, 0] == pytest.approx(RADIUS)


def test_a_robot_that_stands_is_an_obstacle_and_is_not_pushed():
    f = field([[1.0, 1.0, 0.0], [1.3, 1.03, 2.0]])
    for _ in range(6):
        f.advance(np.array([[V, 0.0], [0.0, 0.0]]))
    np.testing.assert_allclose(f.pose[1], [1.3, 1.03, 2.0])
    assert np.hypot(*(f.pose[0] - f.pose[1])[:2]) >= 2 * RADIUS - 1e-8
    assert f.sense().bump[0].any()


@given(st.integers(0, 10_000))
@settings(deadline=None, max_examples=40)
def test_nobody_is_ever_inside_anything(seed):
    rng = np.random.default_rng(seed)
    m = maze("m4")
    f = field(np.zeros((12, 3)), size=m.size, blocks=m.blocks, nest=m.nest, goal=m.goal)
    place = 0
    while place < 12:
        x, y = rng.uniform(RADIUS, 2.5 - RADIUS, 2)
        clear = all(
            np.hypot(max(b[0] - x, 0, x - b[2]), max(b[1] - y, 0, y - b[3])) >= RADIUS
            for b in m.blocks
        )
        if clear and (np.hypot(*(f.pose[:place, :2] - (x, y)).T) >= 2 * RADIUS).all():
            f.pose[place] = x, y, rng.uniform(-3, 3)
            place += 1
    f.present[:] = True
    for _ in range(30):
        command = np.column_stack([rng.choice([-V, 0, V], 12), rng.uniform(-2, 2, 12)])
        f.advance(command)
        x, y = f.pose[:, 0], f.pose[:, 1]
        assert min(x.min(), y.min()) >= RADIUS - 1e-7
        assert max(x.max(), y.max()) <= 2.5 - RADIUS + 1e-7
        for x0, y0, x1, y1 in m.blocks:
            dx = np.maximum(np.maximum(x0 - x, x - x1), 0)
            dy = np.maximum(np.maximum(y0 - y, y - y1), 0)
            assert np.hypot(dx, dy).min() >= RADIUS - 1e-7
        apart = np.hypot(*(f.pose[:, None, :2] - f.pose[None, :, :2]).transpose(2, 0, 1))
        assert apart[~np.eye(12, dtype=bool)].min() >= 2 * RADIUS - 1e-7


@pytest.mark.parametrize("gap", [0.05, 0.09, 0.11, 0.5])
def test_detectors_trip_at_a_tenth_of_a_metre(gap):
    """A wall square to the left detector: its gap is measured from the rim."""
    bearing = math.radians(25.0)
    f = field([[RADIUS + gap, 1.25, math.pi - bearing]])
    assert f.sense().ir.tolist() == [[gap <= TRIP, False]]


def test_detectors_see_blocks_and_robots_but_not_what_is_gone():
    f = field(
        [[1.0, 1.0, 0.0], [1.22, 1.12, 0.0], [2.0, 0.5, math.pi / 2]],
        blocks=np.array([[2.05, 0.65, 2.2, 0.8]]),
    )
    assert f.sense().ir.tolist() == [[True, False], [False, False], [False, True]]
    f.take_away(1)
    assert not f.sense().ir[0].any()
    blind = field([[2.0, 0.5, math.pi / 2]], blocks=f.blocks, blind=[True])
    assert not blind.sense().ir.any()


def test_the_compass_has_the_errors_it_is_given():
    n = 400
    poses = np.column_stack([np.linspace(0.2, 2.3, n), np.full(n, 1.0), np.full(n, 1.0)])
    read = np.array([field(poses, compass=CompassErrors(step=0.0, drift=0.0, bias=0.0))
                     .sense().heading]) - 1.0  # fmt: skip
    assert read.std() == pytest.approx(math.radians(2.0), rel=0.1)
    stepped = field(poses, compass=CompassErrors(step=math.radians(45.0))).sense().heading
    np.testing.assert_allclose(np.degrees(stepped) % 45.0, 0.0, atol=1e-9)
    biased = field(poses, compass=CompassErrors(noise=0.0, step=0.0, drift=0.0)).sense().heading
    assert 0 < np.abs(biased - 1.0).max() <= math.radians(5.0)
    assert np.isnan(PlanarField(Setting(n=1, seed=0, **OPEN)).sense().heading).all(), "not there"


def test_the_goal_is_seen_from_its_patch():
    f = field([[2.2 - REACH + 1e-6, 2.2, 0.0], [2.2 - REACH - 1e-6, 2.2, 0.0]])
    assert f.sense().goal.tolist() == [True, False]


def pair(name="m3", seed=1003, n=2, plan=None, timing=None, trails=False, **behaviour):
    m = maze(name)
    f = PlanarField(
        Setting(
            n=n, seed=seed, size=m.size, blocks=m.blocks, nest=m.nest, goal=m.goal,
            timing=timing or ByteTiming(),
        )
    )  # fmt: skip
    team = ScoutTeam(
        n, rng=Streams(seed).generator("controllers"), behaviour=Behaviour(**behaviour)
    )
    return run(f, team, plan or Plan(), keep_trails=trails), team


def test_a_scout_finds_and_a_worker_follows():
    out, team = pair(trails=True)
    assert out.found_after[1] < out.found_after[0]
    assert out.left[1] >= out.reported + 0.005
    assert out.first_valid - out.reported <= 1.0
    assert out.way_at[1] >= of_maze("m3") - 0.01
    # the vector told is the scout's own reckoning, rounded
    told, own = team.memory.goal[1], out.claimed[0]
    assert np.hypot(*(told - own)) <= math.hypot(0.5, 0.0245 * np.hypot(*own)) + 0.01
    trail = np.array(out.trails)
    assert np.isnan(trail[0, 1]).all(), "the worker is not there before"
    assert np.isfinite(trail[:, 0]).all(), "the scout searches on"


def test_nobody_leaves_when_the_scout_dies_or_sends_rubbish():
    for failure in ("scout-killed", "bad-checksum"):
        out, team = pair(plan=Plan(failure=failure))
        assert np.isnan(out.left[1])
        assert not team.records.known[1]
        assert out.ended >= 60.0
        assert out.tally is not None
        assert out.tally.groups[1] == 0
        assert (out.tally.groups[2] > 0) == (failure == "bad-checksum")


def test_a_channel_that_is_all_noise_brings_nobody_on_the_way():
    plan = Plan(finish="remove")
    out, _ = pair(plan=plan, timing=ByteTiming(byte_error=1.0), scout_after="stop")
    assert np.isnan(out.left[1])
    assert math.isnan(out.first_valid)


def test_a_worker_that_does_not_arrive_is_picked_up():
    out, _ = pair(plan=Plan(told=np.array([-50.0, -50.0])), seed=1000)
    assert out.given_up[1]
    assert np.isnan(out.found[1])
    assert out.ended - out.left[1] == pytest.approx(WORKER_LIMIT, abs=LOOP)


def test_workers_leave_five_seconds_apart_and_all_are_picked_up():
    out, team = pair(n=8, plan=Plan(finish="remove"), scout_after="stop", forced=4)
    assert (np.diff(out.left[1:]) >= 5.0 - 1e-9).all()
    assert np.isfinite(out.found).sum() >= 7
    assert team.done[out.found < out.ended].all()


def test_same_seed_same_run():
    first, _ = pair(n=4, plan=Plan(finish="remove"), scout_after="stop")
    np.random.seed(3)  # noqa: NPY002 - nothing may depend on the global state
    again, _ = pair(n=4, plan=Plan(finish="remove"), scout_after="stop")
    assert first.found.tobytes() == again.found.tobytes()
    assert first.way_at.tobytes() == again.way_at.tobytes()
    other, _ = pair(n=4, seed=1004, plan=Plan(finish="remove"), scout_after="stop")
    assert other.found.tobytes() != first.found.tobytes()


def test_shortest_ways_against_geometry():
    empty = np.empty((0, 4))
    a, b = np.array([0.3, 1.25]), np.array([2.2, 1.25])
    assert shortest(2.5, empty, a, b) == pytest.approx(1.9 - REACH)
    # round one corner of a wall from below: two tangents and an arc
    wall = np.array([[1.2, 1.0, 1.3, 2.5]])
    found = shortest(2.5, wall, a, b)
    corners = [np.array([1.2, 1.0 - RADIUS]), np.array([1.3, 1.0 - RADIUS])]
    least = np.hypot(*(corners[0] - a)) + 0.1 + np.hypot(*(b - corners[1])) - REACH
    assert least - 0.02 < found < 1.01 * least
    for name in ("m1", "m2", "m3", "m4"):
        m = maze(name)
        assert np.hypot(*(m.goal - m.nest)) - REACH <= of_maze(name) < 1.3 * 2.7


def test_bug2_goes_round_one_block_either_way():
    nest, goal = np.array([0.3, 1.25]), np.array([2.2, 1.25])
    free = shapely.box(0, 0, 2.5, 2.5).difference(shapely.box(1.0, 1.05, 1.4, 1.65))
    left, right = (bug2(free, nest, goal, hand) for hand in (1, -1))
    straight = 1.9 - REACH
    # down 0.2 with the block on its left, or up 0.4 with it on its right, and back
    assert left == pytest.approx(straight + 2 * 0.2)
    assert right == pytest.approx(straight + 2 * 0.4)
    # a block at the lower wall: with the solid on its left it would follow the whole arena
    free = open_ = shapely.box(0, 0, 2.5, 2.5)
    free = free.difference(shapely.box(1.0, 0.0, 1.4, 1.65))
    assert bug2(free, nest, goal, -1) == pytest.approx(straight + 2 * 0.4)
    assert bug2(free, nest, goal, 1) == pytest.approx(straight - 0.4 + 12.1)
    assert bug2(open_, nest, goal, 1) == pytest.approx(straight)
    shut = open_.difference(shapely.box(1.0, 0.0, 1.1, 2.5))
    assert bug2(shapely.get_parts(shut)[0], nest, goal, 1) == math.inf


def test_bug2_is_no_shorter_than_the_shortest():
    for name in ("m1", "m2", "m3", "m4", "f1", "f2", "f3"):
        assert all(of_maze(name) <= way < 7 * of_maze(name) for way in bug2_of(name))
