"""Wall following."""

from dataclasses import KW_ONLY, dataclass
from typing import Literal

import numpy as np

from controllers.schemas.base import Schema, View, unit
from controllers.schemas.percepts import Array
from mjmr.errors import InvalidInputError


@dataclass(frozen=True, eq=False)
class FollowWall(Schema):
    """Along the nearest thing within reach, keeping it at one hand and at a distance.

    The vector is the tangent, tilted towards the wall where it is further away than ``distance``
    and off it where it is nearer, by up to 45 degrees.

    Attributes:
        of: Percept, such as the nearest points of walls.
        distance: From the robot's centre to the surface [m].
        reach: Range beyond which it is idle [m].
        hand: On which side the wall stays.
    """

    of: str
    _: KW_ONLY
    distance: float
    reach: float
    hand: Literal["left", "right"] = "left"

    def __post_init__(self):
        if not 0 < self.distance < self.reach:
            raise InvalidInputError(
                f"{self.label}: 0 < distance < reach; got {self.distance} and {self.reach} m"
            )
        if self.hand not in ("left", "right"):
            raise InvalidInputError(f"{self.label}: hand is left or right; got {self.hand!r}")

    @property
    def label(self) -> str:
        """Follow what, at which hand."""
        return f"follow {self.of} at the {self.hand}"

    @property
    def percepts(self) -> tuple[str, ...]:
        """What it follows."""
        return (self.of,)

    def field(self, view: View) -> Array:
        """Vectors (n, 2) of length 1; 0 where nothing is in reach."""
        nearest = view.things(self.of).nearest()
        gap = nearest.gap[:, 0]
        near = gap < self.reach
        towards = unit(np.where(near[:, None], nearest.offset[:, 0], 0.0))
        # with the wall at the left it lies 90 degrees anticlockwise of the way
        turn = -1.0 if self.hand == "left" else 1.0
        along = turn * np.column_stack([-towards[:, 1], towards[:, 0]])
        tilt = np.clip((np.where(near, gap, 0.0) - self.distance) / self.distance, -1.0, 1.0)
        return unit(along + tilt[:, None] * towards)
