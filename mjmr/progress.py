"""Progress of a run: a live bar on a terminal, a plain line now and then elsewhere."""

import contextlib
import os
import time
from collections import deque
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

_WINDOW = 60.0  # [s] of wall time the rate is measured over
_LINE_EVERY = 5.0  # [s] of wall time between plain lines


class Progress:
    """Counts trials and says how many, how fast and how long still; a context manager."""

    def __init__(self, console: "Console", done: int, total: int):
        """Begin with ``done`` trials kept from before, of ``total``."""
        self._console, self._done, self._total, self._failed = console, done, total, 0
        self._begin = time.monotonic()
        self._ends: deque[float] = deque()
        self._last_line = self._begin
        self._bar: Any = None

    def __enter__(self) -> "Progress":
        if self._console.is_terminal:
            from rich import progress

            self._bar = progress.Progress(
                progress.TextColumn("trials"),
                progress.BarColumn(),
                progress.TextColumn("{task.fields[told]}"),
                progress.TimeElapsedColumn(),
                console=self._console,
            )
            self._task = self._bar.add_task(
                "", total=self._total, completed=self._done, told=self.told()
            )
            self._bar.start()
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.stop()
        else:
            self._line()

    def advance(self, ok: bool) -> None:
        """One more trial has ended."""
        now = time.monotonic()
        self._done += 1
        self._failed += not ok
        self._ends.append(now)
        while self._ends[0] < now - _WINDOW:
            self._ends.popleft()
        if self._bar is not None:
            self._bar.update(self._task, completed=self._done, told=self.told())
        elif now - self._last_line >= _LINE_EVERY:
            self._line()

    def told(self) -> str:
        """Done, failed, rate and time left, in words."""
        parts = [f"{self._done}/{self._total}"]
        if self._failed:
            parts.append(f"{self._failed} failed")
        if self._ends:
            span = max(min(time.monotonic() - self._begin, _WINDOW), 1e-3)
            rate = len(self._ends) / span
            parts.append(f"{rate:.3g}/s" if rate >= 1.0 else f"{1.0 / rate:.3g} s each")
            if self._done < self._total:
                parts.append(f"{duration((self._total - self._done) / rate)} left")
        return ", ".join(parts)

    def _line(self) -> None:
        self._last_line = time.monotonic()
        say(self._console, f"trials {self.told()}")


@contextlib.contextmanager
def doing(console: "Console", text: str) -> Iterator[None]:
    """Say what is being done for as long as it takes."""
    if console.is_terminal:
        with console.status(text):
            yield
    else:
        say(console, text)
        yield


def say(console: "Console", text: str) -> None:
    """Print a line as it is: no markup, no wrapping."""
    console.print(text, markup=False, highlight=False, soft_wrap=True)


def standard_output(width: int = 120) -> "Console":
    """Console for results: as wide as the terminal or ``COLUMNS``, else of ``width`` columns."""
    from rich.console import Console

    class Output(Console):
        def on_broken_pipe(self) -> None:
            # rich would exit with 1 here; whoever called decides what an absent reader means.
            raise BrokenPipeError

    console = Output()
    if not console.is_terminal and "COLUMNS" not in os.environ:
        console = Output(width=width)
    return console


def duration(seconds: float) -> str:
    """A length of wall time as one says it."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    if seconds < 5400.0:
        return f"{seconds / 60.0:.0f} min"
    return f"{seconds / 3600.0:.1f} h"
