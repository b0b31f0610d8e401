"""``mjmr compare``."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from tyro.conf import Positional

from mjmr.cli.parsing import option, parse, show
from mjmr.errors import MjmrError

if TYPE_CHECKING:
    from mjmr.compare import Comparison, Difference

_P = 0.01
_MORE = """
EXAMPLES
  mjmr compare renders/safe-navigation/quick renders/safe-navigation/quick+navigator=Dash
  mjmr compare published mine --by scene,sigma_mm --metrics overlap_mm_s,goals
  mjmr compare published mine --only mode=metric --out difference.json

Trials are paired by condition and seed; pairs of one seed under several conditions are averaged,
since they are not independent. The interval is of the mean of B - A (95 %, bootstrap over seeds);
p is Wilcoxon's signed-rank test, two-sided, marked * below 0.01. With several rows p (Holm) is
adjusted for their number: among many comparisons some p below 0.01 come by chance.

EXIT CODES
  0  the runs were compared, whatever came of it
  2  not a results folder, different studies, nothing in common, an unknown name
"""


@dataclass(frozen=True)
class Compare:
    """Compare two runs of a study on the trials that finished in both.

    Prints for every metric both means, their paired difference with interval and p, then which
    claims' verdicts changed, and what beside swapped parts differs between the runs.
    """

    run_a: Annotated[Positional[Path], option("RUN_A", "Results folder of the first run.")]
    run_b: Annotated[Positional[Path], option("RUN_B", "Results folder of the second run.")]
    by: Annotated[
        str | None, option("NAME[,NAME...]", "Split by these conditions.", "pool them all")
    ] = None
    only: Annotated[
        tuple[str, ...],
        option("KEY=VALUE[,VALUE...]", "Compare conditions with these values only.", "all"),
    ] = ()
    metrics: Annotated[
        str | None, option("NAME[,NAME...]", "Compare these.", "all numbers but wall times")
    ] = None
    out: Annotated[
        Path | None, option("FILE", "Write the table too: .csv, or all as JSON.", "none")
    ] = None


def main(arguments: Sequence[str]) -> int:
    """Compare two results folders."""
    a = parse(Compare, "compare", arguments, _MORE)
    from rich.text import Text

    from mjmr.compare import compare, to_text
    from mjmr.files import write_atomically

    by, metrics = ([] if t is None else t.split(",") for t in (a.by, a.metrics))
    found = compare(a.run_a, a.run_b, by=by, only=a.only, metrics=metrics)
    if a.out is not None:
        try:
            write_atomically(a.out, to_text(found, a.out))
        except OSError as e:
            raise MjmrError(f"cannot write {a.out}: {e.strerror}") from e
    show(Text(_heading(found)))
    show(_table(found.rows))
    show(Text("\n".join([*_remarks(found), *_verdicts(found)])))
    return 0


def _heading(c: "Comparison") -> str:
    lines = [
        f"{name}: {run.folder} ({run.meta.get('size')}, {run.parts})"
        for name, run in (("A", c.a), ("B", c.b))
    ]
    return "\n".join([f"{c.a.meta['study']}: {c.pairs} pairs of trials", *lines])


def _table(rows: "Sequence[Difference]") -> Any:
    from rich.table import Table
    from rich.text import Text

    from mjmr.compare import group_text

    split, many = bool(rows and rows[0].group), len(rows) > 1
    table = Table()
    for header in ["condition"] * split + ["metric"]:
        table.add_column(header, overflow="fold")
    for header in ["A", "B", "B - A", "95 % interval", "n", "p"] + ["p (Holm)"] * many:
        table.add_column(header, justify="right")
    for r in rows:
        cells = [group_text(r.group)] * split + [r.metric, f"{r.a:.4g}", f"{r.b:.4g}"]
        cells += [f"{r.difference:+.4g}", f"[{r.low:.4g}, {r.high:.4g}]"]
        cells += [f"{r.n}" if r.n == r.seeds else f"{r.n} ({r.seeds} seeds)"]
        cells += [_p(r.p)] + [_p(r.p_holm)] * many
        table.add_row(*map(Text, cells))
    return table


def _p(p: float) -> str:
    return f"{p:.2g}{'*' if p < _P else ' '}"


def _remarks(c: "Comparison") -> list[str]:
    lines = []
    if len(c.rows) > 1:
        below = sum(r.p < _P for r in c.rows), sum(r.p_holm < _P for r in c.rows)
        lines.append(
            f"{len(c.rows)} comparisons: p < {_P:g} in {below[0]}, after Holm's adjustment in "
            f"{below[1]}"
        )
    for name, run, alone in (("A", c.a, c.only_a), ("B", c.b, c.only_b)):
        if alone:
            lines.append(f"{alone} trials finished in {name} alone and are left out")
        if lost := run.count("failed") + run.count("no-gl"):
            lines.append(f"{lost} trials failed in {name}")
    return [*lines, *(f"note: {text}" for text in c.warnings)]


def _verdicts(c: "Comparison") -> list[str]:
    if c.a.verdicts is None or c.b.verdicts is None:
        return []
    if not c.changed:
        return [f"verdicts of the whole runs: all {len(c.a.verdicts)} the same"]
    told = [f"  {name}: {before} -> {after}" for name, (before, after) in c.changed.items()]
    count = f"{len(c.changed)} of {len(c.a.verdicts)}"
    return [f"verdicts of the whole runs: {count} differ, A -> B", *told]
