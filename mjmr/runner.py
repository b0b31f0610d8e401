"""Running a study: trials, claims, files. The only writer of a results folder.

What a run leaves in its folder: ``results.sqlite`` (every trial), ``claims.json``, ``claims.md``,
``run.json`` (what was run, by which code), plots as SVG, ``film.mp4``, ``failures/`` (replays).
"""

import contextlib
import dataclasses
import functools
import os
import shlex
import signal
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mjmr.claims import Verdict, judge_all
from mjmr.conditions import parse_filter
from mjmr.errors import GL_ADVICE, InvalidInputError, MissingGLError, MjmrError
from mjmr.failures import keep_replay
from mjmr.files import temporary_folder, write_atomically
from mjmr.film_options import FilmOptions
from mjmr.parts import Job, PartChoice
from mjmr.progress import Progress, doing, say
from mjmr.registry import load_study
from mjmr.run_words import print_verdicts, tell_failures, told
from mjmr.store import Outcome, Store, is_of, set_aside
from mjmr.study import Study, Trial
from mjmr.study_calls import call_study, make_film
from mjmr.table import NoTrialsError, Row, Table

if TYPE_CHECKING:
    from rich.console import Console

    from mjmr.executor import Executor
    from mjmr.verdicts import Difference

OK, FAILED, CHANGED, INTERRUPTED = 0, 1, 3, 130


@dataclass(frozen=True, kw_only=True)
class RunOptions:
    """What to run, and how.

    Args:
        study: Name, or dotted reference ``module:attribute``.
        size: ``quick``, ``standard`` or ``full``.
        seeds: Seeds of every condition; None takes what the size declares.
        workers: Processes; None takes one for each CPU this process may use.
        cluster: Address ``tcp://host:port`` of a Dask scheduler whose workers compute the trials.
        only: Conditions as texts ``key=value[,value...]``.
        parts: What takes a role in place of the study's own.
        out: Results folder; None takes that of :func:`default_folder`.
        film: Make the film if it is not there.
        check: Compare verdicts with the committed ones.
        accept: Write verdicts as the committed ones.
        fresh: Set aside a results folder that is of another digest or damaged, rather than
            refuse it.
        retry: Compute failed trials again.

    Raises:
        InvalidInputError: Options that are out of range or exclude each other.
    """

    study: str
    size: str = "quick"
    seeds: int | None = None
    workers: int | None = None
    cluster: str | None = None
    only: tuple[str, ...] = ()
    parts: tuple[PartChoice, ...] = ()
    out: Path | None = None
    film: bool = True
    check: bool = False
    accept: bool = False
    fresh: bool = False
    retry: bool = False

    def __post_init__(self):
        for name, value in (("seeds", self.seeds), ("workers", self.workers)):
            if value is not None and value < 1:
                raise InvalidInputError(f"{name} must be at least 1, not {value}")
        if self.cluster is not None:
            from mjmr.cluster import check_address

            if self.workers is not None:
                raise InvalidInputError(
                    "--cluster and --workers exclude each other: a cluster's workers are started "
                    "beside its scheduler"
                )
            check_address(self.cluster)
        if self.check and self.accept:
            raise InvalidInputError("--check and --accept exclude each other")
        for flag, given in (("--check", self.check), ("--accept", self.accept)):
            if given and (self.only or self.seeds is not None):
                raise InvalidInputError(
                    f"{flag} takes a whole size, since verdicts are committed for whole sizes: "
                    "leave out --only and --seeds"
                )
            if given and self.parts:
                raise InvalidInputError(
                    f"{flag} takes the published parts, since verdicts are committed for them: "
                    "leave out --with"
                )


@dataclass(frozen=True, kw_only=True)
class RunResult:
    """How a run ended.

    Args:
        exit_code: 0 all trials finished; 1 any failed; 3 a verdict changed; 130 interrupted.
        folder: Where the results are.
        table: Every trial the size declares, finished or not.
        verdicts: The claims judged; empty if interrupted.
        differences: Where verdicts differ from the committed ones, if that was asked.
    """

    exit_code: int
    folder: Path
    table: Table
    verdicts: list[Verdict] = field(default_factory=list)
    differences: "list[Difference]" = field(default_factory=list)


def default_folder(study: Study, size: str) -> Path:
    """``renders/STUDY/SIZE`` under the current folder, with ``+ROLE=Class`` for chosen parts."""
    chosen = "".join(f"+{c.role}={c.name}" for c in sorted(study.chosen, key=lambda c: c.role))
    return Path("renders") / study.name / f"{size}{chosen}"


def run_study(
    options: RunOptions,
    console: "Console | None" = None,
    messages: "Console | None" = None,
    executor: "Executor | None" = None,
) -> RunResult:
    """Run what is not done yet, judge the claims, write the files.

    Args:
        options: What to run.
        console: For the verdicts; None takes standard output.
        messages: For progress and remarks; None takes standard error.
        executor: Where trials are computed; None takes local processes.

    Raises:
        MjmrError: Bad input or an unusable results folder; nothing has been run then.
    """
    from rich.console import Console

    from mjmr import verdicts as committed

    messages = messages or Console(stderr=True)
    study = load_study(options.study).choose(options.parts)
    only = parse_filter(study.parameters, options.only)
    trials = study.trials(options.size, options.seeds, only)
    claims = study.load_claims()
    expected = committed.committed(study, options.size) if options.check else {}
    if options.accept and study.verdicts is None:
        raise MjmrError(f"study {study.name} declares no verdicts file for --accept to write")
    folder = options.out or default_folder(study, options.size)
    run = _Run(options, study, trials, folder, messages)
    if options.fresh and not is_of(folder, run.meta()["digest"]):
        aside = set_aside(folder)
        if aside:
            say(messages, f"set aside as {aside}")
    try:
        with Store(folder, run.meta()) as store:
            complete = run.compute(store, executor)
            asked = run.table(store, trials)
            # Claims see all the size declares: with --only, the rest is "not run".
            table = run.table(store, study.trials(options.size, options.seeds))
            if not complete:
                run.write_record(asked, [])
                return run.interrupted(table)
            verdicts = judge_all(claims, table, options.size)
            troubles = run.write_files(asked, verdicts)
            print_verdicts(console, study, options.size, verdicts)
            troubles += run.film()
            run.write_record(asked, verdicts)
    except KeyboardInterrupt:
        return run.interrupted(None)
    except OSError as e:
        raise MjmrError(f"run in {folder} stopped: {e}") from e
    failed = tell_failures(messages, folder, asked, verdicts)
    for trouble in troubles:
        say(messages, trouble)
    found = committed.differences(expected, verdicts) if options.check else []
    for difference in found:
        say(messages, f"verdict changed: {difference}")
    say(messages, f"results in {folder}")
    code = FAILED if failed or troubles else CHANGED if found else OK
    if options.accept:
        if code != OK:
            say(messages, "verdicts not accepted, since something failed")
        else:
            committed.accept(study, options.size, verdicts)
            say(messages, f"verdicts written to {study.verdicts}")
    return RunResult(
        exit_code=code, folder=folder, table=table, verdicts=verdicts, differences=found
    )


class _Run:
    """One run under way: what all of its steps need to know."""

    def __init__(
        self,
        options: RunOptions,
        study: Study,
        trials: list[Trial],
        folder: Path,
        messages: "Console",
    ):
        self.options, self.study, self.trials = options, study, trials
        self.folder, self.messages = folder, messages
        self.begin = time.monotonic()
        self.done, self.workers, self.computed = 0, 0, 0

    def meta(self) -> dict[str, Any]:
        from mjmr.provenance import git_revision, versions

        return {
            "digest": self.study.digest(self.options.size),
            "digest_of_published": self.study.choose(()).digest(self.options.size),
            "study": self.study.name,
            "reference": self.options.study,
            "size": self.options.size,
            "parts": [dataclasses.asdict(choice) for choice in self.study.chosen],
            "versions": versions(),
            "git_revision": git_revision(),
        }

    def compute(self, store: Store, executor: "Executor | None") -> bool:
        """Compute and keep what is not there yet; False if Ctrl-C came between."""
        settled = {"ok"} if self.options.retry else {"ok", "failed"}
        kept = {(o.condition, o.seed) for o in store.outcomes() if o.status in settled}
        pending = [trial for trial in self.trials if trial not in kept]
        self.done = len(self.trials) - len(pending)
        if not pending:
            return True
        if self.done:
            say(self.messages, f"resuming: {self.done} of {len(self.trials)} trials are kept")
        executor = executor or self._executor(len(pending))
        job = Job(self.options.study, self.study.chosen)
        with (
            _interrupts() as stopped,
            contextlib.closing(executor.run(job, pending, stopped)) as outcomes,
            Progress(self.messages, self.done, len(self.trials)) as progress,
        ):
            for outcome in outcomes:
                keep_replay(self.folder, outcome)
                store.record(outcome)
                self.done += 1
                self.computed += 1
                progress.advance(outcome.status == "ok")
        return self.done == len(self.trials)

    def _executor(self, trials: int) -> "Executor":
        if self.options.cluster is not None:
            from mjmr.cluster import DaskExecutor

            self.study.resolve("trial")  # its workers compile for themselves
            size, digest = self.options.size, self.study.digest(self.options.size)
            tell = functools.partial(say, self.messages)
            return DaskExecutor(self.options.cluster, size, digest, tell)
        from mjmr.executor import LocalExecutor

        self._prepare()
        self.workers = min(self.options.workers or cpu_count(), trials)
        return LocalExecutor(self.workers)

    def _prepare(self) -> None:
        self.study.resolve("trial")  # a study that cannot be imported is told once, here
        prepare = self.study.resolve("prepare")
        if prepare is None:
            return
        with doing(self.messages, "preparing (compiles on the first run) ..."):
            call_study("prepare", prepare)

    def table(self, store: Store, trials: list[Trial]) -> Table:
        """These trials, with what is known of them."""
        found = {(o.condition, o.seed): o for o in store.outcomes()}
        return Table([_row(t, found.get(t)) for t in trials], self.study.parameters)

    def write_files(self, asked: Table, verdicts: list[Verdict]) -> list[str]:
        """Write claims, and plots of the trials asked for; returns what went wrong."""
        from mjmr import reports

        title = f"{told(self.study, self.options.size)}: {self.study.title}"
        write_atomically(self.folder / "claims.json", reports.verdicts_json(verdicts))
        write_atomically(self.folder / "claims.md", reports.verdicts_markdown(verdicts, title))
        plots = self.study.plots
        if plots is None or not asked.finished:
            return []
        try:
            with temporary_folder(self.folder, "plots") as folder:
                written = call_study("plots", self.study.resolve("plots"), asked.fresh(), folder)
                for path in sorted(p for p in map(Path, written or ()) if p.is_file()):
                    os.replace(path, self.folder / path.name)
        except NoTrialsError as e:  # with --only a plot may lack what it shows
            say(self.messages, f"plots skipped: {e}")
        except MjmrError as e:
            return [str(e)]
        return []

    def film(self) -> list[str]:
        """Make the film if it is wanted and not there; returns what went wrong."""
        path = self.folder / "film.mp4"
        if not self.options.film or self.study.film is None or path.exists():
            return []
        try:
            with doing(self.messages, "making the film ..."):
                make_film(self.study, path, FilmOptions())
        except MissingGLError:
            say(self.messages, f"{GL_ADVICE}; film skipped")
        except MjmrError as e:
            return [str(e)]
        return []

    def write_record(self, table: Table, verdicts: list[Verdict]) -> None:
        """Write ``run.json``."""
        from mjmr import reports

        o = self.options
        record = {
            **self.meta(),
            "seeds": o.seeds,
            "only": list(o.only),
            "workers": self.workers,
            "cluster": o.cluster,
            "film": o.film,
            "trials": len(table),
            "finished": table.finished,
            "failed": table.failed,
            "computed_now": self.computed,
            "conditions": [
                {"condition": dict(c), "seeds": len(table.where(**c))} for c in table.conditions
            ],
            "verdicts": {v.claim.id: v.verdict for v in verdicts},
            "host_cpus": os.cpu_count(),
            "wall_time_s": round(time.monotonic() - self.begin, 3),
            "command": self._command(),
        }
        write_atomically(self.folder / "run.json", reports.to_json(record))

    def interrupted(self, table: Table | None) -> RunResult:
        say(
            self.messages,
            f"interrupted: {self.done} of {len(self.trials)} trials are kept in {self.folder}; "
            f"resume with: {self._command()}",
        )
        rows = [_row(t, None) for t in self.trials]
        return RunResult(
            exit_code=INTERRUPTED,
            folder=self.folder,
            table=table or Table(rows, self.study.parameters),
        )

    def _command(self) -> str:
        o = self.options
        words = ["mjmr", "run", o.study, "--size", o.size]
        words += ["--seeds", str(o.seeds)] if o.seeds is not None else []
        words += ["--workers", str(o.workers)] if o.workers is not None else []
        words += ["--cluster", o.cluster] if o.cluster is not None else []
        words += ["--only", *o.only] if o.only else []
        words += ["--with", *map(str, o.parts)] if o.parts else []
        words += ["--out", str(o.out)] if o.out is not None else []
        words += [f"--{n}" for n in ("check", "accept", "retry") if getattr(o, n)]
        words += [] if o.film else ["--no-film"]
        return shlex.join(words)


def cpu_count() -> int:
    """CPUs this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _row(trial: Trial, outcome: Outcome | None) -> Row:
    condition, seed = trial
    if outcome is None:
        return Row(condition, seed, "missing")
    metrics = {**outcome.metrics, **outcome.wall}
    return Row(condition, seed, outcome.status, metrics, outcome.error)


@contextlib.contextmanager
def _interrupts() -> Iterator[Callable[[], bool]]:
    """Turn the first Ctrl-C into a flag, so that no write is cut short; a second one raises."""
    stopped = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield stopped.is_set
        return

    def on_interrupt(*_: object) -> None:
        if stopped.is_set():
            raise KeyboardInterrupt
        stopped.set()

    before = signal.signal(signal.SIGINT, on_interrupt)
    try:
        yield stopped.is_set
    finally:
        signal.signal(signal.SIGINT, before)
