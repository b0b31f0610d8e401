"""ConeSight: who is in a limited cone of view, where; rays in place of a camera."""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.finite import finite
from mjmr.sensors.base import Sensor

Array = NDArray[np.float64]


class ConeSight(Sensor):
    """What a level camera that looks ahead and finds a mark on every robot tells its robot.

    A robot is seen if the line from the eye to its mark is within the cone and the range and
    nothing but the two robots themselves is in its way; whether a mark is wide enough for a camera
    to resolve is not asked. Mounted in the world, on every robot of the team; exact.

    Attributes:
        cone: Whole horizontal angle [rad].
        range: Between eye and mark, in the plane [m].
    """

    name = "cone_sight"
    stands = True

    def __init__(
        self,
        *,
        cone: float,
        range: float,
        eye: ArrayLike,
        mark: ArrayLike,
        rate: float = 10.0,
        latency: float = 0.0,
        phase: float = 0.0,
    ):
        """Set the cone, where eye and mark are, and the schedule.

        Args:
            cone: Whole horizontal angle, up to 2 pi [rad].
            range: [m].
            eye: In the robot's frame (3,) [m].
            mark: The middle of the mark, in the robot's frame (3,) [m].
            rate: Looks a second [Hz].
            latency: [s].
            phase: Instant of the first look [s].

        Raises:
            InvalidInputError: A cone or range that cannot be, or points of another shape.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        if not 0 < cone <= 2 * math.pi:
            raise InvalidInputError(f"a cone is more than 0 and up to 2 pi rad; got {cone}")
        if not range > 0:
            raise InvalidInputError(f"a range is positive; got {range} m")
        self.cone, self.range = float(cone), float(range)
        points = []
        for name, given in (("eye", eye), ("mark", mark)):
            point = finite(given, (3,))
            if point is None:
                raise InvalidInputError(f"{name} is a point (3,) [m]; got {given}")
            points.append(point)
        self._eye, self._mark = points

    def read(self) -> Array:
        """Newest look (n, n, 2): distance [m] and bearing [rad] of each other robot's mark.

        From the looking robot's origin, in its frame. NaN where a robot is not seen, on the
        diagonal and before the first look.
        """
        return super().read()

    def prepare(self, sequence: np.random.SeedSequence, group: Any) -> None:
        """Nothing is random."""
        assert self._simulation is not None
        self._n = self._simulation.team.n

    def observe(self, time: float) -> Any:
        """Where everything is now."""
        assert self._simulation is not None
        return self._simulation.visible_state()

    def compute(self, state: Any, number: int) -> Array:
        """Try the lines that are within the cone and the range."""
        assert self._simulation is not None
        scene = self._simulation.rays
        scene.show(state)
        places, turns = scene.bases()
        eyes, marks = places + turns @ self._eye, places + turns @ self._mark
        robots = np.arange(self._n)
        from_eye = np.einsum("nik,nmi->nmk", turns, marks[None] - eyes[:, None])
        seen = np.abs(np.arctan2(from_eye[..., 1], from_eye[..., 0])) <= self.cone / 2
        seen &= np.hypot(from_eye[..., 0], from_eye[..., 1]) <= self.range
        np.fill_diagonal(seen, False)
        if seen.any():
            seen &= scene.clear(eyes, marks, robots, robots)
        apart = np.einsum("nik,nmi->nmk", turns, marks[None] - places[:, None])
        where = np.stack(
            [np.hypot(apart[..., 0], apart[..., 1]), np.arctan2(apart[..., 1], apart[..., 0])], -1
        )
        return np.where(seen[..., None], where, np.nan)

    def nothing(self) -> Array:
        """All NaN."""
        return np.full((self._n, self._n, 2), np.nan)
