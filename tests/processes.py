"""Looking at processes that may end while one looks."""

import contextlib

import psutil


def spawned(process: psutil.Process) -> list[psutil.Process]:
    """Children, at any depth, that multiprocessing spawned."""
    found = []
    for child in process.children(recursive=True):
        with contextlib.suppress(psutil.Error):
            if "spawn_main" in " ".join(child.cmdline()):
                found.append(child)
    return found
