"""The study: its trials run, its claims have trials, its page shows its machines."""

import re
from pathlib import Path

import numpy as np
import pytest

from controllers.scouting import Behaviour, machine
from controllers.scouting.diagram import state_machine
from experiments.scout_workers import study
from experiments.scout_workers.evidence import points_lost, ratio_of_medians
from experiments.scout_workers.trial import trial
from mjmr.claims import judge
from mjmr.conditions import Grid
from mjmr.errors import InvalidInputError
from mjmr.table import Row, Table

PAGE = Path(__file__).resolve().parents[2] / "docs" / "scout-workers.md"


def run(seed=1003, **given):
    return trial(study.condition(**given), seed)


def table(metrics, seeds=None, **varied):
    conditions = Grid(**varied).conditions(study.parameters)
    if seeds is None:
        rows = [Row(c, 0, "ok", m) for c, m in zip(conditions, metrics, strict=True)]
    else:
        rows = [Row(conditions[0], s, "ok", m) for s, m in zip(seeds, metrics, strict=True)]
    return Table(rows, study.parameters)


def claim(name):
    (found,) = [c for c in study.load_claims() if c.id == name]
    return found


def test_every_claim_has_trials_at_the_sizes_that_decide_it():
    for size in ("quick", "standard", "full"):
        conditions = {condition for condition, _ in study.trials(size)}
        for c in study.load_claims():
            wanted = {k: v if isinstance(v, tuple) else (v,) for k, v in c.needs.items()}
            there = any(all(x[k] in v for k, v in wanted.items()) for x in conditions)
            assert there or size not in c.sizes, (size, c.id)


@pytest.mark.parametrize("given", [
    {}, {"experiment": "open"}, {"experiment": "trap", "depth": 0.1},
    {"mode": "radio", "experiment": "phase"}, {"failure": "ir-dead"},
    {"experiment": "scaling", "robots": 4, "finish": "remove", "forced": 4},
    {"experiment": "succession", "robots": 5, "finish": "remove", "succession": "both",
     "release": 40.0},
])  # fmt: skip
def test_same_seed_same_numbers(given):
    first = run(**given)
    np.random.seed(5)  # noqa: NPY002 - nothing may depend on the global state
    again = run(**given)
    kept = {k for k in first if not k.startswith("wall_")}
    assert {k: first[k] for k in kept} == {k: again[k] for k in kept}
    plain = (float, int, str, bool, type(None))
    assert all(type(v) in plain for v in first.values()), first


def test_a_mode_without_the_experiment_is_refused():
    with pytest.raises(InvalidInputError, match="phase is of mode radio; got planar"):
        run(experiment="phase")
    with pytest.raises(InvalidInputError, match="trap is of mode planar; got physical"):
        run(mode="physical", experiment="trap")


def test_a_scout_without_a_worker_is_refused():
    with pytest.raises(InvalidInputError, match="robots"):
        study.condition(robots=1)


def test_the_vector_is_exact_and_a_wrong_reckoning_is_found_out(monkeypatch):
    given = {"experiment": "open", "compass": "exact", "servo_pct": 0.0}
    good = run(**given)
    assert good["error_units"] < 1e-9
    noisy = run(**{**given, "servo_pct": 5.0})
    assert noisy["error_units"] > 0.1
    c = claim("vector-exact")
    verdicts = [judge(c, table([m], **given), "quick").verdict for m in (good, noisy)]
    assert verdicts == ["holds", "fails"]


def test_the_period_is_measured_not_computed():
    c = claim("period-140")
    given = {"mode": "radio", "experiment": "phase"}
    good = run(**given)
    assert judge(c, table([good], **given), "quick").verdict == "holds"
    other = run(**given, spacing_ms=5.0, pause_ms=19.0)
    assert judge(c, table([other], **given), "quick").verdict == "fails"
    jittery = run(**given, jitter_ms=1.0)
    assert judge(c, table([jittery], **given), "quick").verdict == "fails"


def test_checks_compared():
    given = {"mode": "radio", "experiment": "codes"}
    assert [run(**given)[k] for k in ("swapped", "late", "zeros")] == [0, 0, 0]
    one = run(**given, check="crc8-one-seed")
    assert one["swapped"] == 128 * 128, "every message whose two values could be either"
    assert one["zeros"] == 1


def test_the_ratio_is_of_medians_and_leaves_out_who_did_not_arrive():
    rows = [{"worker_s": w, "scout_s": s}
            for w, s in ((10.0, 40.0), (20.0, 50.0), (30.0, 60.0), (None, 900.0))]  # fmt: skip
    found = ratio_of_medians(table(rows, seeds=range(4), maze="m3"))
    assert found.measured == pytest.approx(20 / 50)
    assert found.n == 3
    assert "1 of 4" in found.why


def test_points_lost_are_paired_by_seed():
    rows = [Row(study.condition(compass_deg=step), seed, "ok", {"success": won})
            for step, seeds in ((2.0, (1, 1, 1, 0)), (15.0, (1, 0, 1)))
            for seed, won in enumerate(map(bool, seeds))]  # fmt: skip
    found = points_lost(Table(rows, study.parameters), {"compass_deg": 2.0}, {"compass_deg": 15.0})
    assert (found.measured, found.n) == (pytest.approx(1 / 3), 3)


def test_the_page_shows_the_machines_that_run():
    diagrams = re.findall(r"^```mermaid\n(.*?)^```", PAGE.read_text(), re.M | re.S)
    b = Behaviour()
    assert diagrams == [state_machine(m(b)).mermaid() for m in (machine.scout, machine.worker)]
