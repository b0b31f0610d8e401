"""A study of coin tosses: fast, deterministic, and able to misbehave in every way a study can.

What goes wrong is asked for by conditions and, for what must differ between runs of the same
digest, by environment variables.
"""

import os
import signal
import time
from pathlib import Path

import numpy as np

from mjmr.claims import Bound, Claim, Evidence, Table
from mjmr.conditions import Grid, Parameter
from mjmr.errors import MissingGLError
from mjmr.statistics import paired_difference, proportion
from mjmr.study import Size, Study

PARAMETERS = (
    Parameter("bias", "Probability of heads", 0.5, values=(0.0, 0.5, 0.9, 1.0)),
    Parameter("mode", "Simulation", "metric", values=("metric", "physical")),
    Parameter(
        "act", "How the trial behaves", "well", values=("well", "raise", "die", "die-once", "gl")
    ),
)


def trial(condition, seed):
    log = os.environ.get("TOY_LOG")
    if log:
        with open(log, "a") as file:
            file.write(f"{condition['bias']} {condition['mode']} {seed}\n")
    time.sleep(float(os.environ.get("TOY_SLEEP", "0")))
    match condition["act"]:
        case "raise":
            raise RuntimeError("the coin\nrolled away")
        case "gl":
            raise MissingGLError("no off-screen OpenGL")
        case "die":
            os.kill(os.getpid(), signal.SIGKILL)
        case "die-once":
            mark = Path(os.environ["TOY_MARK"])
            if not mark.exists():
                mark.touch()
                os.kill(os.getpid(), signal.SIGKILL)
    generator = np.random.default_rng(seed)
    tosses = generator.random(100) < condition["bias"]
    return {
        "heads": int(tosses.sum()),
        "first": bool(tosses[0]),
        "noise": np.float64(generator.standard_normal()),
        "undefined": float("nan"),
        "side": "head" if tosses[0] else "tail",
        "nothing": None,
        "pid_free": 1.0,
        "wall_toss": time.perf_counter(),
    }


def claims():
    return [
        Claim(
            id="fair",
            text="The coin is fair.",
            published="50 %",
            how="share of first tosses that are heads, bias 0.5",
            bound=Bound.within(0.0, 1.0),
            needs={"bias": 0.5, "mode": "metric"},
            evaluate=lambda t: Evidence.of(proportion(t.values("first"))),
            sizes=("quick", "standard"),
        ),
        Claim(
            id="bias-shows",
            text="A biased coin gives more heads.",
            how="difference of heads over seeds",
            bound=Bound(">", 0.0),
            needs={"mode": "metric"},
            evaluate=_difference,
            sizes=("quick", "standard"),
        ),
        Claim(
            id="later",
            text="Decided by many tosses.",
            how="mean heads",
            bound=Bound(">=", 40.0),
            evaluate=lambda t: Evidence(float(t.where(bias=0.5).values("heads").mean())),
            sizes=("standard",),
        ),
        Claim(
            id="fast",
            text="Tosses are fast.",
            how="wall time of a trial",
            bound=Bound("<", 1e-9),
            evaluate=lambda t: Evidence(float(t.values("wall_trial").mean())),
            sizes=("quick",),
            timing=True,
        ),
    ]


def _difference(table: Table) -> Evidence:
    a, b = table.where(bias=0.9).pair(table.where(bias=0.5), "heads")
    return Evidence.of(paired_difference(a, b))


def prepare():
    if os.environ.get("TOY_PREPARE_SLEEP"):
        time.sleep(float(os.environ["TOY_PREPARE_SLEEP"]))


def plots(table, folder):
    path = Path(folder) / "heads.svg"
    path.write_text(f"<svg>{len(table.values('heads'))}</svg>")
    return [path]


def film(study, path, options):
    if os.environ.get("TOY_FILM") == "gl":
        raise MissingGLError("no off-screen OpenGL")
    if os.environ.get("TOY_FILM") == "raise":
        raise RuntimeError("film tore")
    Path(path).write_bytes(f"{study.name} {options.camera} {options.look}".encode())


class _World:
    def __init__(self, condition):
        self.condition = condition

    def to_xml(self):
        return f"<mujoco model='{self.condition['mode']}'/>"


def bench():
    return {"tosses a second": "1e6 (spread 2 %)"}


def _study(name="toy", **changes):
    quick = (Grid(bias=(0.5, 0.9)), Grid(seeds=2, mode="physical"))
    fields = {
        "name": name,
        "title": "Coin tosses",
        "paper": "J. Bernoulli, Ars Conjectandi, 1713",
        "summary": "Tosses coins.",
        "parameters": PARAMETERS,
        "sizes": (
            Size("quick", quick, 4, 0.1),
            Size("standard", quick, 40, 1.0),
            Size("full", (Grid(bias=(0.0, 0.5, 0.9, 1.0)),), 100, 2.0),
        ),
        "trial": "tests.toy_study:trial",
        "claims": "tests.toy_study:claims",
        "film": "tests.toy_study:film",
        "plots": "tests.toy_study:plots",
        "world": "tests.toy_study:_World",
        "bench": "tests.toy_study:bench",
        "prepare": "tests.toy_study:prepare",
        "verdicts": Path(os.environ.get("TOY_VERDICTS", "/nonexistent/verdicts.json")),
        # Others may edit the sources while a test runs.
        "source_packages": tuple(os.environ.get("TOY_SOURCES", "").split()),
    }
    return Study(**{**fields, **changes})


def _badly(act):
    grids = (Grid(bias=(0.5, 0.9)), Grid(act=act, seeds=1))
    return _study(f"toy-{act}", sizes=(Size("quick", grids, 3, 0.1),), claims=_quick_claims)


def _quick_claims():
    return [
        Claim(
            id="bias-shows",
            text="A biased coin gives more heads.",
            how="difference of heads over seeds",
            bound=Bound(">", 0.0),
            evaluate=lambda t: _difference(t.where(act="well")),
            sizes=("quick",),
        ),
        Claim(
            id="all",
            text="Every toss counts.",
            how="mean heads",
            bound=Bound(">", 0.0),
            evaluate=lambda t: Evidence(float(t.values("heads").mean())),
            sizes=("quick",),
        ),
    ]


study = _study()
raising = _badly("raise")
dying = _badly("die")
dying_once = _badly("die-once")
blind = _badly("gl")
