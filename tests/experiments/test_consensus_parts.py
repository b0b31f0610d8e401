"""Study consensus: other rules and laws take its roles, and nonsense is told in one sentence."""

import pytest

from experiments.consensus import study
from mjmr.errors import MjmrError, PartError
from mjmr.parts import PartChoice

HALF = """
import numpy as np

class Half:
    def __init__(self, n):
        self.n = n
    def step(self, heard, weight):
        others = heard & ~np.eye(self.n, dtype=bool)
        gains = 0.5 * others / np.maximum(others.sum(axis=1, keepdims=True), 1)
        return gains + np.diag(1 - gains.sum(axis=1))
"""
STIFF = """
class Stiff:
    def __init__(self, n): pass
    def step(self, velocity, relative, gains):
        import numpy as np
        return -3 * velocity + 2 * np.einsum("ij,ijm->im", gains, np.nan_to_num(relative))
"""
BODY = {"mode": "physical", "duration": 6.0}


def run(role, reference, source=None, **given):
    chosen = study.choose([PartChoice(role, reference, source)])
    return chosen.bound_trial()(study.condition(**given), 1000)


@pytest.mark.parametrize(
    "given",
    [{"duration": 60.0}, BODY, {**BODY, "sight": "rays", "scan": True}],
    ids=["linear", "told", "seen"],
)
def test_another_rule_takes_the_role_wherever_robots_weigh(given):
    published = study.bound_trial()(study.condition(**given), 1000)
    assert run("gains", "half.py:Half", HALF, **given)["spread_m"] < 0.95 * published["spread_m"]
    same = run("gains", "controllers.consensus:NeighbourGains", **given)
    assert same == published


def test_another_law_moves_bodies():
    published = study.bound_trial()(study.condition(**BODY), 1000)
    assert run("law", "stiff.py:Stiff", STIFF, **BODY)["spread_m"] < 0.9 * published["spread_m"]
    same = run("law", "controllers.consensus:RelativeForm", **BODY)
    assert same == published


@pytest.mark.parametrize(
    ("given", "metric"),
    [
        ({"experiment": "moving", "schedule": "star", "side": 4.0, "turn_rate": 0.9,
          "duration": 7.0}, "formation_rms_m"),
        ({"experiment": "agreement", "duration": 0.5}, "distance_rms"),
        ({"experiment": "graph", "robots": 4, "duration": 1.0}, "spread_m"),
    ],
)  # fmt: skip
def test_another_law_reaches_every_experiment_with_bodies(given, metric):
    """Of average, whose robots' ways are not told, the next test."""
    condition = study.condition(mode="physical", **given)
    published = study.bound_trial()(condition, 1000)
    assert run("law", "stiff.py:Stiff", STIFF, **condition)[metric] != published[metric]
    same = run("law", "controllers.consensus:RelativeForm", **condition)
    assert same == published


def test_another_law_drives_robots_that_tell_averages():
    """One that drives them outwards: out of the radio's reach."""
    away = STIFF.replace("2 * np", "-40 * np")
    given = {"mode": "physical", "experiment": "average", "robots": 3, "duration": 4.0}
    published = study.bound_trial()(study.condition(**given), 1000)
    assert run("law", "stiff.py:Stiff", away, **given)["links"] != published["links"]
    same = run("law", "controllers.consensus:RelativeForm", **given)
    assert same == published


def test_rules_of_the_package_take_the_role_of_a_crowd_too():
    crowd = {"experiment": "graph", "robots": 12, "graph": "star", "duration": 2000.0}
    alike = study.bound_trial()(study.condition(**crowd), 1000)
    assert run("gains", "controllers.consensus:EqualGains", **crowd) == alike
    average = run("gains", "controllers.consensus:MetropolisGains", **crowd)
    # the hub is weighted 1 / 12 by all and by itself: slower than half and half
    assert average["agree_s"] > 1.5 * alike["agree_s"]


@pytest.mark.parametrize(
    ("source", "told"),
    [
        (HALF.replace("1 - gains", "1.2 - gains"),
         r"gains half\.py:Half returned at call 0 cannot be: each row of gains sums to one; row 0 "
         r"sums to 1\.2$"),
        (HALF.replace("others = heard &", "others = True |"), "row 0 weights 1, whom it does not"),
        (HALF.replace("0.5 *", "-0.5 *"), r"row 1 gives 0 -0\.5"),
        (HALF.replace("return gains +", "return np.nan * gains +"), "NaN for robots 0, 1, 2"),
    ],
)  # fmt: skip
def test_gains_that_cannot_be_are_told_with_row_and_sum(source, told):
    with pytest.raises(PartError, match=told) as caught:
        run("gains", "half.py:Half", source, duration=10.0)
    assert "\n" not in str(caught.value).strip()


def test_gains_that_cannot_be_are_told_with_tick_and_time():
    late = HALF.replace("return gains +", "return (1 + (heard.sum() > 3)) * gains +")
    given = {**BODY, "sight": "rays", "scan": True}
    with pytest.raises(MjmrError, match=r"at tick \d+ \(\d+\.\d+ s\) cannot be: .* sums to 1\.5"):
        run("gains", "half.py:Half", late, **given)


@pytest.mark.parametrize(
    ("source", "told"),
    [
        ("class Half:\n    def __init__(self): pass\n", "its constructor takes"),
        ("class Half:\n    def __init__(self, n): pass\n", "it has no method step"),
        (HALF.replace("step(self, heard, weight)", "step(self, heard)"), "its method step takes"),
    ],
)
def test_a_class_that_cannot_take_the_role_is_refused_before_a_trial(source, told):
    with pytest.raises(PartError, match=f"cannot be the gains: {told}.*a gains has __init__"):
        study.choose([PartChoice("gains", "half.py:Half", source)])


def test_graphs_that_metropolis_weights_do_not_fit_are_told():
    with pytest.raises(PartError, match="links both ways; 1 hears 0, who does not hear it"):
        run("gains", "controllers.consensus:MetropolisGains", duration=10.0)
