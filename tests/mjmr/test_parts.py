import io
import json
import linecache
import sqlite3
import sys
import textwrap
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console

from mjmr.errors import InvalidInputError, PartError, UnknownNameError
from mjmr.executor import LocalExecutor, compute
from mjmr.part_sources import load, parse_choices
from mjmr.parts import Job, Method, Part, PartChoice, Parts
from mjmr.registry import load_study
from mjmr.runner import RunOptions, default_folder, run_study
from mjmr.store import StoreError, encode, read_meta
from tests.toy_parts import Full, Slow, study

TOY = "tests.toy_parts:study"
CONDITION = study.condition()
(PART,) = study.parts

GOOD = """
import numpy as np


class Drift:
    def __init__(self, n, speed, rng):
        self.speed, self.k = speed, -1
        self.velocity = rng.normal(size=(n, 2)) * speed

    def step(self, position):
        self.k += 1
        return {returned}
"""


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(folder, returned="self.velocity", name="drift.py"):
    (folder / name).write_text(GOOD.format(returned=returned))
    return parse_choices([f"mover={name}:Drift"])


def fail(folder, returned):
    """Error and traceback of a trial whose mover returns this."""
    (folder / "drift.py").write_text(GOOD.format(returned=returned))
    outcome = compute(Job(TOY, parse_choices(["mover=drift.py:Drift"])), CONDITION, 0)
    assert outcome.status == "failed"
    return outcome.error, outcome.traceback


def test_references_are_modules_or_files(here, monkeypatch):
    (here / "sub").mkdir()
    for name in ("a.py", "sub/a.py", "sub/plain"):
        (here / name).write_text(f"# {name}\n")
    monkeypatch.setenv("HOME", str(here))
    given = {
        "mover=my.pkg:Nav": None,
        "mover=a.py:Nav": "# a.py\n",
        "mover=./a.py:Nav": "# a.py\n",
        "mover=sub/plain:Nav": "# sub/plain\n",
        f"mover={here}/sub/a.py:Nav": "# sub/a.py\n",
        "mover=~/sub/a.py:Nav": "# sub/a.py\n",
    }
    for text, source in given.items():
        (choice,) = parse_choices([text])
        assert choice == PartChoice("mover", text.partition("=")[2], source)
        assert str(choice) == text
    assert [c.role for c in parse_choices(["a=x:Y", "b=x:Z"])] == ["a", "b"]


@pytest.mark.parametrize(
    ("texts", "told"),
    [
        (["mover"], "expected ROLE=package.module:Class or ROLE=path/to/file.py:Class, not"),
        (["mover=a.py"], "expected ROLE="),
        (["mover=:Nav"], "expected ROLE="),
        (["mover=a.py:"], "expected ROLE="),
        (["=a.b:C"], "expected ROLE="),
        (["mover=a.b:C D"], "expected ROLE="),
        (["mover=a.b:C", "mover=a.b:D"], "mover is given twice"),
        (["mover=gone.py:Nav"], "cannot read the file of gone.py:Nav: No such file"),
        (["mover=./:Nav"], "cannot read the file of ./:Nav: Is a directory"),
        (["mover=latin.py:Nav"], "cannot read the file of latin.py:Nav: UnicodeDecodeError"),
    ],
)
def test_what_is_no_choice_is_refused(here, texts, told):
    (here / "latin.py").write_bytes(b"# coding: utf-8\nx = '\xe9'\n")
    with pytest.raises((InvalidInputError, PartError)) as e:
        parse_choices(texts)
    assert told in str(e.value)
    assert str(e.value).count("\n") == 0


BROKEN = {
    "def f(:\n": "cannot load x.py:Nav: SyntaxError: invalid syntax (x.py, line 1)",
    "1 / 0\n": "cannot load x.py:Nav: ZeroDivisionError: division by zero",
    "import sys\nsys.exit(3)\n": "cannot load x.py:Nav: SystemExit: 3",
    "class Nev: ...\nfrom pathlib import Path\n": "x.py has no Nav; its classes: Nev",
    "import next_door\n": "No module named 'next_door'; a file travels alone",
    "x = '\0'\n": "cannot load x.py:Nav: ",
}


@pytest.mark.parametrize("source", BROKEN)
def test_a_file_that_cannot_be_loaded_is_one_sentence(source):
    before = set(sys.modules)
    with pytest.raises(PartError) as e:
        study.choose((PartChoice("mover", "x.py:Nav", source),))
    assert BROKEN[source] in str(e.value)
    if "Nev" not in source:
        assert {m for m in set(sys.modules) - before if m.startswith("mjmr_part")} == set()


def test_dotted_references_that_lead_nowhere():
    for reference, told in (
        ("nowhere.at_all:Nav", "set PYTHONPATH"),
        ("tests.toy_parts:Slo", "tests.toy_parts has no Slo; its classes: Slow, Full"),
        ("controllers.motion:Nav", "has no Nav; its classes: Navigator"),
    ):
        with pytest.raises(PartError) as e:
            study.choose((PartChoice("mover", reference),))
        assert told in str(e.value)


def test_unknown_roles_list_the_valid_ones():
    with pytest.raises(UnknownNameError, match="unknown part 'movr'; valid: mover"):
        study.choose((PartChoice("movr", "tests.toy_parts:Full"),))
    with pytest.raises(InvalidInputError, match="study toy declares no parts"):
        load_study("tests.toy_study:study").choose((PartChoice("coin", "a:B"),))


def test_modules_of_files_can_hold_dataclasses_and_are_told_apart():
    source = "from dataclasses import dataclass\n@dataclass\nclass A:\n    x: 'int' = {}\n"
    one, two = (load(PartChoice("a", "a.py:A", source.format(i))) for i in (1, 2))
    assert (one().x, two().x) == (1, 2)
    assert one.__module__ != two.__module__


CANNOT = {
    "Nav = 3": "it is no class but a int",
    "class Nav: ...": "its constructor takes ()",
    "class Nav:\n def __init__(self, n, speed): ...": "its constructor takes (n, speed)",
    "class Nav:\n def __init__(self, n, speed, rng, *, k): ...": "(n, speed, rng, *, k)",
    "class Nav:\n def __init__(self, *a): ...": "it has no method step",
    "class Nav:\n step = 3\n def __init__(self, *a): ...": "its step is no method but a int",
    "class Nav:\n def __init__(self, *a): ...\n def step(self): ...": "method step takes (self)",
    "class Nav:\n def __init__(self, *a): ...\n def step(self, p, q): ...": "(self, p, q)",
    "class Nav:\n def __init__(self, *a): ...\n @staticmethod\n def step(): ...": "step takes ()",
}


@pytest.mark.parametrize("source", CANNOT)
def test_a_class_that_cannot_take_the_role_is_refused_before_any_trial(source):
    with pytest.raises(PartError) as e:
        study.choose((PartChoice("mover", "x.py:Nav", source),))
    told = str(e.value)
    assert told.startswith("x.py:Nav cannot be the mover: ")
    assert CANNOT[source] in told
    assert told.endswith(
        "; a mover has __init__(n, speed, rng) and step(position) -> (n, 2) [m/s, world frame]"
    )


@pytest.mark.parametrize(
    "source",
    [
        "class Nav:\n def __init__(self, a, b, c, d=1): ...\n def step(self, p, more=()): ...",
        "class Nav:\n def __init__(self, *a): ...\n @staticmethod\n def step(p): ...",
        "class Nav:\n def __init__(self, *a): ...\n @classmethod\n def step(cls, p): ...",
        "def Nav(n, speed, rng): ...",
    ],
)
def test_other_names_and_more_arguments_are_welcome(source):
    assert study.choose((PartChoice("mover", "x.py:Nav", source),)).chosen


def test_the_published_parts_can_take_their_own_roles():
    for reference in (TOY, "safe-navigation"):
        declared = load_study(reference)
        assert declared.parts
        declared.choose([PartChoice(part.role, part.default) for part in declared.parts])


def test_a_shape_names_arguments_of_the_constructor():
    with pytest.raises(InvalidInputError, match="a size 'm', which is no argument"):
        Part(role="a", doc="", default="a:B", methods=(Method(name="f", returns=("m", 2)),))


def test_only_a_swapped_part_is_guarded():
    assert Parts(study.parts)["mover"] is Slow
    swapped = Parts(study.parts, [PartChoice("mover", "tests.toy_parts:Full")])["mover"]
    assert swapped is not Full
    mover = swapped(4, 1.0, np.random.default_rng(0))
    assert mover.step(np.zeros((4, 2))).shape == (4, 2)
    assert mover.velocity.shape == (4, 2)
    assert not hasattr(mover, "sampled")


NEEDS = "; step must return finite floats of shape (4, 2) [m/s, world frame]"


@pytest.mark.parametrize(
    ("returned", "told"),
    [
        ("self.velocity[:3]", "returned shape (3, 2) at tick 0 (0.000 s)"),
        ("self.velocity[:, 0]", "returned shape (4,) at tick 0 (0.000 s)"),
        ("None", "returned nothing at tick 0 (0.000 s)"),
        ("'fast'", "returned a str, no numbers at tick 0 (0.000 s)"),
        ("[[1, 2], [3]]", "returned rows of unequal length at tick 0 (0.000 s)"),
        ("self.velocity + 0j", "returned a ndarray, no numbers at tick 0 (0.000 s)"),
        (
            "np.where((self.k == 17) & (np.arange(4) == 2)[:, None], np.nan, self.velocity)",
            "returned NaN for robot 2 at tick 17 (1.700 s)",
        ),
        (
            "np.where((self.k == 3) & (np.arange(4) % 2 == 1)[:, None], np.inf, self.velocity)",
            "returned infinity for robots 1, 3 at tick 3 (0.300 s)",
        ),
    ],
)
def test_what_a_swapped_part_returns_is_checked(here, returned, told):
    error, _ = fail(here, returned)
    assert error == f"PartError: mover drift.py:Drift {told}{NEEDS}"


def test_an_error_inside_a_swapped_part_names_it_and_shows_its_lines(here):
    error, traceback = fail(here, "position[self.k + 1]['x'] if self.k == 1 else self.velocity")
    assert error.startswith(
        "PartError: mover drift.py:Drift raised in step at tick 1 (0.100 s): IndexError: "
    )
    assert 'File "drift.py", line 12, in step' in traceback
    assert "return position[self.k + 1]['x']" in traceback
    told = "raised in step at tick 0 (0.000 s): SystemExit: 3"
    assert told in fail(here, "__import__('sys').exit(3)")[0]
    (here / "drift.py").write_text("class Drift:\n def __init__(s, *a): [][1]\n def step(s, p): 0")
    choice = parse_choices(["mover=drift.py:Drift"])
    error = compute(Job(TOY, choice), CONDITION, 0).error
    told = "PartError: mover drift.py:Drift raised in its constructor: IndexError: "
    assert error.startswith(told)


def test_without_a_simulation_calls_are_counted():
    source = "class Nav:\n def __init__(s, *a): ...\n def step(s, p): return p"
    mover = Parts([PART], [PartChoice("mover", "x.py:Nav", source)])["mover"](1, 1.0, None)
    mover.step(np.zeros((1, 2)))
    with pytest.raises(PartError, match="returned NaN for robot 0 at call 1; "):
        mover.step(np.full((1, 2), np.nan))


def test_a_function_that_builds_an_object_without_the_method_is_told():
    mover = Parts([PART], [PartChoice("mover", "x.py:Nav", "def Nav(*a): return a")])["mover"]
    with pytest.raises(PartError, match="built an object without a method step"):
        mover(1, 1.0, None)


def test_a_method_a_class_may_have_must_fit_if_it_is_there():
    turn = Method(name="turn", arguments=("angle",), returns=("n",), unit="rad", optional=True)
    part = replace(PART, methods=(*PART.methods, turn))
    source = "class Nav:\n def __init__(s, *a): ...\n def step(s, p): return p\n"

    def mover(more=""):
        return Parts([part], [PartChoice("mover", "x.py:Nav", source + more)])["mover"](2, 1.0, 0)

    assert not hasattr(mover(), "turn")
    np.testing.assert_array_equal(mover(" def turn(s, a): return a").turn([0.0, 1.0]), [0.0, 1.0])
    with pytest.raises(PartError, match="its method turn takes"):
        mover(" def turn(s): ...")
    with pytest.raises(PartError, match="turn must return finite floats of shape"):
        mover(" def turn(s, a): return a").turn([0.0])


def test_a_part_that_changes_what_it_gets_or_gave_does_no_harm():
    source = "class Nav:\n def __init__(s, *a): ...\n def step(s, p):\n  p += 1.0\n  return p\n"
    mover = Parts([PART], [PartChoice("mover", "x.py:Nav", source)])["mover"](2, 1.0, None)
    given = np.zeros((2, 2))
    np.testing.assert_array_equal(mover.step(given), np.ones((2, 2)))
    assert (given == 0.0).all()
    full = Parts([PART], [PartChoice("mover", "tests.toy_parts:Full")])["mover"]
    kept = full(2, 1.0, np.random.default_rng(0))
    before = kept.velocity.copy()
    kept.step(given)[:] = 7.0
    np.testing.assert_array_equal(kept.velocity, before)


def told(outcomes):
    return sorted((o.condition.key, o.seed, o.status, encode(o.metrics), o.error) for o in outcomes)


def test_two_workers_compute_a_file_that_has_gone_like_this_process(here):
    choices = write(here)
    (here / "drift.py").unlink()
    trials = study.trials("quick")
    two = told(LocalExecutor(2).run(Job(TOY, choices), trials))
    assert [t[2] for t in two] == ["ok"] * 16
    assert all('"name":"Guard"' in t[3] for t in two)
    assert two == told(compute(Job(TOY, choices), *trial) for trial in trials)
    assert two != told(compute(Job(TOY), *trial) for trial in trials)


def test_a_worker_runs_what_the_driver_read(here):
    choices = write(here)
    before = told([compute(Job(TOY, choices), CONDITION, 0)])
    write(here, "self.velocity * 0")
    assert told(LocalExecutor(1).run(Job(TOY, choices), [(CONDITION, 0)])) == before


def test_compiled_functions_of_a_file_need_no_file():
    source = (
        "from mjmr.jit import njit\n@njit\ndef f(x):\n    return 2.0 * x\n"
        "class Nav:\n def __init__(s, *a): ...\n def step(s, p): return f(p)\n"
    )
    choice = PartChoice("mover", "/nowhere/compiled.py:Nav", source)
    mover = Parts([PART], [choice])["mover"](1, 1.0, None)
    np.testing.assert_array_equal(mover.step(np.ones((1, 2))), [[2.0, 2.0]])


def test_chosen_parts_are_in_the_digest(here, monkeypatch):
    from mjmr.provenance import source_digest

    def digest(*choices):
        return study.choose(choices).digest("quick")

    published, full = digest(), digest(PartChoice("mover", "tests.toy_parts:Full"))
    drift = digest(*write(here))
    (here / "sub").mkdir()
    assert digest(*write(here, name="sub/moved.py")) == drift  # the same text elsewhere
    edited = digest(*write(here, "1.0 * self.velocity"))
    assert digest() == published == study.digest("quick")
    assert len({published, full, drift, edited}) == 4
    monkeypatch.syspath_prepend(str(here))
    (here / "mypkg").mkdir()
    (here / "mypkg/__init__.py").write_text("")
    (here / "mypkg/gain.py").write_text("GAIN = 1.0\n")
    (here / "mypkg/nav.py").write_text(GOOD.format(returned="self.velocity"))
    (here / "lone.py").write_text(GOOD.format(returned="self.velocity"))
    for reference, changed, unrelated in (
        ("mypkg.nav:Drift", "mypkg/gain.py", "unrelated.py"),
        ("lone:Drift", "lone.py", "unrelated.py"),
    ):
        before = digest(PartChoice("mover", reference))
        source_digest.cache_clear()
        (here / unrelated).write_text("x = 1\n")
        assert digest(PartChoice("mover", reference)) == before
        with (here / changed).open("a") as file:
            file.write("# changed\n")
        source_digest.cache_clear()
        assert digest(PartChoice("mover", reference)) != before


def run(folder, choices=(), **options):
    out, messages = io.StringIO(), io.StringIO()
    options = {"workers": 1, "film": False, "out": folder, **options}
    result = run_study(
        RunOptions(study=TOY, parts=choices, **options),
        Console(file=out, width=200),
        Console(file=messages, width=200),
    )
    return result, out.getvalue(), messages.getvalue()


def test_a_run_says_what_was_swapped(here):
    choices = write(here)
    result, out, _ = run(None, choices, seeds=1, film=True)
    folder = here / "renders/toy-parts/quick+mover=Drift"
    assert result.folder.resolve() == folder
    assert (folder / "film.mp4").read_text() == "Guard"  # the film shows the swapped part
    record = json.loads((folder / "run.json").read_text())
    kept = {"role": "mover", "reference": "drift.py:Drift", "source": choices[0].source}
    assert record["parts"] == [kept]
    assert "--with mover=drift.py:Drift" in record["command"]
    meta = read_meta(folder) or {}
    assert meta["parts"] == [kept]
    assert meta["digest"] != meta["digest_of_published"] == study.digest("quick")
    title = (folder / "claims.md").read_text().splitlines()[0]
    assert title == "# toy-parts, size quick, with mover=drift.py:Drift: Movers"
    assert "with mover=drift.py:Drift" in out


def test_default_folders_never_mix():
    two = replace(study, parts=(*study.parts, replace(PART, role="aide")))
    chosen = [
        PartChoice("mover", "tests.toy_parts:Full"),
        PartChoice("aide", "tests.toy_parts:Slow"),
    ]
    names = [
        default_folder(s, "quick").name for s in (two, two.choose(chosen), two.choose(chosen[1:]))
    ]
    assert names == ["quick", "quick+aide=Slow+mover=Full", "quick+aide=Slow"]


def test_an_edited_file_is_refused_its_old_folder(here):
    folder = here / "results"
    run(folder, write(here), seeds=1)
    with sqlite3.connect(folder / "results.sqlite") as db:
        before = db.execute("SELECT * FROM trials").fetchall()
    for other in (write(here, "2 * self.velocity"), ()):
        with pytest.raises(StoreError, match="holds results of another configuration or source"):
            run(folder, other, seeds=1)
    with sqlite3.connect(folder / "results.sqlite") as db:
        assert db.execute("SELECT * FROM trials").fetchall() == before
    _, _, messages = run(folder, write(here), seeds=2)
    assert "resuming: 2 of 4" in messages


def test_a_trial_that_a_part_spoils_has_failed(here):
    choices = write(here, "self.velocity * (np.nan if self.k == 5 and self.speed > 0.5 else 1)")
    result, _, messages = run(here / "r", choices, seeds=1)
    assert result.exit_code == 1
    assert (result.table.finished, result.table.failed) == (1, 1)
    assert "mover drift.py:Drift returned NaN for robots 0, 1, 2, 3 at tick 5" in messages


@pytest.mark.parametrize("flag", ["check", "accept"])
def test_verdicts_are_of_the_published_parts(here, flag):
    with pytest.raises(InvalidInputError, match=f"--{flag} takes the published parts.*--with"):
        RunOptions(study=TOY, parts=write(here), **{flag: True})


def test_text_of_a_file_is_kept_for_tracebacks():
    load(PartChoice("a", "kept.py:A", textwrap.dedent("class A:\n    pass\n")))
    linecache.checkcache()
    assert linecache.getline("kept.py", 1) == "class A:\n"
