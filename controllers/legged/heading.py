"""Keeps legged robots on a heading and on a line: gaits alone drift."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.geometry import angle_difference, rotate

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class HeadingLoop:
    """Turns against the error of the heading.

    Attributes:
        gain: Turn per error [1/s].
        limit: Fastest turn [rad/s].
    """

    gain: float = 1.5
    limit: float = 0.8

    def __post_init__(self):
        if not (self.gain > 0 and self.limit > 0):
            raise InvalidInputError(
                f"a heading loop needs a positive gain and limit; got {self.gain}, {self.limit}"
            )

    def turn(self, heading: ArrayLike, wanted: ArrayLike) -> Array:
        """Turns to command (n,) [rad/s]; 0 where the measured heading is NaN, not reported.

        Args:
            heading: Measured, by a compass or a localizer (n,) [rad].
            wanted: Same frame, broadcast against it [rad].
        """
        error = angle_difference(wanted, heading)
        turn = (self.gain * error).clip(-self.limit, self.limit)
        return np.where(np.isfinite(turn), turn, 0.0)


@dataclass(frozen=True, kw_only=True)
class StraightWalk:
    """Walks along lines: heads back to the line, the more the further off it is.

    Attributes:
        loop: Turns to the heading.
        gain: Heading's angle to the line per distance from it [rad/m].
        limit: Largest such angle [rad].
    """

    loop: HeadingLoop = HeadingLoop()
    gain: float = 2.0
    limit: float = 0.35

    def twist(
        self, poses: ArrayLike, start: ArrayLike, heading: ArrayLike, forward: ArrayLike
    ) -> Array:
        """Commands (n, 3): forward, left [m/s], anticlockwise [rad/s].

        Robots that walk backwards have their backs to where they go. Where a pose is NaN, not
        reported, the command is straight on.

        Args:
            poses: Measured (n, 3) [m, m, rad], world frame.
            start: A point of each line (n, 2) or (2,) [m].
            heading: Of the robots along the lines, broadcast to (n,) [rad].
            forward: Speeds, broadcast to (n,), below zero backwards [m/s].

        Raises:
            InvalidInputError: Poses of another shape.
        """
        pose = np.asarray(poses, dtype=np.float64)
        if pose.ndim != 2 or pose.shape[1] != 3:
            raise InvalidInputError(f"poses must have shape (n, 3); got {pose.shape}")
        line, speed = (np.broadcast_to(a, len(pose)) for a in (heading, forward))
        aside = rotate(pose[:, :2] - np.asarray(start), -line)[:, 1]
        lean = (self.gain * aside).clip(-self.limit, self.limit) * np.sign(speed)
        turn = self.loop.turn(pose[:, 2], line - lean)
        return np.column_stack([speed, np.zeros(len(pose)), turn])
