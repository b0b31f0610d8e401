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
from collections.abc import Callable, Iterator
from pathlib import Path

_PREFIX = ".mjmr-tmp-"


def write_atomically(path: Path, content: str | bytes) -> None:
    """Write bytes, or UTF-8 text: a reader, or a kill, sees the old file or the new one.

    Raises:
        OSError: The folder cannot be written to.
    """
    path = Path(path)
    clear_leftovers(path.parent)
    handle, name = _locked(lambda: _file(path))
    try:
        with os.fdopen(handle, "wb") as file:
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
    handle, folder = _locked(lambda: _folder(parent, name))
    try:
        yield Path(folder)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        os.close(handle)


def _file(path: Path) -> tuple[int, str]:
    return tempfile.mkstemp(prefix=f"{_PREFIX}{path.name}-", dir=path.parent)


def _folder(parent: Path, name: str) -> tuple[int, str]:
    while True:
        folder = tempfile.mkdtemp(prefix=f"{_PREFIX}{name}-", dir=parent)
        with contextlib.suppress(FileNotFoundError):  # taken for a leftover already
            return os.open(folder, os.O_RDONLY), folder


def _locked(create: Callable[[], tuple[int, str]]) -> tuple[int, str]:
    """Handle and name of what ``create`` makes, locked.

    Before it is locked another process may take it for a leftover, and it is made again.
    """
    while True:
        handle, name = create()
        try:
            _lock(handle)
            if os.path.samestat(os.fstat(handle), os.stat(name)):
                return handle, name
        except (BlockingIOError, FileNotFoundError):
            pass
        os.close(handle)
        with contextlib.suppress(OSError):
            Path(name).rmdir() if Path(name).is_dir() else Path(name).unlink()


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
