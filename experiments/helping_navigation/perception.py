"""Sight of teammates: who is in sight, at what bearing and distance, in the observer's own body."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.helping_navigation.physical_world import MARKER_HEIGHT
from mjmr.errors import InvalidInputError
from mjmr.randomness import SampleNoise
from mjmr.sensors.base import Sensor
from mjmr.sensors.line_of_sight import robot_points

Array = NDArray[np.float64]


class TeammateSight(Sensor):
    """What a camera that finds the teammates' markers tells each robot of the team.

    A teammate is in sight if the line between the two masts is free of walls and no longer than
    the sight radius. Errors, if it is noisy, are those of section 6.1 of the paper: a distance is
    off by a share uniform in +-``err_max``, a bearing by up to the angle that half the robot's
    size fills at that distance, uniform too.

    Attributes:
        radius: Of sight [m].
        noisy: Whether there are errors.
        err_max: Largest relative error of a distance.
        robot_size: Width of a robot [m], what bounds a bearing's error.
    """

    name = "teammate_sight"
    stands = True

    def __init__(
        self,
        *,
        radius: float,
        noisy: bool = False,
        err_max: float = 0.0,
        robot_size: float = 0.44,
        rate: float = 10.0,
        phase: float = 0.0,
    ):
        """Set reach, errors and schedule.

        Args:
            radius: Of sight [m].
            noisy: Whether there are errors.
            err_max: Share, 0 to 1; of no consequence unless noisy.
            robot_size: [m].
            rate: Looks a second [Hz].
            phase: Instant of the first [s].

        Raises:
            InvalidInputError: A radius or size that is not positive, or a share outside 0 to 1.
        """
        super().__init__(rate=rate, phase=phase)
        if not (0 < radius < math.inf and 0 < robot_size < math.inf):
            raise InvalidInputError(
                f"radius and robot_size must be positive and finite; got {radius}, {robot_size} m"
            )
        if not 0 <= err_max < 1:
            raise InvalidInputError(f"err_max is a share, 0 or more and below 1; got {err_max}")
        self.radius, self.err_max, self.robot_size = float(radius), float(err_max), robot_size
        self.noisy = noisy

    def read(self) -> Array:
        """Newest look (n, n, 2): distance [m] and bearing [rad] of each teammate.

        The bearing is in the observer's body frame. NaN where a teammate is not in sight, on the
        diagonal and before the first look.
        """
        return super().read()

    def prepare(self, sequence: np.random.SeedSequence, group: Any) -> None:
        """Set up the errors' stream."""
        assert self._simulation is not None
        n = self._simulation.team.n
        self._noise = SampleNoise(sequence, (n, n, 2), "uniform")

    def observe(self, time: float) -> Any:
        """Where everything is now."""
        assert self._simulation is not None
        return self._simulation.visible_state()

    def compute(self, state: Any, number: int) -> Array:
        """Try the lines of sight, then spoil what was measured."""
        assert self._simulation is not None
        scene = self._simulation.rays
        scene.show(state)
        masts = robot_points(self._simulation, MARKER_HEIGHT)
        robots = np.arange(len(masts))
        clear = scene.clear(masts, masts, robots, robots)
        _, turns = scene.bases()
        # in the observer's body axes: (n, n, 3)
        apart = np.einsum("nik,nmi->nmk", turns, masts[None] - masts[:, None])
        distance = np.hypot(apart[..., 0], apart[..., 1])
        bearing = np.arctan2(apart[..., 1], apart[..., 0])
        seen = clear & (distance <= self.radius) & (robots[:, None] != robots)
        if self.noisy:
            draw = 2.0 * self._noise.sample(number) - 1.0
            bound = np.arctan(self.robot_size / 2 / np.maximum(distance, 1e-9))
            distance = distance * (1.0 + self.err_max * draw[..., 0])
            bearing = bearing + bound * draw[..., 1]
        return np.where(seen[..., None], np.stack([distance, bearing], axis=-1), np.nan)

    def nothing(self) -> Array:
        """All NaN."""
        assert self._simulation is not None
        n = self._simulation.team.n
        return np.full((n, n, 2), np.nan)


def radio_sight(simulation: Any, radius: float) -> NDArray[np.bool_]:
    """Which masts reach each other (n, n), for radios: a free line of at most ``radius`` [m]."""
    scene = simulation.rays
    scene.show(simulation.visible_state())
    masts = robot_points(simulation, MARKER_HEIGHT)
    robots = np.arange(len(masts))
    apart = np.linalg.norm(masts[:, None] - masts[None], axis=2)
    return scene.clear(masts, masts, robots, robots) & (apart <= radius)
