import json
import os
import signal
import socket
import subprocess
import sys
import sysconfig
import threading
import time
from pathlib import Path

import psutil
import pytest

from mjmr import cluster
from mjmr.cli import main
from mjmr.cluster import DaskExecutor
from mjmr.errors import MjmrError
from mjmr.executor import LocalExecutor, compute
from mjmr.parts import Job
from mjmr.registry import load_study
from mjmr.store import encode
from tests.dask_cluster import Cluster, free_port

TOY = "tests.toy_study:study"


@pytest.fixture(scope="module")
def two(tmp_path_factory):
    """Two workers for tests that leave them as they are."""
    with Cluster(tmp_path_factory.mktemp("two"), 2) as found:
        yield found


def executor(found, reference=TOY, size="quick", **changes):
    told = []
    digest = load_study(reference).digest(size)
    made = DaskExecutor(found.address, size, changes.get("digest", digest), told.append)
    return made, told


def run(found, reference=TOY, size="quick", **options):
    made, _ = executor(found, reference, size)
    return list(made.run(Job(reference), load_study(reference).trials(size), **options))


def told(outcomes):
    return sorted((o.condition.key, o.seed, o.status, encode(o.metrics)) for o in outcomes)


def test_a_cluster_equals_this_process(two):
    here = told(compute(Job(TOY), *trial) for trial in load_study(TOY).trials("standard"))
    assert told(run(two, size="standard")) == here


def test_exceptions_and_missing_gl_travel_back(two):
    (lost,) = [o for o in run(two, "tests.toy_study:raising") if o.status != "ok"]
    assert (lost.status, lost.error) == ("failed", "RuntimeError: the coin rolled away")
    assert "in trial" in lost.traceback
    assert sorted(o.status for o in run(two, "tests.toy_study:blind")) == ["no-gl"] + ["ok"] * 6


def test_workers_of_a_nanny_use_one_thread(two):
    reference = "tests.toy_environment:study"
    trials = load_study(reference).trials("quick")[:1]
    made, _ = executor(two, reference)
    (outcome,) = made.run(Job(reference), trials)
    assert outcome.status == "ok", outcome.error
    for name in ("OMP", "OPENBLAS", "MKL"):
        assert outcome.metrics[f"{name}_NUM_THREADS"] == "1"


def test_the_command_line_runs_on_a_cluster(two, tmp_path, capsys):
    words = ["run", TOY, "--no-film", "--out", str(tmp_path / "out"), "--cluster", two.address]
    assert main(words) == 0
    record = json.loads((tmp_path / "out" / "run.json").read_text())
    assert record["cluster"] == two.address
    assert record["computed_now"] == 10
    assert f"--cluster {two.address}" in record["command"]
    assert main(words) == 0
    assert json.loads((tmp_path / "out" / "run.json").read_text())["computed_now"] == 0


def test_stopping_gives_up_what_is_under_way(tmp_path):
    with Cluster(tmp_path, 1, TOY_SLEEP="5") as found:
        begin = time.monotonic()
        assert run(found, stop=lambda: time.monotonic() > begin + 1.5) == []
        assert time.monotonic() - begin < 5.0


def test_a_trial_that_kills_its_worker_twice_fails_alone(tmp_path):
    with Cluster(tmp_path, 2) as found:
        outcomes = run(found, "tests.toy_study:dying")
    (lost,) = [o for o in outcomes if o.status != "ok"]
    assert (lost.status, lost.error) == ("failed", "worker died twice")
    assert lost.condition["act"] == "die"
    assert len(outcomes) == 7


def test_workers_that_die_and_join_lose_and_repeat_nothing(tmp_path):
    with Cluster(tmp_path, 2, TOY_SLEEP="0.1", TOY_LOG=str(tmp_path / "log")) as found:
        made, remarks = executor(found, size="standard")
        outcomes, kills = [], 0
        for outcome in made.run(Job(TOY), load_study(TOY).trials("standard")):
            outcomes.append(outcome)
            if len(outcomes) == 20:
                found.add(1, TOY_SLEEP="0.1", TOY_LOG=str(tmp_path / "log"))
            if len(outcomes) in (5, 35, 65) and (alive := found.worker_processes()):
                alive[0].send_signal(signal.SIGKILL)
                kills += 1
    assert kills == 3
    assert {o.status for o in outcomes} == {"ok"}
    assert told(outcomes) == told(compute(Job(TOY), *t) for t in load_study(TOY).trials("standard"))
    # At each kill a trial was under way, and at most one more result had not been fetched.
    assert 82 <= len((tmp_path / "log").read_text().splitlines()) <= 82 + 2 * kills
    assert not [r for r in remarks if "gets no trials" in r]


def test_the_last_worker_may_die_and_another_join(tmp_path):
    with Cluster(tmp_path) as found:
        first = found.add(1, "--no-nanny", TOY_SLEEP="0.1")
        found.wait_for(1)
        made, remarks = executor(found)
        outcomes = []
        for outcome in made.run(Job(TOY), load_study(TOY).trials("quick")):
            outcomes.append(outcome)
            if len(outcomes) == 3:
                first.kill()
                threading.Timer(2.0, found.add).start()
    assert len(outcomes) == 10
    assert {o.status for o in outcomes} == {"ok"}
    assert remarks == ["no worker is left; waiting for one to join"]


def test_an_unfit_worker_that_joins_later_gets_no_trials(tmp_path):
    with Cluster(tmp_path, 1, TOY_SLEEP="0.1") as found:
        made, remarks = executor(found, size="standard")
        outcomes = []
        for outcome in made.run(Job(TOY), load_study(TOY).trials("standard")):
            outcomes.append(outcome)
            if len(outcomes) == 1:
                found.add(1, "--nthreads", "2")
    assert {o.status for o in outcomes} == {"ok"}
    assert len(outcomes) == 82
    (remark,) = remarks
    assert "has 2 threads where trials need one each" in remark


def test_a_lost_scheduler_is_one_sentence(tmp_path):
    with Cluster(tmp_path, 1, TOY_SLEEP="0.1") as found:
        made, _ = executor(found)
        outcomes = made.run(Job(TOY), load_study(TOY).trials("quick"))
        assert next(outcomes).status == "ok"
        found.scheduler.kill()
        begin = time.monotonic()
        with pytest.raises(MjmrError, match="lost the scheduler at tcp://127.0.0.1") as e:
            list(outcomes)
        assert time.monotonic() - begin < 20.0
        assert "\n" not in str(e.value)


@pytest.mark.parametrize(
    "address",
    ["localhost:8786", "tcp://", "tcp://host", "tcp://host:", "tcp://host:0", "tcp://host:70000",
     "http://host:8786", "tcp://ho st:8786", "tcp://host:8786/x", ""],
)  # fmt: skip
def test_what_is_no_address_is_exit_2(address, capsys, tmp_path):
    words = ["run", TOY, "--out", str(tmp_path / "out"), "--cluster", address]
    assert main(words) == 2
    assert "a cluster's address is tcp://host:port" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_cluster_and_workers_exclude_each_other(capsys, tmp_path):
    words = ["run", TOY, "--out", str(tmp_path / "out"), "--workers", "2"]
    assert main([*words, "--cluster", "tcp://host:8786"]) == 2
    assert "--cluster and --workers exclude each other" in capsys.readouterr().err


def test_no_answer_is_one_sentence_and_exit_2(capsys, tmp_path, monkeypatch):
    monkeypatch.setattr(cluster, "CONNECT_SECONDS", 1.0)
    address = f"tcp://127.0.0.1:{free_port()}"
    words = ["run", TOY, "--no-film", "--out", str(tmp_path / "out"), "--cluster", address]
    assert main(words) == 2
    told = capsys.readouterr().err
    assert told.startswith(f"mjmr: no answer from a Dask scheduler at {address} within 1 s")
    assert told.count("\n") == 1
    command = [sys.executable, "-c", "import sys; from mjmr.cli import main; sys.exit(main())"]
    begin = time.monotonic()
    done = subprocess.run([*command, *words], stderr=subprocess.PIPE, text=True)
    assert done.returncode == 2
    assert "within 10 s" in done.stderr
    assert time.monotonic() - begin < 18.0  # with what importing takes, and leaving


def test_without_dask_it_says_what_to_install(monkeypatch, capsys, tmp_path):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    words = ["run", TOY, "--out", str(tmp_path / "out"), "--cluster", "tcp://host:8786"]
    assert main(words) == 2
    assert 'pip install "mjmr[cluster]"' in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def refused(address):
    made = DaskExecutor(address, "quick", load_study(TOY).digest("quick"))
    begin = time.monotonic()
    with pytest.raises(MjmrError) as e:
        list(made.run(Job(TOY), load_study(TOY).trials("quick")))
    assert "\n" not in str(e.value)
    return str(e.value), time.monotonic() - begin


def test_no_answer_is_bounded_whatever_listens(monkeypatch):
    assert cluster.CONNECT_SECONDS == 10.0
    monkeypatch.setattr(cluster, "CONNECT_SECONDS", 2.0)
    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))
        silent.listen(5)
        for port in (free_port(), silent.getsockname()[1]):
            address = f"tcp://127.0.0.1:{port}"
            text, seconds = refused(address)
            assert f"no answer from a Dask scheduler at {address} within 2 s" in text
            assert seconds < 3.0


def test_no_workers_is_told_after_a_while(monkeypatch, tmp_path):
    monkeypatch.setattr(cluster, "CONNECT_SECONDS", 3.0)
    with Cluster(tmp_path) as found:
        text, seconds = refused(found.address)
        assert f"the scheduler at {found.address} has no workers" in text
        assert 3.0 <= seconds < 8.0


def test_a_worker_that_hangs_is_told(monkeypatch, tmp_path):
    monkeypatch.setattr(cluster, "CHECK_SECONDS", 2.0)
    with Cluster(tmp_path) as found:
        worker = found.add(1, "--no-nanny")
        found.wait_for(1)
        worker.send_signal(signal.SIGSTOP)
        text, seconds = refused(found.address)
        assert text.startswith("worker tcp://127.0.0.1:")
        assert "no answer within 2 s" in text
        assert seconds < 12.0


def test_workers_with_threads_are_refused(tmp_path):
    with Cluster(tmp_path) as found:
        found.add(1, "--nthreads", "3")
        found.wait_for(1)
        text, _ = refused(found.address)
    assert text.startswith("worker tcp://127.0.0.1:")
    assert text.endswith(
        "has 3 threads where trials need one each: start workers with --nthreads 1"
    )


def test_workers_without_mjmr_are_named(tmp_path):
    """The interpreter of this worker sees everything installed but mjmr."""
    packages = tmp_path / "packages"
    packages.mkdir()
    for entry in Path(sysconfig.get_path("purelib")).iterdir():
        if "mjmr" not in entry.name.lower() and entry.suffix != ".pth":
            (packages / entry.name).symlink_to(entry)
    with Cluster(tmp_path) as found:
        found.add(1, "--no-nanny", before=("-S",), PYTHONPATH=str(packages))
        found.wait_for(1)
        text, _ = refused(found.address)
    assert text.startswith("worker tcp://127.0.0.1:")
    assert text.endswith("has no mjmr; install the driver's version there")


@pytest.mark.parametrize(
    ("preload", "said"),
    [
        (
            "import importlib.metadata as m, types\n"
            "m.distributions = lambda m=m, **k: [m.types.SimpleNamespace(version='9.9')]\n"
            "m.types = types",
            "has mjmr 9.9 where ",
        ),
        (
            "import mjmr.provenance as p\n"
            "p.versions = lambda true=p.versions: true() | {'numpy': '1.0'}",
            "has numpy 1.0 where ",
        ),
        (
            "import mjmr.provenance as p\np.source_digest = lambda *a, **k: 'changed'\n"
            "import tests.toy_study as t, dataclasses\n"
            "t.study = dataclasses.replace(t.study, source_packages=('tests',))",
            "has the same versions but another source of mjmr or of the study",
        ),
        (
            "import tests.toy_study as t\nt.study = None",
            "cannot load the study (MjmrError: tests.toy_study:study is not a Study",
        ),
    ],
)
def test_workers_of_other_code_say_what_differs(tmp_path, preload, said):
    (tmp_path / "preload.py").write_text(preload)
    with Cluster(tmp_path) as found:
        found.add(1, "--no-nanny", "--preload", str(tmp_path / "preload.py"))
        found.wait_for(1)
        text, _ = refused(found.address)
    assert text.startswith("worker tcp://127.0.0.1:")
    assert said in text


@pytest.mark.slow
def test_one_worker_two_and_a_cluster_give_the_same_bits_in_physics(tmp_path):
    study = load_study("safe-navigation")
    trials = [
        (study.condition(mode=mode, scene=scene, sigma_mm=2.0, duration=0.5), seed)
        for mode in ("metric", "physical")
        for scene in ("A", "overlap")
        for seed in (0, 1)
    ]
    job = Job("safe-navigation")
    one = told(LocalExecutor(1).run(job, trials))
    assert {row[2] for row in one} == {"ok"}
    assert told(LocalExecutor(2).run(job, trials)) == one
    with Cluster(tmp_path, 2) as found:
        made = DaskExecutor(found.address, "quick", study.digest("quick"))
        assert told(made.run(job, trials)) == one


def test_a_killed_driver_leaves_the_cluster_usable(tmp_path):
    with Cluster(tmp_path, 1, TOY_SLEEP="0.2") as found:
        words = ["run", TOY, "--no-film", "--out", str(tmp_path / "out")]
        code = "import sys; from mjmr.cli import main; sys.exit(main())"
        command = [sys.executable, "-c", code, *words, "--cluster", found.address]
        driver = subprocess.Popen(command, env=os.environ | {"PYTHONPATH": os.getcwd()})
        end = time.monotonic() + 20.0
        while not (tmp_path / "out" / "results.sqlite").exists() and time.monotonic() < end:
            time.sleep(0.05)
        time.sleep(0.8)
        driver.kill()
        driver.wait()
        assert all(psutil.pid_exists(p.pid) for p in found.worker_processes())
        assert len(run(found)) == 10


def test_a_worker_that_turns_unfit_with_two_trials_in_hand_loses_none(tmp_path, monkeypatch):
    """Both of its answers are there at the same look; the second is of a worker given up."""
    import distributed

    now = distributed.wait

    def late(*arguments, **options):
        time.sleep(1.0)
        return now(*arguments, **options)

    with Cluster(tmp_path, 2) as found:
        made, heard = executor(found)
        outcomes = made.run(Job(TOY), load_study(TOY).trials("quick"))
        first = cluster._ANSWER
        with distributed.Client(found.address, set_as_default=False) as client:
            worst = min(client.nthreads())
        worn = f"__import__('distributed').get_worker().address == {worst!r}"
        monkeypatch.setattr(cluster, "_ANSWER", f"('unfit', 'is worn') if {worn} else {first}")
        monkeypatch.setattr(distributed, "wait", late)
        assert told(outcomes) == told(
            compute(Job(TOY), *t) for t in load_study(TOY).trials("quick")
        )
    assert heard == [f"worker {worst} is worn; it gets no trials"]
