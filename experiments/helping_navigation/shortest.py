"""Shortest paths over a visibility graph: what a robot with a map would go."""

from functools import cache
from itertools import combinations, pairwise

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from controllers.helping.visibility import clear

Array = NDArray[np.float64]
_HAIR = 1e-4  # m: corners are moved this far into the free space, so that sight along walls counts


class VisibilityGraph:
    """Corners of a free space that see each other, for shortest ways between points in it."""

    def __init__(self, edges: Array):
        """Args: edges: Of the free space (m, 4) [m], see :meth:`mjmr.office.Office.edges`."""
        self._edges = edges
        self._corners = _corners(edges)
        self._graph = nx.Graph()
        for (i, p), (j, q) in combinations(enumerate(self._corners), 2):
            self._join(i, p, j, q)

    def _join(self, i: object, p: Array, j: object, q: Array) -> None:
        if clear(p[0], p[1], q[0], q[1], self._edges):
            self._graph.add_edge(i, j, weight=float(np.hypot(*(p - q))))

    def length(self, start: Array, end: Array) -> float:
        """Length [m] of the shortest way between two points (2,) [m]."""
        ends = {"start": np.asarray(start), "end": np.asarray(end)}
        for name, point in ends.items():
            for i, corner in enumerate(self._corners):
                self._join(name, point, i, corner)
        self._join("start", ends["start"], "end", ends["end"])
        found = nx.shortest_path_length(self._graph, "start", "end", weight="weight")
        self._graph.remove_nodes_from(ends)
        return float(found)

    def tour(self, points: Array) -> Array:
        """Lengths (k - 1,) [m] of the shortest ways along points (k, 2) [m]."""
        return np.array([self.length(a, b) for a, b in pairwise(points)])


def _corners(edges: Array) -> Array:
    """Corners (k, 2) [m] that stick out into the free space, a hair off."""
    found = []
    starts = {tuple(edge[:2]): edge for edge in edges}
    for edge in edges:
        after = starts[tuple(edge[2:])]
        a, b = edge[2:] - edge[:2], after[2:] - after[:2]
        if a[0] * b[1] - a[1] * b[0] < 0.0:  # turns away from the free space on the left
            out = a / np.hypot(*a) - b / np.hypot(*b)
            found.append(edge[2:] + _HAIR * out)
    return np.array(found).reshape(-1, 2)


@cache
def office_graph(name: str, clearance: float) -> VisibilityGraph:
    """Graph of one of the study's offices."""
    from experiments.helping_navigation.point import office

    return VisibilityGraph(office(name).edges(clearance)[0])
