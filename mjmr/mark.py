"""Marks: paint on the floor, seen by eyes, cameras and films, felt by nothing."""

from dataclasses import dataclass

import numpy as np

from mjmr.errors import InvalidInputError


@dataclass(frozen=True, kw_only=True)
class Mark:
    """A painted disc or rectangle.

    Attributes:
        x: Centre [m], world frame.
        y: Centre [m], world frame.
        radius: Of a disc [m]; None for a rectangle.
        length: Of a rectangle along its yaw [m].
        width: Across it [m].
        yaw: [rad].
        rgba: Colour, 0 to 1.

    Raises:
        InvalidInputError: Neither a radius nor both sides, both, or a number that is not positive
            where it is a size, or not finite.
    """

    x: float
    y: float
    radius: float | None = None
    length: float | None = None
    width: float | None = None
    yaw: float = 0.0
    rgba: tuple[float, float, float, float] = (0.95, 0.85, 0.2, 1.0)

    def __post_init__(self):
        sides = [s for s in (self.radius, self.length, self.width) if s is not None]
        disc = self.radius is not None
        sizes = np.array(sides)
        good = np.isfinite(sizes).all() and (sizes > 0).all()
        if len(sides) != (1 if disc else 2) or not good:
            raise InvalidInputError(
                "a mark has a positive radius, or a positive length and width, finite; got radius "
                f"{self.radius}, length {self.length}, width {self.width}"
            )

        if not np.isfinite([self.x, self.y, self.yaw, *self.rgba]).all():
            raise InvalidInputError(
                f"a mark's place, yaw and colour must be finite; got ({self.x}, {self.y}), "
                f"{self.yaw} and {self.rgba}"
            )

    @property
    def half_sides(self) -> tuple[float, float]:
        """Half the length and width of a rectangle, the radius of a disc twice [m]."""
        if self.radius is not None:
            return self.radius, self.radius
        return (self.length or 0.0) / 2.0, (self.width or 0.0) / 2.0
