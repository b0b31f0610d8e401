"""``mjmr run``."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from mjmr.cli.parsing import (
    PartTexts,
    SizeName,
    StudyName,
    option,
    parse,
    part_choices,
    whole_number,
)

_MORE = """
EXAMPLES
  mjmr run safe-navigation
  mjmr run safe-navigation --size standard --workers 8
  mjmr run safe-navigation --only scene=A sigma_mm=0,4 --seeds 10 --out renders/try
  mjmr run safe-navigation --size full --cluster tcp://10.0.0.1:8786
  mjmr run safe-navigation --size standard --check
  mjmr run safe-navigation --with navigator=dash.py:Dash

FILES, in renders/STUDY/SIZE or --out
  results.sqlite   every trial: condition, seed, status, metrics; wall times in a table of their own
  claims.json      claims with measured values, intervals, bounds and verdicts
  claims.md        the same as a table
  run.json         what was run: digest, versions, git revision, conditions, wall time
  *.svg, film.mp4  plots, and the film unless it is there already

SWAPPING A PART
  mjmr show STUDY lists the roles and what a class of each must offer. Results with swapped parts
  go to renders/STUDY/SIZE+ROLE=Class; mjmr compare sets them against the published ones.

RESUMING
  Every finished trial is on disk at once. After Ctrl-C or a crash the same command goes on where
  the run stopped. A folder belongs to one configuration and source; with another one it is refused
  and left as it is, or with --fresh renamed to NAME.old-YYYYmmdd-HHMMSS.

EXIT CODES
  0    all trials finished
  1    a trial, a claim's evaluation, a plot or the film failed
  2    bad input, or a results folder that cannot be used
  3    with --check: a verdict differs from the committed one (timing claims are not compared)
  130  Ctrl-C
"""


@dataclass(frozen=True)
class Run:
    """Run a study's trials, then say claim by claim whether the paper holds.

    Prints a table of claims: published, measured with interval, bound, verdict (holds, fails,
    inconclusive, not testable). The same condition and seed give the same numbers, whatever the
    number of workers.
    """

    study: StudyName
    size: SizeName = "quick"
    seeds: Annotated[
        str | None,
        option("N", "Seeds 0 .. N-1 of every condition, N >= 1.", "what the size declares"),
    ] = None
    workers: Annotated[
        str | None, option("W", "Processes, W >= 1; one thread each.", "one a CPU")
    ] = None
    cluster: Annotated[
        str | None,
        option("tcp://HOST:PORT", "Dask scheduler whose workers compute the trials.", "this host"),
    ] = None
    only: Annotated[
        tuple[str, ...],
        option("KEY=VALUE[,VALUE...]", "Run conditions with these values only.", "all"),
    ] = ()
    with_: PartTexts = ()
    out: Annotated[Path | None, option("DIR", "Results folder.", "renders/STUDY/SIZE")] = None
    film: Annotated[bool, option("", "Make no film.", "make it")] = True
    check: Annotated[bool, option("", "Compare verdicts with the committed ones.", "no")] = False
    accept: Annotated[
        bool, option("", "For maintainers: write verdicts as the committed ones.", "no")
    ] = False
    fresh: Annotated[
        bool, option("", "Set results of other code aside instead of refusing.", "no")
    ] = False
    retry: Annotated[bool, option("", "Compute failed trials again.", "no")] = False


def main(arguments: Sequence[str]) -> int:
    """Run a study."""
    a = parse(Run, "run", arguments, _MORE)
    seeds, workers = whole_number("--seeds", a.seeds), whole_number("--workers", a.workers)
    parts = part_choices(a.with_)
    from mjmr.runner import RunOptions, run_study

    options = RunOptions(
        study=a.study,
        size=a.size,
        seeds=seeds,
        workers=workers,
        cluster=a.cluster,
        only=a.only,
        parts=parts,
        out=a.out,
        film=a.film,
        check=a.check,
        accept=a.accept,
        fresh=a.fresh,
        retry=a.retry,
    )
    return run_study(options).exit_code
