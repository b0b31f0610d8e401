"""Cart: a box on a straight rail that goes to and fro by itself."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError
from mjmr.materials import check_material


@dataclass(frozen=True, kw_only=True)
class Cart:
    """A heavy box that travels to and fro along its own x axis, whatever is in its way.

    Its way is a trapezoidal profile each way; in MuJoCo a servo of limited force holds it there,
    so that it can push and be held up.

    Attributes:
        x: Middle of its way [m], world frame.
        y: The same.
        yaw: Direction of its way [rad].
        length: Along the way [m].
        width: Across it [m].
        height: [m].
        travel: Length of its way, from end to end [m].
        speed: Top speed [m/s].
        acceleration: [m/s^2].
        start: Where on its cycle it is at time 0, 0 to 1; 0 is the lower end.
        mass: [kg].
        force: Most that its servo pushes [N].
        material: One of ``mjmr.materials.MATERIALS``.
    """

    x: float
    y: float
    yaw: float = 0.0
    length: float
    width: float
    height: float = 0.3
    travel: float
    speed: float
    acceleration: float = 0.5
    start: float = 0.0
    mass: float = 20.0
    force: float = 200.0
    material: str = "plain"

    def __post_init__(self):
        check_material(self.material)
        for name in (
            "length",
            "width",
            "height",
            "travel",
            "speed",
            "acceleration",
            "mass",
            "force",
        ):
            if not (math.isfinite(getattr(self, name)) and getattr(self, name) > 0):
                raise InvalidInputError(
                    f"a cart's {name} must be positive and finite; got {getattr(self, name)}"
                )
        if not 0.0 <= self.start <= 1.0:
            raise InvalidInputError(f"a cart's start is 0 to 1; got {self.start}")

    def along(self, time: float) -> tuple[float, float]:
        """Place on its way, -travel/2 to travel/2 [m], and velocity [m/s], at ``time`` [s]."""
        top = min(self.speed, math.sqrt(self.travel * self.acceleration))
        rise = top / self.acceleration
        leg = self.travel / top + rise
        phase = (time + self.start * 2 * leg) % (2 * leg)
        back = phase >= leg
        t = phase - leg if back else phase
        if t < rise:
            way, v = 0.5 * self.acceleration * t * t, self.acceleration * t
        elif t <= leg - rise:
            way, v = top * (t - 0.5 * rise), top
        else:
            left = leg - t
            way, v = self.travel - 0.5 * self.acceleration * left * left, self.acceleration * left
        half = self.travel / 2
        return (half - way, -v) if back else (way - half, v)

    def box(self, along: float) -> NDArray[np.float64]:
        """x, y, yaw, half-length, half-width [m, rad] when it is ``along`` its way [m]."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return np.array(
            [self.x + c * along, self.y + s * along, self.yaw, self.length / 2, self.width / 2]
        )
