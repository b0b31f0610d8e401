import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controllers.schemas import (
    Avoid,
    AvoidPast,
    Blend,
    Draw,
    Follow,
    FollowWall,
    MoveTo,
    Noise,
    StateMachine,
    Swirl,
    Things,
)
from mjmr.errors import InvalidInputError, UnknownNameError

COORDINATE = st.floats(-5, 5).filter(lambda x: abs(x) > 1e-3)


def field_of(schema, percepts, time=0.0, n=1, seed=0):
    """Vectors of one schema, through a machine of one state."""
    behaviour = StateMachine(states={"only": schema}).start(n, np.random.default_rng(seed))
    return behaviour.step(percepts, time)


def at(*offsets, radius=0.0):
    """One robot that perceives things at these offsets."""
    return Things.of(np.array([offsets], dtype=float), radius)


@pytest.mark.parametrize(
    ("distance", "length"), [(2.1, 0.0), (2.0, 0.0), (1.5, 0.5), (1.25, 0.75), (1.0, 1.0), (0.6, 1)]
)
def test_avoid_ramps_with_the_range_to_the_surface(distance, length):
    things = at((distance + 0.3, 0.0), radius=0.3)
    vector = field_of(Avoid("rocks", reach=2.0, stop=1.0), {"rocks": things})
    assert vector == pytest.approx(np.array([[-length, 0.0]]))


def test_avoid_adds_what_all_things_give_and_ignores_what_is_not_there():
    both = field_of(Avoid("rocks", reach=2.0, stop=1.0), {"rocks": at((1.5, 0), (0, 1.5))})
    assert both == pytest.approx(np.array([[-0.5, -0.5]]))
    none = at((1.5, 0), (np.nan, np.nan))
    assert field_of(Avoid("rocks", reach=2.0, stop=1.0), {"rocks": none})[0, 1] == 0.0


@settings(deadline=None)  # the first call compiles
@given(COORDINATE, COORDINATE, COORDINATE, COORDINATE)
def test_swirl_is_perpendicular_and_on_the_side_of_its_direction(x, y, hx, hy):
    percepts = {"rock": at((x, y)), "home": np.array([[hx, hy]])}
    vector = field_of(Swirl("rock", towards="home"), percepts)[0]
    assert vector @ [x, y] == pytest.approx(0.0, abs=1e-9)
    assert np.hypot(*vector) == pytest.approx(1.0)
    assert vector @ [hx, hy] >= -1e-9
    away = field_of(Swirl("rock", towards="home", away=True), percepts)[0]
    assert away @ [hx, hy] <= 1e-9


def test_swirl_fades_as_the_thing_gets_between_robot_and_home():
    swirl = Swirl("rock", towards="home", away=True, saturation=0.2)

    def length(angle):
        rock = np.array([np.cos(angle), np.sin(angle)])
        vector = field_of(swirl, {"rock": at(rock), "home": np.array([[3.0, 0.0]])})
        return float(np.hypot(*vector[0]))

    assert length(0.0) == 0.0
    assert length(np.arcsin(0.1)) == pytest.approx(0.5)
    assert length(np.arcsin(0.3)) == pytest.approx(1.0)
    assert length(3.0) == pytest.approx(1.0)  # the robot is between the rock and home


def test_swirling_away_from_home_takes_a_robot_behind_the_thing():
    """Integrated, the robot ends with the thing between itself and home."""
    swirl = Swirl("rock", towards="home", away=True, saturation=0.2)
    toward = MoveTo("rock", dead_zone=0.5)
    home, rock, robot = np.array([5.0, 0.0]), np.zeros(2), np.array([0.9, 0.3])
    behaviour = StateMachine(states={"go": swirl + 0.3 * toward}).start(1, np.random.default_rng(0))
    for k in range(2000):
        percepts = {"rock": (rock - robot)[None], "home": (home - robot)[None]}
        robot = robot + 0.005 * behaviour.step(percepts, k * 0.01)[0]
    assert robot[0] < -0.4
    assert abs(robot[1]) < 0.05


def test_move_to_has_a_dead_zone_and_backs_off():
    go = MoveTo("disc", dead_zone=0.4, slow=0.2, repel=0.3, touch=0.2)
    for gap, length in [(1.0, 1.0), (0.5, 0.5), (0.35, 0.0), (0.25, -0.5), (0.1, -1.0)]:
        vector = field_of(go, {"disc": at((0.0, gap + 0.1), radius=0.1)})
        assert vector == pytest.approx(np.array([[0.0, length]])), gap


def test_move_to_takes_the_nearest_surface():
    things = Things.of(np.array([[[1.0, 0.0], [0.0, 1.5]]]), np.array([[0.1, 1.0]]))
    assert field_of(MoveTo("disc"), {"disc": things}) == pytest.approx(np.array([[0.0, 1.0]]))


def test_nothing_there_gives_nothing():
    nothing = np.array([[np.nan, np.nan]])
    for schema in (
        MoveTo("x"),
        Draw("x", full=1.0),
        Follow("x", distance=0.5, slack=0.1),
        Avoid("x", reach=1.0, stop=0.1),
        FollowWall("x", distance=0.5, reach=1.0),
        Swirl("home", towards="x"),
    ):
        vector = field_of(schema, {"x": nothing, "home": np.array([[1.0, 0.0]])})
        assert (vector == 0).all(), schema.label


def test_draw_grows_with_distance_and_follow_changes_sign():
    assert field_of(Draw("x", full=4.0), {"x": [[0, 1.0]]})[0] == pytest.approx([0.0, 0.25])
    assert field_of(Draw("x", full=4.0), {"x": [[0, 9.0]]})[0] == pytest.approx([0.0, 1.0])
    follow = Follow("x", distance=1.0, slack=0.5)
    assert field_of(follow, {"x": [[0.75, 0]]})[0] == pytest.approx([-0.5, 0.0])
    assert field_of(follow, {"x": [[1.0, 0]]})[0] == pytest.approx([0.0, 0.0])
    assert field_of(follow, {"x": [[3.0, 0]]})[0] == pytest.approx([1.0, 0.0])


@pytest.mark.parametrize("hand", ["left", "right"])
def test_a_wall_is_followed_at_its_distance(hand):
    """Around a round pillar, integrated: the distance settles and the way goes round."""
    follow = FollowWall("pillar", distance=0.5, reach=3.0, hand=hand)
    behaviour = StateMachine(states={"follow": follow}).start(1, np.random.default_rng(0))
    robot, turned, previous = np.array([2.5, 0.0]), 0.0, 0.0
    for k in range(3000):
        percepts = {"pillar": Things.of(-robot[None], 1.0)}
        robot = robot + 0.005 * behaviour.step(percepts, k * 0.005)[0]
        angle = np.arctan2(robot[1], robot[0])
        turned += (angle - previous + np.pi) % (2 * np.pi) - np.pi
        previous = angle
    assert np.hypot(*robot) == pytest.approx(1.5, abs=0.01)
    # with the pillar at the left a robot goes round it anticlockwise
    assert turned * (1 if hand == "left" else -1) > 2 * np.pi


def test_noise_is_held_and_depends_on_seed_and_time_alone():
    noise = Noise(hold=5.0)

    def run(times, seed=0):
        behaviour = StateMachine(states={"w": noise}).start(3, np.random.default_rng(seed))
        return [behaviour.step({}, t) for t in times]

    early, held, later = run([0.0, 4.9, 5.0])
    assert (early == held).all()
    assert (early != later).all()
    assert np.hypot(*later.T) == pytest.approx(1.0)
    np.testing.assert_array_equal(run([5.0])[0], later)
    assert (run([5.0], seed=1)[0] != later).any()


def test_noise_headings_are_spread_evenly():
    behaviour = StateMachine(states={"w": Noise(hold=1.0)}).start(4000, np.random.default_rng(0))
    assert np.abs(behaviour.step({}, 0.0).mean(axis=0)).max() < 4 / np.sqrt(2 * 4000)


def test_one_schema_in_two_places_is_the_same_noise():
    noise = Noise(hold=5.0)
    swirl = Swirl("rock", towards=noise)
    rock = at((1.0, 0.0))
    both = field_of(0.6 * noise + swirl, {"rock": rock})[0]
    alone = field_of(noise, {})[0]
    assert both == pytest.approx(0.6 * alone + [0.0, np.sign(alone[1])])


def test_weights_multiply_and_add():
    home = {"home": [[1.0, 0.0]], "rock": [[0.0, 0.5]]}
    blend = 2 * (0.5 * MoveTo("home") + MoveTo("rock")) + Blend([(3.0, MoveTo("home"))])
    assert field_of(blend, home) == pytest.approx(np.array([[4.0, 2.0]]))


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: -1.0 * MoveTo("home"), "weight of 'move to home'"),
        (lambda: np.nan * MoveTo("home"), "weight of 'move to home'"),
        (lambda: Noise(hold=0.0), "hold must be positive"),
        (lambda: Avoid("rocks", reach=1.0, stop=1.0), "avoid rocks: stop must be below reach"),
        (lambda: Avoid("rocks", reach=1.0, stop=-0.1), "avoid rocks: stop must be 0 or more"),
        (lambda: Swirl("rocks", towards="home", saturation=1.5), "saturation is a sine"),
        (lambda: MoveTo("home", dead_zone=0.1, repel=0.2), "touch < repel <= dead_zone"),
        (lambda: Draw("home", full=0.0), "full must be positive"),
        (lambda: Follow("x", distance=1.0, slack=0.0), "slack must be positive"),
        (lambda: FollowWall("walls", distance=2.0, reach=1.0), "0 < distance < reach"),
        (lambda: FollowWall("walls", distance=0.5, reach=1, hand="up"), "hand is left or right"),
    ],
)
def test_numbers_out_of_range_are_refused_by_name(make, said):
    with pytest.raises(InvalidInputError, match=said):
        make()


def test_an_unknown_percept_is_named():
    with pytest.raises(UnknownNameError, match="unknown percept 'hone'; valid: home"):
        field_of(MoveTo("hone"), {"home": [[1.0, 0.0]]})


def test_percepts_of_another_team_are_refused():
    with pytest.raises(InvalidInputError, match="percept 'home' must be of 1 robots; got 2"):
        field_of(MoveTo("home"), {"home": [[1.0, 0.0], [1.0, 0.0]]})


def test_avoiding_the_past_leads_out_of_a_pocket_that_attraction_stays_in():
    """A wall of pillars, open to the back, between robot and goal."""
    arc = np.linspace(-1.6, 1.6, 60)
    pillars = np.concatenate(
        [
            np.column_stack([np.full(60, 1.0), arc]),
            np.column_stack([np.linspace(-0.6, 1.0, 30), np.full(30, 1.6)]),
            np.column_stack([np.linspace(-0.6, 1.0, 30), np.full(30, -1.6)]),
        ]
    )
    goal = np.array([3.0, 0.0])
    avoid, go = Avoid("nearest wall", reach=0.5, stop=0.1), MoveTo("goal")
    past = AvoidPast("place", walls="walls", towards="goal")
    nearest = {}
    for name, blend in {"drawn": go + 0.3 * avoid, "past": past + 0.3 * avoid}.items():
        behaviour = StateMachine(states={"go": blend}).start(1, np.random.default_rng(0))
        robot, least = np.zeros(2), np.inf
        for k in range(4000):
            walls = Things.of((pillars - robot)[None], 0.05)
            percepts = {
                "walls": walls,
                "nearest wall": walls.nearest(),
                "goal": (goal - robot)[None],
                "place": robot[None],
            }
            step = 0.02 * behaviour.step(percepts, 0.05 * k)[0]
            blocked = np.hypot(*(pillars - robot - step).T).min() < 0.15
            robot = robot if blocked else robot + step
            least = min(least, float(np.hypot(*(goal - robot))))
        nearest[name] = least
    assert nearest["drawn"] > 1.8
    assert nearest["past"] < 0.5


def test_robots_avoid_their_own_past_only():
    past = AvoidPast("place", walls="walls")
    behaviour = StateMachine(states={"go": past}).start(2, np.random.default_rng(0))
    nothing = Things.of(np.empty((2, 0, 2)))
    for k in range(64):  # the first goes along x again and again, the second stays
        places = np.array([[0.2 + 0.4 * (k % 8), 0.2], [0.2, 0.2]])
        if k == 60:
            break
        behaviour.step({"walls": nothing, "place": places}, float(k))
    vector = behaviour.step({"walls": nothing, "place": places}, 60.0)
    assert abs(vector[0, 1]) > 0.3  # off its beaten track
    lost = behaviour.step({"walls": nothing, "place": np.full((2, 2), np.nan)}, 61.0)
    assert (lost == 0).all()


def test_avoid_past_is_checked():
    with pytest.raises(InvalidInputError, match="avoid past: cell must be positive"):
        AvoidPast("place", walls="walls", cell=0.0)
    with pytest.raises(InvalidInputError, match="extent must be more than a cell"):
        AvoidPast("place", walls="walls", extent=0.3)
