"""The scout's and the worker's tables as state machines of the schema library."""

import numpy as np
from numpy.typing import ArrayLike

from controllers.schemas import After, Blend, Schema, Sees, StateMachine, View
from controllers.schemas.percepts import Array, Percepts
from controllers.scouting.machine import ACTIONS, CUES, Machine

_STEPS = {"seek": 1.0, "back": -1.0}


class Act(Schema):
    """What a state does in one program loop: a unit along the heading, or nothing but turning."""

    def __init__(self, state: str):
        """Take the action of a state."""
        self._label, self._step = ACTIONS[state], _STEPS.get(state, 0.0)

    @property
    def label(self) -> str:
        """In words."""
        return self._label

    @property
    def percepts(self) -> tuple[str, ...]:
        """The compass, where the state always drives."""
        return ("heading",) if self._step else ()

    def field(self, view: View) -> Array:
        """Steps (n, 2) [units]; zero where the state turns, or does one or the other."""
        if not self._step:
            return np.zeros((view.n, 2))
        return self._step * view.direction("heading")


def state_machine(machine: Machine) -> StateMachine:
    """The machine, declared for a team; cues are percepts of the same names, from :func:`cues`."""
    names = (machine.initial, *(s for s in machine.states if s != machine.initial))
    used = dict.fromkeys(t.cue for t in machine.transitions)
    return StateMachine(
        states={name: Blend([(1.0, Act(name))]) for name in names},
        cues={name: After(0.0) if name == "always" else Sees(name) for name in used},
        transitions=list(machine.transitions),
    )


def cues(flags: ArrayLike, heading: ArrayLike) -> Percepts:
    """Percepts of a loop: which cues each robot went by (n, cues), and its compass (n,) [rad]."""
    held, ahead = np.asarray(flags, dtype=bool), np.asarray(heading, dtype=np.float64)
    found = {name: np.where(held[:, [k]], [0.0, 0.0], np.nan) for k, name in enumerate(CUES)}
    return {**found, "heading": np.column_stack([np.cos(ahead), np.sin(ahead)])}
