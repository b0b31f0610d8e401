"""``mjmr show``."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from mjmr.cli.parsing import StudyName, parse, show
from mjmr.conditions import format_value
from mjmr.study import Study

_MORE = """
EXAMPLES
  mjmr show safe-navigation

EXIT CODES
  0  done
  2  no such study; the valid names are listed
"""


@dataclass(frozen=True)
class Show:
    """Show a study: its paper, conditions, sizes, parts and claims.

    Conditions are what --only of mjmr run takes, parts what --with takes. Sizes are shown with
    their number of trials and the wall time expected on two cores; parts with what a class must
    offer to take one; claims with their bounds and the sizes that decide them.
    """

    study: StudyName


def main(arguments: Sequence[str]) -> int:
    """Print a study's declaration."""
    from rich.text import Text

    from mjmr.registry import load_study

    study = load_study(parse(Show, "show", arguments, _MORE).study)
    claims = study.load_claims()
    show(Text(f"{study.name}: {study.title}", "bold"))
    show(Text(f"{study.paper}\n\n{study.summary}\n"))
    show(_conditions(study))
    show(_sizes(study))
    if study.parts:
        show(_parts(study))
    show(_claims(claims))
    return 0


def _table(title: str, *headers: str) -> Any:
    from rich.table import Table

    table = Table(title=title, title_justify="left", show_lines=False)
    for header in headers:
        table.add_column(header, overflow="fold")
    return table


def _row(table: Any, *cells: object) -> None:
    from rich.text import Text

    table.add_row(*(Text(str(cell)) for cell in cells))


def _conditions(study: Study) -> Any:
    table = _table("Conditions", "name", "meaning", "values", "default", "unit")
    for p in study.parameters:
        _row(table, p.name, p.doc, p.describe(), format_value(p.default), p.unit)
    return table


def _sizes(study: Study) -> Any:
    table = _table("Sizes", "name", "conditions", "trials", "minutes (2 cores)", "note")
    for size in study.sizes:
        trials = study.trials(size.name)
        conditions = len({condition for condition, _ in trials})
        _row(table, size.name, conditions, len(trials), f"{size.expected_minutes:g}", size.note)
    return table


def _parts(study: Study) -> Any:
    table = _table("Parts, for --with of mjmr run", "role", "what it does", "published", "a class")
    table.show_lines = True
    for part in study.parts:
        has = [] if part.constructor is None else [f"__init__({', '.join(part.constructor)})"]
        for m in part.methods:
            has.append(f"{'may have ' * m.optional}{m}{': ' * bool(m.doc)}{m.doc}")
        has += [f"may have {text}" for text in part.optional]
        _row(table, part.role, part.doc, part.default, "\n".join(has))
    return table


def _claims(claims: Sequence[Any]) -> Any:
    table = _table("Claims", "id", "the paper", "published", "how measured", "bound", "decided at")
    table.show_lines = True
    table.columns[0].min_width = max((len(c.id) for c in claims), default=0)
    for c in claims:
        unit = f" {c.unit}" if c.unit else ""
        sizes = ", ".join(c.sizes) + (" (timing)" if c.timing else "")
        bound = f"{c.bound}{unit} ({c.bound_source})"
        _row(table, c.id, c.text, c.published, c.how, bound, sizes)
    return table
