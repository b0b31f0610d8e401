"""A results folder as one table in a file, for other tools: CSV, or Parquet with typed columns."""

import csv
import io
from pathlib import Path
from typing import Any

from mjmr.errors import InvalidInputError, MjmrError
from mjmr.files import write_atomically
from mjmr.store import Outcome, StoreError, read_outcomes

ENDINGS = (".csv", ".parquet")
Columns = list[tuple[str, list[Any]]]


def export(folder: Path, path: Path) -> int:
    """Write the trials of a results folder: a row each, conditions and metrics first.

    Args:
        folder: Results folder.
        path: File to write; its ending says what it becomes.

    Returns:
        Number of trials.

    Raises:
        InvalidInputError: An ending there is no format for.
        MjmrError: Parquet without pyarrow.
        StoreError: As for :func:`mjmr.store.reading`, or the file cannot be written.
    """
    path = Path(path)
    ending = path.suffix.lower()
    if ending not in ENDINGS:
        raise InvalidInputError(f"a file to export to ends in {' or '.join(ENDINGS)}, not {path}")
    found = read_outcomes(folder)
    columns = _columns(found)
    content = _csv(columns) if ending == ".csv" else _parquet(columns)
    try:
        write_atomically(path, content)
    except OSError as e:
        raise StoreError(f"cannot write {path}: {e.strerror}") from e
    return len(found)


def _columns(found: list[Outcome]) -> Columns:
    """Columns by name, in the order both formats have them."""
    columns: Columns = [
        (n, [o.condition.get(n) for o in found]) for n in _names(found, "condition")
    ]
    columns += [("seed", [o.seed for o in found]), ("status", [o.status for o in found])]
    columns += [(n, [o.metrics.get(n) for o in found]) for n in _names(found, "metrics")]
    columns += [(n, [o.wall.get(n) for o in found]) for n in _names(found, "wall")]
    return [*columns, ("error", [o.error for o in found])]


def _names(found: list[Outcome], kind: str) -> list[str]:
    return list(dict.fromkeys(name for o in found for name in getattr(o, kind)))


def _csv(columns: Columns) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(name for name, _ in columns)
    writer.writerows(zip(*(values for _, values in columns), strict=True))
    return text.getvalue()


def _parquet(columns: Columns) -> bytes:
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError as e:
        raise MjmrError('Parquet needs pyarrow: pip install "mjmr[parquet]"') from e
    # Two columns may have one name, a condition and a metric; Parquet allows that as CSV does.
    arrays = [pyarrow.array(*_typed(values)) for _, values in columns]
    table = pyarrow.Table.from_arrays(arrays, names=[name for name, _ in columns])
    sink = io.BytesIO()
    parquet.write_table(table, sink)
    return sink.getvalue()


def _typed(values: list[Any]) -> tuple[list[Any], Any]:
    """Values of one column and the one type that holds all of them as they are.

    Numbers of both kinds are floats, if no whole one is too large to be one; anything else that is
    mixed, or whole numbers that 64 bits do not hold, is text.
    """
    import pyarrow

    kinds = {type(v) for v in values if v is not None}
    if kinds == {bool}:
        return values, pyarrow.bool_()
    if kinds == {int} and all(v is None or -(2**63) <= v < 2**63 for v in values):
        return values, pyarrow.int64()
    whole = [v for v in values if type(v) is int]
    if kinds and kinds <= {int, float} and all(abs(v) <= 2**53 for v in whole):
        return [None if v is None else float(v) for v in values], pyarrow.float64()
    return [None if v is None else str(v) for v in values], pyarrow.string()
