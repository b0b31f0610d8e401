"""``mjmr trial``."""

import io
import json
import os
import subprocess
import sys
from pathlib import Path

import av
import numpy as np
import pytest
from rich.console import Console

from mjmr import executor
from mjmr.cli import main
from mjmr.cli.trial_command import _film_alone
from mjmr.runner import RunOptions, run_study

ROOT = Path(__file__).resolve().parents[2]
TOY = "tests.toy_physics:study"


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "120")
    return tmp_path


def printed(text):
    """Metrics of the table as texts by name."""
    cells = [[c.strip() for c in line.split("│")[1:-1]] for line in text.splitlines()]
    return dict(row for row in cells if len(row) == 2)


def frames(path):
    with av.open(str(path)) as container:
        return sum(1 for _ in container.decode(video=0))


def test_a_trial_has_the_bits_it_has_in_a_run(here, capsys):
    options = RunOptions(study=TOY, out=here / "run", workers=1, film=False)
    result = run_study(options, Console(file=io.StringIO()), Console(file=io.StringIO()))
    for mode, seed in (("physical", 1), ("metric", 0)):
        (row,) = [r for r in result.table.rows if r.condition["mode"] == mode and r.seed == seed]
        kept = {name: row.metrics[name] for name in ("x", "y", "yaw")}
        words = ["trial", TOY, f"mode={mode}", "--seed", str(seed)]
        for look in ([], ["--film", "a.mp4", "--trace", "a.npz"]):
            assert main([*words, *look]) == 0
            shown = printed(capsys.readouterr().out)
            assert {name: float(shown[name]) for name in kept} == kept
            assert shown["wall_trial"].endswith("(wall time)")


def test_film_and_trace_are_written_and_named(here, capsys):
    assert main(["trial", TOY, "duration=0.5", "--trace", "t.npz", "--film", "--seed", "3"]) == 0
    out = capsys.readouterr().out
    film = here / "renders" / "toy-physics" / "trial-seed3.mp4"
    assert "trace: t.npz" in out
    assert f"film: {film.relative_to(here)}" in out
    assert frames(film) == 15
    with np.load("t.npz") as archive:
        head = json.loads(str(archive["header"]))
    assert head["study"] == "toy-physics"
    assert head["condition"] == {"act": "well", "mode": "physical", "duration": 0.5}
    assert head["seed"] == 3


def test_a_failed_trial_shows_what_happened_up_to_then(here, capsys):
    assert main(["trial", TOY, "act=raise", "--film", "f.mp4", "--trace", "f.npz"]) == 1
    said = capsys.readouterr()
    assert "act=raise, seed 0 failed: RuntimeError: the controller gave up" in said.err
    assert "film: f.mp4" in said.out
    with np.load("f.npz") as archive:
        assert archive["times"][-1] == pytest.approx(31 / 60)
        assert json.loads(str(archive["header"]))["error"].startswith("RuntimeError")
    assert frames("f.mp4") == pytest.approx(16, abs=1)


def test_a_divergence_is_filmed_up_to_the_last_good_state(here, capsys):
    assert main(["trial", TOY, "act=explode", "duration=60", "--trace", "f.npz"]) == 1
    assert "the physics diverged at t = " in capsys.readouterr().err
    with np.load("f.npz") as archive:
        assert np.isfinite(archive["positions"]).all()
        assert archive["times"][-1] > 2.0
    assert main(["replay", "f.npz", "--speed", "20"]) == 0


def test_a_trial_without_a_simulation(here, capsys):
    assert main(["trial", TOY, "act=nothing"]) == 0
    capsys.readouterr()
    assert main(["trial", TOY, "act=nothing", "--trace", "n.npz"]) == 2
    said = capsys.readouterr()
    assert "nothing to film or trace" in said.err
    assert "x" in printed(said.out), "the metrics are shown all the same"
    assert not list(here.iterdir())


def test_what_a_study_builds_to_prepare_is_not_the_trial(capsys):
    """In a fresh process, as the command line is, the study is prepared in the same breath."""
    executor._trial_function.cache_clear()
    assert main(["trial", TOY, "duration=0.5", "--trace", "t.npz"]) == 0
    assert "simulations" not in capsys.readouterr().out
    with np.load("t.npz") as archive:
        assert archive["times"][-1] == pytest.approx(0.5)


def test_of_several_simulations_the_first_is_shown(capsys):
    assert main(["trial", TOY, "act=two", "duration=0.2", "--trace", "t.npz"]) == 0
    assert "built 2 simulations; film and trace show the first" in capsys.readouterr().out
    with np.load("t.npz") as archive:  # the second one is never ticked
        assert archive["times"][-1] == pytest.approx(0.2)


BAD = {
    "": "missing from mjmr trial: STUDY",
    "tests.toy_physics:studi": "cannot load tests.toy_physics:studi",
    "S act=wel": "unknown value of act 'wel'; valid: well",
    "S scene=A": "unknown condition 'scene'; valid: ",
    "S duration=long": "duration takes a number",
    "S act=well,raise": "act takes one value here",
    "S act": "expected key=value",
    "S --seed -1": "--seed must be a whole number of at least 0, not '-1'",
    "S --seed one": "--seed must be a whole number of at least 0, not 'one'",
    "S --trace t.csv": "ends in .npz or .parquet; got t.csv",
    "S --trace no/t.npz": "cannot write no/t.npz: there is no folder no",
    "S --film no/t.mp4": "cannot write no/t.mp4: there is no folder no",
    "S --film --camera side": "unknown camera 'side'",
    "S --film --look good": "unknown look 'good'",
}


@pytest.mark.parametrize("line", BAD)
def test_bad_input_is_one_sentence_and_nothing_is_run(line, capsys, here):
    assert main(["trial", *line.replace("S ", f"{TOY} ").split()]) == 2
    err = capsys.readouterr().err
    assert BAD[line] in err
    assert err.count("\n") == 1, "not even 'running the trial ...'"
    assert not [p for p in here.rglob("*") if p.is_file()]


def test_film_alone_takes_no_value():
    assert _film_alone(["s", "--film"]) == ["s", "--film", ""]
    assert _film_alone(["--film", "--seed", "1"]) == ["--film", "", "--seed", "1"]
    assert _film_alone(["--film", "a=1"]) == ["--film", "", "a=1"]
    assert _film_alone(["--film", "a.mp4"]) == ["--film", "a.mp4"]


def test_numeric_libraries_are_loaded_for_one_thread_as_in_a_worker():
    """In a process of its own: they read the environment once, when numpy is imported."""
    code = (
        "import os, sys; from mjmr.cli import main\n"
        "class Spy:\n"
        "    def find_spec(self, name, *_):\n"
        "        if name == 'numpy': print('numpy', os.environ.get('OPENBLAS_NUM_THREADS'))\n"
        "sys.meta_path.insert(0, Spy())\n"
        f"code = main(['trial', '{TOY}', 'duration=0.1'])\n"
        "print('after', os.environ.get('OPENBLAS_NUM_THREADS'))\n"
        "sys.exit(code)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True,
        env={k: v for k, v in os.environ.items() if not k.endswith("_NUM_THREADS")},
    )  # fmt: skip
    lines = done.stdout.splitlines()
    assert (lines[0], lines[-1]) == ("numpy 1", "after None")


def test_a_condition_that_has_no_world_is_bad_input(capsys):
    assert main(["trial", "safe-navigation", "mode=metric", "drive=omni"]) == 2
    assert "drive=omni needs mode=physical" in capsys.readouterr().err
