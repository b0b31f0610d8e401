"""The checks of pushing: they measure what they say, and can fail. Seeds here decide nothing."""

import numpy as np
import pytest

from experiments.versatile_pushing import claims_pushing, pushing, sizes
from mjmr.claims import judge_all
from mjmr.conditions import Parameter
from mjmr.robots.round_pusher import RoundPusher
from mjmr.table import Row, Table

PARAMETERS = (
    Parameter("task", "which check", "stall", tuple(pushing.TESTS)),
    Parameter("weight", "of the disc", 1),
    Parameter("heading_deg", "of the push", 0.0),
    Parameter("off_normal_deg", "of a wedging robot", 0.0),
    Parameter("dt_ms", "timestep", 10.0),
)
BASE = {"weight": 1, "heading_deg": 0.0, "off_normal_deg": 60.0, "dt_ms": 10.0}


def run(task, seed=1000, **given):
    return pushing.TESTS[task]({"task": task} | BASE | given, seed)


def weigh(monkeypatch, spare):
    """Let discs resist ``spare`` of a push beyond w of them."""
    monkeypatch.setattr(pushing, "SPARE", spare)


def test_a_weight_of_w_resists_w_pushes_and_six_tenths():
    np.testing.assert_allclose(
        [pushing.friction_force(w) / RoundPusher.push_force for w in (0, 1, 2)], [0.6, 1.6, 2.6]
    )


@pytest.mark.parametrize("dt_ms", [10.0, 5.0])
def test_one_robot_pushes_as_hard_as_stated_in_any_direction(dt_ms):
    for seed in (1000, 1001, 1002):
        assert abs(run("stall", seed, dt_ms=dt_ms)["error_pct"]) < 2.0


@pytest.mark.parametrize("weight", [1, 2])
def test_as_many_robots_as_the_weight_do_not_move_it(weight):
    metrics = run("held", weight=weight, heading_deg=22.0)
    assert metrics["push_share"] == pytest.approx(1.0, abs=0.01)
    assert metrics["creep_mm"] < 15.0
    assert metrics["arrival_mm"] < 50.0


@pytest.mark.parametrize("weight", [0, 1, 2])
def test_one_robot_more_moves_it(weight):
    assert run("moved", weight=weight, heading_deg=45.0)["way"] > 2.0
    from_rest = run("moved-from-rest", weight=weight)["way"]
    assert 1.5 < from_rest < run("moved", weight=weight)["way"]


def test_wedging_is_measured():
    assert 0.0 < run("wedged")["way"] < 0.4


def test_the_checks_fail_where_they_should(monkeypatch):
    """Discs that resist less than w pushes are not held, those that resist w + 1 are not moved."""
    weigh(monkeypatch, -0.1)
    assert run("held", weight=2)["creep_mm"] > 1000.0
    # a run-up carries them on a little
    weigh(monkeypatch, 1.6)
    assert run("moved", weight=1)["way"] < 0.2
    weigh(monkeypatch, 0.6)
    monkeypatch.setattr(RoundPusher, "push_force", 11.0)
    assert run("stall")["error_pct"] > 5.0


def test_seeds_draw_directions_and_the_same_seed_the_same_numbers():
    first = run("moved", 1000)
    assert run("moved", 1000) == first
    assert run("moved", 1001) != first


def test_claims_decide_what_the_trials_say():
    rows = []
    for grid in sizes.pushing_grids(1, timesteps=(10.0,)):
        for condition in grid.conditions(PARAMETERS):
            metrics = {"error_pct": 0.1, "creep_mm": 1.0, "arrival_mm": 10.0, "push_share": 1.0,
                       "way": 0.1 if "wedged" in condition["task"] else 2.2}  # fmt: skip
            rows.append(Row(condition, 0, "ok", metrics))
    verdicts = {
        v.claim.id: v.verdict
        for v in judge_all(claims_pushing.claims_pushing(), Table(rows, PARAMETERS), "quick")
    }
    # one timestep alone compares nothing
    assert verdicts.pop("push-timestep") == "not testable"
    assert set(verdicts.values()) == {"holds"}
    worse = [r for r in rows if r.condition["task"] == "held"][:1]
    rows.append(Row(worse[0].condition, 1, "ok", dict(worse[0].metrics) | {"creep_mm": 16.0}))
    again = judge_all(claims_pushing.claims_pushing(), Table(rows, PARAMETERS), "quick")
    found = {v.claim.id: (v.verdict, v.measured) for v in again}
    assert found["push-held"] == ("fails", 16.0)
    assert found["push-held-arrival"] == ("holds", 10.0)


def test_claims_rest_on_trials_that_every_size_makes():
    tasks = {grid.values["task"] for grid in sizes.pushing_grids(1)}
    told = {t for task in tasks for t in (task if isinstance(task, tuple) else (task,))}
    assert told == set(pushing.TESTS)
    for claim in claims_pushing.claims_pushing():
        assert claim.needs["task"] in told
