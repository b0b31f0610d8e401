"""The two state machines, as data: what a robot does next, by what it perceives.

A robot is in one state for one program loop. At the start of the next loop the first transition of
its state whose cue is there is taken, else it stays; then the state's action is done. The compiled
team (:mod:`controllers.scouting.team`) runs these very tables; :mod:`controllers.scouting.diagram`
makes state machines of the schema library of them, which are drawn, and tested to switch alike.

Source: MacKunis and Raviv 2003, figures 2.1 and 2.2 and sections 2.2, 3.2 and 3.4.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from controllers.scouting.behaviour import Behaviour

STATES = (
    "wait", "search", "transmit", "align", "seek", "spiral", "avoid", "back", "turn", "report",
    "done",
)  # fmt: skip
WAIT, SEARCH, TRANSMIT, ALIGN, SEEK, SPIRAL, AVOID, BACK, TURN, REPORT, DONE = range(11)

CUES = (
    "always", "bumped", "sees goal", "blocked", "clear", "off course", "aligned", "at vector",
    "at nest", "may leave", "spiral ended", "spiralling",
    "in the way",
)  # fmt: skip
(ALWAYS, BUMPED, SEES_GOAL, BLOCKED, CLEAR, OFF_COURSE, ALIGNED, AT_VECTOR, AT_NEST, MAY_LEAVE,
 SPIRAL_ENDED, SPIRALLING, IN_THE_WAY) = range(13)  # fmt: skip

ACTIONS = {
    "wait": "listen",
    "search": "forward a unit or a random turn",
    "transmit": "begin to send the vector",
    "align": "rotate to the course",
    "seek": "forward a unit",
    "spiral": "forward a unit or round a corner",
    "avoid": "rotate away by a step",
    "back": "back up a unit",
    "turn": "rotate away from the side hit",
    "report": "begin to send what it found",
    "done": "rest",
}
"""What is done in each state for one loop."""


class Transition(NamedTuple):
    """From a state, on a cue, to a state; by name."""

    state: str
    cue: str
    to: str


class Machine(NamedTuple):
    """A state machine: name, initial state, transitions in order of priority in each state."""

    name: str
    initial: str
    transitions: tuple[Transition, ...]

    @property
    def states(self) -> tuple[str, ...]:
        """States that occur, in the order of :data:`STATES`."""
        used = (
            {self.initial} | {t.state for t in self.transitions} | {t.to for t in self.transitions}
        )
        return tuple(s for s in STATES if s in used)


def _machine(name: str, initial: str, *rows: tuple[str, str]) -> Machine:
    """Rows are (state, "cue > state, cue > state, ...")."""
    found = []
    for state, told in rows:
        for step in told.split(", "):
            cue, to = step.split(" > ")
            found.append(Transition(state, cue, to))
    return Machine(name, initial, tuple(found))


def scout(behaviour: Behaviour) -> Machine:
    """The scout's machine. It reports a goal once."""
    after = {"search": "search", "stop": "done"}[behaviour.scout_after]
    return _machine(
        "scout",
        "search",
        ("search", "bumped > back, sees goal > transmit, blocked > avoid"),
        ("avoid", "bumped > back, sees goal > transmit, clear > search"),
        ("back", "always > turn"),
        ("turn", "sees goal > transmit, blocked > avoid, always > search"),
        ("transmit", f"always > {after}"),
    )


def worker(behaviour: Behaviour) -> Machine:
    """The worker's machine. On its way home it no longer looks for the goal."""
    after = {"home": "align", "stop": "done"}[behaviour.after_goal]
    home = ", at nest > done" if behaviour.after_goal == "home" else ""
    return _machine(
        "worker",
        "wait",
        ("wait", "may leave > align"),
        ("align", "sees goal > report, in the way > avoid, aligned > seek"),
        (
            "seek",
            f"bumped > back, sees goal > report{home}, blocked > avoid, at vector > spiral, "
            "off course > align",
        ),
        (
            "avoid",
            "bumped > back, sees goal > report, spiralling > spiral, off course > align, "
            "clear > seek",
        ),
        ("back", "always > turn"),
        ("turn", "sees goal > report, blocked > avoid, spiralling > spiral, always > seek"),
        ("spiral", "bumped > back, sees goal > report, blocked > avoid, spiral ended > align"),
        ("report", f"always > {after}"),
    )


def table(machine: Machine) -> NDArray[np.int64]:
    """Transitions as numbers: shape (states, most transitions of a state, 2): cue, state; or -1."""
    rows: list[list[tuple[int, int]]] = [[] for _ in STATES]
    for t in machine.transitions:
        rows[STATES.index(t.state)].append((CUES.index(t.cue), STATES.index(t.to)))
    found = np.full((len(STATES), 8, 2), -1, dtype=np.int64)
    for state, row in enumerate(rows):
        for k, pair in enumerate(row):
            found[state, k] = pair
    return found
