"""Safety filters behind one interface: what a team wishes, made safe, in one call a cycle.

A filter is made with ``(bounds, boxes, n, config, rng)`` and called as
``step(position, velocity, wish, active)``; any controller's velocities can be put through it, and
any study can offer the role. Here are no filter at all and the barrier; the velocity-space search
is in controllers/safety/search.py.
"""

import math
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.motion.trapezoid import Limits
from controllers.safety.barrier import BarrierConfig, BarrierFilter
from controllers.safety.obstacles import NearestPoints
from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True)
class SafetyConfig:
    """What a safety filter has to know of the robots.

    Attributes:
        radius: Of the disc around the controlled point that holds the body [m].
        limits: What that point can do in every direction.
        period: Between two calls [s].
        margin: Kept around each disc [m]; two discs therefore stay twice this apart.
        rate: The barrier's gamma [1/s]: how fast a gap may be used up.
        samples: Random accelerations the search tries.

    Raises:
        InvalidInputError: A number that is not positive and finite; a negative margin or number of
            samples.
    """

    radius: float
    limits: Limits = field(default_factory=Limits)
    period: float = 1.0 / 60.0
    margin: float = 0.025
    rate: float = 2.0
    samples: int = 50

    def __post_init__(self):
        for name in ("radius", "period", "rate"):
            value = getattr(self, name)
            if not 0 < value < math.inf:
                raise InvalidInputError(f"{name} must be positive and finite; got {value}")
        if not 0 <= self.margin < math.inf or self.samples < 0:
            raise InvalidInputError(
                f"margin and samples are 0 or more; got {self.margin} m and {self.samples}"
            )


class SafetyFilter(Protocol):
    """What every filter offers.

    Attributes:
        overruled: Whose wish was not taken in the last call (n,).
        infeasible: Calls without a safe set of velocities so far.
    """

    overruled: Flags
    infeasible: int

    def step(
        self, position: Array, velocity: Array, wish: Array, active: Flags | None = None
    ) -> Array:
        """Velocities (n, 2) [m/s] to be reached at the end of the period.

        Args:
            position: Of the controlled points (n, 2) [m], world frame.
            velocity: Theirs (n, 2) [m/s].
            wish: (n, 2) [m/s].
            active: Who obeys (n,); None for all. Who does not is told to brake.
        """
        ...


class Unfiltered:
    """No filter: every wish as it is. What the others are compared with."""

    def __init__(
        self, bounds: Array, boxes: ArrayLike | None, n: int, config: SafetyConfig, rng: object
    ):
        """See :class:`SafetyFilter`."""
        self.overruled, self.infeasible = np.zeros(n, dtype=bool), 0

    def step(
        self, position: Array, velocity: Array, wish: Array, active: Flags | None = None
    ) -> Array:
        """See :class:`SafetyFilter`."""
        return wish if active is None else np.where(active[:, None], wish, 0.0)


class Barrier:
    """The barrier's quadratic program, walls and boxes included, for bodies that take time.

    What comes out of the program is a velocity at once; the bodies get as near to it as their
    limits allow in one period. What that leaves of the guarantee has to be in the margin and in a
    rate that braking can follow: closing speeds fall at ``rate`` times themselves, so rate times
    top speed should stay below the deceleration.

    Attributes:
        program: The program; it counts its solutions.
    """

    def __init__(
        self, bounds: Array, boxes: ArrayLike | None, n: int, config: SafetyConfig, rng: object
    ):
        """Set the program up.

        Args:
            bounds: Of the world (4,) [m].
            boxes: What stands there (k, 5): x, y, yaw, half-length, half-width [m, rad], or None.
            n: Robots.
            config: Of robots and filter.
            rng: Not used; nothing here is random.
        """
        self._walls = NearestPoints(bounds, boxes)
        self._config = config
        self.program = BarrierFilter(
            n,
            BarrierConfig(
                distance=2.0 * (config.radius + config.margin),
                clearance=config.radius + config.margin,
                rate=config.rate,
                top_speed=config.limits.max_speed,
                obstacles=self._walls.count,
            ),
        )
        self.overruled = np.zeros(n, dtype=bool)

    @property
    def infeasible(self) -> int:
        """Calls without a safe set of velocities so far; everybody braked."""
        return self.program.infeasible

    def step(
        self, position: Array, velocity: Array, wish: Array, active: Flags | None = None
    ) -> Array:
        """See :class:`SafetyFilter`."""
        config = self._config
        wanted = wish if active is None else np.where(active[:, None], wish, 0.0)
        safe = self.program.filter(position, wanted, self._walls.of(position))
        self.overruled = self.program.changed > 1e-3 * config.limits.max_speed
        return reachable(velocity, safe, config.limits, config.period)


def reachable(velocity: Array, wish: Array, limits: Limits, period: float) -> Array:
    """What is nearest to ``wish`` (n, 2) of what one period can make of ``velocity`` (n, 2) [m/s].

    Nearest along and across the velocity, each by itself; the same set of changes as the search's
    (:func:`controllers.motion.safety.reachable_box`), for all robots at once.
    """
    speed = np.hypot(velocity[:, 0], velocity[:, 1])
    moving = speed > 0.0
    ahead = np.where(moving[:, None], velocity / np.where(moving, speed, 1.0)[:, None], (1.0, 0.0))
    change = wish - velocity
    along = (change * ahead).sum(axis=1)
    across = change[:, 1] * ahead[:, 0] - change[:, 0] * ahead[:, 1]
    A, B = limits.acceleration, limits.deceleration
    # a slow robot stops within the period and speeds up backwards after
    least = np.where(speed < B * period, -speed - A * (period - speed / B), -B * period)
    along = np.clip(along, least, A * period)
    across = np.clip(across, -A * period, A * period)
    sideways = np.column_stack([-ahead[:, 1], ahead[:, 0]])
    return velocity + along[:, None] * ahead + across[:, None] * sideways
