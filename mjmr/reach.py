"""Who can hear whom: range, line of sight and faults, the rules every radio of a simulation shares.

It works on true positions at the instant it is asked, as waves do, and hands them to nobody.
"""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError

if TYPE_CHECKING:
    from mjmr.loop import TickedSimulation

Flags = NDArray[np.bool_]


class Reach:
    """Reach within a simulation's team, computed once a physics step and again after a lift."""

    def __init__(
        self,
        simulation: "TickedSimulation",
        range: float = math.inf,
        visible: Callable[[], Flags] | None = None,
    ):
        """Set the rules.

        Args:
            simulation: Physical or kinematic.
            range: Between the origins of two robots' bases, inclusive [m].
            visible: For (n, n) flags over the team, sender first: whether a line of sight between
                two robots is free, to be read from the simulation, not from its guarded truth;
                None: waves go through everything.

        Raises:
            InvalidInputError: A negative range.
        """
        if not range >= 0:
            raise InvalidInputError(f"a radio's range is 0 or more; got {range} m")
        self.range = float(range)
        self._simulation, self._team, self._visible = simulation, simulation.team, visible
        n = self._team.n
        self._step, self._flags = -1, np.zeros((n, n), dtype=bool)
        simulation.lift_followers.append(lambda rows, poses: self.forget())

    def now(self) -> Flags:
        """Who can hear whom now (n, n), sender first; not to be written to."""
        simulation, team = self._simulation, self._team
        if self._step != simulation.step:
            reach = np.ones((team.n, team.n), dtype=bool)
            if self.range < math.inf:
                at = team.stack([simulation.base_poses_of(g)[:, :3] for g in team.groups])
                apart = at[:, None] - at[None]
                reach = (apart**2).sum(axis=2) <= self.range**2
            if self._visible is not None:
                free = np.asarray(self._visible())
                if free.shape != reach.shape or free.dtype != bool:
                    raise InvalidInputError(
                        f"visible must return flags of shape {reach.shape}; got {free.dtype} of "
                        f"shape {free.shape}"
                    )
                reach &= free
            self._flags, self._step = reach, simulation.step
        return self._flags

    def forget(self) -> None:
        """Compute it anew when asked next: the simulation was put back, or robots were lifted."""
        self._step = -1

    def faulty(self, kind: str, time: float) -> Flags | None:
        """Robots that are ``"silent"`` or ``"deaf"`` at ``time`` [s] (n,); None if none is."""
        masks = [getattr(g.faults, kind)(time) for g in self._team.groups]
        if all(mask is None for mask in masks):
            return None
        pairs = zip(self._team.groups, masks, strict=True)
        return np.concatenate([np.zeros(g.n, dtype=bool) if m is None else m for g, m in pairs])
