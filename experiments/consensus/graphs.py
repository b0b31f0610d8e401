"""Who hears whom, and how much it weighs: the paper's cases, negatives, and graphs of n robots."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from controllers.consensus import StructureReport, check_structure
from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

CASE_I = np.array([[1, 0, 0], [1, 1, 0], [0, 1, 1]], dtype=bool)
"""Robot 1 leads, 2 follows 1, 3 follows 2."""
CASE_II = np.array([[1, 1, 0], [0, 1, 0], [1, 0, 1]], dtype=bool)
"""Robot 2 leads, 1 follows 2, 3 follows 1."""
CASE_III = np.array([[1, 0, 1], [1, 1, 0], [0, 0, 1]], dtype=bool)
"""Robot 3 leads, 1 follows 3, 2 follows 1: for random leaders alone."""
STAR = np.array([[1, 0, 0], [1, 1, 0], [1, 0, 1]], dtype=bool)
"""Case i as the paper's printed matrix has it: 3 hears the leader."""
ONE_TWO = np.array([[1, 0, 0], [1, 1, 0], [0, 0, 1]], dtype=bool)
TWO_THREE = np.array([[1, 0, 0], [0, 1, 0], [0, 1, 1]], dtype=bool)
TWO_ONE = np.array([[1, 1, 0], [0, 1, 0], [0, 0, 1]], dtype=bool)
EXAMPLE_41 = np.array([[1, 1, 0, 1], [0, 1, 0, 0], [1, 0, 1, 0], [0, 0, 1, 1]], dtype=bool)

_CYCLES: dict[str, tuple[Flags, ...]] = {
    "alternate": (CASE_I, CASE_II),
    "case-i": (CASE_I,),
    "case-ii": (CASE_II,),
    "star": (STAR,),
    "joint": (ONE_TWO, TWO_THREE),
    "isolated": (ONE_TWO, TWO_ONE),
    "decaying": (CASE_I, CASE_II),
    "random-leader": (CASE_I, CASE_II, CASE_III),
}
SCHEDULES = tuple(_CYCLES)
_DECAY = 0.5


@dataclass(frozen=True, eq=False)
class Schedule:
    """What graph holds at each instant of a run, and with which gains.

    Attributes:
        graphs: At each instant, flags (q, q).
        gains: At each (q, q).
        dwell: From one instant to the next [s].
    """

    graphs: list[Flags]
    gains: list[Array]
    dwell: float

    def at(self, time: float) -> int:
        """Number of the instant in force at ``time`` [s]."""
        return min(int(time / self.dwell + 1e-9), len(self.graphs) - 1)

    def pieces(self, begin: float, end: float) -> Iterator[tuple[int, float]]:
        """A span of time [s] cut where the graph changes: (instant in force, duration [s])."""
        while end - begin > 1e-9:
            k = self.at(begin)
            until = end if k + 1 == len(self.graphs) else min(end, (k + 1) * self.dwell)
            yield k, until - begin
            begin = until

    def structure(self) -> StructureReport:
        """Whether what goes on for ever, the last third, meets Assumption 4.2."""
        tail = max(2, len(self.graphs) // 3)
        return check_structure(self.graphs[-tail:], self.gains[-tail:])


def leader_of(name: str) -> int:
    """Who hears nobody in a schedule's first graph."""
    return int(np.flatnonzero(_CYCLES[name][0].sum(axis=1) == 1)[0])


def three(
    name: str, dwell: float, duration: float, weight: float, rng: np.random.Generator, rule: Any
) -> Schedule:
    """Schedule of the paper's three robots.

    Args:
        name: One of ``SCHEDULES``.
        dwell: [s].
        duration: Of the run [s].
        weight: That a follower gives to the one it follows.
        rng: Draws random leaders.
        rule: The part that gives weights; see :mod:`experiments.consensus.roles`.
    """
    cycle = _CYCLES[name]
    count = max(1, int(np.ceil(duration / dwell - 1e-9)))
    if name == "random-leader":
        order = rng.integers(len(cycle), size=count)
    else:
        order = np.arange(count) % len(cycle)
    graphs = [cycle[k] for k in order]
    fade = _DECAY ** np.arange(count) if name == "decaying" else np.ones(count)
    return Schedule(
        graphs, [rule.step(g, float(weight * f)) for g, f in zip(graphs, fade, strict=True)], dwell
    )


def refuse_hopeless(schedule: Schedule, anyway: bool) -> None:
    """Say so before running if these graphs can never meet Assumption 4.2.

    Raises:
        InvalidInputError: They cannot, and nobody asked to run them all the same.
    """
    if anyway:
        return
    report = schedule.structure()
    if not report.holds:
        raise InvalidInputError(
            f"these graphs never meet Assumption 4.2: {report.why}; anyway=true runs them all "
            "the same"
        )


def team_graph(name: str, n: int, rng: np.random.Generator) -> Flags:
    """Who hears whom among n robots (n, n), links both ways.

    Args:
        name: ``ring``, ``path``, ``star``, ``complete`` or ``geometric`` (points in a unit square
            that are nearer than a radius twice as large as would just connect them on average).
        n: 2 or more.
        rng: Places the points.
    """
    if name == "geometric":
        radius = 2.0 * np.sqrt(np.log(n) / (np.pi * n))
        while True:
            points = rng.uniform(size=(n, 2))
            graph = nx.random_geometric_graph(n, radius, pos=dict(enumerate(points)))
            if nx.is_connected(graph):
                break
    else:
        makers = {
            "ring": nx.cycle_graph, "path": nx.path_graph, "complete": nx.complete_graph,
            "star": lambda k: nx.star_graph(k - 1),
        }  # fmt: skip
        graph = makers[name](n)
    return nx.to_numpy_array(graph).astype(bool) | np.eye(n, dtype=bool)


def static(
    name: str, n: int, duration: float, weight: float, rng: np.random.Generator, rule: Any
) -> Schedule:
    """Schedule of one graph for the whole run; arguments as of :func:`three`."""
    graph = team_graph(name, n, rng)
    return Schedule([graph], [rule.step(graph, weight)], duration)


def random_admissible(
    q: int, instants: int, rng: np.random.Generator
) -> tuple[list[Flags], list[Array]]:
    """A sequence that meets Assumption 4.2 at every third instant or more, any graph between.

    Groups and their order are drawn once; instants that meet it have every group strongly connected
    and hearing an earlier one, with other links than the time before. Gains are 0.2 to 1 before
    rows are scaled to one.
    """
    groups = max(2, int(rng.integers(2, min(q, 5) + 1)))
    cuts = np.sort(rng.choice(np.arange(1, q), groups - 1, replace=False))
    group = np.searchsorted(cuts, np.arange(q), side="right")
    shuffle = rng.permutation(q)
    graphs, gains = [], []
    for k in range(instants):
        if k % 3 == 0:
            graph = _admissible(group, rng)
        else:
            graph = rng.uniform(size=(q, q)) < rng.uniform(0.0, 0.5)
            np.fill_diagonal(graph, True)
        graph = graph[np.ix_(shuffle, shuffle)]
        weights = np.where(graph, rng.uniform(0.2, 1.0, size=(q, q)), 0.0)
        graphs.append(graph)
        gains.append(weights / weights.sum(axis=1, keepdims=True))
    return graphs, gains


def _admissible(group: NDArray[np.int64], rng: np.random.Generator) -> Flags:
    q = len(group)
    graph = np.eye(q, dtype=bool)
    for g in range(group.max() + 1):
        own = rng.permutation(np.flatnonzero(group == g))
        graph[own, np.roll(own, 1)] = True
        graph[np.ix_(own, own)] |= rng.uniform(size=(len(own), len(own))) < 0.2
        if g:
            graph[rng.choice(own), rng.choice(np.flatnonzero(group < g))] = True
    extra = (rng.uniform(size=(q, q)) < 0.1) & (group[:, None] > group[None])
    return graph | extra
