import contextlib
import csv
import json
import os
import subprocess
import sys

import pytest

from mjmr.cli import COMMANDS, main

MAIN = "import sys; from mjmr.cli import main; sys.exit(main())"


@pytest.fixture(autouse=True)
def toys(monkeypatch, tmp_path):
    entries = {"toy": "toy_study:study", "toy-raise": "toy_study:raising"}
    entries["toy-parts"] = "toy_parts:study"
    told = " ".join(f"{name}=tests.{where}" for name, where in entries.items())
    monkeypatch.setenv("MJMR_STUDIES", told)
    monkeypatch.delenv("MJMR_DEBUG", raising=False)
    monkeypatch.chdir(tmp_path)


BAD = {
    "": "a command is missing: list, show, run",
    "rum toy": "unknown command 'rum'; valid: run",
    "run": "missing from mjmr run: STUDY",
    "run tyo": "unknown study 'tyo'; valid: toy, toy-",
    "run toy extra": "unrecognized options: extra",
    "run toy --sise quick": "perhaps --size",
    "run toy --size": "missing value for argument '--size'",
    "run toy --size quik": "unknown size 'quik'; valid: quick",
    "run toy --seeds 0": "--seeds must be a whole number of at least 1, not '0'",
    "run toy --seeds -1": "--seeds must be a whole number of at least 1, not '-1'",
    "run toy --seeds many": "--seeds must be a whole number",
    "run toy --workers 0": "--workers must be a whole number",
    "run toy --workers 1.5": "--workers must be a whole number",
    "run toy --only bis=1": "unknown condition 'bis'; valid: bias",
    "run toy --only bias=0.95": "unknown value of bias '0.95'; valid: 0.5, 0.9",
    "run toy --only bias=much": "unknown value of bias 'much'",
    "run toy --only bias": "expected key=value[,value...], not 'bias'",
    "run toy --only bias=0.5 bias=0.9": "bias is given twice",
    "run toy --only bias=1.0": "size quick of toy has no condition with bias=1.0",
    "run toy --check": "no verdicts of toy are committed for size quick",
    "run toy --check --seeds 2": "--check takes a whole size",
    "run toy --check --only bias=0.5": "--check takes a whole size",
    "run toy --check --accept": "--check and --accept exclude each other",
    "run toy --out file/below": "cannot",
    "run nowhere.at_all:study": "cannot load nowhere.at_all:study",
    "run toy --with coin=tests.toy_parts:Full": "study toy declares no parts",
    "run toy --with coin": "expected ROLE=package.module:Class or ROLE=path/to/file.py:Class, not",
    "run toy-parts --with movr=tests.toy_parts:Full": "unknown part 'movr'; valid: mover",
    "run toy-parts --with mover=gone.py:Full": "cannot read the file of gone.py:Full: No such file",
    "run toy-parts --with mover=gone.there:Full": "cannot load gone.there:Full: ModuleNotFoundErr",
    "run toy-parts --with mover=tests.toy_parts:study": "cannot be the mover: it is no class",
    "run toy-parts --with mover=a.b:C --with mover=a.b:D": "mover is given twice",
    "run toy-parts --with mover=a.b:C mover=a.b:D": "mover is given twice",
    "run toy-parts --check --with mover=tests.toy_parts:Full": "--check takes the published parts",
    "run toy-parts --accept --with mover=tests.toy_parts:Full": "--accept takes the published",
    "compare": "missing from mjmr compare: RUN_A RUN_B",
    "compare one": "missing from mjmr compare: RUN_B",
    "compare one two": "no results in one; make them with mjmr run",
    "show": "missing from mjmr show: STUDY",
    "show toi": "unknown study 'toi'; valid: toy",
    "film toy --camera side": "unknown camera 'side'; valid: ",
    "film toy --look good": "unknown look 'good'; valid: ",
    "film toy --out file/below.mp4": "cannot write to file",
    "mjcf toy": "missing from mjmr mjcf: FILE.xml",
    "mjcf toy a.xml mod=metric": "unknown condition 'mod'; valid: mode",
    "mjcf toy a.xml mode=metric,physical": "mode takes one value here",
    "mjcf toy mode=metric": "the file comes before the condition: mjmr mjcf toy FILE.xml",
    "mjcf toy nowhere/a.xml": "cannot write nowhere/a.xml",
    "bench tyo": "unknown study 'tyo'",
    "bench --size hug": "unknown size 'hug'; valid: ",
    "export toy a.csv": "no results in renders/toy/quick; make them with mjmr run",
    "export toy a.csv --size hug": "unknown size 'hug'",
    "export toy a.xlsx": "a file to export to ends in .csv or .parquet, not a.xlsx",
    "run toy --cluster host:8786": "a cluster's address is tcp://host:port",
    "run toy --cluster tcp://h:1 --workers 2": "--cluster and --workers exclude each other",
    "robots pionee": "unknown robot 'pionee'; valid: pioneer2dx, ",
    "robots --view": "--view takes the name of a robot",
    "robots soccer_bot --out a.png": "it takes --view",
    "robots soccer_bot --view --out nowhere/a.png": "there is no folder nowhere",
    "list all": "unrecognized options: all",
}


@pytest.mark.parametrize("line", BAD)
def test_bad_input_is_one_sentence_and_exit_2(line, capsys, tmp_path):
    (tmp_path / "file").write_text("")
    assert main(line.split()) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert err.startswith("mjmr: ")
    assert BAD[line] in err
    assert [p.name for p in tmp_path.iterdir()] == ["file"]


def test_help_of_every_command_reads_like_a_manual(capsys):
    assert main(["--help"]) == 0
    text = capsys.readouterr().out
    for command in COMMANDS:
        assert f"\n  {command}" in text
        with pytest.raises(SystemExit) as e:
            main([command, "--help"])
        assert e.value.code == 0
        told = capsys.readouterr().out
        assert f"usage: mjmr {command}" in told
        assert "EXAMPLES" in told
        assert "EXIT CODES" in told
        assert max(len(line) for line in told[told.index("EXAMPLES") :].splitlines()) <= 100


def test_list_and_show(capsys):
    assert main(["list"]) in (0, 1)  # 1 if an installed study is broken
    assert "toy-raise" in capsys.readouterr().out
    assert main(["show", "toy"]) == 0
    shown = capsys.readouterr().out
    for words in ("Ars Conjectandi", "0.0, 0.5, 0.9, 1.0", "standard", "82", "bias-shows", "> 0"):
        assert words in shown


def test_show_lists_parts_and_what_they_demand(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    main(["show", "toy-parts"])
    shown = capsys.readouterr().out
    for words in (
        "mover",
        "velocities from positions",
        "tests.toy_parts:Slow",
        "__init__(n, speed, rng)",
        "step(position) -> (n, 2) [m/s, world frame]",
        "may have nothing: for nobody",
    ):
        assert words in shown
    main(["show", "toy"])
    assert "--with" not in capsys.readouterr().out


def test_swap_a_part_and_compare(capsys, tmp_path, monkeypatch):
    monkeypatch.setenv("COLUMNS", "140")
    words = ["run", "toy-parts", "--workers", "1", "--no-film"]
    assert main(words) == 0
    (tmp_path / "mine.py").write_text("from tests.toy_parts import Full\n\nclass Fast(Full): ...\n")
    assert main([*words, "--with", "mover=mine.py:Fast"]) == 0
    assert "results in renders/toy-parts/quick+mover=Fast" in capsys.readouterr().err
    (tmp_path / "mine.py").unlink()
    runs = ["renders/toy-parts/quick", "renders/toy-parts/quick+mover=Fast"]
    assert main(["compare", *runs, "--by", "speed", "--out", "found.csv"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    assert "B: renders/toy-parts/quick+mover=Fast (quick, mover=mine.py:Fast)" in out
    (line,) = [line for line in out.splitlines() if "speed=0.4" in line and " way " in line]
    told = " ".join(line.replace("│", " ").split())
    # seven comparisons: three metrics twice, and one that slow robots alone have
    assert told == "speed=0.4 way 0.4 0.8 +0.4 [0.4, 0.4] 8 0.0078* 0.055"
    assert "verdicts of the whole runs: 1 of 2 differ, A -> B\n  slow: holds -> fails" in out
    with (tmp_path / "found.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert {r["speed"] for r in rows} == {"0.4", "0.8"}


def test_a_broken_study_does_not_hide_the_others(capsys, monkeypatch):
    monkeypatch.setenv("MJMR_STUDIES", "toy=tests.toy_study:study lost=nowhere.at_all:study")
    assert main(["list"]) == 1
    out, err = capsys.readouterr()
    assert "toy" in out
    assert "lost: cannot load nowhere.at_all:study" in err


def test_from_run_to_export(capsys, tmp_path):
    assert main(["run", "toy", "--workers", "1", "--no-film", "--only", "bias=0.9"]) == 0
    out, err = capsys.readouterr()
    assert "bias-shows" in out
    assert "results in renders/toy/quick" in err
    assert json.loads((tmp_path / "renders/toy/quick/run.json").read_text())["only"] == ["bias=0.9"]
    assert main(["export", "toy", "trials.csv"]) == 0
    with (tmp_path / "trials.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [r["seed"] for r in rows] == ["0", "1", "2", "3"]
    assert {r["status"] for r in rows} == {"ok"}


def test_a_film_does_not_go_beside_results_of_other_code(capsys, tmp_path, monkeypatch):
    assert main(["run", "toy", "--workers", "1", "--no-film", "--only", "bias=0.9"]) == 0
    monkeypatch.setattr("mjmr.provenance.versions", lambda: {"mjmr": "0"})
    capsys.readouterr()
    assert main(["film", "toy"]) == 2
    assert "renders/toy/quick holds results of another" in capsys.readouterr().err
    assert not (tmp_path / "renders/toy/quick/film.mp4").exists()
    assert main(["film", "toy", "--out", "other.mp4"]) == 0
    assert (tmp_path / "other.mp4").exists()


def test_mjcf_film_bench_version(capsys, tmp_path, monkeypatch):
    assert main(["mjcf", "toy", "model.xml", "mode=physical"]) == 0
    assert (tmp_path / "model.xml").read_text() == "<mujoco model='physical'/>"
    assert (
        main(
            [
                "film",
                "toy",
                "--camera",
                "chase",
                "--look",
                "fine",
                "--size",
                "full",
                "--out",
                "a.mp4",
            ]
        )
        == 0
    )
    assert (tmp_path / "a.mp4").read_bytes() == b"toy chase fine"
    assert main(["film", "toy"]) == 0
    assert (tmp_path / "renders/toy/quick/film.mp4").exists()
    monkeypatch.setenv("TOY_FILM", "gl")
    capsys.readouterr()
    assert main(["film", "toy"]) == 1
    assert "libegl1" in capsys.readouterr().err
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    assert main(["bench", "toy"]) == 0
    assert "tosses a second: 1e6" in capsys.readouterr().out
    assert main(["bench"]) == 2
    assert main(["--version"]) == 0
    assert "mjmr 0." in capsys.readouterr().out


def test_tracebacks_only_on_request(monkeypatch, capsys):
    monkeypatch.setattr("mjmr.registry.load_study", lambda name: 1 / 0)
    assert main(["show", "toy"]) == 1
    assert capsys.readouterr().err == (
        "mjmr: unexpected ZeroDivisionError: division by zero (MJMR_DEBUG=1 shows where)\n"
    )
    monkeypatch.setenv("MJMR_DEBUG", "1")
    with pytest.raises(ZeroDivisionError):
        main(["show", "toy"])


def test_help_and_list_load_nothing_heavy():
    code = (
        "import sys\nfrom mjmr.cli import main\nmain(['--help'])\nmain(['list'])\n"
        "heavy = {'mujoco', 'numba', 'matplotlib', 'scipy', 'cv2', 'pebble', 'dm_control'}\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    # Installed studies are not the toy's doing, so only it and what mjmr loads are looked at.
    environment = {**os.environ, "MJMR_STUDIES": "cheap=tests.toy_cheap:study"}
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env=environment
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == "[]"


def test_a_reader_that_leaves_early_is_no_error():
    for words in (["--help"], ["show", "toy"]):
        process = subprocess.Popen(
            [sys.executable, "-c", MAIN, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )
        assert process.stdout is not None
        process.stdout.close()
        assert process.stderr is not None
        assert process.stderr.read() == b""
        assert process.wait() == 141
        process.stderr.close()


def test_complaints_are_sentences_in_any_locale():
    environment = {**os.environ, "LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONIOENCODING": "ascii"}
    for words in (["run", "toy", "--sise", "3"], ["run"], ["run", "toy", "--only", "bias=\xe9"]):
        done = subprocess.run(
            [sys.executable, "-c", MAIN, *words], capture_output=True, env=environment
        )
        assert done.returncode == 2
        assert done.stderr.startswith(b"mjmr: ")
        assert done.stderr.count(b"\n") == 1
        assert b"|" not in done.stderr


def test_failed_trials_are_exit_1_without_traceback(capsys):
    assert main(["run", "toy-raise", "--workers", "1", "--no-film"]) == 1
    out, err = capsys.readouterr()
    assert "the coin rolled away" in err
    assert "Traceback" not in out + err


def test_every_example_in_the_helps_is_good_input(capsys):
    """Each line that starts with mjmr names a command, a study and conditions there are."""
    from mjmr.cli import COMMANDS
    from mjmr.conditions import parse_filter
    from mjmr.registry import load_study

    seen = 0
    for words in ([], *([c] for c in COMMANDS)):
        with contextlib.suppress(SystemExit):
            main([*words, "--help"])
        for line in capsys.readouterr().out.splitlines():
            example = line.split()
            if example[:1] != ["mjmr"] or len(example) < 2 or example[1] not in COMMANDS:
                continue
            others = ("MJMR", "KEY", "navigator=")
            conditions = [w for w in example if "=" in w and not w.startswith(others)]
            if "safe-navigation" in example:
                parse_filter(load_study("safe-navigation").parameters, conditions)
                seen += 1
    assert seen >= 8


def test_declarations_of_installed_studies_load_nothing_heavy():
    code = (
        "import sys\nfrom mjmr.registry import load_study, study_references\n"
        "for name in study_references(): load_study(name)\n"
        "heavy = {'numpy', 'mujoco', 'numba', 'matplotlib', 'scipy', 'cv2', 'shapely'}\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    environment = {k: v for k, v in os.environ.items() if k != "MJMR_STUDIES"}
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env=environment
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == "[]"
