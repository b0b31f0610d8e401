"""Results of a study's size: one SQLite file that survives ``kill -9`` and is never overwritten.

The journal mode is DELETE with ``synchronous=FULL``: every finished trial is one durable
transaction, a killed driver leaves at most a journal that the next opening rolls back, and the
results are one file that can be copied at any time. WAL would commit faster than trials finish,
at the price of two more files and shared memory, which network folders do not have.

Every trial has a checksum, looked at whenever it is read. Metrics are JSON whose floats round-trip
bit for bit; nan and infinities are written as ``{"float": "nan"}``, since JSON has no word for
them.
"""

import contextlib
import fcntl
import hashlib
import json
import math
import os
import sqlite3
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from mjmr.conditions import Condition
from mjmr.errors import MjmrError
from mjmr.files import clear_leftovers
from mjmr.table import Metric

SCHEMA_VERSION = 2
FILE = "results.sqlite"
_LOCK = ".lock"
_STATUSES = ("ok", "failed", "no-gl")
_SCHEMA = """
CREATE TABLE meta (name TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE trials (
    id INTEGER PRIMARY KEY,
    condition TEXT NOT NULL,
    seed INTEGER NOT NULL,
    status TEXT NOT NULL CHECK (status IN ('ok', 'failed', 'no-gl')),
    metrics TEXT NOT NULL,
    error TEXT NOT NULL,
    traceback TEXT NOT NULL,
    checksum TEXT NOT NULL,
    UNIQUE (condition, seed)
);
CREATE TABLE wall_times (
    condition TEXT NOT NULL,
    seed INTEGER NOT NULL,
    name TEXT NOT NULL,
    value REAL,
    PRIMARY KEY (condition, seed, name)
);
"""


class StoreError(MjmrError):
    """A results folder cannot be used as asked; nothing in it was changed."""


@dataclass(frozen=True)
class Outcome:
    """A trial that has ended.

    Args:
        condition: Its complete condition.
        seed: Its seed.
        status: ``ok``, ``failed`` or ``no-gl``.
        metrics: What it measured; empty unless ok.
        wall: Wall-clock times by name [s, unless the name says otherwise].
        error: One line about a failure.
        traceback: Where it failed.
        replay: Content of a file that ``mjmr replay`` reads; empty if there is none. It is
            written beside the results, not into them.
    """

    condition: Condition
    seed: int
    status: str
    metrics: Mapping[str, Metric] = field(default_factory=dict)
    wall: Mapping[str, float] = field(default_factory=dict)
    error: str = ""
    traceback: str = ""
    replay: bytes = b""


class Store:
    """A results folder open for writing by this process alone; a context manager."""

    def __init__(self, folder: Path, meta: Mapping[str, Any]):
        """Open, or create, the results in ``folder``.

        Args:
            folder: Created if it is not there.
            meta: Written on creation; ``meta["digest"]`` must equal that of existing results.

        Raises:
            StoreError: Another digest, a damaged file, a folder in use or one that cannot be
                written to. The folder is then as it was.
        """
        self.folder = Path(folder)
        self.path = self.folder / FILE
        self._check_digest(meta)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            self._lock = open(self.folder / _LOCK, "a")  # noqa: SIM115
        except OSError as e:
            raise StoreError(f"cannot write to {self.folder}: {e.strerror}") from e
        try:
            try:
                fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError as e:
                raise StoreError(f"another mjmr is running in {self.folder}") from e
            self._check_digest(meta)  # again: another driver may have come between
            clear_leftovers(self.folder)
            self._db = self._open(meta)
        except BaseException:
            self._lock.close()
            raise

    def _check_digest(self, meta: Mapping[str, Any]) -> None:
        found = read_meta(self.folder)
        if found is None or found.get("digest") == meta["digest"]:
            return
        raise StoreError(
            f"{self.folder} holds results of another configuration or source "
            f"(digest {str(found.get('digest'))[:12]}, now {str(meta['digest'])[:12]}); "
            "choose another folder with --out, or --fresh to set it aside and start anew"
        )

    def _open(self, meta: Mapping[str, Any]) -> sqlite3.Connection:
        try:
            db = sqlite3.connect(self.path, timeout=30.0, isolation_level=None)
            db.execute("PRAGMA journal_mode=DELETE")
            db.execute("PRAGMA synchronous=FULL")
            if not db.execute("SELECT 1 FROM sqlite_master LIMIT 1").fetchone():
                entries = {
                    "schema_version": SCHEMA_VERSION,
                    "created": datetime.now(UTC).isoformat(timespec="seconds"),
                    **meta,
                }
                db.execute("BEGIN IMMEDIATE")
                for statement in _SCHEMA.split(";")[:-1]:
                    db.execute(statement)
                rows = [(name, json.dumps(value)) for name, value in entries.items()]
                db.executemany("INSERT INTO meta VALUES (?, ?)", rows)
                db.execute("COMMIT")
        except sqlite3.Error as e:
            raise StoreError(f"cannot write to {self.path}: {e}") from e
        return db

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, e: BaseException | None, tb: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the file and let others open it."""
        self._db.close()
        self._lock.close()

    def record(self, outcome: Outcome) -> None:
        """Keep a finished trial; it is on disk when this returns.

        A trial that did not end ``ok`` may be recorded again, one that did may not.

        Raises:
            StoreError: It is there already, or cannot be written.
        """
        key, metrics = outcome.condition.key, encode(outcome.metrics)
        row = (key, outcome.seed, outcome.status, metrics, outcome.error, outcome.traceback)
        row += (_checksum(*row),)
        try:
            self._db.execute("BEGIN IMMEDIATE")
            try:
                written = self._db.execute(
                    "INSERT INTO trials (condition, seed, status, metrics, error, "
                    "traceback, checksum) VALUES (?, ?, ?, ?, ?, ?, ?) "
                    "ON CONFLICT (condition, seed) DO UPDATE SET "
                    "status = excluded.status, metrics = excluded.metrics, "
                    "error = excluded.error, traceback = excluded.traceback, "
                    "checksum = excluded.checksum "
                    "WHERE trials.status != 'ok'",
                    row,
                ).rowcount
                if written != 1:
                    raise StoreError(
                        f"trial {outcome.condition} seed {outcome.seed} is recorded already"
                    )
                self._db.executemany(
                    "INSERT OR REPLACE INTO wall_times VALUES (?, ?, ?, ?)",
                    [(key, outcome.seed, name, value) for name, value in outcome.wall.items()],
                )
                self._db.execute("COMMIT")
            except BaseException:
                self._db.execute("ROLLBACK")
                raise
        except sqlite3.Error as e:
            raise StoreError(f"cannot write to {self.path}: {e}") from e

    def outcomes(self) -> list[Outcome]:
        """Every recorded trial, ordered by condition and seed."""
        return list(_outcomes(self._db))


def read_meta(folder: Path) -> dict[str, Any] | None:
    """What the results in ``folder`` say about themselves; None if there are none.

    Nothing is written, except that SQLite rolls back what a killed driver left half done.

    Raises:
        StoreError: The file is damaged, not a database, or of another schema.
    """
    path = Path(folder) / FILE
    try:
        if not path.is_file() or path.stat().st_size == 0:
            return None
    except OSError as e:
        raise StoreError(f"cannot read {path}: {e.strerror}") from e
    with reading(folder) as db:
        return _meta(db)


@contextlib.contextmanager
def reading(folder: Path) -> Iterator[sqlite3.Connection]:
    """A read-only connection to checked results, also while a driver is at work.

    Raises:
        StoreError: There are none, or they are damaged, not a database, or of another schema.
    """
    path = Path(folder) / FILE
    if not path.is_file():
        raise StoreError(f"no results in {folder}; make them with mjmr run")
    advice = "; move it elsewhere, or use --fresh to set its folder aside and start anew"
    try:
        with contextlib.closing(_connect(path)) as db:
            damage = db.execute("PRAGMA quick_check(1)").fetchone()[0]
            if damage != "ok":
                raise StoreError(f"{path} is damaged ({' '.join(damage.split())}){advice}")
            tables = {n for (n,) in db.execute("SELECT name FROM sqlite_master WHERE type='table'")}
            if tables and not {"meta", "trials", "wall_times"} <= tables:
                raise StoreError(f"{path} is a database, but not of mjmr{advice}")
            version = (_meta(db) or {}).get("schema_version")
            if tables and version != SCHEMA_VERSION:
                raise StoreError(
                    f"{path} has schema {version}, this mjmr reads {SCHEMA_VERSION}{advice}"
                )
            yield db
    except sqlite3.Error as e:
        raise StoreError(f"{path} is damaged or not a database ({e}){advice}") from e


def _connect(path: Path) -> sqlite3.Connection:
    uri = path.resolve().as_uri()
    journal = path.with_name(path.name + "-journal")
    # A journal that a killed driver left must be rolled back before anything can be read.
    mode = "rw" if journal.exists() and os.access(path, os.W_OK) else "ro"
    return sqlite3.connect(f"{uri}?mode={mode}", uri=True, timeout=30.0, isolation_level=None)


def _meta(db: sqlite3.Connection) -> dict[str, Any] | None:
    if not db.execute("SELECT 1 FROM sqlite_master WHERE name = 'meta'").fetchone():
        return None
    return {name: _parse(value) for name, value in db.execute("SELECT name, value FROM meta")}


def _parse(text: str) -> Any:
    try:
        return json.loads(text)
    except (TypeError, ValueError) as e:
        raise StoreError(
            f"{FILE} is damaged ({text!r:.40} is no JSON); move it elsewhere, or use --fresh to "
            "set its folder aside and start anew"
        ) from e


def read_outcomes(folder: Path) -> list[Outcome]:
    """Every recorded trial of a folder, ordered by condition and seed.

    Raises:
        StoreError: As for :func:`reading`.
    """
    with reading(folder) as db:
        return list(_outcomes(db)) if _meta(db) else []


def _outcomes(db: sqlite3.Connection) -> Iterator[Outcome]:
    wall: dict[tuple[str, int], dict[str, float]] = {}
    for key, seed, name, value in db.execute(
        "SELECT condition, seed, name, value FROM wall_times ORDER BY rowid"
    ):
        # SQLite keeps no nan: it comes back as NULL.
        wall.setdefault((key, seed), {})[name] = math.nan if value is None else value
    for *row, checksum in db.execute(
        "SELECT condition, seed, status, metrics, error, traceback, checksum FROM trials "
        "ORDER BY condition, seed"
    ):
        key, seed, status, metrics, error, trace = row
        if _checksum(*row) != checksum:
            raise StoreError(
                f"{FILE} is damaged: trial {key} seed {seed} is not what was written (its checksum "
                "differs); move it elsewhere, or use --fresh to set its folder aside and start anew"
            )
        yield Outcome(
            Condition(_parse(key)),
            seed,
            status,
            decode(metrics),
            wall.get((key, seed), {}),
            error,
            trace,
        )


def _checksum(*row: Any) -> str:
    """SHA-256 of a trial as its row has it, so that no changed digit passes for a result."""
    return hashlib.sha256(json.dumps(row).encode()).hexdigest()


def is_of(folder: Path, digest: str) -> bool:
    """Whether ``folder`` can take results of ``digest``: it holds such, or none at all."""
    try:
        meta = read_meta(folder)
    except StoreError:
        return False
    return meta is None or meta.get("digest") == digest


def set_aside(folder: Path) -> Path | None:
    """Rename a results folder to ``NAME.old-YYYYmmdd-HHMMSS``; nothing is deleted.

    Returns:
        The new name, or None if there was nothing to set aside.

    Raises:
        StoreError: Not a folder of mjmr, in use by another mjmr, or it cannot be renamed.
    """
    folder = Path(folder).resolve()
    try:
        if not folder.exists() or not any(folder.iterdir()):
            return None
        if not (folder / FILE).exists():
            raise StoreError(f"{folder} holds no {FILE}: not a results folder, so it stays")
        with open(folder / _LOCK, "a") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError as e:
                raise StoreError(f"another mjmr is running in {folder}") from e
            stamp, count = time.strftime("%Y%m%d-%H%M%S"), 1
            aside = folder.with_name(f"{folder.name}.old-{stamp}")
            while aside.exists():
                count += 1
                aside = folder.with_name(f"{folder.name}.old-{stamp}-{count}")
            folder.rename(aside)
    except OSError as e:
        raise StoreError(f"cannot set {folder} aside: {e.strerror}") from e
    return aside


def encode(metrics: Mapping[str, Metric]) -> str:
    """Metrics as strict JSON; floats by their shortest repr, which reads back bit for bit."""
    return json.dumps(
        {name: strict(value) for name, value in metrics.items()}, separators=(",", ":")
    )


def decode(text: str) -> dict[str, Metric]:
    """Inverse of :func:`encode`."""
    found = _parse(text)
    return {n: float(v["float"]) if isinstance(v, dict) else v for n, v in found.items()}


def strict(value: Metric) -> Any:
    """A metric as JSON has words for: numbers that are not finite as ``{"float": "nan"}``."""
    if isinstance(value, float) and not math.isfinite(value):
        return {"float": repr(value)}
    return value
