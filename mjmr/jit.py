"""Numba's ``njit`` with an on-disk cache that can never be stale.

Numba invalidates a cached function when its own file changes, not when a function it inlines
changes in another file. The cache folder is therefore named by a digest of all our files that
speak of ``njit``: another source, another folder. Compiled functions take functions and constants
from such files only.
"""

import functools
import os
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
    return numba.njit(cache=cache, error_model="numpy", **options)(function)
