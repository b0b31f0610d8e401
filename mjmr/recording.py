"""Recording: states of a run over time, with what the controller wants to show beside them."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError, UnknownNameError

if TYPE_CHECKING:
    from mjmr.loop import TickedSimulation

Array = NDArray[np.float64]
NOTES = ("goals", "waypoints", "stops")


class Recording:
    """Poses of every robot and free prop after each control period, for films and traces.

    Attributes:
        world: What was simulated.
        team: Whose rows the arrays have.
        period: Between two records [s].
    """

    def __init__(self, simulation: "TickedSimulation", caption: Callable[[], str] | None = None):
        """Start recording.

        Args:
            simulation: What to record, from its present state on.
            caption: Called at every record for a line of text under the picture; it may read
                truth.
        """
        self.world, self.team = simulation.world, simulation.team
        self.period = simulation.control_period
        self._simulation = simulation
        self._times: list[float] = []
        self._poses: list[Array] = []
        self._movers: list[Array] = []
        self._notes: list[dict[str, Array]] = []
        self._captions: list[str] = []
        self._note: dict[str, Array] = {}
        self._caption = caption or (lambda: "")
        simulation.observe(self._capture)

    def note(self, **arrays: ArrayLike) -> None:
        """Say what to draw from now on; may be called by a controller's loop.

        Args:
            arrays: ``goals`` (rings), ``waypoints`` (the path to the goal leads through them) and
                ``stops`` (where the planned command followed by braking ends), each of shape
                (n, 2) over the team [m], world frame; NaN rows are not drawn.

        Raises:
            UnknownNameError: Another name.
            InvalidInputError: Another shape.
        """
        fresh = dict(self._note)
        for key, value in arrays.items():
            if key not in NOTES:
                raise UnknownNameError("note", key, NOTES)
            array = np.array(value, dtype=np.float64)
            if array.shape != (self.team.n, 2):
                raise InvalidInputError(
                    f"{key} must have shape ({self.team.n}, 2); got {array.shape}"
                )
            fresh[key] = array
        self._note = fresh

    def _capture(self) -> None:
        simulation = self._simulation
        truth = simulation.truth
        self._times.append(simulation.time)
        self._poses.append(self.team.stack([truth.poses(g) for g in self.team.groups]))
        self._movers.append(truth.movers())
        self._notes.append(self._note)
        self._captions.append(self._caption())

    def __len__(self) -> int:
        return len(self._times)

    @property
    def times(self) -> Array:
        """Instants [s], shape (k,)."""
        return np.array(self._times)

    @property
    def poses(self) -> Array:
        """Robots' poses, shape (k, n, 3)."""
        return np.stack(self._poses)

    @property
    def movers(self) -> Array:
        """Free props' poses, shape (k, m, 7)."""
        return np.stack(self._movers)

    def notes(self, index: int) -> dict[str, Array]:
        """What was noted for record ``index``."""
        return self._notes[index]

    def caption(self, index: int) -> str:
        """Line of text of record ``index``."""
        return self._captions[index]
