"""``mjmr list``."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass

from mjmr.cli.parsing import parse, show
from mjmr.errors import MjmrError

_MORE = """
EXAMPLES
  mjmr list
  MJMR_STUDIES="mine=my.package:study" mjmr list

EXIT CODES
  0  every study could be loaded
  1  one could not; the others are listed
"""


@dataclass(frozen=True)
class List:
    """List the studies: name, title, paper.

    Studies are found through the entry-point group mjmr.studies of installed packages, and through
    the environment variable MJMR_STUDIES.
    """


def main(arguments: Sequence[str]) -> int:
    """Print one row a study."""
    from rich.table import Table
    from rich.text import Text

    from mjmr.registry import load_study, study_references

    parse(List, "list", arguments, _MORE)
    table = Table(box=None, pad_edge=False)
    table.add_column("study", no_wrap=True)
    table.add_column("title", overflow="fold")
    table.add_column("paper", overflow="fold")
    broken = []
    for name in study_references():
        try:
            study = load_study(name)
        except MjmrError as e:
            broken.append(f"mjmr: {name}: {e}")
        else:
            table.add_row(Text(name), Text(study.title), Text(study.paper))
    show(table)
    for line in broken:
        print(line, file=sys.stderr)
    return 1 if broken else 0
