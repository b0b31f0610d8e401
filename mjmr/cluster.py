"""Trials on a Dask cluster: a scheduler that is running, workers of one thread each.

The driver places every trial itself, on a worker it has checked, and keeps two there: one that is
computed and one that waits. When a worker is gone it is therefore known whose trial it died of,
and the rest goes elsewhere. What travels is a text for ``eval`` and pickled values, so that a
scheduler needs no mjmr, and a worker without it can say so.
"""

import contextlib
import importlib.util
import itertools
import logging
import pickle
import re
import threading
import time
import uuid
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from concurrent.futures import CancelledError
from dataclasses import dataclass, field
from typing import Any

from mjmr.cluster_worker import wrong_threads
from mjmr.errors import InvalidInputError, MjmrError, one_line
from mjmr.executor import Executor
from mjmr.parts import Job
from mjmr.provenance import versions
from mjmr.store import Outcome
from mjmr.study import Trial

CONNECT_SECONDS = 10.0  # wall time an answer, and then a first worker, is waited for
CHECK_SECONDS = 120.0  # wall time a worker may take to import a study
_POLL = 0.2  # [s] between looks at whether to stop
_LOOK = 1.0  # [s] between looks at who is there
_AHEAD = 2  # trials placed on a worker
_VERSION = (
    "next((d.version for d in __import__('importlib.metadata', fromlist=['distributions'])"
    ".distributions(name='mjmr')), None)"
)
_ANSWER = "__import__('mjmr.cluster_worker', fromlist=['answer']).answer(*request)"


def check_address(address: str) -> None:
    """Check what can be checked without a connection.

    Raises:
        InvalidInputError: Not of the form ``tcp://host:port``.
        MjmrError: Dask is not installed.
    """
    found = re.fullmatch(r"(?:tcp|tls|ucx)://(?:[\w.-]+|\[[\da-fA-F:.]+\]):(\d{1,5})", address)
    if not found or not 0 < int(found[1]) < 65536:
        raise InvalidInputError(
            f"a cluster's address is tcp://host:port (or tls://, ucx://), not {address!r}"
        )
    if importlib.util.find_spec("distributed") is None:
        raise MjmrError('--cluster needs Dask: pip install "mjmr[cluster]"')


class DaskExecutor(Executor):
    """Workers of a running Dask scheduler; they may die, and join, at any time."""

    def __init__(
        self, address: str, size: str, digest: str, tell: Callable[[str], None] = lambda text: None
    ):
        """Use a cluster; it is not connected to before :meth:`run`.

        Args:
            address: Of its scheduler, ``tcp://host:port``.
            size: The study's size the trials are of.
            digest: What ``study.digest(size)`` must be on every worker.
            tell: Gets remarks, one sentence each.

        Raises:
            MjmrError: As for :func:`check_address`.
        """
        check_address(address)
        self.address, self.size, self.digest, self.tell = address, size, digest, tell

    def run(
        self, job: Job, trials: Iterable[Trial], stop: Callable[[], bool] = lambda: False
    ) -> Generator[Outcome, None, None]:
        """See :meth:`Executor.run`; a trial whose worker died twice comes back as failed.

        Raises:
            MjmrError: At once: no answer, no worker or an unfit one. From the iteration: the
                scheduler is lost.
        """
        logging.getLogger("distributed").setLevel(logging.CRITICAL)
        with contextlib.ExitStack() as stack:
            client = stack.enter_context(_connected(self.address))
            stack.enter_context(_losing(self.address))
            crew = _Crew(client, job, self)
            crew.gather(stop)
            connection = stack.pop_all()

        def outcomes() -> Generator[Outcome, None, None]:
            with connection:
                yield from crew.work(trials, stop)

        return outcomes()


@dataclass(eq=False)
class _Task:
    trial: Trial
    deaths: int = 0
    future: Any = None


@dataclass
class _Worker:
    address: str
    tasks: deque[_Task] = field(default_factory=deque)


class _Crew:
    """The workers in use, and what each of them has to do, first what it is at."""

    def __init__(self, client: Any, job: Job, executor: DaskExecutor):
        self.client, self.tell = client, executor.tell
        self.request = (versions(), executor.size, executor.digest, pickle.dumps(job))
        self.workers: dict[str, _Worker] = {}
        self.refused: set[str] = set()
        self.again: deque[_Task] = deque()
        self.looked = 0.0
        self.names = (f"mjmr-{uuid.uuid4().hex}-{i}" for i in itertools.count())

    def gather(self, stop: Callable[[], bool]) -> None:
        """Wait for a first worker; check all there are."""
        end = time.monotonic() + CONNECT_SECONDS
        while not (threads := self.client.nthreads()):
            if stop():
                return
            if time.monotonic() > end:
                raise MjmrError(
                    f"the scheduler at {self.client.scheduler.address} has no workers, and none "
                    f"came within {CONNECT_SECONDS:g} s; start some with: dask worker ADDRESS "
                    "--nthreads 1"
                )
            time.sleep(_POLL)
        unfit = self._check(threads)
        if unfit:
            address, why = next(iter(unfit.items()))
            more = f" ({len(unfit)} of {len(threads)} workers are unfit)" if len(unfit) > 1 else ""
            raise MjmrError(f"worker {address} {why}{more}")
        self.workers = {address: _Worker(address) for address in threads}
        self.looked = time.monotonic()

    def work(
        self, trials: Iterable[Trial], stop: Callable[[], bool]
    ) -> Generator[Outcome, None, None]:
        """Yield outcomes as they come."""
        from distributed import TimeoutError as NotYet
        from distributed import wait

        fresh = (_Task(trial) for trial in trials)
        try:
            while not stop():
                yield from self._look()
                for ahead in range(1, _AHEAD + 1):  # one for everybody before a second for any
                    for worker in self.workers.values():
                        if len(worker.tasks) < ahead and self._more(fresh):
                            self._start(self.again.popleft(), worker)
                futures = [t.future for w in self.workers.values() for t in w.tasks]
                if not futures:
                    if not self._more(fresh):
                        return
                    time.sleep(_POLL)
                    continue
                with self.client.as_current(), contextlib.suppress(NotYet):
                    wait(futures, timeout=_POLL, return_when="FIRST_COMPLETED")
                for worker in list(self.workers.values()):
                    for task in [t for t in worker.tasks if t.future.done()]:
                        if task not in worker.tasks:  # the one before has cost it its worker
                            continue
                        outcome = self._finish(worker, task)
                        if outcome is not None:
                            yield outcome
        finally:
            left = [t.future for w in self.workers.values() for t in w.tasks]
            if left and self.client.status == "running":
                self.client.cancel(left)

    def _more(self, fresh: Iterator[_Task]) -> bool:
        """Whether a trial is left to start; it is then the first of ``again``."""
        if not self.again:
            self.again.extend(itertools.islice(fresh, 1))
        return bool(self.again)

    def _start(self, task: _Task, worker: _Worker) -> None:
        request = (*self.request, pickle.dumps(task.trial))
        task.future = self.client.submit(
            eval,
            _ANSWER,
            {"request": request},
            key=next(self.names),
            workers=[worker.address],
            allow_other_workers=False,
            pure=False,
        )
        worker.tasks.append(task)

    def _finish(self, worker: _Worker, task: _Task) -> Outcome | None:
        """Outcome of a trial that is done; None if it has to be computed again."""
        from distributed import TimeoutError as NotYet
        from distributed.scheduler import KilledWorker

        told: Any
        try:
            kind, told = task.future.result(timeout=2 * _LOOK)
        except NotYet:  # the result went down with its worker, which is noticed in time
            return None
        except KilledWorker:
            # A nanny has restarted the worker at its old address, again and again.
            worker.tasks.remove(task)
            task.deaths = 2
            return _dead(task)
        except (OSError, CancelledError):
            raise  # the scheduler is lost
        except Exception as e:
            kind, told = "unfit", f"cannot compute ({one_line(e)})"
        worker.tasks.remove(task)
        if kind == "outcome":
            return pickle.loads(told)
        self.again.append(task)
        self._refuse(worker, told)
        return None

    def _look(self) -> Iterator[Outcome]:
        """Notice who has gone and who has come; yields trials that have killed two workers."""
        if time.monotonic() < self.looked + _LOOK:
            return
        threads = self.client.nthreads()
        for address in self.workers.keys() - threads.keys():
            worker = self.workers.pop(address)
            done = [t for t in worker.tasks if t.future.done()]
            lost = [t for t in worker.tasks if t not in done]
            self.client.cancel([t.future for t in worker.tasks])
            if lost:
                lost[0].deaths += 1  # the others were waiting behind it
            for task in done + lost:
                if task.deaths < 2:
                    self.again.append(task)
                else:
                    yield _dead(task)
            if not self.workers:
                self.tell("no worker is left; waiting for one to join")
        new = {a: n for a, n in threads.items() if a not in self.workers and a not in self.refused}
        unfit = self._check(new) if new else {}
        for address in new:
            if address in unfit:
                self._refuse(_Worker(address), unfit[address])
            else:
                self.workers[address] = _Worker(address)
        self.looked = time.monotonic()

    def _refuse(self, worker: _Worker, why: str) -> None:
        self.workers.pop(worker.address, None)
        self.refused.add(worker.address)
        self.client.cancel([t.future for t in worker.tasks])
        self.again.extend(worker.tasks)
        worker.tasks.clear()
        self.tell(f"worker {worker.address} {why}; it gets no trials")

    def _check(self, threads: Mapping[str, int]) -> dict[str, str]:
        """Why workers are unfit, by address; those that left meanwhile are fit, and noticed."""
        unfit = {a: wrong_threads(n) for a, n in threads.items() if n != 1}
        mine = versions()["mjmr"]
        for address, found in self._ask(_VERSION, {}, threads.keys() - unfit.keys()).items():
            if isinstance(found, Exception):
                unfit[address] = _lacking(found)
            elif found is None:
                unfit[address] = "has no mjmr; install the driver's version there"
            elif found != mine:
                unfit[address] = f"has mjmr {found} where {mine} is wanted"
        names = {"request": (*self.request, None)}
        for address, found in self._ask(_ANSWER, names, threads.keys() - unfit.keys()).items():
            if isinstance(found, Exception):
                unfit[address] = _lacking(found)
            elif found[0] == "unfit":
                unfit[address] = found[1]
        return {a: unfit[a] for a in threads if unfit.get(a)}

    def _ask(self, text: str, names: dict[str, Any], addresses: Iterable[str]) -> dict[str, Any]:
        workers = list(addresses)
        if not workers:
            return {}

        def ask() -> dict[str, Any]:
            return self.client.run(eval, text, names, workers=workers, on_error="return")

        found = _within(CHECK_SECONDS, ask)
        if isinstance(found, dict):
            return found
        late = MjmrError(f"no answer within {CHECK_SECONDS:g} s")
        return dict.fromkeys(workers, late if found is None else found)


def _dead(task: _Task) -> Outcome:
    return Outcome(*task.trial, "failed", error="worker died twice")


def _lacking(e: Exception) -> str:
    """Why a worker that raised this is unfit; nothing if it is gone, which is noticed elsewhere."""
    if isinstance(e, OSError):
        return ""
    if isinstance(e, ImportError) and (e.name or "mjmr").partition(".")[0] == "mjmr":
        return "has no mjmr; install the driver's version there"
    return f"cannot be used ({one_line(e)})"


@contextlib.contextmanager
def _connected(address: str) -> Iterator[Any]:
    """A client; it comes within :data:`CONNECT_SECONDS`, whatever is at the address."""
    from distributed import Client

    # Dask bounds connecting, but not the talk after it; what listens there may not be Dask.
    client = _within(
        CONNECT_SECONDS, lambda: Client(address, timeout=CONNECT_SECONDS, set_as_default=False)
    )
    if client is None or isinstance(client, Exception):
        why = f" ({one_line(client)})" if client and not isinstance(client, OSError) else ""
        raise MjmrError(
            f"no answer from a Dask scheduler at {address} within {CONNECT_SECONDS:g} s{why}; "
            "start one with: dask scheduler"
        )
    try:
        yield client
    finally:
        with contextlib.suppress(Exception):
            client.close(timeout=2)


def _within(seconds: float, function: Callable[[], Any]) -> Any:
    """What a function returns or raises; None if that takes longer, and it is then left alone."""
    found: list[Any] = []

    def call() -> None:
        try:
            found.append(function())
        except Exception as e:
            found.append(e)

    thread = threading.Thread(target=call, daemon=True)
    thread.start()
    thread.join(seconds)
    return found[0] if found else None


@contextlib.contextmanager
def _losing(address: str) -> Iterator[None]:
    """Say what a lost connection means for the run."""
    try:
        yield
    except (OSError, CancelledError) as e:
        raise MjmrError(
            f"lost the scheduler at {address} ({one_line(e)}); what is finished is kept, and the "
            "same command goes on from there"
        ) from e
