"""Traces say what happened, and looking on changes nothing."""

import json
import re
import subprocess
import sys
from pathlib import Path

import mujoco
import numpy as np
import pytest

from mjmr.cli import main
from mjmr.errors import InvalidInputError, MjmrError
from mjmr.kinematics import KinematicSimulation
from mjmr.registry import load_study
from mjmr.replay import load
from mjmr.sensors.localizer import Localizer
from mjmr.simulation import Simulation
from mjmr.trace import MESSAGE_COLUMNS, Trace
from mjmr.trace_file import unpack
from mjmr.watch import watching
from tests.mjmr.worlds import BOTH, soccer
from tests.toy_physics import trial, world

STUDY = load_study("tests.toy_physics:study")
FACTS = {"study": "toy-physics", "condition": {}, "seed": 0, "error": ""}
DOCS = Path(__file__).resolve().parents[2] / "docs"


def traced(condition, seed, look=Trace):
    """Metrics of the toy trial, what looked on, and the simulation."""
    seen = []
    with watching(lambda simulation: seen.append((look(simulation), simulation))):
        metrics = trial(condition, seed)
    return metrics, *seen[0]


@pytest.fixture(scope="module")
def trace():
    return traced(STUDY.condition(), 4)[1]


@pytest.mark.parametrize("mode", ["physical", "metric"])
def test_a_trial_looked_at_gives_the_same_bits(mode):
    condition = STUDY.condition(mode=mode)
    plain, _, one = traced(condition, 5, look=lambda _: None)
    seen, trace, other = traced(condition, 5)
    assert seen == plain
    assert one._physics_state().tobytes() == other._physics_state().tobytes()
    assert trace.arrays(trace.recording.footage())["times"][-1] == pytest.approx(1.5)


@pytest.mark.parametrize("kind", BOTH)
def test_states_commands_and_set_points_are_those_of_the_loop(kind):
    built, robots = soccer([[-1.0, 0.8, 0.3], [1.0, -0.8, 0.0]], command_latency=2)
    simulation = kind(built)
    trace = Trace(simulation)
    poses, twists, commands, executed = [], [], [], []

    def see():
        poses.append(simulation.truth.poses(robots))
        twists.append(simulation.truth.twists(robots))
        executed.append(robots.executed.copy())

    simulation.observe(see)
    for t in simulation.ticks(0.5):
        command = np.tile([9.0 * t, 0.1, 0.5], (2, 1))
        robots.drive(command)
        commands.append(robots.platform.clamp(command))
    found = trace.arrays(trace.recording.footage())
    np.testing.assert_array_equal(found["poses"], poses)
    np.testing.assert_array_equal(found["twists"], twists)
    np.testing.assert_array_equal(found["set_points"], executed)
    np.testing.assert_array_equal(found["commands"][1:], commands)
    assert not found["commands"][0].any()
    assert np.hypot(*found["commands"][-1, 0, :2]) == pytest.approx(3.0), "after the limits"
    np.testing.assert_allclose(found["times"], np.arange(31) / 60)
    assert found["positions"].shape == (31, trace.recording.footage().model.nq)


def test_every_sample_is_there_and_is_what_a_reader_gets():
    built, robots = soccer([[-1.0, 0.8, 0.3], [1.0, -0.8, 0.0]])
    # faster than the loop: every other sample is superseded before anybody can read it
    robots.mount(Localizer(rate=100.0, latency=0.03, position_noise=0.01, yaw_noise=0.02))
    simulation = Simulation(built, seed=8)
    trace = Trace(simulation)
    read = {}
    for _ in simulation.ticks(1.0):
        read[robots.localizer.sampled_at] = robots.localizer.read().copy()
        robots.drive(np.tile([0.5, 0.0, 0.2], (2, 1)))
    found = trace.arrays(trace.recording.footage())
    key = "sensor_soccer_bot/localizer_"
    np.testing.assert_array_equal(found[key + "numbers"], np.arange(101))
    np.testing.assert_allclose(found[key + "sampled"], np.arange(101) / 100, atol=1 / 240)
    late = found[key + "delivered"] - found[key + "sampled"]
    np.testing.assert_allclose(late, 0.03, atol=1 / 240)
    by_time = dict(zip(found[key + "sampled"], found[key + "values"], strict=True))
    del read[next(t for t in read if np.isnan(t))]
    assert 50 <= len(read) < 60
    for time, value in read.items():
        np.testing.assert_array_equal(by_time[time], value)


def test_contacts_carry_the_weight_of_what_rests():
    """A ball of 46 g presses 0.451 N on the floor; a pile's sum is the pile's weight."""
    built, _ = soccer([[-1.0, 0.8, 0.0]])
    built.add_golf_ball(0.5, 0.5)
    built.add_box(1.0, -0.5, 0.3, 0.2, mass=2.0)
    simulation = Simulation(built)
    trace = Trace(simulation)
    for _ in simulation.ticks(2.0):
        pass
    found = trace.arrays(trace.recording.footage())
    last = slice(*found["contact_offsets"][-2:])
    names = found["body_names"][found["contact_bodies"][last]]
    forces = found["contact_forces"][last]
    for body, weight in (("ball0", 0.046 * 9.81), ("box1", 2.0 * 9.81)):
        mine = (names == body).any(axis=1)
        assert mine.any()
        assert (names[mine] == "world").any(axis=1).all()
        assert forces[mine].sum() == pytest.approx(weight, rel=0.02)
        assert (found["contact_distances"][last][mine] <= 0.0).all()
    geoms = found["geom_names"][found["contact_geoms"][last]]
    assert {"ball0", "box1"} <= set(geoms.ravel().tolist())
    assert len(found["contact_forces"]) == found["contact_offsets"][-1]


def test_normal_forces_are_mujocos_in_both_cones():
    for cone in (mujoco.mjtCone.mjCONE_PYRAMIDAL, mujoco.mjtCone.mjCONE_ELLIPTIC):
        built, _ = soccer([[-1.0, 0.8, 0.0]])
        built.add_box(1.0, -0.5, 0.3, 0.2, mass=2.0)
        built.add_golf_ball(0.5, 0.5)
        built.edit(lambda spec, cone=cone: setattr(spec.option, "cone", cone))
        simulation = Simulation(built)
        trace = Trace(simulation)
        for _ in simulation.ticks(0.2):
            pass
        wanted = np.zeros((simulation.data.ncon, 6))
        for k in range(simulation.data.ncon):
            mujoco.mj_contactForce(simulation.model, simulation.data, k, wanted[k])
        found = trace.arrays(trace.recording.footage())
        last = slice(*found["contact_offsets"][-2:])
        assert len(wanted) >= 4
        np.testing.assert_allclose(found["contact_forces"][last], wanted[:, 0], rtol=1e-12)


class Big(Localizer):
    """As large as a camera's picture."""

    def nothing(self):
        return np.zeros((self._group.n, 200, 200))

    def compute(self, state, number):
        raise AssertionError("a picture nobody wants is not computed")


class Broken(Localizer):
    def compute(self, state, number):
        raise MjmrError("no light")


def test_large_samples_are_left_out_and_broken_ones_do_not_fail_the_trial(tmp_path):
    built, robots = soccer([[-1.0, 0.8, 0.0]])
    robots.mount(Big(rate=10.0), "eye")
    robots.mount(Broken(rate=10.0), "lamp")
    simulation = KinematicSimulation(built)
    trace = Trace(simulation)
    for _ in simulation.ticks(0.5):
        pass
    assert list(trace.left_out) == ["soccer_bot/eye", "soccer_bot/lamp"]
    assert "16384" in trace.left_out["soccer_bot/eye"]
    trace.save(tmp_path / "t.npz", FACTS)
    head, _, arrays = unpack(tmp_path / "t.npz")
    assert head["left_out"] == trace.left_out
    kept = {name.split("_values")[0] for name in arrays if name.endswith("_values")}
    assert kept == {"sensor_soccer_bot/localizer"}


def test_a_simulation_forgets_who_followed_its_sensors_before():
    built, robots = soccer([[-1.0, 0.8, 0.0]])
    trace = Trace(KinematicSimulation(built))
    for _ in KinematicSimulation(built).ticks(0.5):
        pass
    assert not any(trace._samples.values())


def test_a_file_has_everything_and_numpy_alone_reads_it(trace, tmp_path):
    trace.save(tmp_path / "t.npz", {**FACTS, "condition": {"act": "well"}, "seed": 4})
    assert [p.name for p in tmp_path.iterdir()] == ["t.npz"]
    with np.load(tmp_path / "t.npz", allow_pickle=False) as archive:
        head = json.loads(str(archive["header"]))
        found = {name: archive[name] for name in archive.files}
    assert (head["kind"], head["format"], head["seed"]) == ("trace", 1, 4)
    assert head["condition"] == {"act": "well"}
    assert {"mjmr", "mujoco", "numpy"} <= set(head["versions"])
    assert head["robots"] == ["soccer_bot0", "soccer_bot1"]
    assert head["sensors"]["soccer_bot/localizer"]["rate"] == 100.0
    model = mujoco.MjModel.from_xml_string(head["model_xml"])
    assert found["positions"].shape == (91, model.nq)
    assert model.opt.timestep == pytest.approx(head["timestep"])
    for name, dtype in MESSAGE_COLUMNS.items():
        assert (found[name].shape, found[name].dtype) == ((0,), dtype)
    np.testing.assert_array_equal(found["note_goals"][-1], [[1.0, 0.3], [-1.0, -0.3]])
    assert np.isnan(found["note_goals"][0]).all(), "nothing was noted before the first tick"
    documented = (DOCS / "look-closer.md").read_text()
    for name in found:
        general = re.sub(r"^sensor_.*_", "sensor_GROUP/NAME_", name)
        last = "_" + name.rpartition("_")[2]
        assert any(f"`{word}`" in documented for word in (general, last)), name


@pytest.mark.parametrize("mode", ["physical", "metric"])
def test_a_replay_of_a_trace_shows_what_the_recording_shows(mode, tmp_path):
    from mjmr.film import Film
    from mjmr.film_options import FilmOptions

    _, trace, _ = traced(STUDY.condition(mode=mode, duration=0.5), 1)
    trace.save(tmp_path / "t.npz", FACTS)
    options = FilmOptions(width=320, height=240)
    stills = []
    for shown in (trace.recording, load(tmp_path / "t.npz").footage):
        film = Film("t", options)
        film.add(shown)
        stills.append(film.still(0.4))
    np.testing.assert_array_equal(stills[0], stills[1])
    start = Film("t", options)
    start.add(trace.recording)
    assert (start.still(0.0) != stills[0]).any()


def rows(table, **wanted):
    return [r for r in table.to_pylist() if all(r[k] == v for k, v in wanted.items())]


def test_parquet_has_the_same_numbers(trace, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    trace.save(tmp_path / "t.parquet", FACTS)
    table = parquet.read_table(tmp_path / "t.parquet")
    found = trace.arrays(trace.recording.footage())
    head = json.loads(table.schema.metadata[b"mjmr"])
    assert head["model_xml"].startswith("<mujoco")
    yaw = rows(table, kind="pose", robot="soccer_bot1", field="yaw")
    assert [r["value"] for r in yaw] == found["poses"][:, 1, 2].tolist()
    assert [r["time"] for r in yaw] == found["times"].tolist()
    for kind, name in (("command", "commands"), ("set_point", "set_points"), ("twist", "twists")):
        left = rows(table, kind=kind, robot="soccer_bot0", field="left")
        assert [r["value"] for r in left] == found[name][:, 0, 1].tolist()
    reported = rows(table, kind="sensor", source="soccer_bot/localizer", robot="soccer_bot1",
                    field="1")  # fmt: skip
    key = "sensor_soccer_bot/localizer_"
    assert [r["number"] for r in reported] == found[key + "numbers"].tolist()
    assert [r["delivered"] for r in reported] == found[key + "delivered"].tolist()
    assert [r["value"] for r in reported] == found[key + "values"][:, 1, 1].tolist()
    forces = rows(table, kind="contact", field="normal_force")
    assert [r["value"] for r in forces] == found["contact_forces"].tolist()
    counts = np.diff(found["contact_offsets"])
    assert [r["number"] for r in forces] == [k for count in counts for k in range(count)]
    assert {r["source"] for r in forces} >= {"world | ball0"}
    coordinates = rows(table, kind="position", field="qpos3")
    assert [r["value"] for r in coordinates] == found["positions"][:, 3].tolist()
    assert len(rows(table, kind="note", robot="soccer_bot0", field="goals_y")) == 91
    assert len(rows(table, kind="caption")) == 91


def test_parquet_without_contacts_or_samples(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    built, robots = soccer([[-1.0, 0.8, 0.0]])
    robots.mount(Localizer(rate=1.0, phase=100.0))
    simulation = KinematicSimulation(built)
    trace = Trace(simulation)
    for _ in simulation.ticks(0.1):
        pass
    trace.save(tmp_path / "t.parquet", FACTS)
    kinds = set(parquet.read_table(tmp_path / "t.parquet")["kind"].to_pylist())
    assert kinds == {"pose", "twist", "command", "set_point", "position", "caption"}


def test_the_reading_example_of_the_page_runs(trace, tmp_path):
    pytest.importorskip("pyarrow")
    trace.save(tmp_path / "trial.parquet", FACTS)
    (code,) = re.findall(
        r"^```python\n(.*?)^```", (DOCS / "look-closer.md").read_text(), re.M | re.S
    )
    assert len([line for line in code.splitlines() if line.strip()]) <= 10
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert "soccer_bot1" in done.stdout
    assert "world | ball0" in done.stdout


def test_parquet_without_pyarrow_is_one_clear_sentence(trace, tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(MjmrError, match=r"pip install 'mjmr\[parquet\]'"):
        trace.save(tmp_path / "t.parquet", FACTS)
    monkeypatch.chdir(tmp_path)
    assert main(["trial", "tests.toy_physics:study", "--trace", "t.parquet"]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_a_trace_is_whole_or_not_there(trace, tmp_path, monkeypatch):
    path = tmp_path / "t.npz"
    path.write_bytes(b"before")
    monkeypatch.setattr(
        "os.replace", lambda *_: (_ for _ in ()).throw(OSError(28, "No space left"))
    )
    with pytest.raises(MjmrError, match="cannot write .*No space left"):
        trace.save(path, FACTS)
    assert [p.name for p in tmp_path.iterdir()] == ["t.npz"]
    assert path.read_bytes() == b"before"


def test_other_endings_are_refused(trace, tmp_path):
    with pytest.raises(InvalidInputError, match=r"ends in \.npz or \.parquet"):
        trace.save(tmp_path / "t.csv", FACTS)
    with pytest.raises(InvalidInputError, match="empty"):
        Trace(Simulation(world()[0])).save(tmp_path / "t.npz", FACTS)
    assert not list(tmp_path.iterdir())
