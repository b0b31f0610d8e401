"""``mjmr trial``."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from tyro.conf import Positional

from mjmr.cli.parsing import (
    PartTexts,
    StudyName,
    check_file,
    option,
    parse,
    part_choices,
    show,
    whole_number,
)
from mjmr.errors import GL_ADVICE, MissingGLError, MjmrError

if TYPE_CHECKING:
    from rich.table import Table

    from mjmr.conditions import Condition
    from mjmr.film_options import FilmOptions
    from mjmr.store import Outcome
    from mjmr.study import Study
    from mjmr.trace import Trace

_MORE = """
EXAMPLES
  mjmr trial safe-navigation
  mjmr trial safe-navigation mode=physical scene=cross4 --seed 7 --film
  mjmr trial safe-navigation --film crossing.mp4 --trace crossing.npz
  mjmr trial safe-navigation scene=cross4 --with navigator=dash.py:Dash --film

EXIT CODES
  0  the trial finished
  1  it failed (film and trace show what happened up to then), or there is no off-screen OpenGL
  2  bad input, or a file that cannot be written
"""


@dataclass(frozen=True)
class Trial:
    """Run one trial and look at it: metrics, a film, a trace of all that happened.

    The metrics are those the same condition and seed have in mjmr run, bit for bit.
    """

    study: StudyName
    condition: Annotated[
        Positional[tuple[str, ...]],
        option("KEY=VALUE", "Values of the condition; mjmr show STUDY lists them.", "defaults"),
    ] = ()
    seed: Annotated[str, option("K", "Seed of the trial, K >= 0.", "0")] = "0"
    film: Annotated[
        str | None,
        option("[FILE]", "Make a film; alone: renders/STUDY/trial-seedK.mp4.", "no film"),
    ] = None
    trace: Annotated[
        Path | None,
        option("FILE", "Write a trace that ends in .npz or .parquet.", "no trace"),
    ] = None
    with_: PartTexts = ()
    camera: Annotated[str, option("CAMERA", "overview or chase.", "overview")] = "overview"
    look: Annotated[str, option("LOOK", "draft (fast) or fine.", "draft")] = "draft"


def main(arguments: Sequence[str]) -> int:
    """Run one trial."""
    a = parse(Trial, "trial", _film_alone(arguments), _MORE)
    seed = whole_number("--seed", a.seed, least=0) or 0
    from mjmr.one_thread import one_thread_each

    with one_thread_each():  # as in a worker of mjmr run, for the same bits
        from mjmr.conditions import parse_condition
        from mjmr.film_options import FilmOptions
        from mjmr.registry import load_study
        from mjmr.study import condition_summary
        from mjmr.trace import check_ending

        study = load_study(a.study).choose(part_choices(a.with_))
        condition = parse_condition(study.parameters, a.condition)
        options = FilmOptions(camera=a.camera, look=a.look)
        film = None if a.film is None else _film_path(study, a.film, seed)
        for path in filter(None, (film, a.trace)):
            check_file(path)
        if a.trace is not None:
            check_ending(a.trace)
        traces, outcome = _run(a.study, study, condition, seed, look=bool(film or a.trace))
    told = condition_summary(condition, study.parameters)
    title = f"{study.name}{study.swapped}: {told}, seed {seed}"
    if outcome.status == "ok":
        show(_table(title, outcome))
    else:
        told = GL_ADVICE if outcome.status == "no-gl" else f"{title} failed: {outcome.error}"
        print(f"mjmr: {told}", file=sys.stderr)
    code = 0 if outcome.status == "ok" else 1
    if not (film or a.trace):
        return code
    if not traces or not len(traces[0].recording):
        why = "there is nothing to film or trace: the trial ticked no simulation"
        if code:
            print(f"mjmr: {why}", file=sys.stderr)
            return code
        raise MjmrError(why)
    if len(traces) > 1:
        print(f"the trial built {len(traces)} simulations; film and trace show the first")
    if a.trace is not None:
        swapped = [str(choice) for choice in study.chosen]
        facts = {"study": study.name, "parts": swapped, "condition": dict(condition), "seed": seed}
        traces[0].save(a.trace, {**facts, "error": outcome.error})
        print(f"trace: {a.trace}")
        for name, why in traces[0].left_out.items():
            print(f"  without the samples of {name}: {why}")
    if film is not None and not _write_film(traces[0], title, film, options):
        return 1
    return code


def _run(
    name: str, study: "Study", condition: "Condition", seed: int, look: bool
) -> "tuple[list[Trace], Outcome]":
    """Run the trial as a worker does; traces of its simulations if somebody wants to look."""
    from rich.console import Console

    from mjmr.executor import compute, make_ready
    from mjmr.parts import Job
    from mjmr.progress import doing
    from mjmr.study_calls import call_study
    from mjmr.trace import Trace
    from mjmr.watch import watching

    job = Job(name, study.chosen)
    # a study that cannot be imported, or has no such world, is bad input, not a failed trial
    study.resolve("trial")
    build = study.resolve("world")
    if build is not None:
        call_study("world", build, condition)
    traces: list[Trace] = []
    with doing(Console(stderr=True), "running the trial ..."):
        call_study("prepare", make_ready, job)  # it may build simulations that are not the trial's
        with watching(lambda s: traces.append(Trace(s)) if look else None):
            outcome = compute(job, condition, seed)
    return traces, outcome


def _write_film(trace: "Trace", title: str, path: Path, options: "FilmOptions") -> bool:
    """Write the film and say where; False if there is no OpenGL."""
    from rich.console import Console

    from mjmr.progress import doing
    from mjmr.replay import Replay, write_film

    try:
        with doing(Console(stderr=True), "making the film ..."):
            write_film(Replay(trace.recording.footage(), title, None, ""), path, options)
    except MissingGLError:
        print(f"mjmr: {GL_ADVICE}", file=sys.stderr)
        return False
    print(f"film: {path}")
    return True


def _film_alone(arguments: Sequence[str]) -> list[str]:
    """Give ``--film`` without a file an empty one, which stands for the default place."""
    words = []
    following = [*arguments[1:], "--"]
    for word, after in zip(arguments, following, strict=False):
        words.append(word)
        if word == "--film" and (after.startswith("-") or "=" in after):
            words.append("")
    return words


def _film_path(study: "Study", given: str, seed: int) -> Path:
    if given:
        return Path(given)
    path = Path("renders") / study.name / f"trial-seed{seed}.mp4"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as e:
        raise MjmrError(f"cannot write to {path.parent}: {e.strerror}") from e
    return path


def _table(title: str, outcome: "Outcome") -> "Table":
    from rich.table import Table
    from rich.text import Text

    table = Table(title=Text(title), title_justify="left")
    table.add_column("metric", no_wrap=True)
    table.add_column("value", overflow="fold")
    for name, value in outcome.metrics.items():
        table.add_row(Text(name), Text(str(value)))
    for name, value in outcome.wall.items():
        table.add_row(Text(name, "dim"), Text(f"{value:.3g} (wall time)", "dim"))
    return table
