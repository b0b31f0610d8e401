import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from mjmr.cli import main
from mjmr.compare import compare, to_text
from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.executor import compute
from mjmr.parts import Job, PartChoice
from mjmr.runner import RunOptions, run_study
from mjmr.store import Outcome, Store, StoreError
from tests.toy_parts import study

REFERENCE = "tests.toy_parts:study"
FULL = (PartChoice("mover", "tests.toy_parts:Full"),)


def meta(**changes):
    found = {"digest": "1", "study": "toy-parts", "reference": REFERENCE, "size": "quick"}
    return {**found, "parts": [], "versions": {"numpy": "2.0"}, **changes}


def save(folder, values, **changes):
    """Results in which trials ``(speed, seed)`` have these metrics, or failed with this text."""
    with Store(folder, meta(**changes)) as store:
        for (speed, seed), found in values.items():
            condition = study.condition(speed=speed)
            if isinstance(found, str):
                store.record(Outcome(condition, seed, "failed", error=found))
            else:
                store.record(Outcome(condition, seed, "ok", found, {"wall_trial": seed + 1.0}))
    return folder


def seeds(values, speed=0.4, metric="way"):
    return {(speed, k): {metric: v} for k, v in enumerate(values)}


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Quick runs of the published part and of another."""
    base = tmp_path_factory.mktemp("runs")
    for name, parts in (("slow", ()), ("full", FULL)):
        options = RunOptions(study=REFERENCE, workers=1, film=False, out=base / name, parts=parts)
        run_study(options)
    return base / "slow", base / "full"


def by_metric(comparison):
    return {row.metric: row for row in comparison.rows}


def test_a_run_against_another_part(runs):
    found = compare(*runs)
    assert (found.pairs, found.only_a, found.only_b, found.warnings) == (16, 0, 0, [])
    rows = by_metric(found)
    assert list(rows) == ["way", "drift", "far", "slow_only"]  # numbers alone, in order
    way = rows["way"]
    assert way.a == pytest.approx(0.6)
    assert way.b == pytest.approx(1.2)
    assert way.n == 16
    assert way.difference == pytest.approx(0.6)
    assert way.low < way.difference < way.high
    assert rows["slow_only"].n == 8
    assert rows["slow_only"].p == 1.0
    assert found.changed == {"slow": ("holds", "fails")}
    assert found.b.parts == "mover=tests.toy_parts:Full"


def test_the_statistics_are_those_of_the_pairs(tmp_path):
    rng = np.random.default_rng(3)
    a = rng.normal(size=12)
    b = a + rng.normal(0.4, 0.3, size=12)
    one = save(tmp_path / "a", seeds(a))
    two = save(tmp_path / "b", dict(reversed(seeds(b).items())))
    (row,) = compare(one, two).rows
    assert row.difference == pytest.approx(np.mean(b - a))
    assert row.p == pytest.approx(stats.wilcoxon(a, b).pvalue)  # pyright: ignore
    assert row.low < row.difference < row.high
    assert row.high - row.low < 1.0  # unpaired it would be about 1.6
    back = compare(two, one).rows[0]
    assert (back.difference, back.p) == (pytest.approx(-row.difference), row.p)


def test_pairs_have_the_same_condition_and_seed_and_are_finished_in_both(tmp_path):
    one = save(tmp_path / "a", {**seeds([1, 2, 3, 4]), (0.8, 1): {"way": 50}, (0.8, 2): "lost"})
    two = save(tmp_path / "b", {**seeds([2, 2, 5]), (0.8, 0): {"way": 90}, (0.8, 2): {"way": 1}})
    found = compare(one, two)
    assert (found.pairs, found.only_a, found.only_b) == (3, 2, 2)
    assert (found.a.count("failed"), found.b.count("failed")) == (1, 0)
    (row,) = found.rows
    assert (row.a, row.b, row.difference, row.n) == (2.0, 3.0, 1.0, 3)


def test_values_that_are_no_finite_numbers_drop_out_in_pairs(tmp_path):
    odd = [1.0, float("nan"), 3.0, None, "four", 6.0]
    one = save(tmp_path / "a", seeds(odd))
    two = save(tmp_path / "b", seeds([2.0, 2.0, float("inf"), 2.0, 2.0, 2.0]))
    (row,) = compare(one, two).rows
    assert (row.a, row.b, row.n) == (3.5, 2.0, 2)


def test_splitting_filtering_and_choosing(runs):
    split = compare(*runs, by=["speed"], metrics=["way", "far"])
    assert [(r.group, r.metric) for r in split.rows] == [
        ({"speed": speed}, metric) for speed in (0.4, 0.8) for metric in ("way", "far")
    ]
    fast = compare(*runs, only=["speed=0.8"], metrics=["way"])
    assert (fast.pairs, fast.rows[0].a) == (8, pytest.approx(0.8))
    assert split.rows[2].a == fast.rows[0].a
    (wall,) = compare(*runs, metrics=["wall_step_us"]).rows
    assert (wall.a, wall.n) == (4.5, 16)


def test_p_is_adjusted_for_the_number_of_comparisons(tmp_path):
    """Holm by hand: 4 x the least, 3 x the second, and so on, never falling, at most 1."""
    a = {(0.4, k): {"w": 0.0, "x": 0.0, "y": 0.0, "z": 0.0} for k in range(10)}
    signs = {"w": 10, "x": 9, "y": 8, "z": 5}
    b = {
        (0.4, k): {m: (k + 1.0) * (1 if k < s else -1) for m, s in signs.items()} for k in range(10)
    }
    rows = by_metric(compare(save(tmp_path / "a", a), save(tmp_path / "b", b)))
    p = {m: rows[m].p for m in signs}
    assert p["w"] == pytest.approx(2 / 2**10)
    ordered = sorted(signs, key=lambda m: p[m])
    least = 0.0
    for factor, metric in zip((4, 3, 2, 1), ordered, strict=True):
        least = max(least, min(1.0, factor * p[metric]))
        assert rows[metric].p_holm == pytest.approx(least)
    assert rows["w"].p_holm > p["w"]


def test_what_differs_beside_the_parts_is_told(tmp_path, runs):
    base = {"digest": "1", "digest_of_published": "0"}
    one = save(tmp_path / "a", seeds([1, 2]), **base)
    for name, changes, told in (
        ("same", base, "both runs are of the same configuration, source and parts"),
        ("parts", {**base, "digest": "2"}, None),
        ("code", {"digest": "2", "digest_of_published": "3"}, "differ in more than the parts"),
        ("size", {**base, "size": "full"}, "the runs are of sizes quick and full"),
        ("numpy", {**base, "digest": "2", "versions": {"numpy": "3"}}, "numpy is 2.0 in the first"),
    ):
        warnings = compare(one, save(tmp_path / name, seeds([1, 3]), **changes)).warnings
        claims = [w for w in warnings if "has no claims to compare" in w]
        others = [w for w in warnings if w not in claims]
        assert len(claims) == 2
        assert len(others) == (told is not None)
        assert told is None or told in others[0]


def test_claims_that_cannot_be_read_are_no_changed_verdicts(tmp_path, runs):
    copy = tmp_path / "copy"
    shutil.copytree(runs[1], copy)
    for text in ("{", "[3]", None):
        (copy / "claims.json").unlink()
        if text is not None:
            (copy / "claims.json").write_text(text)
        found = compare(runs[0], copy)
        assert found.changed == {}
        assert any(f"{copy} has no claims" in w for w in found.warnings)
        (copy / "claims.json").touch()


def test_bad_input(tmp_path, runs):
    one = save(tmp_path / "a", seeds([1, 2]))
    with pytest.raises(StoreError, match="no results in nowhere"):
        compare(one, Path("nowhere"))
    (tmp_path / "empty").mkdir()
    with pytest.raises(StoreError, match="no results in"):
        compare(tmp_path / "empty", one)
    with pytest.raises(InvalidInputError, match="one study are compared, not toy-parts and other"):
        compare(one, save(tmp_path / "other", seeds([1]), study="other"))
    with pytest.raises(InvalidInputError, match="no trial is finished in both"):
        compare(one, save(tmp_path / "b", seeds([1, 2], speed=0.8)))
    with pytest.raises(InvalidInputError, match="no trial with speed=0.8 is finished in both"):
        compare(one, one, only=["speed=0.8"])
    with pytest.raises(UnknownNameError, match="unknown condition 'sped'; valid: speed"):
        compare(*runs, by=["sped"])
    with pytest.raises(UnknownNameError, match="unknown condition 'sped'"):
        compare(*runs, only=["sped=1"])
    with pytest.raises(UnknownNameError, match="unknown metric 'wai'; valid: way"):
        compare(*runs, metrics=["wai"])
    with pytest.raises(InvalidInputError, match="metric name is nowhere a finite number"):
        compare(*runs, metrics=["name"])


def test_nothing_is_written_to_the_folders(runs):
    before = {p: (p.stat().st_mtime_ns, p.stat().st_size) for r in runs for p in r.iterdir()}
    compare(*runs)
    assert {
        p: (p.stat().st_mtime_ns, p.stat().st_size) for r in runs for p in r.iterdir()
    } == before


def test_files_hold_what_was_found(tmp_path, runs):
    found = compare(*runs, by=["speed"])
    read = json.loads(to_text(found, Path("x.json")))
    assert read["pairs"] == 16
    assert read["b"]["meta"]["parts"][0]["reference"] == "tests.toy_parts:Full"
    assert read["verdicts_changed"] == {"slow": {"a": "holds", "b": "fails"}}
    assert [r["difference"] for r in read["metrics"]] == [r.difference for r in found.rows]
    lines = to_text(found, Path("x.csv")).splitlines()
    assert lines[0] == "speed,metric,a,b,difference,low,high,n,p,p_holm"
    assert len(lines) == 1 + len(found.rows)
    assert [float(v) for v in lines[1].split(",")[2:5]] == [
        found.rows[0].a,
        found.rows[0].b,
        found.rows[0].difference,
    ]


def test_what_is_printed(tmp_path, runs, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "140")
    assert main(["compare", *map(str, runs)]) == 0
    out = capsys.readouterr().out
    assert "toy-parts: 16 pairs of trials" in out
    assert "4 comparisons: p < 0.01 in 1, after Holm's adjustment in 0" in out
    assert "slow: holds -> fails" in out
    lost = save(tmp_path / "a", {**seeds([1, 2]), (0.8, 1): "lost"})
    assert main(["compare", str(lost), str(save(tmp_path / "b", seeds([1, 2, 3])))]) == 0
    out = capsys.readouterr().out
    assert "1 trials failed in A" in out
    assert "1 trials finished in B alone and are left out" in out
    assert "comparisons" not in out
    assert "verdicts" not in out
    assert main(["compare", str(runs[0]), str(runs[0])]) == 0
    assert "verdicts of the whole runs: all 2 the same" in capsys.readouterr().out
    assert main(["compare", *map(str, runs), "--out", str(tmp_path / "no/where.json")]) == 2
    assert "cannot write" in capsys.readouterr().err


def test_trials_of_a_folder_are_what_the_study_computes(runs):
    """The pairs compared are the runs' own trials, not something like them."""
    condition = study.condition(speed=0.8)
    fresh = compute(Job(REFERENCE, FULL), condition, 3)
    assert compare(*runs).b.outcomes[condition, 3].metrics["way"] == fresh.metrics["way"]
