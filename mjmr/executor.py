"""Where trials are computed: processes of this machine, one thread each.

An executor takes trials and yields outcomes as they finish; it writes nothing. Each of its workers
is a pool of one process, so that a worker's death is always the death of one known trial.
"""

import contextlib
import ctypes
import dataclasses
import functools
import os
import signal
import sys
import threading
import time
import traceback
import weakref
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import FIRST_COMPLETED, Future, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from typing import Any

from mjmr.conditions import Condition
from mjmr.errors import InvalidInputError, MissingGLError, one_line
from mjmr.one_thread import one_thread_each
from mjmr.parts import Job
from mjmr.store import Outcome
from mjmr.study import Trial
from mjmr.watch import watching

_POLL = 0.2  # [s] between looks at whether to stop


class Executor(ABC):
    """Computes trials of a study somewhere."""

    @abstractmethod
    def run(
        self, job: Job, trials: Iterable[Trial], stop: Callable[[], bool] = lambda: False
    ) -> Generator[Outcome, None, None]:
        """Yield the outcome of every trial, in the order they finish.

        Args:
            job: The study, and what was swapped in it.
            trials: What to compute; taken one by one as workers become free.
            stop: Looked at a few times a second; when it says True, trials under way are given up
                and the iteration ends.
        """


class LocalExecutor(Executor):
    """Spawned processes, one thread each, that die with the process that started them."""

    def __init__(self, workers: int):
        """Use this many processes.

        Raises:
            InvalidInputError: Fewer than one.
        """
        if workers < 1:
            raise InvalidInputError(f"workers must be at least 1, not {workers}")
        self.workers = workers

    def run(
        self, job: Job, trials: Iterable[Trial], stop: Callable[[], bool] = lambda: False
    ) -> Generator[Outcome, None, None]:
        """See :meth:`Executor.run`."""
        again: deque[_Task] = deque()
        fresh = (_Task(trial) for trial in trials)
        workers: list[_Worker] = []
        busy: dict[Future, tuple[_Worker, _Task]] = {}
        with one_thread_each():
            try:
                while not stop():
                    while len(busy) < self.workers:
                        task = again.popleft() if again else next(fresh, None)
                        if task is None:
                            break
                        idle = next((w for w in workers if not w.busy), None)
                        if idle is None:
                            idle = _Worker(job)
                            workers.append(idle)
                        busy[idle.start(task)] = idle, task
                    if not busy:
                        return
                    done, _ = wait(busy, timeout=_POLL, return_when=FIRST_COMPLETED)
                    for future in done:
                        worker, task = busy.pop(future)
                        outcome = worker.finish(future, task)
                        if outcome is None:
                            again.append(task)
                        else:
                            yield outcome
            finally:
                for worker in workers:
                    worker.kill()


@dataclass
class _Task:
    trial: Trial
    deaths: int = 0


class _Worker:
    """A pool of one process that computes one trial at a time, replaced when it dies."""

    def __init__(self, job: Job):
        self._job = job
        self._pool: Any = None
        self.busy = False

    def start(self, task: _Task) -> Future:
        """Begin a trial."""
        self.busy = True
        condition, seed = task.trial
        for _ in range(2):
            if self._pool is None or not self._pool.active:  # died between trials
                self.kill()
                self._pool = _start_pool()
            with contextlib.suppress(RuntimeError):  # died just now
                return self._pool.schedule(compute, args=(self._job, condition, seed))
        raise RuntimeError("a worker process cannot be started")

    def finish(self, future: Future, task: _Task) -> Outcome | None:
        """Outcome of a trial whose future is done; None if its worker died for the first time."""
        from pebble import ProcessExpired

        self.busy = False
        condition, seed = task.trial
        try:
            return future.result()
        except ProcessExpired as e:
            why = f"exit code {e.exitcode}"
        except BrokenProcessPool:
            why = "exit code unknown"
            self.kill()
        except Exception as e:
            return _failed(condition, seed, e)
        task.deaths += 1
        if task.deaths < 2:
            return None
        return Outcome(condition, seed, "failed", error=f"worker died twice: {why}")

    def kill(self) -> None:
        """End the process, and what it is computing."""
        if self._pool is not None:
            self._pool.stop()
            self._pool.join()
            self._pool = None


def _start_pool() -> Any:
    """A pool whose process, and any that replaces it, never hears Ctrl-C.

    Signal masks are inherited: the pool's threads get the mask of this one, processes the mask of
    the thread that starts them. multiprocessing's tracker is started first since it unblocks.
    """
    import multiprocessing
    from multiprocessing import resource_tracker

    from pebble import ProcessPool

    resource_tracker.ensure_running()
    context = multiprocessing.get_context("spawn")
    pool = ProcessPool(max_workers=1, context=context, initializer=_begin, initargs=(os.getpid(),))
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        _ = pool.active  # starts it
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    return pool


def _begin(parent: int) -> None:
    """First thing in a worker: no Ctrl-C, and no life without the driver, even after kill -9."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if sys.platform == "linux":
        pr_set_pdeathsig = 1
        ctypes.CDLL(None, use_errno=True).prctl(pr_set_pdeathsig, signal.SIGKILL, 0, 0, 0)
        if os.getppid() != parent:  # it died before the kernel was told
            os._exit(1)
    else:
        threading.Thread(target=_watch, args=(parent,), daemon=True).start()


def _watch(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(_POLL)
    os._exit(1)


@functools.cache
def _trial_function(job: Job) -> Callable[..., Any]:
    from mjmr.registry import load_study

    loaded = load_study(job.study).choose(job.parts)
    prepare = loaded.resolve("prepare")
    if prepare is not None:
        prepare()  # what the driver has compiled is loaded here, not inside the first trial
    return loaded.bound_trial()


def make_ready(job: Job) -> None:
    """Load and prepare a study here, as its first trial would.

    Raises:
        Exception: Whatever the study raises.
    """
    _trial_function(job)


def compute(job: Job, condition: Condition, seed: int) -> Outcome:
    """Compute one trial, here; whatever goes wrong is in the outcome.

    A trial that fails while its simulation runs brings a replay of the last second.

    Args:
        job: The study, and what was swapped in it.
        condition: Complete condition.
        seed: Seed of the trial.
    """
    built: list[weakref.ref[Any]] = []  # they live as long as the trial, and in its traceback
    try:
        function = _trial_function(job)
        start = time.perf_counter()
        with watching(lambda simulation: built.append(weakref.ref(simulation))):
            returned = function(condition, seed)
        wall = {"wall_trial": time.perf_counter() - start}
        metrics = {str(name): _metric(name, value) for name, value in dict(returned).items()}
    except MissingGLError as e:
        return Outcome(condition, seed, "no-gl", error=_one_line(e))
    except Exception as e:
        failed = _failed(condition, seed, e)
        alive = [s for s in (reference() for reference in built) if s is not None]
        return dataclasses.replace(failed, **_replay(job, failed, alive)) if alive else failed
    for name in [n for n in metrics if n.startswith("wall_")]:
        wall[name] = float(metrics.pop(name))
    return Outcome(condition, seed, "ok", metrics, wall)


def _replay(job: Job, failed: Outcome, simulations: list[Any]) -> dict[str, Any]:
    """The outcome's replay; where that cannot be made, its traceback with the reason."""
    from mjmr.replay import failure_file

    simulation = next((s for s in simulations if s.diverged), simulations[-1])
    try:
        return {"replay": failure_file(simulation, job, failed)}
    except Exception as e:  # it must not hide why the trial failed
        return {"traceback": f"{failed.traceback}\nno replay: {_one_line(e)}\n"}


def _metric(name: object, value: Any) -> Any:
    item = getattr(value, "item", None)
    if callable(item) and getattr(value, "ndim", 1) == 0:  # a numpy scalar
        value = item()
    if value is None or type(value) in (bool, int, float, str):
        if str(name).startswith("wall_") and type(value) not in (int, float):
            raise InvalidInputError(f"metric {name} is a wall time, so a number, not {value!r}")
        return value
    raise InvalidInputError(
        f"metric {name} must be a float, int, str, bool or None, not {type(value).__name__}"
    )


def _failed(condition: Condition, seed: int, e: BaseException) -> Outcome:
    told = "".join(traceback.format_exception(e))
    return Outcome(condition, seed, "failed", error=_one_line(e), traceback=_storable(told))


def _one_line(e: BaseException) -> str:
    return _storable(one_line(e))


def _storable(text: str) -> str:
    return text.encode("utf-8", "backslashreplace").decode("utf-8")
