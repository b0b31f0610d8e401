"""Files that are either whole or not there.

What is not whole yet has a name that starts with ``.mjmr-tmp-`` and is locked by the process that
writes it. The lock goes with the process, however it ends, so whoever comes next knows what was
left behind and removes it.
"""

import contextlib
import fcntl
import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

_PREFIX = ".mjmr-tmp-"


def write_atomically(path: Path, content: str | bytes) -> None:
    """Write bytes, or UTF-8 text: a reader, or a kill, sees the old file or the new one.

    Raises:
        OSError: The folder cannot be written to.
    """
    path = Path(path)
    clear_leftovers(path.parent)
    handle, name = tempfile.mkstemp(prefix=f"{_PREFIX}{path.name}-", dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            _lock(handle)
            file.write(content.encode() if isinstance(content, str) else content)
            file.flush()
            os.fsync(file.fileno())
            os.chmod(name, 0o666 & ~_umask())
            os.replace(name, path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


@contextlib.contextmanager
def temporary_folder(parent: Path, name: str) -> Iterator[Path]:
    """A folder in ``parent`` for files on their way to it; gone afterwards.

    Raises:
        OSError: ``parent`` cannot be written to.
    """
    clear_leftovers(parent)
    folder = Path(tempfile.mkdtemp(prefix=f"{_PREFIX}{name}-", dir=parent))
    handle = os.open(folder, os.O_RDONLY)
    try:
        _lock(handle)
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        os.close(handle)


def clear_leftovers(folder: Path) -> None:
    """Remove what killed processes have left half written in ``folder``."""
    for path in Path(folder).glob(f"{_PREFIX}*"):
        with contextlib.suppress(OSError):  # in use, or removed by another just now
            handle = os.open(path, os.O_RDONLY)
            try:
                _lock(handle)
                if path.is_dir():
                    shutil.rmtree(path)
                else:
                    path.unlink()
            finally:
                os.close(handle)


def _lock(handle: int) -> None:
    fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
