"""Team: an ordered set of agents across groups."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError
from mjmr.group import Group
from mjmr.robots.markings import TEAM_COLOURS


class Team:
    """Agents across groups, in the groups' order; what meters, graphs and films work on.

    Attributes:
        n: Number of agents.
        names: Of the agents.
        radii: Of their bodies, shape (n,) [m].
        colours: RGB, shape (n, 3), 0 to 1.
    """

    def __init__(self, groups: Sequence[Group]):
        """Args: groups: At least one group, each once."""
        if not groups or len(set(map(id, groups))) != len(groups):
            raise InvalidInputError("a team needs at least one group, and each only once")
        self.groups = tuple(groups)
        self.n = sum(g.n for g in groups)
        self.names = tuple(name for g in groups for name in g.names)
        self.radii: NDArray[np.float64] = np.repeat(
            [g.platform.radius for g in groups], [g.n for g in groups]
        )
        self.colours: NDArray[np.float64] = np.repeat(
            [TEAM_COLOURS[g.team][:3] for g in groups], [g.n for g in groups], axis=0
        )

    def rows(self, group: Group) -> slice:
        """Where a group's agents are in arrays over the team."""
        first = 0
        for g in self.groups:
            if g is group:
                return slice(first, first + g.n)
            first += g.n
        raise InvalidInputError(f"group {group.name!r} is not in this team")

    def stack(self, arrays: Sequence[NDArray[np.float64]]) -> NDArray[np.float64]:
        """Join one array a group, each with leading axis n, into one over the team."""
        return arrays[0] if len(arrays) == 1 else np.concatenate(list(arrays))
