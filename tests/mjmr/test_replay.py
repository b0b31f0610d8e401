"""Failed trials leave a replay of their last second, and replays become films."""

import io
import json
import subprocess
import sys

import av
import cv2
import numpy as np
import pytest
from rich.console import Console

from mjmr.cli import main
from mjmr.errors import InvalidInputError, MjmrError, SimulationDivergedError
from mjmr.executor import compute
from mjmr.failures import failure_path, keep_replay
from mjmr.parts import Job
from mjmr.registry import load_study
from mjmr.replay import load
from mjmr.runner import RunOptions, run_study
from mjmr.simulation import Simulation
from mjmr.store import Outcome
from tests.mjmr.worlds import soccer
from tests.toy_physics import world

TOY = "tests.toy_physics:study"
STUDY = load_study(TOY)


@pytest.fixture(scope="module")
def failed():
    """Outcome of a trial whose physics diverges after a few seconds."""
    return compute(Job(TOY), STUDY.condition(act="explode", duration=60.0), 0)


@pytest.fixture
def file(failed, tmp_path):
    path = tmp_path / "failure.npz"
    path.write_bytes(failed.replay)
    return path


def rewritten(path, **changes):
    """The file with other entries; a callable gets the present one."""
    with np.load(path) as archive:
        entries = dict(archive)
    for name, change in changes.items():
        entries[name] = change(entries[name])
    np.savez(path, **entries)
    return path


def header_with(**changes):
    return lambda text: np.array(json.dumps(json.loads(str(text)) | changes))


def test_a_run_keeps_a_replay_of_a_divergence_and_it_becomes_a_film(tmp_path, capsys):
    messages = io.StringIO()
    options = RunOptions(
        study="tests.toy_physics:exploding", out=tmp_path / "run", workers=1, film=False
    )
    result = run_study(options, Console(file=io.StringIO()), Console(file=messages, width=400))
    assert result.exit_code == 1
    (lost,) = [row for row in result.table.rows if row.status != "ok"]
    assert "SimulationDivergedError: the physics diverged at t = " in lost.error
    path = failure_path(tmp_path / "run", lost.condition, lost.seed)
    assert list((tmp_path / "run" / "failures").iterdir()) == [path]
    assert f"replay with: mjmr replay {path}" in messages.getvalue()
    assert main(["replay", str(path)]) == 0
    told = capsys.readouterr().out
    assert "at 0.25 x" in told
    assert lost.error in told
    with av.open(str(path.with_suffix(".mp4"))) as container:
        frames = [f.to_ndarray(format="rgb24") for f in container.decode(video=0)]
    assert len(frames) == pytest.approx(120, abs=4), "a second at a quarter of its speed, 30 fps"
    changed = [
        (cv2.absdiff(a, b).max(axis=2) > 60).sum()
        for a, b in zip(frames[:-4], frames[4:], strict=True)
    ]
    assert np.mean(np.array(changed) > 50) > 0.9, "robots move all the time"


def test_the_replay_is_the_last_second_before_the_divergence(failed, file):
    assert failed.status == "failed"
    replay = load(file)
    at = float(failed.error.split("t = ")[1].split(" s")[0])
    times = replay.footage.times
    np.testing.assert_allclose(np.diff(times), 1 / 60, atol=1e-9)
    assert len(times) == 61
    assert times[-1] == pytest.approx(at - 1 / 60, abs=1e-3)
    assert replay.error == failed.error
    assert f"failed at t = {at:.3f} s" in replay.footage.caption(60)
    assert "mjWARN_BADQACC" in replay.footage.caption(60)


def test_the_replay_has_the_states_the_trial_had(failed, file):
    """Compared with a trial of the same world that is recorded from outside."""
    from mjmr.recording import Recording
    from mjmr.watch import watching

    kept = []
    with watching(lambda s: kept.append(Recording(s))):
        again = compute(Job(TOY), STUDY.condition(act="explode", duration=60.0), 0)
    assert again.error == failed.error
    footage = load(file).footage
    np.testing.assert_array_equal(footage.positions, kept[0].positions[-61:])
    np.testing.assert_array_equal(footage.poses, kept[0].poses[-61:])
    assert footage.model.dof_damping.min() == -1.5, "edits of the world are in the model"


def test_an_exception_of_the_controller_is_replayed_too(tmp_path):
    outcome = compute(Job(TOY), STUDY.condition(act="raise"), 3)
    assert outcome.error == "RuntimeError: the controller gave up"
    keep_replay(tmp_path, outcome)
    replay = load(failure_path(tmp_path, outcome.condition, 3))
    assert replay.footage.times[0] == 0.0
    assert replay.footage.times[-1] == pytest.approx(31 / 60)
    assert replay.title == f"{TOY} seed 3"


def test_a_divergence_in_the_first_period_shows_the_start(tmp_path):
    outcome = compute(Job(TOY), STUDY.condition(act="explode-at-once"), 0)
    keep_replay(tmp_path, outcome)
    footage = load(failure_path(tmp_path, outcome.condition, 0)).footage
    assert footage.times.tolist() == [0.0]
    np.testing.assert_allclose(footage.poses[0, 0], [-1.0, 0.3, 0.0], atol=1e-12)


def test_what_has_no_states_brings_no_replay():
    metric = compute(Job(TOY), STUDY.condition(act="raise", mode="metric"), 0)
    assert (metric.status, metric.replay) == ("failed", b"")
    toss = compute(Job("tests.toy_study:raising"), load_study("tests.toy_study:raising").condition(
        act="raise"), 0)  # fmt: skip
    assert (toss.status, toss.replay, "no replay" in toss.traceback) == ("failed", b"", False)
    assert compute(Job(TOY), STUDY.condition(), 0).replay == b""


def test_a_trial_that_succeeds_at_last_takes_its_replay_away(tmp_path, failed):
    keep_replay(tmp_path, failed)
    path = failure_path(tmp_path, failed.condition, 0)
    assert path.exists()
    keep_replay(tmp_path, Outcome(failed.condition, 0, "ok", {"x": 1.0}))
    assert not path.exists()


def test_the_last_second_follows_a_restore():
    simulation = Simulation(soccer([[0.0, 0.0, 0.0]])[0])
    for _ in simulation.ticks(0.5):
        pass
    middle = simulation.snapshot()
    for _ in simulation.ticks(1.5):
        pass
    times, positions, velocities = simulation.last_second.states()
    np.testing.assert_allclose(times, 1.0 + np.arange(61) / 60)
    assert positions.shape == (61, simulation.model.nq)
    assert velocities.shape == (61, simulation.model.nv)
    simulation.restore(middle)
    for _ in simulation.ticks(0.1):
        pass
    np.testing.assert_allclose(simulation.last_second.states()[0], 0.5 + np.arange(7) / 60)


def test_a_divergence_is_marked_until_it_is_left():
    built, _ = world()
    simulation = Simulation(built)
    good = simulation.snapshot()
    simulation.data.qvel[:] = 1e12
    with pytest.raises(SimulationDivergedError):
        list(simulation.ticks(0.1))
    assert simulation.diverged
    simulation.restore(good)
    assert not simulation.diverged


def test_the_film_ends_before_a_state_that_is_not_finite(file):
    def spoil(positions):
        positions[50:, 3] = np.nan
        return positions

    assert len(load(rewritten(file, positions=spoil)).footage.times) == 50
    with pytest.raises(MjmrError, match="first state is not finite"):
        load(rewritten(file, positions=lambda p: p * np.nan))


def test_files_that_cannot_be_shown_are_refused_in_one_sentence(file, tmp_path, capsys):
    content = file.read_bytes()

    def refused(sentence, path=file):
        with pytest.raises(MjmrError, match=sentence) as caught:
            load(path)
        assert "\n" not in str(caught.value)
        assert main(["replay", str(path)]) == 2
        assert "mjmr: " in capsys.readouterr().err

    refused("there is no file", tmp_path / "nowhere.npz")
    refused("cannot read", tmp_path)
    file.write_bytes(content[: len(content) // 2])
    refused("damaged")
    middle = len(content) // 2
    file.write_bytes(content[:middle] + bytes(64) + content[middle + 64 :])
    refused("damaged")
    file.write_bytes(b"PAR1")
    refused("damaged, or no .npz file of mjmr's")
    np.savez(file, x=np.zeros(3))
    refused("not a trace or replay file")
    file.write_bytes(content)
    refused(
        "has format 99; this mjmr reads format 1", rewritten(file, header=header_with(format=99))
    )
    for package in ("mjmr", "mujoco"):
        file.write_bytes(content)
        old = json.loads(str(np.load(file)["header"]))["versions"] | {package: "0.0.1"}
        refused(f"was written with {package} 0.0.1.* this is",
                rewritten(file, header=header_with(versions=old)))  # fmt: skip
    file.write_bytes(content)
    refused("positions and poses", rewritten(file, poses=lambda p: p[:, :1]))
    file.write_bytes(content)
    with np.load(file) as archive:
        entries = {name: archive[name] for name in archive.files if name != "poses"}
    np.savez(file, **entries)
    refused("damaged: it has no poses")
    file.write_bytes(content)
    refused("AxisError", rewritten(file, positions=lambda p: p[:, 0]))
    file.write_bytes(content)
    head = json.loads(str(np.load(file)["header"]))
    del head["kind"]
    refused("damaged: it has no kind", rewritten(file, header=lambda _: np.array(json.dumps(head))))
    file.write_bytes(content)
    refused("no .npz file of mjmr's", rewritten(file, header=lambda _: np.array("[1]")))
    np.save(tmp_path / "array.npy", np.zeros(3))
    refused("no .npz file of mjmr's", tmp_path / "array.npy")


def test_bad_options_are_refused(file, tmp_path, capsys):
    for words, sentence in {
        ("--speed", "fast"): "--speed must be a positive number, not 'fast'",
        ("--speed", "0"): "speed must be positive; got 0.0",
        ("--camera", "side"): "unknown camera 'side'",
        ("--follow", "-1"): "--follow must be a whole number of at least 0",
        ("--out", str(tmp_path / "no" / "a.mp4")): "there is no folder",
        ("--out", str(tmp_path)): "it is a folder",
        ("--camera", "chase", "--follow", "99"): "no robot 99 to follow; valid: 0 to 1",
    }.items():
        assert main(["replay", str(file), *words]) == 2
        assert sentence in capsys.readouterr().err


def test_looks_of_a_replay_can_be_chosen(file, tmp_path, capsys):
    out = tmp_path / "chase.mp4"
    words = ["--camera", "chase", "--follow", "1", "--speed", "2", "--out", str(out)]
    assert main(["replay", str(file), *words]) == 0
    assert "at 2 x" in capsys.readouterr().out
    with av.open(str(out)) as container:
        assert sum(1 for _ in container.decode(video=0)) == 15


def test_bounds_of_bad_footage():
    from mjmr.footage import Footage

    model = world()[0].spec().compile()
    with pytest.raises(InvalidInputError, match="empty"):
        Footage(
            model=model, bounds=np.ones(4), radii=np.ones(2), period=0.1, times=np.empty(0),
            positions=np.empty((0, model.nq)), poses=np.empty((0, 2, 3)),
        )  # fmt: skip


_FILM = """
import pathlib, re
from mjmr.bench import _film
write = _film({panels}, 2.0)
def mib(name):
    status = pathlib.Path("/proc/self/status").read_text()
    return int(re.search(name + r":\\s+(\\d+)", status)[1]) / 1024
before = mib("VmRSS")
write()
print(mib("VmHWM") - before)
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.parametrize("panels", [1, 2])
def test_a_film_takes_less_than_300_mib(panels):
    done = subprocess.run(
        [sys.executable, "-c", _FILM.format(panels=panels)],
        capture_output=True, text=True, check=True, timeout=120,
    )  # fmt: skip
    assert 20 < float(done.stdout) < 300
