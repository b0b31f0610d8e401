"""What goes wrong in a trial, or who comes and goes: by the hands of an operator."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from controllers.perimeter import TRACKING
from experiments.perimeter.sensing import INSIDE
from experiments.perimeter.worlds import HALF, PARKED, Scene

LATER = 60.0  # s, when a robot is removed or added
AFTER = 10.0  # s, that robot 0 tracks before its camera is unplugged
OUTAGE = 20.0  # s, until it is plugged in again
LIE_AT = 5.0  # s, when somebody is told a false location


class Failure:
    """Acts on buses, radios and robots as the condition says.

    Attributes:
        on: Who is switched on (n,).
        speaks: Whose radio works (n,).
        at: When it happened [s]; NaN: not yet.
        robot: To whom; -1: nobody yet.
        lie: A place where there is no spill (2,) [m].
    """

    def __init__(
        self, condition: Mapping[str, Any], scene: Scene, simulation: Any, senses: Any, team: Any
    ):
        """Set up what there is from the start."""
        n = scene.trucks.n
        self.kind = condition["failure"]
        self.on, self.speaks = np.ones(n, dtype=bool), np.ones(n, dtype=bool)
        self.at, self.robot = float("nan"), -1
        self._scene, self._simulation = scene, simulation
        self._senses, self._team = senses, team
        self._since = np.full(n, np.inf)
        self._removed = False
        corners = np.array([[x, y] for x in (-1, 1) for y in (-1, 1)]) * (HALF - 10.0)
        self.lie = corners[np.argmax(-scene.depth(corners, 0.0))]
        if self.kind == "radio":
            self.speaks[:] = False
            self.at, self.robot = 0.0, 0
        if self.kind == "added":
            self.on[-1] = self.speaks[-1] = False
            self.robot = n - 1
        if self.kind == "removed":
            simulation.observe(self._lift)

    def act(self, now: float) -> None:
        """Do what is due at ``now`` [s]."""
        kind = self.kind
        if kind == "camera":
            self._camera(now)
        elif kind == "lie" and np.isnan(self.at) and now >= LIE_AT:
            self.at, self.robot = now, 0
            who = np.zeros(len(self.on), dtype=bool)
            who[0] = True
            self._team.tell(who, self.lie, now)
        elif kind == "added" and np.isnan(self.at) and now >= LATER:
            self.at = now
            self.on[-1] = self.speaks[-1] = True
        elif kind == "removed" and np.isnan(self.at) and now >= LATER:
            self.at, self.robot = now, 0
            self.on[0] = self.speaks[0] = False

    def _camera(self, now: float) -> None:
        bus = self._senses.bus
        if self.robot < 0:
            tracks = self._team.state == TRACKING
            self._since = np.where(tracks, np.minimum(self._since, now), np.inf)
            long = np.flatnonzero(now - self._since >= AFTER)
            if len(long):
                self.at, self.robot = now, int(long[0])
                bus.unplug(INSIDE, [self.robot])
        elif now >= self.at + OUTAGE and not self._removed:
            self._removed = True
            bus.plug(INSIDE, [self.robot])

    def _lift(self) -> None:
        if not np.isnan(self.at) and not self._removed:
            self._removed = True
            spot = [[*PARKED, 0.0]]
            self._simulation.lift(self._scene.trucks, [self.robot], spot)
