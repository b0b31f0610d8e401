"""Spot: what kind of thing a robot looks at in one direction, by a ray in place of a camera."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.finite import finite
from mjmr.geometry import look_at
from mjmr.randomness import SampleNoise
from mjmr.sensors.base import Sensor
from mjmr.sensors.visual_arc import KINDS, NOTHING, kinds_of

if TYPE_CHECKING:
    from mjmr.group import Group

Array = NDArray[np.float64]


class Spot(Sensor):
    """One ray on every robot of a group, and the kind of surface it meets first.

    It stands for the middle of a camera's picture, and knows kinds as :class:`VisualArc` does, by
    their colours. It turns and tilts with the robot's base, whose own shapes it does not meet.

    Attributes:
        position: Where the ray begins (3,) [m], frame of the base.
        target: A point it goes through (3,) [m].
        max_range: [m].
        wrong: Probability that a reading is wrong.
    """

    name = "spot"

    def __init__(
        self,
        *,
        position: ArrayLike,
        target: ArrayLike,
        kind: str = "pillar",
        max_range: float = 5.0,
        rate: float = 10.0,
        latency: float = 0.0,
        phase: float = 0.0,
        wrong: float = 0.0,
    ):
        """Set ray, schedule and errors.

        Args:
            position: See above.
            target: See above.
            kind: Which of :data:`mjmr.sensors.visual_arc.KINDS` is told from all others.
            max_range: [m].
            rate: Looks a second [Hz].
            latency: [s].
            phase: Instant of the first look [s].
            wrong: Probability that a look tells the contrary.

        Raises:
            InvalidInputError: Points that are one or not finite, an unknown kind, or a share or
                range that cannot be.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        ends = finite([position, target], (2, 3))
        if ends is None or (ends[0] == ends[1]).all():
            raise InvalidInputError("a spot's position and target are two points of three numbers")
        if kind not in KINDS:
            raise InvalidInputError(f"a spot's kind is one of {', '.join(KINDS)}; got {kind!r}")
        if not 0 <= wrong <= 1:
            raise InvalidInputError(f"wrong is a probability, 0 to 1; got {wrong}")
        if not max_range > 0:
            raise InvalidInputError(f"max_range must be positive; got {max_range} m")
        self.position, self.target = ends
        self.max_range, self.wrong = float(max_range), float(wrong)
        self._kind = KINDS.index(kind)

    def read(self) -> Array:
        """Newest look delivered by now (n,): 1 if the kind is met, 0 if not, NaN at first."""
        return super().read()

    @property
    def reading_bounds(self) -> tuple[ArrayLike, ArrayLike]:
        """0 and 1."""
        return 0.0, 1.0

    def prepare(self, sequence: np.random.SeedSequence, group: "Group") -> None:
        """Set up the noise stream."""
        assert self._simulation is not None
        self._noise = SampleNoise(sequence, (group.n,), "uniform")
        rows = self._simulation.team.rows(group)
        self._rows = np.arange(rows.start, rows.stop)
        right, down, forward = look_at(self.position, self.target).T
        self._frame = np.column_stack([forward, -right, -down])
        self._kinds: Array | None = None

    def observe(self, time: float) -> Any:
        """Where everything is now."""
        assert self._simulation is not None
        return self._simulation.visible_state()

    def compute(self, state: Any, number: int) -> Array:
        """Cast the rays, spoil what they tell."""
        assert self._simulation is not None
        scene = self._simulation.rays
        if self._kinds is None:
            self._kinds = kinds_of(scene.model, scene.names)
        scene.show(state)
        places, turns = (part[self._rows] for part in scene.bases())
        _, hits, _ = scene.cast(
            places + turns @ self.position, turns @ self._frame, self._rows, np.zeros(1),
            self.max_range,
        )  # fmt: skip
        kinds = self._kinds[hits[:, 0]]
        met = np.where(hits[:, 0] < 0, NOTHING, kinds) == self._kind
        if self.wrong > 0:
            met ^= self._noise.sample(number) < self.wrong
        return met.astype(np.float64)

    def nothing(self) -> Array:
        """All NaN."""
        return np.full(self._group.n, np.nan)
