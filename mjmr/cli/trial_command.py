"""``mjmr trial``."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from tyro.conf import Positional

from mjmr.cli.parsing import StudyName, option, parse, show, whole_number
from mjmr.errors import GL_ADVICE, InvalidInputError, MissingGLError, MjmrError

if TYPE_CHECKING:
    from rich.table import Table

    from mjmr.conditions import Condition
    from mjmr.store import Outcome
    from mjmr.study import Study

_MORE = """
EXAMPLES
  mjmr trial safe-navigation
  mjmr trial safe-navigation mode=physical scene=cross4 --seed 7 --film
  mjmr trial safe-navigation --film crossing.mp4 --trace crossing.npz

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
    camera: Annotated[str, option("CAMERA", "overview or chase.", "overview")] = "overview"
    look: Annotated[str, option("LOOK", "draft (fast) or fine.", "draft")] = "draft"


def main(arguments: Sequence[str]) -> int:
    """Run one trial."""
    a = parse(Trial, "trial", _film_alone(arguments), _MORE)
    seed = whole_number("--seed", a.seed, least=0) or 0
    from mjmr.one_thread import one_thread_each

    with one_thread_each():  # as in a worker of mjmr run, for the same bits
        from rich.console import Console

        from mjmr.conditions import parse_condition
        from mjmr.executor import compute
        from mjmr.film_options import FilmOptions
        from mjmr.parts import Job
        from mjmr.progress import doing
        from mjmr.recording import Recording
        from mjmr.registry import load_study
        from mjmr.study_calls import call_study
        from mjmr.trace import Trace, check_ending
        from mjmr.watch import watching

        study = load_study(a.study)
        condition = parse_condition(study.parameters, a.condition)
        options = FilmOptions(camera=a.camera, look=a.look)
        film = None if a.film is None else _film_path(study, a.film, seed)
        for path in (p for p in (film, a.trace) if p is not None):
            _check_folder(path)
        if a.trace is not None:
            check_ending(a.trace)
        prepare, messages = study.resolve("prepare"), Console(stderr=True)
        study.resolve("trial")
        seen: list[Any] = []
        look_on = Trace if a.trace else Recording
        with doing(messages, "running the trial ..."):
            if prepare is not None:
                call_study("prepare", prepare)
            if film or a.trace:
                with watching(lambda simulation: seen.append(look_on(simulation))):
                    outcome = compute(Job(a.study, study.chosen), condition, seed)
            else:
                outcome = compute(Job(a.study, study.chosen), condition, seed)
    title = _title(study, condition, seed)
    if outcome.status == "ok":
        show(_table(title, outcome))
    else:
        told = GL_ADVICE if outcome.status == "no-gl" else f"{title} failed: {outcome.error}"
        print(f"mjmr: {told}", file=sys.stderr)
    code = 0 if outcome.status == "ok" else 1
    if not (film or a.trace):
        return code
    if not seen or not len(_recording(seen[0])):
        why = "the trial built no simulation, or never ticked it"
        if code:
            print(f"mjmr: no film or trace: {why}", file=sys.stderr)
            return code
        raise MjmrError(f"there is nothing to film or trace: {why}")
    if len(seen) > 1:
        print(f"the trial built {len(seen)} simulations; film and trace show the first")
    if a.trace is not None:
        facts = {"study": study.name, "condition": dict(condition), "seed": seed}
        seen[0].save(a.trace, {**facts, "error": outcome.error})
        print(f"trace: {a.trace}")
        for name, why in seen[0].left_out.items():
            print(f"  without the samples of {name}: {why}")
    if film is not None:
        from mjmr.replay import Replay, write_film

        replay = Replay(_recording(seen[0]).footage(), title, None, outcome.error)
        try:
            with doing(messages, "making the film ..."):
                write_film(replay, film, options)
        except MissingGLError:
            print(f"mjmr: {GL_ADVICE}", file=sys.stderr)
            return 1
        print(f"film: {film}")
    return code


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


def _check_folder(path: Path) -> None:
    if not path.parent.is_dir():
        raise InvalidInputError(f"cannot write {path}: there is no folder {path.parent}")


def _recording(seen: Any) -> Any:
    return getattr(seen, "recording", seen)


def _title(study: "Study", condition: "Condition", seed: int) -> str:
    from mjmr.study import condition_summary

    return f"{study.name}: {condition_summary(condition, study.parameters)}, seed {seed}"


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
