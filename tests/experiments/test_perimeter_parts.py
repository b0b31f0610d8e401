"""Another team in place of the published one."""

import re
from pathlib import Path

import pytest

from experiments.perimeter import study
from mjmr.errors import InvalidInputError, PartError
from mjmr.parts import PartChoice

PAGE = Path(__file__).parents[2] / "docs" / "perimeter.md"
TINY = re.findall(r"```python\n# file: my.py\n(.*?)```", PAGE.read_text(), re.DOTALL)[0]
"""The page's own: everybody follows the edge it starts on."""


def run(source, name="Mine", seconds=35.0, **values):
    chosen = study.choose([PartChoice("team", f"mine.py:{name}", source)])
    return chosen.bound_trial()(
        study.condition(task="stay", start="bunch", mode="unicycle", duration=seconds, **values),
        1000,
    )


def test_a_tiny_team_needs_states_and_a_step_alone():
    found = run(TINY)
    assert found["all_track"]
    assert found["last_joined_s"] < 0.5
    assert 0.0 < found["rms_m"] < 0.05
    assert found["anticlockwise_rad"] > 0.5
    # what it says nothing of
    assert (found["by_relay"], found["most_hops"], found["desired_m"]) == (0, 0, -1.0)


def test_what_the_trial_works_out_is_what_the_published_team_says():
    published = """
from controllers.perimeter import PerimeterTeam


class Mine:
    def __init__(self, n, config, rng):
        self._team = PerimeterTeam(n, config, rng)
        self.speak = self._team.speak

    @property
    def state(self):
        return self._team.state

    def step(self, now):
        return self._team.step(now)
"""
    values = {
        "task": "stay", "start": "even", "robots": 2, "failure": "added", "mode": "unicycle",
        "duration": 106.0,
    }  # fmt: skip
    theirs = study.bound_trial()(study.condition(**values), 1001)
    chosen = study.choose([PartChoice("team", "mine.py:Mine", published)])
    mine = chosen.bound_trial()(study.condition(**values), 1001)
    unlike = {k for k in theirs if theirs[k] != mine[k]}
    assert theirs["by_relay"] == theirs["own_finders"] == 1
    assert unlike <= {"most_hops", "desired_m"}


@pytest.mark.parametrize(
    ("source", "name", "words"),
    [
        (TINY, "Yours", "Yours"),
        ("class Mine:\n    def __init__(self, n, config, rng): ...", "Mine",
         "it has no method step; a team has __init__(n, config, rng) and step(now) -> (n, 2)"),
        (TINY.replace("(self, n, config, rng)", "(self, n)"), "Mine", "its constructor takes"),
        (TINY.replace("(self, now)", "(self)"), "Mine", "its method step takes (self)"),
    ],
)  # fmt: skip
def test_a_class_that_cannot_be_a_team_is_refused_in_one_sentence(source, name, words):
    with pytest.raises(PartError) as e:
        run(source, name)
    assert words in str(e.value)
    assert "\n" not in str(e.value)


@pytest.mark.parametrize(
    ("source", "words"),
    [
        (TINY.replace("self.state = np.full(n, 3)", ""), "got none"),
        (TINY.replace("np.full(n, 3)", "np.full(n, 4)"), "whole numbers from 0 to 3"),
        (TINY.replace("np.full(n, 3)", "np.full(n + 1, 3)"), "an array of 5 whole numbers"),
        (TINY.replace("np.full(n, 3)", "np.full(n, 3.0)"), "whole numbers"),
        (TINY + "\n    def speak(self, now):\n        return np.zeros((5, 2))\n",
         "speaks arrays of shape (5, 11)"),
    ],
)  # fmt: skip
def test_states_and_words_that_cannot_be_read_are_told(source, words):
    with pytest.raises(InvalidInputError) as e:
        run(source, seconds=2.0)
    assert words in str(e.value)


def test_a_step_that_returns_nonsense_names_the_truck_and_the_tick():
    odd = TINY.replace("return np.column_stack", "turn[2] = np.nan\n        return np.column_stack")
    with pytest.raises(PartError, match=r"team mine.py:Mine returned NaN for robot 2 at tick"):
        run(odd, seconds=2.0)


def test_a_team_that_cannot_be_told_is_not_run_with_a_lie():
    with pytest.raises(InvalidInputError, match="the team needs a method tell"):
        run(TINY, seconds=8.0, failure="lie")


def test_show_lists_what_a_team_must_have():
    part = study.parts[0]
    assert part.interface == "__init__(n, config, rng) and step(now) -> (n, 2) " \
        "[m/s and rad/s, forward and turn]"  # fmt: skip
    assert {words.split()[0] for words in part.optional} == {
        "joined", "told", "sensed", "hops", "desired",
    }  # fmt: skip
