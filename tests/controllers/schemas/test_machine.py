import numpy as np
import pytest

from controllers.schemas import (
    After,
    Blend,
    Condition,
    Hysteresis,
    MoveTo,
    Noise,
    Sees,
    StateMachine,
    Things,
    Within,
    steer,
)
from mjmr.errors import InvalidInputError, UnknownNameError

NOWHERE = [np.nan, np.nan]


def pusher(**changes):
    declared = {
        "states": {
            "wander": 0.6 * Noise(hold=5.0),
            "position": MoveTo("disc"),
            "push": 2.0 * MoveTo("disc"),
        },
        "cues": {"sees disc": Sees("disc"), "near": Within("disc", 0.5, leave=0.8)},
        "transitions": [
            ("wander", "sees disc", "position"),
            ("position", "near", "push"),
            ("push", "not near", "position"),
            ("position", "not sees disc", "wander"),
        ],
    }
    return StateMachine(**(declared | changes))


def test_robots_switch_each_by_its_own_cues():
    behaviour = pusher().start(3, np.random.default_rng(0))
    percepts = {"disc": np.array([[2.0, 0.0], NOWHERE, [0.0, 0.4]])}
    behaviour.step(percepts, 0.0)
    assert behaviour.state_names == ["position", "wander", "position"]
    vector = behaviour.step(percepts, 0.1)
    assert behaviour.state_names == ["position", "wander", "push"]
    assert vector[[0, 2]] == pytest.approx(np.array([[1.0, 0.0], [0.0, 2.0]]))
    assert np.hypot(*vector[1]) == pytest.approx(0.6)
    assert behaviour.transitions.tolist() == [2, 1, 0, 0]


def test_thresholds_have_hysteresis():
    behaviour = pusher().start(1, np.random.default_rng(0))
    seen = []
    for k, x in enumerate([0.9, 0.7, 0.49, 0.7, 0.79, 0.81, 0.7]):
        behaviour.step({"disc": [[x, 0.0]]}, 0.1 * k)
        seen.append(behaviour.state_names[0])
    assert seen == ["position", "position", "push", "push", "push", "position", "position"]


def test_hysteresis_of_a_function_is_off_where_it_is_not_a_number():
    cue = Hysteresis(lambda view: view.vector("x")[:, 0], enter=1.0, leave=2.0)
    machine = StateMachine(
        states={"off": Blend(), "on": Blend()},
        cues={"small": cue},
        transitions=[("off", "small", "on"), ("on", "not small", "off")],
    )
    behaviour = machine.start(1, np.random.default_rng(0))
    states = []
    for k, x in enumerate([1.5, 1.0, 1.5, np.nan, 1.5]):
        behaviour.step({"x": [[x, 0.0]]}, float(k))
        states.append(behaviour.state_names[0])
    assert states == ["off", "on", "on", "off", "off"]


def test_the_first_transition_declared_wins_and_one_is_taken_a_step():
    machine = StateMachine(
        states={"a": Blend(), "b": Blend(), "c": Blend()},
        cues={"yes": Condition(lambda view: [True]), "also": Condition(lambda view: [True])},
        transitions=[("a", "yes", "b"), ("a", "also", "c"), ("b", "yes", "c")],
    )
    behaviour = machine.start(1, np.random.default_rng(0))
    behaviour.step({}, 0.0)
    assert behaviour.state_names == ["b"]
    behaviour.step({}, 1.0)
    assert behaviour.state_names == ["c"]


def test_time_in_a_state_counts_from_entering_it():
    machine = StateMachine(
        states={"wait": Blend(), "go": Blend()},
        cues={"long": After(1.0)},
        transitions=[("wait", "long", "go"), ("go", "long", "wait")],
    )
    behaviour = machine.start(2, np.random.default_rng(0))
    states = []
    for k in range(8):  # begins at 5 s
        behaviour.step({}, 5.0 + 0.5 * k)
        states.append(behaviour.state[0])
    assert states == [0, 0, 1, 1, 0, 0, 1, 1]


def test_a_team_does_what_its_robots_do_alone():
    """Structure of arrays: nothing leaks from one robot into another."""
    rng = np.random.default_rng(3)
    machine = pusher(states=pusher().states | {"wander": MoveTo("home")})
    team = machine.start(5, np.random.default_rng(0))
    alone = [machine.start(1, np.random.default_rng(0)) for _ in range(5)]
    for k in range(50):
        disc = rng.uniform(-1, 1, (5, 3, 2))
        valid = rng.random((5, 3)) < 0.3
        things = Things(disc, np.full((5, 3), 0.1), valid)
        home = rng.uniform(-1, 1, (5, 2))
        together = team.step({"disc": things, "home": home}, 0.1 * k)
        for i, one in enumerate(alone):
            own = Things(disc[i : i + 1], things.radius[i : i + 1], valid[i : i + 1])
            vector = one.step({"disc": own, "home": home[i : i + 1]}, 0.1 * k)
            np.testing.assert_array_equal(vector[0], together[i])
            assert one.state[0] == team.state[i]
    assert team.transitions.min() > 0


@pytest.mark.parametrize(
    ("changes", "error", "said"),
    [
        (
            {"transitions": [("wander", "sees disc", "position")]},
            InvalidInputError,
            "no transition leads from 'wander' to 'push'",
        ),
        (
            {"transitions": [("wander", "smells disc", "position")]},
            UnknownNameError,
            "unknown cue 'smells disc'; valid: sees disc, near",
        ),
        (
            {"transitions": [("wander", "near", "pull")]},
            UnknownNameError,
            "unknown state 'pull'; valid: push, position, wander",
        ),
        (
            {"transitions": [("wander", "near", "push"), ("wander", "near", "position")]},
            InvalidInputError,
            "'wander' has two transitions for 'near'",
        ),
        ({"states": {}, "transitions": []}, InvalidInputError, "needs a state"),
        ({"cues": {"not near": Sees("disc")}}, InvalidInputError, "does not begin with 'not'"),
    ],
)
def test_bad_declarations_are_refused_by_name(changes, error, said):
    with pytest.raises(error, match=said):
        pusher(**changes)


def test_thresholds_must_be_in_order():
    with pytest.raises(InvalidInputError, match="leave at the entering threshold or above"):
        Within("disc", 0.5, leave=0.4)
    with pytest.raises(InvalidInputError, match="leave at the entering threshold or above"):
        Hysteresis(lambda view: np.zeros(1), enter=1.0, leave=0.0)


def test_a_cue_of_a_wrong_shape_is_named():
    machine = StateMachine(
        states={"a": Blend(), "b": Blend()},
        cues={"odd": Condition(lambda view: [True, False])},
        transitions=[("a", "odd", "b")],
    )
    with pytest.raises(InvalidInputError, match="cue 'odd' must give 1 flags"):
        machine.start(1, np.random.default_rng(0)).step({}, 0.0)


def test_what_a_machine_perceives_is_listed():
    assert pusher().percepts == ("disc",)


def test_diagrams_show_states_weights_and_arrows():
    text = pusher().mermaid()
    assert text.startswith("stateDiagram-v2\n    [*] --> wander\n")
    assert "    wander : 0.6 noise\n" in text
    assert "    push : 2 move to disc\n" in text
    assert "    push --> position : not near\n" in text
    graph = pusher().dot()
    assert '"wander" -> "position" [label="sees disc"];' in graph
    assert graph.count("->") == 5  # four transitions and the start
    assert graph.rstrip().endswith("}")


def test_steering_turns_towards_and_goes_ahead_as_far_as_it_faces():
    vector = np.array([[1.0, 0.0], [0.0, 0.5], [-1.0, 0.0], [0.0, 0.0], [3.0, 0.0]])
    command = steer(vector, np.zeros(5), top_speed=0.5, top_turn=2.0, gain=4.0)
    assert command[:, 0] == pytest.approx([0.5, 0.0, 0.0, 0.0, 0.5])
    assert command[:, 1] == pytest.approx([0.0, 2.0, 2.0, 0.0, 0.0])
    assert steer(vector[:1], np.array([0.1]), top_speed=1, top_turn=2)[0, 1] == pytest.approx(-0.4)
    with pytest.raises(InvalidInputError, match="must be positive"):
        steer(vector, np.zeros(5), top_speed=0.0, top_turn=2.0)
