"""Numba's ``njit`` with an on-disk cache that can never be stale.

Numba invalidates a cached function when its own file changes, not when a function it inlines
changes in another file. The cache folder is therefore named by a digest of all our files that
speak of ``njit``: another source, another folder. Compiled functions take functions and constants
from such files only.
"""

import contextlib
import fcntl
import functools
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numba
from numba.core import config

from mjmr.provenance import source_digest


@functools.cache
def cache_folder() -> Path:
    """Folder of the compiled functions of exactly these sources.

    ``NUMBA_CACHE_DIR``, or ``$XDG_CACHE_HOME/mjmr/numba``, with the digest below it.
    """
    root = os.environ.get("NUMBA_CACHE_DIR")
    if not root:
        base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
        root = str(Path(base) / "mjmr" / "numba")
    return Path(root) / source_digest("mjmr", "controllers", containing="njit")[:16]


def njit(function: Any = None, **options: Any) -> Any:
    """``numba.njit(cache=True, error_model="numpy")`` into :func:`cache_folder`.

    What has no file is not cached: a part that travels as text is compiled by every process.

    No fast-math and no parallel threads: the same input gives the same bits everywhere.
    """
    if function is None:
        return functools.partial(njit, **options)
    config.CACHE_DIR = str(cache_folder())  # pyright: ignore[reportAttributeAccessIssue]
    # A module built from text has no file, and its text may be newer or older than one on disk.
    cache = "__file__" in function.__globals__
    compiled = numba.njit(cache=cache, error_model="numpy", **options)(function)
    _save_alone(compiled)
    return compiled


def _save_alone(compiled: Any) -> None:
    """Let one process at a time save to the cache.

    Numba's files are whole or not there, but it reads the index of a function's signatures, adds
    one and writes it back: two processes that compile at once may give one name to two of them,
    and a third one would then run the code of the wrong one.
    """
    cache: Any = getattr(compiled, "_cache", None)
    save = getattr(cache, "save_overload", None)
    if save is None:  # NUMBA_DISABLE_JIT
        return

    def save_overload(signature: Any, data: Any) -> None:
        with _locked() as folder:
            save(signature, data)
            for leftover in folder.rglob("*.tmp.*"):  # of a process killed while it saved
                leftover.unlink(missing_ok=True)

    cache.save_overload = save_overload


@contextlib.contextmanager
def _locked() -> Iterator[Path]:
    folder = cache_folder()
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / ".lock", "a") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield folder
