"""Kill runs at chosen moments, resume them, and compare what is left with a run left alone.

``python -m tests.kill_runs [ROUNDS]`` kills each phase so many times (10) and prints a table. The
phases are hit exactly: a driver started through this file lays a trap in its own process, so the
testbed knows nothing of it.

    result    SIGKILL to the driver, between a trial's result arriving and its transaction
    commit    inside the transaction, after its INSERT
    compile   while numba saves what it compiled, cache empty at first
    film      while the film is being written
    worker    SIGKILL to a random worker in mid-trial; the driver lives
"""

import contextlib
import json
import os
import random
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import psutil

from tests.processes import spawned

STUDY = "safe-navigation"
ONLY = ("scene=overlap,straight,cross10,A", "sigma_mm=0")
PHASES = ("result", "commit", "compile", "film", "worker")


def trap(phase: str, count: int) -> None:
    """Die at the ``count``-th time this process comes to ``phase``."""
    left = [count]

    def step() -> None:
        left[0] -= 1
        if left[0] == 0:
            os.kill(os.getpid(), signal.SIGKILL)

    if phase == "result":
        from mjmr.store import Store

        record = Store.record

        def late(self, outcome):
            step()
            record(self, outcome)

        Store.record = late
    elif phase == "commit":
        connect = sqlite3.connect

        class Connection(sqlite3.Connection):
            def execute(self, sql, *arguments):
                if sql == "COMMIT" and self.total_changes and self.recording:
                    step()
                self.recording = sql == "BEGIN IMMEDIATE" or (
                    getattr(self, "recording", False) and sql != "COMMIT"
                )
                return super().execute(sql, *arguments)

            recording = False

        sqlite3.connect = lambda *a, **k: connect(*a, **{**k, "factory": Connection})
    elif phase == "compile":
        from numba.core.caching import IndexDataCacheFile

        save = IndexDataCacheFile._save_data

        def between(self, name, data):  # the index names data that is not there yet
            half = Path(self._data_path(name) + ".tmp.half")
            half.write_bytes(b"half")
            step()
            half.unlink()
            save(self, name, data)

        IndexDataCacheFile._save_data = between
    elif phase == "film":
        from mjmr.video import VideoWriter

        write = VideoWriter.write

        def frame(self, picture):
            step()
            write(self, picture)

        VideoWriter.write = frame


def start(folder: Path, study: str, words: tuple[str, ...], phase: str, count: int, cache: Path):
    """A driver of ``mjmr run`` that dies at a phase; count 0: that does not."""
    command = [sys.executable, "-m", "tests.kill_runs", "--trap", phase, str(count), "run", study]
    log = open(folder.with_suffix(".log"), "a")  # noqa: SIM115
    try:
        return subprocess.Popen(
            [*command, "--out", str(folder), *words],
            stdout=log,
            stderr=log,
            env={**os.environ, "NUMBA_CACHE_DIR": str(cache)},
        )
    finally:
        log.close()


def finish(driver: subprocess.Popen, seconds: float = 300.0) -> int:
    """Wait for a driver's end; none of its workers may outlive it. Returns its exit code."""
    end, workers = time.monotonic() + seconds, {}
    while driver.poll() is None:
        assert time.monotonic() < end, "the driver hangs"
        with contextlib.suppress(psutil.Error):
            workers |= {p.pid: p for p in psutil.Process(driver.pid).children(recursive=True)}
        time.sleep(0.02)
    _, orphans = psutil.wait_procs(list(workers.values()), timeout=5.0)
    assert orphans == [], "a worker outlived its driver"
    return driver.returncode


def contents(folder: Path) -> dict:
    """What a finished run says, wall times left out."""
    with contextlib.closing(sqlite3.connect(folder / "results.sqlite")) as db:
        rows = db.execute(
            "SELECT condition, seed, status, metrics, error FROM trials ORDER BY condition, seed"
        ).fetchall()
    assert len({row[:2] for row in rows}) == len(rows)
    claims = json.loads((folder / "claims.json").read_text())
    return {"trials": rows, "verdicts": {c["id"]: c["verdict"] for c in claims if not c["timing"]}}


def leftovers(folder: Path) -> list[str]:
    """Files in a results folder, or a cache, that are not meant to stay."""
    marks = (".tmp.", ".mjmr-tmp-", ".part", "-journal")
    return sorted(str(p) for p in folder.rglob("*") if any(m in p.name for m in marks))


def check_film(folder: Path) -> None:
    """The film can be decoded to its end."""
    import av

    with av.open(str(folder / "film.mp4")) as container:
        stream = container.streams.video[0]
        assert sum(1 for _ in container.decode(video=0)) == stream.frames > 0


def kill_a_worker(driver: subprocess.Popen, moments: random.Random) -> bool:
    """SIGKILL one of a driver's workers, somewhere in its trials; False if there is none left."""
    process = psutil.Process(driver.pid)
    time.sleep(moments.uniform(1.0, 3.0))
    with contextlib.suppress(psutil.Error):
        workers = [p for p in spawned(process) if p.cpu_times().user > 0.3]
        if workers:
            moments.choice(workers).kill()
            return True
    return False


def series(
    place: Path,
    phase: str,
    kills: int,
    study: str = STUDY,
    words: tuple[str, ...] = (),
    seed: int = 0,
) -> tuple[Path, dict[str, int]]:
    """Kill one run after another in one folder, then let it end.

    Returns:
        The folder and what happened: kills, resumed runs, temporary files seen between.
    """
    moments, folder, cache = random.Random(seed), place / phase, place / "cache"
    if phase == "compile":
        cache = place / "cold"
    done, runs, seen = 0, 0, 0
    if phase == "worker":  # chance may kill two workers at one trial, which then counts as failed
        words = (*words, "--retry")
    while True:
        killing = done < kills
        wanted = phase if killing and phase != "worker" else "none"
        count = moments.randint(1, 3) if phase != "film" else moments.randint(1, 60)
        driver = start(folder, study, words, wanted, count, cache)
        runs += 1
        while phase == "worker" and done < kills and driver.poll() is None:
            done += kill_a_worker(driver, moments)
        code = finish(driver)
        if code == -signal.SIGKILL:
            done += 1
            seen += len(leftovers(folder)) + (len(leftovers(cache)) if phase == "compile" else 0)
            continue
        assert code in (0, 1), folder.with_suffix(".log").read_text()[-2000:]
        if done >= kills and phase == "worker" and killing:
            continue  # the same command once more computes what may have failed
        if done >= kills:
            break
        assert phase != "compile", f"all is compiled after {done} kills"
        shutil.rmtree(folder)  # it ended before enough were killed: once more from the start
    assert leftovers(folder) == [], leftovers(folder)
    assert phase != "compile" or leftovers(cache) == []
    return folder, {"kills": done, "runs": runs, "temporary files seen": seen}


def main() -> None:
    """Run every phase; compare each with a run left alone."""
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 10
    phases = sys.argv[2:] or PHASES
    words = ("--workers", "2", "--only", *ONLY)
    place = Path(tempfile.mkdtemp(prefix="kill-runs-"))
    begin = time.monotonic()
    assert finish(start(place / "whole", STUDY, words, "none", 0, place / "cache")) in (0, 1)
    whole = contents(place / "whole")
    check_film(place / "whole")
    trials = len(whole["trials"])
    print(f"left alone: {trials} trials, {time.monotonic() - begin:.0f} s", flush=True)
    total = 0
    for number, phase in enumerate(phases):
        begin = time.monotonic()
        folder, told = series(place, phase, rounds, words=words, seed=number)
        assert contents(folder) == whole, f"{phase}: not as the run left alone, see {folder}"
        check_film(folder)
        total += told["kills"]
        said = ", ".join(f"{v} {k}" for k, v in told.items())
        print(f"{phase}: {said}; equal, {time.monotonic() - begin:.0f} s", flush=True)
    shutil.rmtree(place)
    print(f"{total} kills; every trial, verdict and film as in the run left alone")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--trap"]:
        trap(sys.argv[2], int(sys.argv[3]))
        from mjmr.cli import main as mjmr

        sys.exit(mjmr(sys.argv[4:]))
    main()
