"""Looking on: callbacks that see every simulation made while they are in force.

A trial builds its own simulation; films, traces and replays look into it without the trial
knowing of them.
"""

import contextlib
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mjmr.loop import TickedSimulation

Watcher = Callable[["TickedSimulation"], None]
_WATCHERS: ContextVar[tuple[Watcher, ...]] = ContextVar("watchers", default=())


@contextlib.contextmanager
def watching(watcher: Watcher) -> Iterator[None]:
    """Call ``watcher`` with every simulation built inside the block, before its first tick.

    A watcher may register observers; it must leave the simulation as it is, so that a trial looked
    at gives the same bits as one that is not.
    """
    token = _WATCHERS.set((*_WATCHERS.get(), watcher))
    try:
        yield
    finally:
        _WATCHERS.reset(token)


def announce(simulation: "TickedSimulation") -> None:
    """Show a new simulation to every watcher in force; called by simulations."""
    for watcher in _WATCHERS.get():
        watcher(simulation)
