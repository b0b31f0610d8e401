"""Scouts and workers: reckoning, transitions, release and what is told on."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controllers.scouting import LOOP, UNIT, Behaviour, Codec, ScoutTeam, kernel, machine
from controllers.scouting.diagram import cues, state_machine
from mjmr.errors import InvalidInputError, UnknownNameError


def team(n=2, seed=0, scouts=1, codec=None, **behaviour):
    return ScoutTeam(
        n, rng=np.random.default_rng(seed), scouts=scouts, codec=codec,
        behaviour=Behaviour(**behaviour),
    )  # fmt: skip


class Bench:
    """One robot on blocks: it turns and drives where it is told, and feels what we say."""

    def __init__(self, robots, heading=0.0):
        self.team, self.time = robots, 0.0
        self.heading = np.full(robots.n, float(heading))

    def step(self, ir=(0, 0), bump=(0, 0), goal=False, active=None):
        """Last robot feels; returns the name of its state and its action."""
        n = self.team.n
        eyes, feelers, seen = np.zeros((n, 2)), np.zeros((n, 2)), np.zeros(n)
        eyes[-1], feelers[-1], seen[-1] = ir, bump, goal
        command = self.team.step(self.time, self.heading, eyes, feelers, seen, active)
        np.testing.assert_allclose(command, self.team.action * (UNIT / LOOP, 1 / LOOP))
        self.heading = self.heading + command[:, 1] * LOOP
        self.time += LOOP
        return machine.STATES[self.team.state[-1]], tuple(self.team.action[-1])


def worker(heading=0.0, vector=(20.0, 0.0), **behaviour):
    robots = team(1, scouts=0, **behaviour)
    robots.tell(vector)
    return Bench(robots, heading)


def test_numbers_of_the_kernel_are_the_machines():
    for name in machine.STATES:
        assert getattr(kernel, name.upper()) == machine.STATES.index(name)
        assert getattr(machine, name.upper()) == machine.STATES.index(name)
    for name in machine.CUES:
        constant = name.upper().replace(" ", "_")
        assert getattr(machine, constant) == machine.CUES.index(name)
    assert len(machine.CUES) == kernel.CUE_COUNT


@given(st.lists(st.tuples(st.floats(-math.pi, math.pi), st.booleans()), max_size=40))
@settings(max_examples=50)
def test_reckoning_adds_unit_steps_and_backing_subtracts(steps):
    """Eqs. 3 and 4, against complex numbers; a bump makes it back up and turn."""
    robots = team(1, wander_chance=0.0)
    expected = 0.0 + 0.0j
    for heading, bumped in steps:
        before = robots.state[0]
        robots.step(0.0, [heading], [[0, 0]], [[bumped, bumped]], [0])
        state = robots.state[0]
        if state == machine.SEARCH:
            expected += np.exp(1j * heading)
        elif state == machine.BACK:
            expected -= np.exp(1j * heading)
            assert before != machine.BACK
    assert complex(*robots.travelled[0]) == pytest.approx(expected, abs=1e-12)
    angle, d = robots.vector(0)
    assert d * np.exp(1j * angle) == pytest.approx(expected, abs=1e-9)


def test_turning_counts_nothing():
    b = worker(heading=math.pi)
    b.step()
    b.step()
    assert (b.team.travelled == 0).all()
    assert b.team.state[0] == machine.ALIGN


def test_a_worker_turns_to_its_course_then_drives_by_equation_6():
    b = worker(heading=2.0, vector=(3.0, 0.0))
    assert b.step()[0] == "align"
    while b.step()[0] == "align":
        pass
    assert abs(b.heading[0]) < 0.2
    b.step()
    np.testing.assert_allclose(b.team.travelled[0], [2.0, 0.0], atol=0.02)
    assert b.step()[0] == "spiral", "1 unit is left and no goal is seen"


def test_obstacles_left_and_right():
    for ir, side in (((1, 0), -1), ((0, 1), 1)):
        b = worker()
        b.step()
        assert b.step()[0] == "seek"
        assert b.step(ir=ir) == ("avoid", (0.0, side * math.radians(20.0)))
        assert b.step(ir=ir)[0] == "avoid"
        # the side is kept until it is clear, whatever is seen then
        assert b.step(ir=(1, 1)) == ("avoid", (0.0, side * math.radians(20.0)))
        assert b.step() == ("seek", (1.0, 0.0)), "one forced unit, though off its course"
        assert b.step()[0] == "align", "60 degrees off: more than the margin"


def test_a_bump_is_backed_away_from_and_turned_from():
    for bump, side in (((1, 0), -1), ((0, 1), 1)):
        b = worker()
        b.step()
        b.step()
        assert b.step(bump=bump) == ("back", (-1.0, 0.0))
        assert b.step() == ("turn", (0.0, side * math.radians(45.0)))
        assert b.step() == ("seek", (1.0, 0.0))
    assert b.team.memory.length[0] == 3


@pytest.mark.parametrize(("forced", "margin", "state"), [
    (0, 35.0, "align"), (0, 90.0, "seek"), (1, 35.0, "seek"), (4, 5.0, "seek"),
])  # fmt: skip
def test_when_the_course_is_compared(forced, margin, state):
    """Three steps of 20 degrees away from it: in this loop if no unit is forced."""
    b = worker(forced=forced, margin=math.radians(margin))
    b.step()
    b.step()
    for _ in range(3):
        assert b.step(ir=(0, 1))[0] == "avoid"
    assert b.step()[0] == state
    driven = 1
    while state == "seek" and b.step()[0] == "seek" and driven < 10:
        driven += 1
    assert driven == (10 if margin == 90.0 else max(forced, 1))


def test_no_unit_is_driven_into_what_is_in_the_way():
    b = worker(heading=0.5)
    assert b.step()[0] == "align"
    assert b.step(ir=(1, 1))[0] == "avoid", "aligned, but blocked"
    assert b.team.travelled[0].tolist() == [0.0, 0.0]


def test_the_spiral_goes_round_and_starts_anew():
    b = worker(vector=(1.0, 0.0), spiral_legs=6)
    states, places = [], []
    for _ in range(60):
        states.append(b.step()[0])
        places.append(b.team.travelled[0])
    assert states.count("spiral") > 30
    assert "align" in states[2:], "after six sides"
    first = np.array(places[: states.index("align", 2)])
    assert np.ptp(first, axis=0) == pytest.approx([6.0, 6.0], abs=1.01), "sides 2 2 4 4 6 6"


def test_a_scout_tells_once_and_searches_on():
    robots = team(1, wander_chance=0.0)
    b = Bench(robots)
    b.step()
    b.step()
    assert b.step(goal=True)[0] == "transmit"
    assert robots.reports[0]
    assert Codec().valid([list(robots.message(0))])[0]
    assert robots.message(0)[0::2] == bytes([0, 2])
    assert b.step(goal=True)[0] == "search"
    assert not robots.reports[0]
    stop = Bench(team(1, scout_after="stop"))
    assert [stop.step(goal=True)[0], stop.step()[0]] == ["transmit", "done"]


def test_nobody_leaves_without_a_valid_group_and_then_in_turn():
    robots = team(4, release=5.0)
    b = Bench(robots)
    group = list(Codec().encode(0, 20))
    bad = [group[0], group[1] ^ 4, *group[2:]]
    for _ in range(4):
        robots.hear(np.repeat(np.arange(4), 2), [bad, [0, 0, 0, 0]] * 4)
        b.step()
    assert robots.released.tolist() == [True, False, False, False]
    assert robots.records.dropped.tolist() == [8] * 4
    robots.hear([1, 2, 3], [group] * 3)
    left = {}
    for _ in range(40):
        left |= {i: b.time for i in np.flatnonzero(robots.released) if i not in left}
        b.step()
    assert [left[k] - left[1] for k in (1, 2, 3)] == [0.0, 5.0, 10.0]
    assert np.isfinite(robots.left_at[1:]).all()


def test_a_robot_that_is_not_there_does_nothing():
    b = worker()
    for _ in range(5):
        assert b.step(active=[False]) == ("wait", (0.0, 0.0))
    assert b.step(active=[True])[0] == "align"


def test_homing():
    b = worker(vector=(3.0, 0.0), after_goal="home")
    b.step()
    b.step()
    b.step()
    assert b.step(goal=True)[0] == "report"
    names = [b.step(goal=True)[0] for _ in range(20)]
    assert names[0] == "align"
    assert "report" not in names
    assert names[-1] == "done"
    assert np.hypot(*b.team.travelled[0]) < 1.5


def drive(robots, loops, seed=3):
    """Stir a team with random perceptions; yields before-states, headings and active flags."""
    rng = np.random.default_rng(seed)
    n = robots.n
    robots.tell((15.0, 5.0))
    for k in range(loops):
        heading = rng.uniform(-np.pi, np.pi, n) if k % 3 else np.full(n, 0.32)
        ir, bump = rng.random((n, 2)) < 0.15, rng.random((n, 2)) < 0.03
        goal = rng.random(n) < 0.01
        robots.step(k * LOOP, heading, ir, bump, goal)
        yield heading


@pytest.mark.parametrize("after", [("search", "stop"), ("stop", "home")])
def test_the_declared_machines_switch_as_the_compiled_team_does(after):
    """Every transition there is, in 300 robots, loop for loop."""
    n, scouts = 300, 100
    options = {"scout_after": after[0], "after_goal": after[1], "forced": 0}
    robots = team(n, scouts=scouts, release=0.0, spiral_legs=4, **options)
    b = robots.behaviour
    declared = [state_machine(machine.scout(b)), state_machine(machine.worker(b))]
    rows = [np.arange(scouts), np.arange(scouts, n)]
    running = [m.start(len(r), np.random.default_rng(0))
               for m, r in zip(declared, rows, strict=True)]  # fmt: skip
    moved = np.zeros((n, 2))
    for k, heading in enumerate(drive(robots, 400)):
        before = moved.copy()
        moved = robots.travelled
        names = [machine.STATES[s] for s in robots.state]
        for machine_, r in zip(running, rows, strict=True):
            vector = machine_.step(cues(robots.cues[r], heading[r]), k * LOOP)
            assert machine_.state_names == [names[i] for i in r]
            fixed = np.isin(machine_.state_names, ["seek", "back", "avoid", "align", "turn"])
            np.testing.assert_allclose(vector[fixed], (moved - before)[r][fixed], atol=1e-9)
    for machine_ in running:
        taken = dict(zip(machine_.machine.transitions, machine_.transitions, strict=True))
        assert all(taken.values()), [t for t, count in taken.items() if not count]


def test_every_state_has_a_way_out_but_the_last():
    b = Behaviour()
    for m in (machine.scout(b), machine.worker(b)):
        leaves = {t.state for t in m.transitions}
        assert set(m.states) - leaves <= {"done"}
        assert machine.table(m).shape == (len(machine.STATES), 8, 2)


def finisher(mode, travelled, length=20.0, trail=((5.0, 0.0), (5.0, 5.0)), hears=()):
    """A worker that knew (20, 0) from the scout comes to the goal; returns its records, message."""
    robots = team(3, succession=mode)
    r = robots.records
    r.hear(np.array([1]), np.frombuffer(r.codec.encode(0, 20), np.uint8)[None])
    for group in hears:
        r.hear(np.array([1]), np.frombuffer(group, np.uint8)[None])
    r.finish(1, travelled=np.array(travelled), length=length, trail=np.array(trail), scout=False)
    return r, r.outgoing[1]


def told(records, message):
    """What robot 2 knows after a message."""
    groups = np.frombuffer(message, np.uint8).reshape(-1, 4)
    records.hear(np.full(len(groups), 2), groups)
    return records


def test_finishers_are_silent_average_or_give_via_points():
    assert finisher("none", (18.0, 0.0))[1] == b""
    r, message = finisher("average", (16.0, 0.0))
    r = told(r, message)
    np.testing.assert_allclose(r.goal[2], [16.0, 0.0], atol=1e-9)
    assert (r.count[2], r.via_count(2)) == (1, 0), "the scout's vector is replaced"
    # the next one averages with what it heard
    codec = r.codec
    heard = [codec.encode(0, 14), codec.encode(3, 20, kind=1)]
    r, message = finisher("average", (18.0, 0.0), hears=heard)
    r = told(r, message)
    np.testing.assert_allclose(r.goal[2], [15.0, 0.0], atol=1e-9)
    assert r.count[2] == 4
    r, message = finisher("via", (16.0, 0.0), trail=((5.0, 0.0), (5.0, 5.0), (16.0, 0.0)))
    r = told(r, message)
    np.testing.assert_allclose(r.goal[2], [20.0, 0.0], atol=1e-9)
    assert r.via_count(2) == 2
    assert np.hypot(*(r.vias[2, 1] - (5.0, 5.0))) < 0.6
    assert r.codec.impostors(message) == 0


def test_a_path_that_is_no_shorter_is_not_told():
    codec = Codec(kinds=6)
    heard = [codec.encode(1, 20, kind=1)]
    assert finisher("via", (16.0, 0.0), length=19.5, hears=heard)[1] == b""
    assert finisher("via", (16.0, 0.0), length=19.0, hears=heard)[1] != b""


def test_via_points_are_driven_through():
    robots = team(1, scouts=0, succession="via")
    robots.tell((10.0, 0.0))
    robots.records.vias[0, 0] = (5.0, 5.0)
    b = Bench(robots)
    for _ in range(14):
        b.step()
    trail = robots.memory.trail[0, : robots.memory.marks[0]]
    assert np.hypot(*(trail - (5.0, 5.0)).T).min() < 1.5
    assert robots.memory.via_at[0] == 1


def test_same_seed_same_steps():
    found = []
    for _ in range(2):
        robots = team(10, scouts=4, release=1.0)
        list(drive(robots, 100))
        np.random.seed(7)  # noqa: NPY002 - nothing may depend on the global state
        found.append((robots.state.tobytes(), robots.travelled.tobytes()))
    assert found[0] == found[1]


def test_bad_input():
    robots = team(2)
    with pytest.raises(InvalidInputError, match=r"shape \(2,\), ir and bump \(2, 2\)"):
        robots.step(0.0, [0.0], np.zeros((2, 2)), np.zeros((2, 2)), [0, 0])
    with pytest.raises(InvalidInputError, match="needs a finite heading"):
        robots.step(0.0, [np.nan, 0.0], np.zeros((2, 2)), np.zeros((2, 2)), [0, 0])
    with pytest.raises(InvalidInputError, match="0 to n scouts; 2, 3"):
        team(2, scouts=3)
    with pytest.raises(InvalidInputError, match="forced units are a whole number"):
        Behaviour(forced=-1)
    with pytest.raises(InvalidInputError, match="above 0 and up to pi"):
        Behaviour(margin=0.0)
    with pytest.raises(InvalidInputError, match="no larger than turn_limit"):
        Behaviour(avoid_step=2.0)
    with pytest.raises(UnknownNameError, match="succession 'gossip'; valid: "):
        Behaviour(succession="gossip")
    with pytest.raises(InvalidInputError, match="average needs 2 kinds of group; the codec has 1"):
        team(2, codec=Codec(), succession="average")
