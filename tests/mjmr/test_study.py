from dataclasses import replace

import pytest

from mjmr import registry
from mjmr.conditions import Grid, Parameter
from mjmr.errors import InvalidInputError, MjmrError, UnknownNameError
from mjmr.registry import load_study, study_references
from mjmr.study import Size, resolve
from tests.toy_study import study


def test_trials_are_each_there_once_in_a_fixed_order():
    sizes = (Size("quick", (Grid(bias=(0.5, 0.9)), Grid(seeds=3, bias=0.5)), 2, 0.1),)
    trials = replace(study, sizes=sizes).trials("quick")
    assert [(c["bias"], s) for c, s in trials] == [
        (0.5, 0),
        (0.9, 0),
        (0.5, 1),
        (0.9, 1),
        (0.5, 2),
    ]
    assert len(set(trials)) == len(trials)


def test_seeds_and_conditions_can_be_chosen():
    assert {s for _, s in study.trials("quick", seeds=7)} == set(range(7))
    chosen = study.trials("quick", only={"bias": (0.5,), "mode": ("physical",)})
    assert [(c["bias"], c["mode"], s) for c, s in chosen] == [
        (0.5, "physical", 0),
        (0.5, "physical", 1),
    ]
    few = study.trials("quick", seeds=2)
    assert set(few) <= set(study.trials("quick"))


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("quik",), "valid: quick"),
        (("quick", 0), "at least 1"),
        (("quick", None, {"bia": (0.5,)}), "valid: bias"),
        (("quick", None, {"bias": (0.7,)}), "value of bias"),
        (("quick", None, {"bias": (0.9,), "mode": ("physical",)}), "no condition with bias=0.9"),
    ],
)
def test_bad_choices_are_refused(arguments, said):
    with pytest.raises(InvalidInputError, match=said):
        study.trials(*arguments)


def test_digest_follows_everything_a_result_depends_on(monkeypatch):
    base = study.digest("quick")
    assert replace(study).digest("quick") == base
    other_grid = (*study.sizes[1:], Size("quick", (Grid(bias=1.0),), 4, 0.1))
    other_parameter = (*study.parameters, Parameter("new", "", 1))
    changed = [
        study.digest("standard"),
        replace(study, name="other").digest("quick"),
        replace(study, sizes=other_grid).digest("quick"),
        replace(study, parameters=other_parameter).digest("quick"),
        replace(study, trial="tests.toy_study:claims").digest("quick"),
        replace(study, source_packages=("controllers",)).digest("quick"),
    ]
    monkeypatch.setattr("mjmr.provenance.versions", lambda: {"numpy": "0"})
    changed.append(study.digest("quick"))
    assert len({base, *changed}) == 1 + len(changed)
    later = replace(study.sizes[0], expected_minutes=9.0, note="slow")
    monkeypatch.undo()
    assert replace(study, sizes=(later, *study.sizes[1:])).digest("quick") == base


def test_sources_and_models_count_by_default():
    whole = replace(study, source_packages=None)
    assert whole.package == "tests"
    assert whole.digest("quick") != study.digest("quick")
    assert whole.digest("quick") == whole.digest("quick")


def test_claims_are_checked(monkeypatch):
    claims = study.load_claims()
    with pytest.raises(InvalidInputError, match="twice"):
        replace(study, claims=[claims[0], claims[0]]).load_claims()
    with pytest.raises(UnknownNameError, match="unknown size"):
        replace(study, claims=[replace(claims[0], sizes=("huge",))]).load_claims()


def test_declarations_that_contradict_themselves_are_refused():
    with pytest.raises(InvalidInputError, match="declared twice"):
        replace(study, parameters=(*study.parameters, study.parameters[0]))
    with pytest.raises(InvalidInputError, match="declared twice"):
        replace(study, sizes=(*study.sizes, study.sizes[0]))
    with pytest.raises(InvalidInputError):
        Size("quick", (), 1, 1.0)


@pytest.mark.parametrize(
    "reference", ["tests.toy_study", "tests.nowhere:x", "tests.toy_study:nothing", ":x"]
)
def test_references_that_lead_nowhere_say_so(reference):
    with pytest.raises(MjmrError):
        resolve(reference)


def test_studies_are_found_by_name(monkeypatch):
    monkeypatch.setenv("MJMR_STUDIES", "toy=tests.toy_study:study toy-die=tests.toy_study:dying")
    assert load_study("toy") is study
    assert load_study("tests.toy_study:study") is study
    with pytest.raises(UnknownNameError, match="valid: toy, "):
        load_study("tyo")


def test_a_name_taken_twice_is_an_error(monkeypatch):
    monkeypatch.setenv("MJMR_STUDIES", "toy=tests.toy_study:study toy=tests.toy_study:dying")
    with pytest.raises(MjmrError, match="two studies are called 'toy'"):
        study_references()
    monkeypatch.setenv("MJMR_STUDIES", "toy=tests.toy_study:study toy=tests.toy_study:study")
    assert study_references()["toy"] == "tests.toy_study:study"


@pytest.mark.parametrize(
    ("entries", "said"),
    [
        ("toy", "expected name=package.module:attribute"),
        ("wrong=tests.toy_study:study", "calls itself 'toy'"),
        ("wrong=tests.toy_study:trial", "is not a Study"),
    ],
)
def test_bad_registrations_say_what_is_wrong(monkeypatch, entries, said):
    monkeypatch.setenv("MJMR_STUDIES", entries)
    with pytest.raises(MjmrError, match=said):
        registry.load_study("wrong")
