"""Footage: what a film shows, whether it was recorded just now or read from a file."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Footage:
    """States of a model over time, with what is drawn over them.

    Attributes:
        model: The compiled ``mujoco.MjModel``.
        bounds: Of the world (4,) [m].
        radii: Of the robots, shape (n,) [m].
        period: Between two instants [s].
        times: Instants, shape (k,) [s].
        positions: ``qpos`` at each, shape (k, nq).
        poses: Of the robots at each, shape (k, n, 3) [m, m, rad], world frame.
        notes: What the controller wanted shown at each; see
            :meth:`mjmr.loop.TickedSimulation.note`. Empty: nothing.
        captions: A line of text for each; empty: none.
        lifts: How often each robot had been lifted by each instant (k, n); None: never. A trail
            ends where a robot was picked up.
    """

    model: Any
    bounds: Array
    radii: Array
    period: float
    times: Array
    positions: Array
    poses: Array
    notes: Sequence[dict[str, Array]] = field(default_factory=tuple)
    captions: Sequence[str] = field(default_factory=tuple)
    lifts: NDArray[np.int64] | None = None

    def __post_init__(self):
        k, n = len(self.times), len(self.radii)
        if not k:
            raise InvalidInputError("this recording is empty; tick its simulation first")
        if self.positions.shape != (k, self.model.nq) or self.poses.shape != (k, n, 3):
            raise InvalidInputError(
                f"positions and poses of {k} instants must have shapes ({k}, {self.model.nq}) and "
                f"({k}, {n}, 3); got {self.positions.shape} and {self.poses.shape}"
            )

        for name, told in (("notes", self.notes), ("captions", self.captions)):
            if len(told) not in (0, k):
                raise InvalidInputError(f"{name} of {k} instants must be as many; got {len(told)}")

    def note(self, index: int) -> dict[str, Array]:
        """What is drawn at instant ``index``."""
        return self.notes[index] if self.notes else {}

    def caption(self, index: int) -> str:
        """Line of text of instant ``index``."""
        return self.captions[index] if self.captions else ""


def lift_counts(
    times: Array, poses: Array, lifts: Iterable[tuple[float, int, Array]]
) -> NDArray[np.int64]:
    """How often each robot had been lifted by each instant (k, n).

    Args:
        times: Instants (k,) [s].
        poses: Of the robots at each (k, n, 3).
        lifts: When [s], which robot of the team, and where to (3,). One at an instant itself counts
            from there or from the next one on, as the poses show.
    """
    counts = np.zeros(poses.shape[:2], dtype=np.int64)
    for time, robot, pose in lifts:
        first = int(np.searchsorted(times, time - 1e-9))
        if first < len(times) and np.abs(poses[first, robot, :2] - pose[:2]).max() > 1e-6:
            first += 1
        counts[first:, robot] += 1
    return counts
