"""What is measured of a run, from the true ways of the controlled points."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mjmr.loop import TickedSimulation

Array = NDArray[np.float64]
STILL, OVER = 0.02, 1.0  # m, s: who moves less in this time stands
SERIES = 0.5  # s, between entries of a series


class Ways:
    """Positions of the controlled points after every control period.

    Attributes:
        positions: So far, (k, n, 2) [m].
    """

    def __init__(self, simulation: TickedSimulation, robots: Any, length: float):
        """Watch.

        Args:
            simulation: What to watch.
            robots: Its group.
            length: How far ahead of the robot's origin the controlled point is [m].
        """
        self._positions: list[Array] = []
        truth = simulation.truth

        def observe() -> None:
            pose = truth.poses(robots)
            ahead = np.column_stack([np.cos(pose[:, 2]), np.sin(pose[:, 2])])
            self._positions.append(pose[:, :2] + length * ahead)

        simulation.observe(observe)

    @property
    def positions(self) -> Array:
        """See the class."""
        return np.stack(self._positions)


def least_distances(positions: Array) -> Array:
    """Least distance between two points at each instant (k,) [m]."""
    i, j = np.triu_indices(positions.shape[1], 1)
    apart = positions[:, i] - positions[:, j]
    return np.sqrt((apart**2).sum(axis=2)).min(axis=1)


def standing(positions: Array, period: float) -> NDArray[np.bool_]:
    """Who has moved less than 2 cm in the second that ends at each instant (k, n)."""
    back = round(OVER / period)
    still = np.zeros(positions.shape[:2], dtype=bool)
    moved = positions[back:] - positions[:-back]
    still[back:] = (moved**2).sum(axis=2) < STILL**2
    return still


def measure(positions: Array, period: float, distance: float, home: Any) -> dict[str, Any]:
    """Metrics of a run.

    Args:
        positions: True, after each control period, (k, n, 2) [m].
        period: [s].
        distance: Below which two discs overlap [m].
        home: Who is at its goal at each instant (k, n), or None where goals go on and on.

    Returns:
        ``spare_mm``: least distance of two points less ``distance``, which is ``discs_meet_mm``;
        ``deadlock_s``: time in which
        nobody moves and somebody is not home; ``waiting_share``: robots' time spent standing and
        not home; ``home``: robots home at the end; ``all_home_s``: when all were for the first
        time, None if never; ``least_cm``: series, every 0.5 s.
    """
    near = least_distances(positions)
    still = standing(positions, period)
    there = np.zeros(still.shape, dtype=bool) if home is None else home
    everybody = there.all(axis=1)
    first = int(np.argmax(everybody)) if everybody.any() else None
    waiting = still & ~there
    until = len(still) if first is None else first + 1
    step = round(SERIES / period)
    return {
        "discs_meet_mm": 1e3 * distance,
        "spare_mm": float(1e3 * (near.min() - distance)),
        "deadlock_s": float((still.all(axis=1) & ~everybody).sum() * period),
        "waiting_share": float(waiting[:until].mean()),
        "home": int(there[-1].sum()),
        "all_home_s": None if first is None else (first + 1) * period,
        "least_cm": " ".join(f"{100 * d:.1f}" for d in near[step - 1 :: step]),
    }
