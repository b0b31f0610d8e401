import json
import pickle

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mjmr.conditions import (
    Condition,
    Grid,
    Parameter,
    complete,
    condition_key,
    format_value,
    parse_condition,
    parse_filter,
)
from mjmr.errors import InvalidInputError, UnknownNameError

PARAMETERS = (
    Parameter("scene", "where", "A", values=("A", "cross4", "cross10")),
    Parameter("sigma", "noise", 0.0, unit="m"),
    Parameter("robots", "how many", 4),
    Parameter("search", "whether", True),
    Parameter("note", "free text", "none"),
)
# A busy machine says nothing about the code.
relaxed = settings(suppress_health_check=[HealthCheck.too_slow], deadline=None)
conditions = st.fixed_dictionaries(
    {},
    optional={
        "scene": st.sampled_from(("A", "cross4", "cross10")),
        "sigma": st.floats(allow_nan=False, allow_infinity=False),
        "robots": st.integers(),
        "search": st.booleans(),
        "note": st.text(st.characters(exclude_characters=",", exclude_categories=("Cs",))),
    },
)


@relaxed
@given(conditions)
def test_key_reads_back_to_the_same_condition(given_values):
    condition = complete(PARAMETERS, given_values)
    again = Condition(json.loads(condition.key))
    assert again == condition
    assert hash(again) == hash(condition)
    assert condition_key(again) == condition.key
    assert {n: (type(v), v) for n, v in again.items()} == {
        n: (type(v), v) for n, v in condition.items()
    }
    assert pickle.loads(pickle.dumps(condition)) == condition


@relaxed
@given(conditions)
def test_what_is_written_is_parsed_back(given_values):
    condition = complete(PARAMETERS, given_values)
    texts = [f"{name}={format_value(value)}" for name, value in condition.items()]
    assert parse_condition(PARAMETERS, texts) == condition


@relaxed
@given(conditions, conditions)
def test_keys_are_equal_exactly_if_the_values_are(a, b):
    x, y = complete(PARAMETERS, a), complete(PARAMETERS, b)
    assert (x.key == y.key) == (dict(x) == dict(y))


def test_defaults_are_filled_in_and_order_does_not_matter():
    a = complete(PARAMETERS, {"sigma": 1, "scene": "A"})
    b = complete(PARAMETERS, {"scene": "A", "sigma": np.float64(1.0)})
    assert list(a) == [p.name for p in PARAMETERS]
    assert a.key == b.key
    assert a["robots"] == 4


def test_minus_zero_is_zero():
    assert complete(PARAMETERS, {"sigma": -0.0}).key == complete(PARAMETERS, {"sigma": 0}).key


def test_a_condition_cannot_be_changed():
    condition = complete(PARAMETERS, {})
    with pytest.raises(TypeError):
        condition["sigma"] = 1.0  # pyright: ignore


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("sgima=1", "valid: sigma"),
        ("scene=cros4", "valid: cross4"),
        ("sigma=much", "sigma takes a number"),
        ("sigma=nan", "sigma takes a finite number"),
        ("robots=1.5", "robots takes a whole number"),
        ("search=maybe", "search takes true or false"),
        ("sigma", "key=value"),
        ("=1", "unknown condition"),
    ],
)
def test_bad_filters_say_what_is_valid(text, names):
    with pytest.raises(InvalidInputError, match=names) as e:
        parse_filter(PARAMETERS, [text])
    assert "\n" not in str(e.value)


def test_filters_are_typed_and_not_given_twice():
    found = parse_filter(PARAMETERS, ["sigma=0,1e-3,0", "search=off,true"])
    assert found == {"sigma": (0.0, 1e-3), "search": (False, True)}
    assert all(type(v) is float for v in found["sigma"])
    with pytest.raises(InvalidInputError, match="twice"):
        parse_filter(PARAMETERS, ["sigma=0", "sigma=1"])
    with pytest.raises(InvalidInputError, match="one value"):
        parse_condition(PARAMETERS, ["sigma=0,1"])


def test_grid_is_the_product_over_defaults():
    found = Grid(sigma=[1, 2], scene=("A", "cross4"), search=False).conditions(PARAMETERS)
    assert [(c["scene"], c["sigma"]) for c in found] == [
        ("A", 1.0),
        ("A", 2.0),
        ("cross4", 1.0),
        ("cross4", 2.0),
    ]
    assert all(c["search"] is False and c["robots"] == 4 for c in found)


@pytest.mark.parametrize("bad", [{"sgima": 1}, {"scene": "B"}, {"search": 1}, {"robots": True}])
def test_grid_refuses_what_is_not_declared(bad):
    with pytest.raises(InvalidInputError):
        Grid(**bad).conditions(PARAMETERS)


@pytest.mark.parametrize(
    "build",
    [
        lambda: Grid(seeds=0),
        lambda: Grid(sigma=[]),
        lambda: Parameter("seeds", "", 1),
        lambda: Parameter("two words", "", 1),
        lambda: Parameter("x", "", 1, values=(2, 3)),
        lambda: Parameter("x", "", 1, values=(1, 1)),
        lambda: Parameter("x", "", float("inf")),
        lambda: Parameter("x", "", None),  # pyright: ignore
        lambda: Parameter("x", "", 1.0, least=2.0),
    ],
)
def test_declarations_that_contradict_themselves_are_refused(build):
    with pytest.raises(InvalidInputError):
        build()


def test_reading_an_undeclared_name_lists_those_there_are():
    with pytest.raises(UnknownNameError, match="valid: sigma"):
        complete(PARAMETERS, {})["sgima"]


def test_numbers_below_the_least_are_refused():
    parameter = Parameter("duration", "", 1.0, unit="s", least=0.05)
    assert parameter.parse("0.05") == 0.05
    with pytest.raises(InvalidInputError, match=r"duration must be at least 0.05 s; got -1 s"):
        parameter.parse("-1")
