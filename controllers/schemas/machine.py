"""State machines over schemas: states are weighted sums, transitions are perceptual cues."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from controllers.schemas.base import Blend, Memories, Schema, View, all_schemas
from controllers.schemas.cues import Cue
from controllers.schemas.percepts import Array, Percepts
from mjmr.errors import InvalidInputError, UnknownNameError

_NOT = "not "


@dataclass(frozen=True)
class Transition:
    """One arrow.

    Attributes:
        source: State it leaves.
        cue: Name of the cue that must hold.
        negated: Whether the cue must not hold instead.
        target: State it enters.
    """

    source: str
    cue: str
    negated: bool
    target: str

    @property
    def when(self) -> str:
        """The cue as it was written."""
        return f"{_NOT}{self.cue}" if self.negated else self.cue


class StateMachine:
    """A behaviour, declared: it can be drawn, and started for a team.

    Example::

        machine = StateMachine(
            states={"search": 0.6 * noise + avoid, "approach": MoveTo("light") + avoid},
            cues={"sees light": Sees("light")},
            transitions=[
                ("search", "sees light", "approach"),
                ("approach", "not sees light", "search"),
            ],
        )

    A robot takes at most one transition a step, the first declared whose cue holds. The first state
    is where all robots begin.

    Attributes:
        states: Weighted sums by name.
        cues: By name.
        transitions: In order.
    """

    def __init__(
        self,
        *,
        states: Mapping[str, Blend | Schema],
        cues: Mapping[str, Cue] | None = None,
        transitions: Sequence[tuple[str, str, str]] = (),
    ):
        """Check and keep the declaration.

        Args:
            states: By name, the first one being the initial one.
            cues: By name; names do not begin with ``not``.
            transitions: (state, cue or ``not cue``, next state).

        Raises:
            UnknownNameError: A transition names a state or a cue there is not.
            InvalidInputError: No state, a state that no transition leads to, one declared twice, or
                a cue called ``not ...``.
        """
        if not states:
            raise InvalidInputError("a state machine needs a state")
        self.states = {k: Blend([(1.0, s)]) if isinstance(s, Schema) else s
                       for k, s in states.items()}  # fmt: skip
        self.cues = dict(cues or {})
        for name in self.cues:
            if name.startswith(_NOT):
                raise InvalidInputError(f"a cue's name does not begin with 'not'; got {name!r}")
        self.transitions = tuple(self._transition(*row) for row in transitions)
        self._check_reachable()

    def _transition(self, source: str, when: str, target: str) -> Transition:
        for name in (source, target):
            if name not in self.states:
                raise UnknownNameError("state", name, self.states)
        negated = when.startswith(_NOT)
        cue = when.removeprefix(_NOT)
        if cue not in self.cues:
            raise UnknownNameError("cue", cue, self.cues)
        return Transition(source, cue, negated, target)

    def _check_reachable(self) -> None:
        pairs = [(t.source, t.when) for t in self.transitions]
        for source, when in pairs:
            if pairs.count((source, when)) > 1:
                raise InvalidInputError(f"{source!r} has two transitions for {when!r}")
        import networkx as nx  # a tenth of a second, for whoever declares a machine

        graph = nx.DiGraph([(t.source, t.target) for t in self.transitions])
        graph.add_nodes_from(self.states)
        reached = nx.descendants(graph, self.initial) | {self.initial}
        lost = [name for name in self.states if name not in reached]
        if lost:
            raise InvalidInputError(
                f"no transition leads from {self.initial!r} to {', '.join(map(repr, lost))}"
            )

    @property
    def initial(self) -> str:
        """The state all robots begin in."""
        return next(iter(self.states))

    @property
    def percepts(self) -> tuple[str, ...]:
        """Names of what its schemas perceive, in order of appearance; cues may ask for more."""
        schemas = all_schemas(list(self.states.values()))
        return tuple(dict.fromkeys(name for s in schemas for name in s.percepts))

    def start(self, n: int, rng: np.random.Generator) -> "Behaviour":
        """Start it for n robots.

        Args:
            n: 1 or more.
            rng: For the schemas' randomness.
        """
        if n < 1:
            raise InvalidInputError(f"a behaviour is of 1 robot or more; got {n}")
        return Behaviour(self, n, rng)

    def mermaid(self) -> str:
        """The diagram as Mermaid text."""
        from controllers.schemas.diagram import mermaid

        return mermaid(self)

    def dot(self) -> str:
        """The diagram as Graphviz text."""
        from controllers.schemas.diagram import dot

        return dot(self)


class Behaviour:
    """A state machine at work in n robots.

    Attributes:
        machine: The declaration.
        state: Of each robot (n,), index into ``names``.
        names: Of the states.
        cues: Which cues held in the last step, by name, (n,).
        transitions: How often each transition was taken so far, in the machine's order.
    """

    def __init__(self, machine: StateMachine, n: int, rng: np.random.Generator):
        """Use :meth:`StateMachine.start`."""
        self.machine, self.names = machine, tuple(machine.states)
        self._blends = list(machine.states.values())
        self._memories = Memories(self._blends, n, rng)
        index = {name: k for k, name in enumerate(self.names)}
        self._arrows = [
            (index[t.source], t.cue, t.negated, index[t.target]) for t in machine.transitions
        ]
        self.state: NDArray[np.int64] = np.zeros(n, dtype=np.int64)
        self.cues = {name: np.zeros(n, dtype=bool) for name in machine.cues}
        self.transitions = np.zeros(len(self._arrows), dtype=np.int64)
        self._entered = np.full(n, np.nan)

    def step(self, percepts: Percepts, time: float) -> Array:
        """Look, switch states, and sum the schemas.

        Args:
            percepts: Of all robots; see :mod:`controllers.schemas.percepts`.
            time: Of this step [s]; not less than in the last one.

        Returns:
            Vectors (n, 2) in the percepts' axes, to be followed at a speed in proportion to their
            lengths; see :func:`controllers.schemas.steering.steer`.

        Raises:
            UnknownNameError: A percept is missing (lists those given).
            InvalidInputError: A percept or cue is not of n robots.
        """
        n = len(self.state)
        self._entered = np.where(np.isnan(self._entered), time, self._entered)
        view = View(percepts, time, self._memories, time - self._entered)
        for name, cue in self.machine.cues.items():
            flags = cue.holds(view, self.cues[name])
            if flags.shape != (n,):
                raise InvalidInputError(
                    f"cue {name!r} must give {n} flags; got shape {flags.shape}"
                )
            self.cues[name] = flags
        self._switch(time)
        present = np.bincount(self.state, minlength=len(self._blends))
        total = np.zeros((n, 2))
        for k, blend in enumerate(self._blends):
            if present[k] == n:
                return blend.field(view)
            if present[k]:
                total = np.where((self.state == k)[:, None], blend.field(view), total)
        return total

    def _switch(self, time: float) -> None:
        before = self.state.copy()
        moved = np.zeros(len(before), dtype=bool)
        for row, (source, cue, negated, target) in enumerate(self._arrows):
            flags = self.cues[cue] != negated
            takes = (before == source) & flags & ~moved
            count = np.count_nonzero(takes)
            if count:
                self.transitions[row] += count
                self.state[takes] = target
                moved |= takes
        self._entered = np.where(moved, time, self._entered)

    @property
    def state_names(self) -> list[str]:
        """Names of the robots' states."""
        return [self.names[k] for k in self.state]
