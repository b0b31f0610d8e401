"""The structure condition: does a sequence of graphs let every system agree?

Source: Qu, Wang and Hull, section 4, Assumption 4.2 and Theorem 4.1. A graph that is not strongly
connected falls into strongly connected groups; put in an order in which everybody hears only its
own group and earlier ones, its matrix is block lower-triangular. The condition asks, again and
again for one and the same order, that (i) within each group every link carries a gain and (ii) each
group but the first gives weight to an earlier one. The gains meant must stay above some epsilon;
the paper asks only that they are nonzero, which is not enough for gains that decay.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.consensus.gains import as_array, check_gains, graph
from mjmr.errors import InvalidInputError


@dataclass(frozen=True)
class Condensation:
    """A graph's strongly connected groups, earlier ones first.

    Attributes:
        groups: Systems of each group, ascending.
    """

    groups: tuple[tuple[int, ...], ...]

    @property
    def order(self) -> NDArray[np.int64]:
        """Permutation (q,): systems so that the graph's matrix is block lower-triangular."""
        return np.array([i for group in self.groups for i in group], dtype=np.int64)


def condense(heard: ArrayLike) -> Condensation:
    """Strongly connected groups of a graph in an order in which each hears only earlier ones.

    Ties are broken by the lowest member, so that equal graphs give equal orders.

    Args:
        heard: Flags (q, q): row hears column.
    """
    flags = graph(heard)
    # an arrow from the one who speaks to the one who hears: speakers come first
    import networkx as nx  # a quarter of a second, which most callers of this package need not wait

    arrows = nx.from_numpy_array(flags.T & ~np.eye(len(flags), dtype=bool),
                                 create_using=nx.DiGraph)  # fmt: skip
    condensed = nx.condensation(arrows)
    members = {k: tuple(sorted(int(i) for i in data["members"]))
               for k, data in condensed.nodes(data=True)}  # fmt: skip
    sequence = nx.lexicographical_topological_sort(condensed, key=lambda k: members[k])
    return Condensation(tuple(members[k] for k in sequence))


def reducible(heard: ArrayLike) -> bool:
    """Whether a graph falls into more than one strongly connected group."""
    return len(condense(heard).groups) > 1


def rooted(heard: ArrayLike) -> bool:
    """Whether somebody is heard by all, directly or through others."""
    flags = graph(heard)
    import networkx as nx

    arrows = nx.from_numpy_array(flags.T, create_using=nx.DiGraph)
    groups = condense(flags).groups
    return len(nx.descendants(arrows, groups[0][0]) | {groups[0][0]}) == len(flags)


@dataclass(frozen=True)
class StructureReport:
    """Whether a sequence of graphs and gains meets the condition, and why not.

    Attributes:
        holds: Whether it does.
        why: What is missing, in one sentence; empty if nothing is.
        instants: Indices of the instants that meet it with the order that does so most often.
        order: That order of the systems; empty if no instant meets it.
        longest_gap: Instants between two that meet it, at most, the sequence taken as one period
            that repeats; 0 if none does.
    """

    holds: bool
    why: str
    instants: tuple[int, ...]
    order: tuple[int, ...]
    longest_gap: int


def check_structure(
    graphs: Sequence[ArrayLike], gains: Sequence[ArrayLike], *, epsilon: float = 1e-3
) -> StructureReport:
    """Whether a sequence meets Assumption 4.2, taken as one period that repeats for ever.

    Sufficient, not necessary: robots that are connected only over several instants may agree too.

    Args:
        graphs: Who hears whom at each instant, flags (q, q).
        gains: Weights at each, (q, q) or by channel (m, q, q).
        epsilon: What gains must not fall below to count.

    Raises:
        InvalidInputError: Sequences of different lengths, graphs of different sizes, an epsilon
            that is not positive, or gains that cannot be.
    """
    if len(graphs) != len(gains) or not len(graphs):
        raise InvalidInputError(
            f"graphs and gains are as many, 1 or more; got {len(graphs)} and {len(gains)}"
        )
    if not epsilon > 0:
        raise InvalidInputError(f"epsilon must be positive; got {epsilon}")
    sizes = {len(graph(heard)) for heard in graphs}
    if len(sizes) > 1:
        told = " and ".join(map(str, sorted(sizes)))
        raise InvalidInputError(f"all graphs are of the same systems; got graphs of {told}")
    by_order: dict[tuple[int, ...], list[int]] = {}
    first_reason = ""
    for k, (heard, weights) in enumerate(zip(graphs, gains, strict=True)):
        condensation = condense(heard)
        reason = _missing(graph(heard), _least(weights, heard), condensation, epsilon)
        if reason:
            first_reason = first_reason or f"instant {k}: {reason}"
        else:
            by_order.setdefault(tuple(int(i) for i in condensation.order), []).append(k)
    if not by_order:
        return StructureReport(False, f"no instant meets it; {first_reason}", (), (), 0)
    order, instants = max(by_order.items(), key=lambda item: (len(item[1]), -item[1][0]))
    around = [*instants, instants[0] + len(graphs)]
    gap = max(b - a for a, b in zip(around[:-1], around[1:], strict=True))
    return StructureReport(True, "", tuple(instants), order, gap)


def _least(weights: ArrayLike, heard: ArrayLike) -> NDArray[np.float64]:
    """The least gain over the channels (q, q), each channel checked."""
    given = as_array(weights, np.float64, "gains")
    channels = given[None] if given.ndim == 2 else given
    return np.min([check_gains(g, heard=heard) for g in channels], axis=0)


def _missing(heard: NDArray, least: NDArray, condensation: Condensation, epsilon: float) -> str:
    for group in condensation.groups:
        block = np.ix_(group, group)
        weak = heard[block] & (least[block] < epsilon)
        if weak.any():
            i, j = np.argwhere(weak)[0]
            return (
                f"system {group[i]} hears {group[j]} of its own group but weights it "
                f"{least[group[i], group[j]]:.3g} (condition i)"
            )
    earlier: list[int] = list(condensation.groups[0])
    for group in condensation.groups[1:]:
        if not (least[np.ix_(group, earlier)] >= epsilon).any():
            names = ", ".join(map(str, group))
            return f"the group of {names} weights nobody of an earlier group (condition ii)"
        earlier += group
    return ""
