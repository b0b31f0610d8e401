"""The paper's local planners A, one class each, for callers in Python.

Each has

    begin()                              another goal
    pause(position)                      a step in which something else steered
    step(position, target, ranges) -> (2,)  where to go, a vector of length at most 1 step

with positions (2,) and target (2,) [m] in the explorer's frame and ``ranges`` (32,) [m], the free
way of its centre along ``RAYS``, up to 3 m. Compiled loops call the same functions directly.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.helping import potential_field, visbug
from controllers.helping.explorer import Settings
from controllers.helping.visibility import RAYS, Walls
from controllers.schemas import visits
from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]


class PotentialField:
    """See :mod:`controllers.helping.potential_field`."""

    def __init__(self, settings: Settings, walls: Walls | None = None, size: Any = None):
        """Args: settings: Reach and gain. walls, size: Not used."""
        self._settings = settings

    def begin(self) -> None:
        """Nothing is remembered."""

    def pause(self, position: Array) -> None:
        """Nothing is remembered."""

    def step(self, position: Array, target: Array, ranges: Array) -> Array:
        """See the module."""
        x, y = np.asarray(target) - position
        s = self._settings
        return np.array(potential_field.direction(x, y, RAYS, ranges, s.reach, s.gain))


class AvoidPast:
    """See :mod:`controllers.schemas.visits`."""

    def __init__(self, settings: Settings, walls: Walls | None = None, size: Any = (30.0, 30.0)):
        """Args: settings: Cell and bias. size: Of the world (2,) [m]. walls: Not used."""
        self._settings = settings
        self._past = visits.past(np.zeros(2), np.asarray(size, dtype=float), settings.cell)

    def begin(self) -> None:
        """Half of where it has been is forgotten."""
        visits.fade(self._past)

    def pause(self, position: Array) -> None:
        """Count the cell all the same; choose afresh afterwards."""
        visits.visit(self._past, position[0], position[1], self._settings.cell)
        self._past.place[:] = np.inf

    def step(self, position: Array, target: Array, ranges: Array) -> Array:
        """See the module."""
        size, bias = self._settings.cell, self._settings.bias
        x, y = position
        visits.visit(self._past, x, y, size)
        ahead = ranges[:: len(RAYS) // visits.HEADINGS]
        # on a robot with a body the way may close while it holds a heading
        if visits.due(self._past, x, y, size) or ahead[self._past.heading[0]] < 1e-3:
            visits.heading(
                self._past, x, y, target[0] - x, target[1] - y, visits.ANGLES,
                np.ascontiguousarray(ahead), size, bias,
            )  # fmt: skip
        angle = visits.ANGLES[self._past.heading[0]]
        return np.array([np.cos(angle), np.sin(angle)])


class VisBug:
    """See :mod:`controllers.helping.visbug`; it is given the walls, and uses what is in sight."""

    def __init__(self, settings: Settings, walls: Walls | None = None, size: Any = None):
        """Args: settings: Step and vision. walls: What hides and stops. size: Not used.

        Raises:
            InvalidInputError: No walls.
        """
        if walls is None:
            raise InvalidInputError("VisBug needs walls, a controllers.helping.Walls")
        self._settings, self._walls = settings, walls
        self._bug = visbug.bug()

    def begin(self) -> None:
        """The M-line starts anew."""
        visbug.forget_path(self._bug)

    def pause(self, position: Array) -> None:
        """The M-line starts anew."""
        visbug.forget_path(self._bug)

    def step(self, position: Array, target: Array, ranges: Array) -> Array:
        """See the module."""
        x, y = position
        walls = self._walls
        if not visbug.has_path(self._bug):
            visbug.plan(
                self._bug, x, y, target[0], target[1], walls.path, walls.after, walls.before,
                self._settings.left,
            )  # fmt: skip
        point = visbug.target(self._bug, x, y, self._settings.vision, walls.sight)
        way = np.array(point) - position
        return way / max(np.hypot(*way), self._settings.step)


class Published:
    """Stands for whichever of the paper's planners a condition names; loops have it compiled."""
