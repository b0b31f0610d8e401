import os
import signal
import subprocess
import sys
import time

import psutil
import pytest

from mjmr.conditions import Condition
from mjmr.errors import InvalidInputError
from mjmr.executor import LocalExecutor, compute
from mjmr.parts import Job
from mjmr.registry import load_study
from mjmr.store import encode
from tests.processes import spawned

TOY = "tests.toy_study:study"


def run(reference, workers=2, trials=None, **options):
    trials = load_study(reference).trials("quick") if trials is None else trials
    return list(LocalExecutor(workers).run(Job(reference), trials, **options))


def told(outcomes):
    return sorted((o.condition.key, o.seed, o.status, encode(o.metrics)) for o in outcomes)


def test_one_worker_equals_two_equals_none():
    trials = load_study(TOY).trials("quick")
    two = told(run(TOY, 2))
    assert len(two) == len(trials)
    assert told(run(TOY, 1)) == two
    assert told(compute(Job(TOY), *trial) for trial in trials) == two


def test_wall_times_are_kept_apart():
    outcome = compute(Job(TOY), *load_study(TOY).trials("quick")[0])
    assert set(outcome.wall) == {"wall_trial", "wall_toss"}
    assert not any(name.startswith("wall_") for name in outcome.metrics)
    assert outcome.wall["wall_trial"] > 0.0
    assert type(outcome.metrics["noise"]) is float


def test_an_exception_fails_its_trial_alone():
    found = run("tests.toy_study:raising")
    (lost,) = [o for o in found if o.status != "ok"]
    assert (lost.status, lost.error) == ("failed", "RuntimeError: the coin rolled away")
    assert "in trial" in lost.traceback
    assert len(found) == 7


def test_a_worker_that_dies_twice_fails_its_trial_alone():
    for workers in (1, 2):
        found = run("tests.toy_study:dying", workers)
        (lost,) = [o for o in found if o.status != "ok"]
        assert (lost.status, lost.error) == ("failed", "worker died twice: exit code -9")
        assert lost.condition["act"] == "die"
        assert len(found) == 7


def test_a_worker_that_dies_once_is_forgiven(tmp_path, monkeypatch):
    monkeypatch.setenv("TOY_MARK", str(tmp_path / "mark"))
    found = run("tests.toy_study:dying_once")
    assert [o.status for o in found] == ["ok"] * 7
    assert (tmp_path / "mark").exists()


def test_missing_gl_is_a_status_of_its_own():
    statuses = [o.status for o in run("tests.toy_study:blind")]
    assert sorted(statuses) == ["no-gl"] + ["ok"] * 6


def test_what_is_no_metric_fails_the_trial():
    for name, returned in (
        ("_returns_array", "ndarray"),
        ("_returns_list", "not iterable"),
        ("_wall_text", "wall time"),
    ):
        outcome = compute(Job(f"{__name__}:{name}"), Condition({}), 0)
        assert outcome.status == "failed"
        assert returned in outcome.error


def test_workers_use_one_thread_and_leave_the_driver_alone(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    (outcome,) = LocalExecutor(1).run(Job("tests.toy_environment:study"), [(Condition({}), 0)])
    assert outcome.error == ""
    assert {v for n, v in outcome.metrics.items() if n.endswith("NUM_THREADS")} == {"1"}
    assert outcome.metrics["sigint"] is True
    assert os.environ["OMP_NUM_THREADS"] == "7"
    assert "NUMBA_NUM_THREADS" not in os.environ


def test_stopping_gives_up_what_is_under_way(monkeypatch):
    monkeypatch.setenv("TOY_SLEEP", "30")
    begin = time.monotonic()
    assert run(TOY, 2, stop=lambda: time.monotonic() > begin + 1.0) == []
    assert time.monotonic() - begin < 8.0
    assert not spawned(psutil.Process())


def test_closing_the_iteration_ends_the_workers():
    outcomes = LocalExecutor(2).run(Job(TOY), load_study(TOY).trials("quick"))
    assert next(outcomes).status == "ok"
    outcomes.close()
    assert not spawned(psutil.Process())


_DRIVER = """
from mjmr.executor import LocalExecutor
from mjmr.parts import Job
from mjmr.registry import load_study
if __name__ == "__main__":
    study = "tests.toy_study:study"
    for _ in LocalExecutor(2).run(Job(study), load_study(study).trials("standard")):
        pass
"""


def test_workers_die_with_a_killed_driver(tmp_path):
    script = tmp_path / "driver.py"
    script.write_text(_DRIVER)
    log = tmp_path / "log"
    # Far into their trials, so that nothing but the driver's death can end them in time.
    environment = {**os.environ, "TOY_SLEEP": "60", "TOY_LOG": str(log)}
    driver = subprocess.Popen([sys.executable, str(script)], env=environment)
    end = time.monotonic() + 20.0
    while not log.exists() or len(log.read_text().splitlines()) < 2:
        assert time.monotonic() < end
        time.sleep(0.02)
    children = psutil.Process(driver.pid).children(recursive=True)
    assert len(children) >= 2
    driver.send_signal(signal.SIGKILL)
    driver.wait()
    _, alive = psutil.wait_procs(children, timeout=2.0)
    assert alive == []


def test_workers_below_one_are_refused():
    with pytest.raises(InvalidInputError):
        LocalExecutor(0)


def _study(trial):
    from dataclasses import replace

    from tests.toy_study import study

    return replace(study, trial=trial)


_returns_array = _study(lambda condition, seed: {"x": __import__("numpy").zeros(2)})
_returns_list = _study(lambda condition, seed: 3)
_wall_text = _study(lambda condition, seed: {"wall_x": "long"})
