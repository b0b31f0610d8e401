"""What a run says at its end: verdicts, and what failed."""

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from mjmr.claims import Verdict
from mjmr.errors import GL_ADVICE
from mjmr.failures import failure_path
from mjmr.progress import say, standard_output
from mjmr.study import Study
from mjmr.study_calls import debugging
from mjmr.table import Table

if TYPE_CHECKING:
    from rich.console import Console


def told(study: Study, size: str) -> str:
    """What was run, as titles say it."""
    return f"{study.name}, size {size}{study.swapped}"


def print_verdicts(
    console: "Console | None", study: Study, size: str, verdicts: Sequence[Verdict]
) -> None:
    """Print the claims this size decides, and name those that others do."""
    from mjmr.reports import undecided_line, verdict_table

    console = console or standard_output(140)
    if verdicts:
        console.print(verdict_table(verdicts, told(study, size), size))
        if line := undecided_line(verdicts, size):
            console.print(line, style="dim")


def tell_failures(
    messages: "Console", folder: Path, table: Table, verdicts: Sequence[Verdict]
) -> bool:
    """Say which trials did not finish and which claims could not be evaluated; True if any."""
    lost = [row for row in table.fresh().rows if row.status != "ok"]
    for row in lost[:5]:
        say(messages, f"trial failed: {row.condition} seed {row.seed}: {row.error}")
        if (replay := failure_path(folder, row.condition, row.seed)).exists():
            say(messages, f"replay with: {shlex.join(['mjmr', 'replay', str(replay)])}")
    if len(lost) > 5:
        say(messages, f"... and {len(lost) - 5} more; mjmr export lists them all")
    if any(row.status == "no-gl" for row in lost):
        say(messages, GL_ADVICE)
    elif lost:
        say(messages, "failed trials are kept as such; compute them again with --retry")
    mistakes = [v for v in verdicts if v.error]
    for verdict in mistakes:
        text = verdict.error if debugging() else f"claim {verdict.claim.id}: {verdict.why}"
        say(messages, text.rstrip())
    return bool(lost or mistakes)
