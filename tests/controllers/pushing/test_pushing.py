"""The pusher's cues, percepts, machine and recovery, each against what it is said to do."""

import math

import numpy as np
import pytest

from controllers.perception.arc_objects import MOVER, ROBOT, Objects
from controllers.pushing import Gaze, Parameters, Pusher, Recovery, Surroundings, pusher_machine
from controllers.pushing.cues import InPosition
from controllers.pushing.percepts import Fusion
from controllers.schemas import Things, View
from controllers.schemas.base import Memories
from mjmr.errors import InvalidInputError

R = 0.24
RING = -math.pi + 2 * math.pi * np.arange(48) / 48


def view(target, home):
    """One robot's view."""
    percepts = {"target": np.array([target], float), "home": np.array([home], float)}
    return View(percepts, 0.0, Memories([], 1, np.random.default_rng(0)))


def holds(cue, target, home, before=False):
    return bool(cue.holds(view(target, home), np.array([before]))[0])


@pytest.mark.parametrize("p", [1.0, 2.0, 4.0])
def test_in_position_within_p_radii_and_out_again_beyond_half_as_much_more(p):
    cue, home = InPosition(p, radius=R), (4.0, 0.0)
    assert holds(cue, (1.5, 0.99 * p * R), home)
    assert not holds(cue, (1.5, 1.01 * p * R), home)
    leave = 1.5 * p * R + 0.5 * R
    assert holds(cue, (2.0, 0.99 * leave), home, before=True)
    assert not holds(cue, (2.0, 1.01 * leave), home, before=True)


def test_with_p_0_a_tenth_of_a_radius_is_let_through():
    cue = InPosition(0.0, radius=R)
    assert holds(cue, (1.0, 0.099 * R), (4.0, 0.0))
    assert not holds(cue, (1.0, 0.11 * R), (4.0, 0.0))


def test_what_is_behind_the_robot_or_beyond_home_is_not_between():
    cue = InPosition(2.0, radius=R)
    assert not holds(cue, (-1.0, 0.0), (4.0, 0.0))
    assert not holds(cue, (2.0, 0.0), (1.5, 0.0))
    assert not holds(cue, (np.nan, np.nan), (1.5, 0.0))


def test_building_turns_the_cue_round():
    cue = InPosition(1.0, radius=R, build=True)
    assert holds(cue, (0.5, 0.1), (-2.0, 0.0))
    assert holds(cue, (3.0, 0.1), (-2.0, 0.0))  # however far home is
    assert not holds(cue, (0.5, 0.1), (2.0, 0.0))


def test_the_cue_does_not_depend_on_the_axes():
    rng = np.random.default_rng(1)
    cue = InPosition(1.5, radius=R)
    for _ in range(200):
        target, home = rng.uniform(-2, 2, 2), rng.uniform(-3, 3, 2)
        c, s = np.cos(a := rng.uniform(-3, 3)), np.sin(a)
        turn = np.array([[c, -s], [s, c]])
        assert holds(cue, target, home) == holds(cue, turn @ target, turn @ home)


def objects(*things, n=1):
    """Of robot 0: (kind, x, y) in the turret's frame."""
    kind, centre = np.zeros((n, 16), dtype=np.int64), np.full((n, 16, 2), np.nan)
    for k, (what, x, y) in enumerate(things):
        kind[0, k], centre[0, k] = what, (x, y)
    gap = np.hypot(centre[..., 0], centre[..., 1])
    return Objects(kind=kind, centre=centre, gap=gap, whole=np.ones((n, 16), dtype=bool))


def gaze(seen, *, heading=0.0, pan=0.0, home=(0.0, 4.0), ring=None):
    return Gaze(
        objects=seen,
        bearing=np.array([heading + pan]),
        heading=np.array([heading]),
        home=np.array([home]),
        ring=np.full((1, 48), np.inf) if ring is None else ring,
    )


def fusion(zone="square", size=0.5, radius=0.1):
    known = Surroundings(disc_radius=radius, robot_radius=R, zone=zone, size=size)
    return Fusion(1, known, RING)


def target(percepts):
    things = percepts["target"]
    return things.offset[0, 0] if things.valid[0, 0] else None


def test_percepts_turn_with_heading_and_turret():
    # home 4 m to the left of a robot that faces +y, that is at -x; a disc ahead of the turret,
    # which looks to the left as well
    seen = gaze(objects((MOVER, 1.0, 0.0)), heading=np.pi / 2, pan=np.pi / 2, home=(np.pi / 2, 4))
    percepts = fusion().percepts(seen)
    assert percepts["home"][0] == pytest.approx((-4.0, 0.0))
    assert target(percepts) == pytest.approx((-1.0, 0.0))


def test_discs_that_are_done_are_no_targets_and_the_nearest_of_the_others_is():
    # home is 2 m ahead: the disc at 1.8 m is in its square, the others are not
    things = ((MOVER, 1.8, 0.3), (MOVER, 1.2, 0.8), (MOVER, 2.6, 0.0))
    seen = gaze(objects(*things), home=(0.0, 2.0))
    assert target(fusion().percepts(seen)) == pytest.approx((1.2, 0.8))
    # building it is the other way round
    far = fusion("outside", 0.7).percepts(seen)
    assert target(far) == pytest.approx((1.8, 0.3))
    done = gaze(objects((MOVER, 1.8, 0.3)), home=(0.0, 2.0))
    assert target(fusion().percepts(done)) is None


def test_robots_are_teammates_and_no_targets():
    percepts = fusion().percepts(gaze(objects((ROBOT, 1.0, 0.0), (MOVER, 2.0, 0.5))))
    assert percepts["teammates"].valid.sum() == 1
    assert target(percepts) == pytest.approx((2.0, 0.5))


def wall(distance, bearing=0.0, noise=0.0):
    """Ring ranges (1, 48) of a wall."""
    cosine = np.cos(RING - bearing)
    ranges = np.where(cosine > 0.05, distance / np.maximum(cosine, 0.05), np.inf)
    ranges += noise * np.random.default_rng(0).standard_normal(48)
    return np.where(ranges < 0.8, ranges, np.inf)[None]


@pytest.mark.parametrize("bearing", np.linspace(-3, 3, 7))
def test_a_wall_is_one_obstacle_at_its_nearest_point(bearing):
    percepts = fusion().percepts(gaze(objects(), heading=0.4, ring=wall(0.4, bearing)))
    (point,) = percepts["obstacles"].offset[0][percepts["obstacles"].valid[0]]
    way = 0.4 + bearing
    assert point == pytest.approx((0.4 * np.cos(way), 0.4 * np.sin(way)), abs=0.03)


def test_noise_makes_no_crowd_of_a_wall():
    percepts = fusion().percepts(gaze(objects(), ring=wall(0.4, noise=0.01)))
    assert 1 <= percepts["obstacles"].valid.sum() <= 2


def test_a_teammate_in_view_is_no_obstacle_besides():
    ring = wall(0.35)
    seen = objects((ROBOT, 0.35 + R, 0.0))
    assert fusion().percepts(gaze(seen, ring=ring))["obstacles"].valid.sum() == 0
    assert fusion().percepts(gaze(objects(), ring=ring))["obstacles"].valid.sum() == 1


def test_the_turret_watches_the_target_then_waits_then_looks_around():
    known = fusion()
    there = known.percepts(gaze(objects((MOVER, 1.0, 1.0))))
    nothing = known.percepts(gaze(objects()))
    heading = np.array([0.3])
    assert known.aim(there, heading, 5.0) == pytest.approx(np.pi / 4 - 0.3)
    assert known.aim(nothing, heading, 5.9) == pytest.approx(np.pi / 4 - 0.3)
    assert known.aim(nothing, heading, 7.0) == pytest.approx(np.pi / 4 - 0.3 + 1.5)


def build(c=0.0, p=1.0, b=False):
    return pusher_machine(Parameters(c=c, p=p, b=b))


def weights(machine, state):
    return {schema.label: weight for weight, schema in machine.states[state]}


def test_c_acts_on_avoiding_and_swirling_round_obstacles_alone():
    for c in (0.0, 0.3, 1.0):
        machine = build(c=c)
        for state, expected in (("position", 2 * (1 - c)), ("push", c)):
            for label, weight in weights(machine, state).items():
                crowd = "teammates" in label or "obstacles" in label
                if crowd:
                    assert weight == pytest.approx(expected), (state, label)
                else:
                    assert weight == weights(build(c=0.5), state)[label]
    assert weights(build(c=0.0), "wander") == weights(build(c=1.0), "wander")


def test_b_flips_home_and_adds_the_draw_to_it_in_wander_alone():
    one, other = build(b=False), build(b=True)
    assert one.transitions == other.transitions
    assert list(one.states) == list(other.states)
    for state in ("position", "push"):
        turned = {k.replace("away from home", "to home"): v for k, v in weights(one, state).items()}
        assert turned == weights(other, state)
    extra = set(weights(other, "wander")) - set(weights(one, "wander"))
    assert extra == {"draw to home"}


@pytest.mark.parametrize("values", [{"c": 1.5}, {"c": -0.1}, {"p": -1.0}, {"p": np.nan}])
def test_parameters_that_cannot_be_are_refused(values):
    with pytest.raises(InvalidInputError):
        Parameters(**{"c": 0.0, "p": 1.0} | values)
    with pytest.raises(InvalidInputError, match="zone"):
        fusion(zone="hexagon")


def pusher(recovery=None, **parameters):
    known = Surroundings(disc_radius=0.1, robot_radius=R, zone="square", size=0.5)
    return Pusher(
        1, Parameters(**{"c": 0.0, "p": 1.0} | parameters), known, RING,
        rng=np.random.default_rng(0), top_speed=0.5, top_turn=2.5, recovery=recovery,
    )  # fmt: skip


def test_states_follow_what_is_seen():
    robot = pusher()

    def state(seen, time):
        robot.step(seen, time)
        return robot.behaviour.state_names[0]

    aside = gaze(objects((MOVER, 0.2, 1.0)))
    between = gaze(objects((MOVER, 1.0, 0.1)))
    assert state(gaze(objects()), 0.0) == "wander"
    assert state(aside, 0.1) == "position"
    assert state(between, 0.2) == "push"
    assert state(between, 0.3) == "push"
    assert state(aside, 0.4) == "position"
    assert state(gaze(objects()), 0.5) == "wander"


def test_positioning_robots_go_round_to_the_far_side_or_building_to_the_near_one():
    """A disc straight to the left, home ahead: the far side of the disc lies behind."""
    for b, sign in ((False, -1), (True, 1)):
        robot = pusher(b=b)
        seen = gaze(objects((MOVER, 0.0, 0.5)), home=(0.0, 2.9))
        robot.step(seen, 0.0)
        robot.step(seen, 0.1)
        assert robot.behaviour.state_names == ["position"]
        assert np.sign(robot.vector[0, 0]) == sign


def test_a_pushing_robot_goes_for_the_disc():
    robot = pusher()
    seen = gaze(objects((MOVER, 0.34, 0.05)))
    for k in range(3):
        command, pan = robot.step(seen, 0.1 * k)
    assert robot.behaviour.state_names == ["push"]
    assert command[0, 0] > 0.35
    assert pan[0] == pytest.approx(math.atan2(0.05, 0.34))


def percepts(distance, seen=True):
    """A target between robot and home, so far from home."""
    offset = np.array([[[5.0 - distance, 0.0]]])
    return {
        "target": Things(offset, np.zeros((1, 1)), np.array([[seen]])),
        "home": np.array([[5.0, 0.0]]),
    }


def run_recovery(distance, seconds=30.0, seen=lambda t: True):
    recovery = Recovery(1, 0.0, np.random.default_rng(0))
    for k in range(round(10 * seconds)):
        recovery.step(percepts(distance(0.1 * k), seen(0.1 * k)), 0.1 * k)
    return recovery


def test_who_gets_nowhere_draws_another_p_and_who_moves_keeps_it():
    stuck = run_recovery(lambda t: 3.0)
    assert stuck.changes == 3
    assert 1.0 <= stuck.p[0] <= 3.0
    assert run_recovery(lambda t: 3.0 - 0.05 * t).changes == 0
    assert run_recovery(lambda t: 3.0, seconds=7.9).changes == 0


def test_noise_is_no_progress_and_a_target_lost_now_and_then_no_stagnation():
    rng = np.random.default_rng(2)
    assert run_recovery(lambda t: 3.0 + 0.05 * rng.standard_normal()).changes == 3
    assert run_recovery(lambda t: 3.0, seen=lambda t: t % 5.0 > 0.2).changes == 0
