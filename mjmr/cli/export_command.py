"""``mjmr export``."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from tyro.conf import Positional

from mjmr.cli.parsing import SizeName, StudyName, option, parse

_MORE = """
EXAMPLES
  mjmr export safe-navigation trials.csv
  mjmr export safe-navigation --size standard trials.parquet

EXIT CODES
  0  the file was written
  2  bad input, no results, or a file that cannot be written
"""


@dataclass(frozen=True)
class Export:
    """Write a study's results as CSV or Parquet, also while a run is under way.

    One row a trial: condition, seed, status, metrics, wall times (names that start with wall_),
    error. Numbers read back bit for bit; in Parquet columns have types, and what a trial lacks is
    null. The file's ending chooses; Parquet needs pip install "mjmr[parquet]".
    """

    study: StudyName
    file: Annotated[
        Positional[Path],
        option("FILE", "File to write, .csv or .parquet; replaced if it exists."),
    ]
    size: SizeName = "quick"
    out: Annotated[Path | None, option("DIR", "Results folder.", "renders/STUDY/SIZE")] = None


def main(arguments: Sequence[str]) -> int:
    """Export results."""
    a = parse(Export, "export", arguments, _MORE)
    from mjmr.export import export
    from mjmr.registry import load_study
    from mjmr.runner import default_folder

    study = load_study(a.study)
    study.size(a.size)
    count = export(a.out or default_folder(study, a.size), a.file)
    print(f"{count} trials written to {a.file}")
    return 0
