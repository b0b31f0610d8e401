import csv
import hashlib
import math
import os
import signal
import sqlite3
import struct
import subprocess
import sys
import time

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mjmr.conditions import Condition
from mjmr.export import export
from mjmr.store import (
    Outcome,
    Store,
    StoreError,
    decode,
    encode,
    read_meta,
    read_outcomes,
    set_aside,
)

META = {"digest": "d" * 64, "study": "toy", "size": "quick"}
A, B = Condition({"x": 1.0}), Condition({"x": 2.0})


def snapshot(folder):
    return {
        str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest()
        for p in sorted(folder.rglob("*"))
        if p.is_file()
    }


def ok(condition, seed, **metrics):
    return Outcome(condition, seed, "ok", metrics, {"wall_trial": 0.5})


def bits(value):
    return struct.pack("<d", value) if isinstance(value, float) else value


# The character tables hypothesis builds at first use can take seconds on a busy machine.
@settings(suppress_health_check=[HealthCheck.too_slow], deadline=None)
@given(
    st.dictionaries(
        st.text(st.characters(exclude_categories=("Cs",))),
        st.one_of(st.floats(allow_nan=False), st.integers(), st.booleans(), st.text(), st.none()),
    )
)
def test_metrics_read_back_bit_for_bit(metrics):
    text = encode(metrics)
    again = decode(text)
    assert list(again) == list(metrics)
    assert {n: (type(v), bits(v)) for n, v in again.items()} == {
        n: (type(v), bits(v)) for n, v in metrics.items()
    }
    for word in ("NaN", "Infinity"):
        assert word not in text or any(word in str(x) for x in metrics.items())


def test_numbers_json_has_no_word_for(tmp_path):
    with Store(tmp_path, META) as store:
        store.record(ok(A, 0, a=math.nan, b=math.inf, c=-math.inf, d=-0.0, e=5e-324, f=0.1))
    (found,) = read_outcomes(tmp_path)
    assert math.isnan(found.metrics["a"])
    rest = [found.metrics[n] for n in "bcdef"]
    assert [bits(v) for v in rest] == [bits(v) for v in (math.inf, -math.inf, -0.0, 5e-324, 0.1)]
    with sqlite3.connect(tmp_path / "results.sqlite") as db:
        assert db.execute("SELECT json_valid(metrics) FROM trials").fetchone() == (1,)


def test_trials_are_there_at_once_and_once_only(tmp_path):
    with Store(tmp_path, META) as store:
        store.record(ok(B, 1, v=1.0))
        assert [(o.condition, o.seed) for o in read_outcomes(tmp_path)] == [(B, 1)]
        store.record(ok(A, 0, v=2.0))
        with pytest.raises(StoreError, match="recorded already"):
            store.record(ok(B, 1, v=3.0))
        assert [(o.condition, o.metrics["v"]) for o in store.outcomes()] == [(A, 2.0), (B, 1.0)]
    assert read_outcomes(tmp_path)[0].wall == {"wall_trial": 0.5}


def test_a_failed_trial_may_be_recorded_again(tmp_path):
    with Store(tmp_path, META) as store:
        store.record(Outcome(A, 0, "failed", error="E: x", traceback="Traceback"))
        store.record(ok(A, 0, v=2.0))
        (found,) = store.outcomes()
        assert (found.status, found.error, found.traceback) == ("ok", "", "")
        with pytest.raises(StoreError):
            store.record(Outcome(A, 0, "failed"))
    assert read_outcomes(tmp_path)[0].metrics == {"v": 2.0}


def test_wall_times_are_apart_from_metrics(tmp_path):
    with Store(tmp_path, META) as store:
        store.record(Outcome(A, 0, "ok", {"v": 1.0}, {"wall_trial": math.nan, "wall_plan": 2.0}))
    with sqlite3.connect(tmp_path / "results.sqlite") as db:
        assert db.execute("SELECT metrics FROM trials").fetchone() == ('{"v":1.0}',)
    wall = read_outcomes(tmp_path)[0].wall
    assert math.isnan(wall["wall_trial"])
    assert wall["wall_plan"] == 2.0


def test_the_same_digest_resumes_and_another_touches_nothing(tmp_path):
    with Store(tmp_path, META) as store:
        store.record(ok(A, 0))
    with Store(tmp_path, META) as store:
        store.record(ok(A, 1))
    before = snapshot(tmp_path)
    with pytest.raises(StoreError, match="--out, or --fresh"):
        Store(tmp_path, {**META, "digest": "e" * 64})
    assert snapshot(tmp_path) == before
    assert len(read_outcomes(tmp_path)) == 2
    assert read_meta(tmp_path)["study"] == "toy"


def corrupt_page(path):
    data = bytearray(path.read_bytes())
    data[4096 + 8 : 4096 + 200] = b"\xff" * 192
    path.write_bytes(data)


@pytest.mark.parametrize(
    ("harm", "said"),
    [
        (lambda p: p.write_bytes(b"not a database, just some text\n" * 50), "not a database"),
        (lambda p: p.write_bytes(p.read_bytes()[: p.stat().st_size // 2]), "damaged"),
        (corrupt_page, "damaged"),
        (lambda p: _sql(p, "UPDATE meta SET value = '99' WHERE name = 'schema_version'"), "schema"),
        (lambda p: _sql(p, "DROP TABLE trials"), "not of mjmr"),
        (lambda p: _sql(p, "UPDATE meta SET value = '{\"' WHERE name = 'digest'"), "damaged"),
    ],
)
def test_damaged_files_are_named_and_left_alone(tmp_path, harm, said):
    folder = tmp_path / "results"
    with Store(folder, META) as store:
        for seed in range(200):
            store.record(ok(A, seed, v=0.1))
    harm(folder / "results.sqlite")
    before = snapshot(folder)
    for attempt in (lambda: Store(folder, META), lambda: read_outcomes(folder)):
        with pytest.raises(StoreError, match=said) as e:
            attempt()
        assert "results.sqlite" in str(e.value)
        assert "--fresh" in str(e.value)
        assert "\n" not in str(e.value)
    assert snapshot(folder) == before
    aside = set_aside(folder)
    assert aside is not None
    assert snapshot(aside) == before
    Store(folder, META).close()


def test_damaged_metrics_are_named(tmp_path):
    with Store(tmp_path / "r", META) as store:
        store.record(ok(A, 0, v=0.1))
    _sql(tmp_path / "r" / "results.sqlite", "UPDATE trials SET metrics = '{\"v\": 0.'")
    with pytest.raises(StoreError, match="damaged"):
        read_outcomes(tmp_path / "r")


@pytest.mark.parametrize(
    "change",
    [
        "metrics = replace(metrics, '0.1', '0.2')",
        "seed = 7",
        "status = 'failed'",
        "condition = replace(condition, '1.0', '2.0')",
        "checksum = 'none'",
    ],
)
def test_a_changed_trial_is_noticed_and_named(tmp_path, change):
    with Store(tmp_path / "r", META) as store:
        store.record(ok(A, 0, v=0.1))
        store.record(Outcome(A, 1, "failed", error="E: x"))
        store.record(ok(A, 1, v=0.3))
    assert len(read_outcomes(tmp_path / "r")) == 2
    _sql(tmp_path / "r" / "results.sqlite", f"UPDATE trials SET {change} WHERE seed = 0")
    with pytest.raises(StoreError, match=r"damaged: trial .*x.* seed [07] is not what was written"):
        read_outcomes(tmp_path / "r")
    with Store(tmp_path / "r", META) as store, pytest.raises(StoreError, match="checksum"):
        store.outcomes()


def _sql(path, statement):
    db = sqlite3.connect(path)
    db.execute(statement)
    db.commit()
    db.close()


def test_a_file_cut_off_at_creation_is_begun_again(tmp_path):
    (tmp_path / "results.sqlite").touch()
    with Store(tmp_path, META) as store:
        store.record(ok(A, 0))
    assert len(read_outcomes(tmp_path)) == 1


def test_two_drivers_do_not_share_a_folder(tmp_path):
    with Store(tmp_path, META):
        with pytest.raises(StoreError, match="another mjmr is running"):
            Store(tmp_path, META)
        with pytest.raises(StoreError, match="another mjmr is running"):
            set_aside(tmp_path)
    Store(tmp_path, META).close()


def test_unwritable_folders_are_one_sentence(tmp_path):
    (tmp_path / "file").write_text("")
    places = [tmp_path / "file" / "results", "/proc/nowhere/results"]
    if os.geteuid() != 0:
        (tmp_path / "closed").mkdir(mode=0o500)
        places.append(tmp_path / "closed")
    for place in places:
        with pytest.raises(StoreError, match="cannot (write|read)") as e:
            Store(place, META)
        assert "\n" not in str(e.value)


def test_setting_aside_deletes_nothing_and_spares_other_folders(tmp_path):
    folder = tmp_path / "quick"
    assert set_aside(folder) is None
    for _ in range(2):
        with Store(folder, META) as store:
            store.record(ok(A, 0))
        (folder / "note.txt").write_text("mine")
        assert set_aside(folder) is not None
    names = sorted(p.name for p in tmp_path.iterdir())
    assert len(names) == 2
    assert all(n.startswith("quick.old-") for n in names)
    assert all((tmp_path / n / "note.txt").exists() for n in names)
    (tmp_path / "documents").mkdir()
    (tmp_path / "documents" / "thesis.tex").write_text("mine")
    with pytest.raises(StoreError, match="not a results folder"):
        set_aside(tmp_path / "documents")


def test_csv_has_every_trial_and_exact_numbers(tmp_path):
    with Store(tmp_path, META) as store:
        store.record(ok(A, 0, v=0.1 + 0.2, s='with "quotes", and commas'))
        store.record(Outcome(B, 3, "failed", error="E: no"))
    path = tmp_path / "out.csv"
    assert export(tmp_path, path) == 2
    first, second = csv.DictReader(path.open(newline=""))
    assert float(first["v"]) == 0.1 + 0.2
    assert first["s"] == 'with "quotes", and commas'
    assert (second["x"], second["seed"], second["status"], second["error"]) == (
        "2.0",
        "3",
        "failed",
        "E: no",
    )
    assert first["wall_trial"] == "0.5"
    with pytest.raises(StoreError, match="no results"):
        export(tmp_path / "nowhere", path)
    with pytest.raises(StoreError, match="cannot write"):
        export(tmp_path, tmp_path / "nowhere" / "out.csv")


_WRITER = """
import sys
from pathlib import Path
from mjmr.conditions import Condition
from mjmr.store import Outcome, Store
with Store(Path(sys.argv[1]), {"digest": "d" * 64}) as store:
    begin = len(store.outcomes())
    for seed in range(begin, 100000):
        metrics, wall = {"v": seed / 7}, {"wall_trial": 1.0}
        store.record(Outcome(Condition({"x": 1.0}), seed, "ok", metrics, wall))
        print(seed, flush=True)
"""


def test_kill_at_any_moment_loses_no_committed_trial(tmp_path):
    told = -1
    for delay in (0.0, 0.013, 0.029, 0.05, 0.11):
        writer = subprocess.Popen(
            [sys.executable, "-c", _WRITER, str(tmp_path)], stdout=subprocess.PIPE, text=True
        )
        assert writer.stdout is not None
        writer.stdout.readline()
        time.sleep(delay)
        writer.send_signal(signal.SIGKILL)
        lines = writer.stdout.read().split("\n")
        writer.wait()
        writer.stdout.close()
        # The last line may be cut short; those before it were told after their commit.
        told = max([told, *map(int, lines[:-1])])
        found = read_outcomes(tmp_path)
        assert sorted(o.seed for o in found) == list(range(len(found)))
        assert len(found) > told
        assert all(o.metrics["v"] == o.seed / 7 and o.wall for o in found)
    assert told > 5
