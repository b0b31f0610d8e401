import hashlib
import io
import json
import os
import random
import signal
import sqlite3
import subprocess
import sys
import time
from dataclasses import replace

import psutil
import pytest
from rich.console import Console

from mjmr.errors import GL_ADVICE, InvalidInputError, MjmrError
from mjmr.progress import Progress
from mjmr.runner import RunOptions, run_study
from mjmr.store import StoreError
from tests import kill_runs
from tests.processes import spawned

TOY = "tests.toy_study:study"


def run(folder, study=TOY, **options):
    """Run with consoles of its own; returns the result, the verdicts as text, the messages."""
    out, messages = io.StringIO(), io.StringIO()
    result = run_study(
        RunOptions(study=study, out=folder, **options),
        Console(file=out, width=200),
        Console(file=messages, width=200),
    )
    return result, out.getvalue(), messages.getvalue()


def metrics(folder):
    """Every trial as it is in the file, wall times left out."""
    with sqlite3.connect(folder / "results.sqlite") as db:
        return db.execute(
            "SELECT condition, seed, status, metrics, error FROM trials ORDER BY condition, seed"
        ).fetchall()


def snapshot(folder):
    return {
        str(p.relative_to(folder)): (hashlib.sha256(p.read_bytes()).hexdigest(), p.stat().st_mtime)
        for p in sorted(folder.rglob("*"))
        if p.is_file()
    }


@pytest.fixture
def finished(tmp_path):
    """A finished quick run, with its result."""
    folder = tmp_path / "quick"
    return folder, run(folder, workers=1)[0]


def test_a_run_leaves_what_it_promises(tmp_path):
    folder = tmp_path / "quick"
    result, out, messages = run(folder)
    assert result.exit_code == 0
    names = {p.name for p in folder.iterdir()}
    assert names == {
        ".lock",
        "results.sqlite",
        "claims.json",
        "claims.md",
        "run.json",
        "heads.svg",
        "film.mp4",
    }
    verdicts = {c["id"]: c["verdict"] for c in json.loads((folder / "claims.json").read_text())}
    assert verdicts == {
        "fair": "holds",
        "bias-shows": "holds",
        "later": "not testable",
        "fast": "fails",
    }
    record = json.loads((folder / "run.json").read_text())
    assert record["verdicts"] == verdicts
    assert (record["trials"], record["finished"], record["computed_now"]) == (10, 10, 10)
    assert [c["seeds"] for c in record["conditions"]] == [4, 4, 2]
    assert len(record["digest"]) == 64
    assert record["versions"]["numpy"]
    assert (folder / "heads.svg").read_text() == "<svg>10</svg>"
    assert (folder / "film.mp4").read_bytes() == b"toy overview draft"
    assert "bias-shows" in out
    assert "inconclusive" not in out
    assert "trials 10/10" in messages
    assert "preparing (compiles on the first run)" in messages


def test_one_worker_and_two_give_the_same_file(tmp_path, finished):
    folder, _ = finished
    run(tmp_path / "two", workers=2)
    assert metrics(folder) == metrics(tmp_path / "two")


def test_a_second_run_computes_nothing(finished):
    folder, first = finished
    before, film = metrics(folder), (folder / "film.mp4").stat().st_mtime_ns
    result, _, messages = run(folder)
    assert json.loads((folder / "run.json").read_text())["computed_now"] == 0
    assert metrics(folder) == before
    assert (folder / "film.mp4").stat().st_mtime_ns == film
    assert "compiling" not in messages
    assert [v.verdict for v in result.verdicts] == [v.verdict for v in first.verdicts]


def test_parts_add_up_to_the_whole(tmp_path, finished):
    folder, _ = finished
    parts = tmp_path / "parts"
    result, _, _ = run(parts, only=("bias=0.5",), seeds=2, film=False)
    assert len(metrics(parts)) == 4
    assert not (parts / "film.mp4").exists()
    unsure = {v.claim.id: (v.verdict, v.why) for v in result.verdicts}
    assert unsure["bias-shows"] == ("not testable", "2 of 2 not run")
    assert unsure["fair"] == ("holds", "")
    assert unsure["fast"] == ("not testable", "2 of 6 not run")
    assert result.exit_code == 0
    assert json.loads((parts / "run.json").read_text())["trials"] == 4
    assert (parts / "heads.svg").read_text() == "<svg>4</svg>"
    _, _, messages = run(parts)
    assert "resuming: 4 of 10" in messages
    assert metrics(parts) == metrics(folder)


def test_more_seeds_extend_a_folder_and_do_not_enter_the_next_verdict(finished):
    folder, first = finished
    more, _, _ = run(folder, seeds=6)
    assert len(metrics(folder)) == 18
    assert more.verdicts[0].n == 6
    again, _, _ = run(folder)
    assert again.verdicts[0].n == first.verdicts[0].n == 4


def test_another_digest_touches_nothing(finished, monkeypatch):
    folder, _ = finished
    before = snapshot(folder)
    with pytest.raises(StoreError, match="another configuration or source"):
        run(folder, size="standard")
    assert snapshot(folder) == before
    monkeypatch.setattr("mjmr.provenance.versions", lambda: {"numpy": "0"})
    with pytest.raises(StoreError, match="--fresh"):
        run(folder)
    assert snapshot(folder) == before
    _, _, messages = run(folder, fresh=True)
    assert "set aside as" in messages
    (aside,) = [p for p in folder.parent.iterdir() if ".old-" in p.name]
    assert snapshot(aside) == before
    assert len(metrics(folder)) == 10


def test_failed_trials_are_kept_and_told_and_can_be_retried(tmp_path):
    folder = tmp_path / "quick"
    result, _, messages = run(folder, "tests.toy_study:raising")
    assert result.exit_code == 1
    assert "RuntimeError: the coin rolled away" in messages
    assert "Traceback" not in messages
    verdicts = {v.claim.id: (v.verdict, v.why) for v in result.verdicts}
    assert verdicts == {"bias-shows": ("holds", ""), "all": ("not testable", "1 of 7 failed")}
    log = tmp_path / "log"
    os.environ["TOY_LOG"] = str(log)
    try:
        assert run(folder, "tests.toy_study:raising")[0].exit_code == 1
        assert not log.exists()
        assert run(folder, "tests.toy_study:raising", retry=True)[0].exit_code == 1
        assert len(log.read_text().splitlines()) == 1
    finally:
        del os.environ["TOY_LOG"]


def test_a_plot_without_its_trials_is_skipped(tmp_path, monkeypatch):
    monkeypatch.setattr("tests.toy_study.plots", lambda t, f: [t.where(bias=0.9).values("heads")])
    result, _, messages = run(tmp_path / "quick", only=("bias=0.5",), film=False)
    assert result.exit_code == 0
    assert "plots skipped: no trials with bias=0.9" in messages


def test_trials_without_gl_say_what_to_install(tmp_path):
    result, _, messages = run(tmp_path / "quick", "tests.toy_study:blind")
    assert result.exit_code == 1
    assert "apt install libegl1 libgl1-mesa-dri" in messages
    assert "1 of 7 need off-screen OpenGL" in result.verdicts[1].why


def test_a_film_without_gl_is_skipped_and_made_later(tmp_path, monkeypatch):
    folder = tmp_path / "quick"
    monkeypatch.setenv("TOY_FILM", "gl")
    result, _, messages = run(folder)
    assert result.exit_code == 0
    told = [line for line in messages.splitlines() if "OpenGL" in line]
    assert told == [f"{GL_ADVICE}; film skipped"]
    assert not (folder / "film.mp4").exists()
    monkeypatch.delenv("TOY_FILM")
    run(folder)
    assert (folder / "film.mp4").exists()


def test_a_film_that_fails_leaves_nothing_behind(tmp_path, monkeypatch):
    folder = tmp_path / "quick"
    monkeypatch.setenv("TOY_FILM", "raise")
    result, _, messages = run(folder)
    assert result.exit_code == 1
    assert "film failed: RuntimeError: film tore" in messages
    assert "Traceback" not in messages
    assert not [p for p in folder.iterdir() if "film" in p.name or "plots" in p.name]


def test_a_mistake_in_a_claim_is_one_line_and_exit_1(tmp_path, monkeypatch):
    monkeypatch.setattr("tests.toy_study.claims", _mistaken_claims)
    result, _, messages = run(tmp_path / "quick")
    assert result.exit_code == 1
    assert "claim fair: evaluation error: ZeroDivisionError" in messages
    assert "Traceback" not in messages


def _mistaken_claims():
    from tests.toy_study import _quick_claims

    first, second = _quick_claims()
    return [replace(first, id="fair", evaluate=lambda t: 1 / 0), second]


def test_verdicts_are_accepted_then_compared(tmp_path, monkeypatch):
    from tests import toy_study

    path = tmp_path / "verdicts.json"
    monkeypatch.setattr(toy_study, "study", replace(toy_study.study, verdicts=path))
    folder = tmp_path / "quick"
    with pytest.raises(MjmrError, match="--accept"):
        run(folder, check=True)
    assert not folder.exists()
    path.write_text(json.dumps({"full": {"fair": "holds"}}))
    assert run(folder, accept=True)[0].exit_code == 0
    kept = json.loads(path.read_text())
    assert kept["full"] == {"fair": "holds"}
    assert kept["quick"] == {"fair": "holds", "bias-shows": "holds", "later": "not testable"}
    assert run(folder, check=True)[0].exit_code == 0
    for changed, said in (
        ({"fair": "fails"}, "fair: committed fails, now holds"),
        ({"gone": "holds"}, "gone: committed holds, now absent"),
    ):
        path.write_text(json.dumps({"quick": {**kept["quick"], **changed}}))
        result, _, messages = run(folder, check=True)
        assert result.exit_code == 3
        assert [str(d) for d in result.differences] == [said]
        assert said in messages
    path.write_text(json.dumps({"quick": {**kept["quick"], "fast": "holds"}}))
    assert run(folder, check=True)[0].exit_code == 0  # timing claims are not compared


@pytest.mark.parametrize(
    "options",
    [
        {"check": True, "accept": True},
        {"check": True, "seeds": 2},
        {"check": True, "only": ("bias=0.5",)},
        {"accept": True, "seeds": 2},
        {"seeds": 0},
        {"workers": 0},
        {"only": ("bia=1",)},
        {"size": "quik"},
    ],
)
def test_bad_options_leave_no_folder(tmp_path, options):
    with pytest.raises(InvalidInputError):
        run(tmp_path / "quick", **options)
    assert not (tmp_path / "quick").exists()


def command(folder, *more, size="standard"):
    words = ["-m", "mjmr", "run", TOY, "--size", size, "--out", str(folder), *more]
    words[:2] = ["-c", "import sys; from mjmr.cli import main; sys.exit(main())"]
    return [sys.executable, *words]


def test_ctrl_c_keeps_what_is_done_and_says_how_to_resume(tmp_path):
    folder = tmp_path / "my results"
    driver = subprocess.Popen(
        command(folder, "--no-film"),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "TOY_SLEEP": "0.2"},
        start_new_session=True,
    )
    wait_for(lambda: folder.exists() and count(folder) >= 3)
    children = psutil.Process(driver.pid).children(recursive=True)
    os.killpg(driver.pid, signal.SIGINT)  # as a terminal does: to the workers as well
    out, messages = driver.communicate(timeout=15)
    assert driver.returncode == 130
    assert "Traceback" not in messages
    done = count(folder)
    assert f"interrupted: {done} of 82 trials are kept" in messages
    resume = f"mjmr run {TOY} --size standard --out '{folder}' --no-film"
    assert f"resume with: {resume}" in messages
    assert psutil.wait_procs(children, timeout=2.0)[1] == []
    assert json.loads((folder / "run.json").read_text())["finished"] == done
    result, _, _ = run(folder, size="standard", film=False)
    assert result.exit_code == 0
    assert count(folder) == 82


def test_ctrl_c_before_the_first_trial(tmp_path):
    folder = tmp_path / "quick"
    driver = subprocess.Popen(
        command(folder),
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "TOY_PREPARE_SLEEP": "30"},
    )
    # not any earlier: libraries that are being imported may swallow an interrupt
    assert driver.stderr.readline().startswith("preparing")
    time.sleep(0.3)
    driver.send_signal(signal.SIGINT)
    _, messages = driver.communicate(timeout=15)
    assert driver.returncode == 130
    assert "interrupted: 0 of 82" in messages
    assert "Traceback" not in messages


def test_ctrl_c_while_workers_start_is_no_crash_of_theirs(tmp_path):
    folder = tmp_path / "quick"
    driver = subprocess.Popen(
        command(folder),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    process = psutil.Process(driver.pid)
    wait_for(lambda: spawned(process))
    time.sleep(0.1)  # its interpreter is up and imports
    os.killpg(driver.pid, signal.SIGINT)
    _, messages = driver.communicate(timeout=15)
    assert driver.returncode == 130
    assert "Traceback" not in messages
    assert "interrupted: " in messages


@pytest.mark.slow
def test_killed_at_random_moments_it_resumes_and_repeats_nothing(tmp_path):
    whole = tmp_path / "whole"
    run(whole, size="standard", film=False)
    folder, log = tmp_path / "killed", tmp_path / "log"
    moments, kills, seen = random.Random(4), 0, []
    while True:
        driver = subprocess.Popen(
            command(folder, "--no-film"),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            env={**os.environ, "TOY_SLEEP": "0.02", "TOY_LOG": str(log)},
        )
        begin = count(folder) if folder.exists() else 0
        if begin < 60:
            wait_for(lambda b=begin: folder.exists() and count(folder) > b)
            time.sleep(moments.uniform(0.0, 0.35))
            driver.send_signal(signal.SIGKILL)
            kills += 1
        _, messages = driver.communicate(timeout=60)
        rows = metrics(folder)
        assert set(seen) <= set(rows), "a trial that was kept is gone or changed"
        seen = rows
        if driver.returncode == 0:
            break
        assert driver.returncode == -signal.SIGKILL, messages
    assert kills >= 3
    assert metrics(folder) == metrics(whole)
    assert len({row[:2] for row in seen}) == len(seen) == 82
    # Only what was under way at a kill was begun twice: one trial a worker, or a result just sent.
    assert 82 <= len(log.read_text().splitlines()) <= 82 + 3 * 2 * kills
    verdicts = [json.loads((f / "claims.json").read_text()) for f in (folder, whole)]
    for claims in verdicts:
        claims[:] = [c for c in claims if not c["timing"]]
    assert verdicts[0] == verdicts[1]


def test_progress_says_how_many_how_fast_how_long():
    text = io.StringIO()
    with Progress(Console(file=text, width=200), 2, 5) as progress:
        assert progress.told() == "2/5"
        progress.advance(True)
        progress.advance(False)
        assert progress.told().startswith("4/5, 1 failed, ")
        assert progress.told().endswith(" left")
        progress.advance(True)
    last = text.getvalue().splitlines()[-1]
    assert last.startswith("trials 5/5, 1 failed, ")
    assert "left" not in last
    with Progress(Console(file=io.StringIO(), force_terminal=True), 0, 2) as bar:
        bar.advance(True)


def count(folder):
    try:
        with sqlite3.connect(f"file:{folder / 'results.sqlite'}?mode=ro", uri=True) as db:
            return db.execute("SELECT count(*) FROM trials").fetchone()[0]
    except sqlite3.Error:
        return 0


def wait_for(condition, seconds=20.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.01)


@pytest.mark.parametrize("phase", ["result", "commit"])
def test_killed_around_a_commit_it_ends_as_if_left_alone(tmp_path, phase):
    """The short version of ``python -m tests.kill_runs``."""
    folder, told = kill_runs.series(
        tmp_path, phase, 3, TOY, ("--workers", "2", "--seeds", "6", "--no-film")
    )
    assert told["kills"] == 3
    assert told["runs"] >= 4
    whole = tmp_path / "whole"
    run(whole, seeds=6, film=False)
    assert kill_runs.contents(folder) == kill_runs.contents(whole)
    assert (folder / "heads.svg").read_bytes() == (whole / "heads.svg").read_bytes()
