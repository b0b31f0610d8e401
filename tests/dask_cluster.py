"""A Dask cluster on loopback, of processes as a user starts them."""

import contextlib
import os
import socket
import subprocess
import sys
import time

import psutil


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Cluster:
    """A scheduler and its workers; a context manager that ends them all."""

    def __init__(self, folder, workers=0, **environment):
        self.folder, self.started = folder, []
        self.scheduler = self._start_scheduler()
        if workers:
            self.add(workers, **environment)
            self.wait_for(workers)

    def add(self, count=1, *words, before=(), **environment):
        """Start workers as docs/cluster.md says; more words and environment as given."""
        threads = () if "--nthreads" in words else ("--nthreads", "1")
        own = ("--nworkers", str(count), "--no-dashboard", "--local-directory", str(self.folder))
        return self._start(
            "worker", (self.address, *own, *threads, *words), environment, before=before
        )

    def _start(self, kind, words, environment, before=()):
        log = open(self.folder / f"{kind}{len(self.started)}.log", "w")  # noqa: SIM115
        process = subprocess.Popen(
            [sys.executable, *before, "-m", f"distributed.cli.dask_{kind}", *words],
            stdout=log,
            stderr=log,
            cwd=self.folder,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path[:1] + [os.getcwd()])}
            | environment,
        )
        log.close()
        self.started.append(process)
        return process

    def _start_scheduler(self):
        for _ in range(3):  # a port that was free may be somebody's by the time it is taken
            port = free_port()
            self.address = f"tcp://127.0.0.1:{port}"
            words = ("--host", "127.0.0.1", "--port", str(port), "--no-dashboard", "--no-show")
            scheduler = self._start("scheduler", words, {})
            if self._opens(port, scheduler):
                return scheduler
            scheduler.kill()
            scheduler.wait()
            self.started.clear()
        log = (self.folder / "scheduler0.log").read_text()
        raise AssertionError(f"the scheduler does not start: {log}")

    @staticmethod
    def _opens(port, scheduler):
        end = time.monotonic() + 60.0
        while time.monotonic() < end and scheduler.poll() is None:
            with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 1):
                return True
            time.sleep(0.05)
        return False

    def wait_for(self, count):
        """Wait until this many workers have joined."""
        from distributed import Client

        with Client(self.address, set_as_default=False) as client:
            client.wait_for_workers(count, timeout=60)

    def worker_processes(self):
        """The processes that compute: children of the nannies."""
        found = []
        for nanny in self.started[1:]:
            with contextlib.suppress(psutil.Error):
                children = psutil.Process(nanny.pid).children()
                found += [c for c in children if "spawn_main" in " ".join(c.cmdline())]
        return found

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in reversed(self.started):
            with contextlib.suppress(psutil.Error):
                for child in psutil.Process(process.pid).children(recursive=True):
                    child.kill()
            process.kill()
            process.wait()
