"""What two-sided platforms share: commands are (forward, turn), whatever the wheels under them."""

import math
from typing import TYPE_CHECKING

import numpy as np

from mjmr.errors import InvalidInputError
from mjmr.robots.diff_drive import wheel_speeds
from mjmr.robots.markings import marked_model
from mjmr.robots.platform import Array, DriveLimits, Platform

if TYPE_CHECKING:
    import mujoco


class Unicycle(Platform):
    """A robot driven by a left and a right side; commands are (forward [m/s], turn [rad/s]).

    ``braking`` is along the path of the faster side: an emergency stop keeps the curvature of the
    path.

    Attributes:
        rolling_radius: At which the wheels roll under the robot's weight [m]; what odometry needs.
        track: Between the sides' wheels [m].
        effective_track: Of two wheels that would turn the robot as its sides do [m]; what odometry
            needs. The track itself unless wheels scrub.
        turn_acceleration: Bound of the yaw rate's changes [rad/s^2].
        disc_radius: Of the disc in the team's colour on top [m].
    """

    command_names = ("forward", "turn")
    rolling_radius: float
    track: float
    effective_track: float
    disc_radius: float

    def __init__(self, *, acceleration: float, turn_acceleration: float):
        """Set what the base's firmware allows.

        Args:
            acceleration: Bound of the forward speed's changes [m/s^2], speeding up and braking.
            turn_acceleration: Bound of the yaw rate's changes [rad/s^2].

        Raises:
            InvalidInputError: A bound that is not positive and finite.
        """
        for bound in (acceleration, turn_acceleration):
            if not (bound > 0 and math.isfinite(bound)):
                raise InvalidInputError(
                    f"accelerations of {type(self).__name__} must be positive and finite; "
                    f"got {bound}"
                )
        self.turn_acceleration = turn_acceleration
        self.limits = DriveLimits(
            max_speed=self.max_twist[0], acceleration=acceleration, deceleration=acceleration
        )

    def model(self, number: int, team: str) -> "mujoco.MjSpec":
        """Model of one robot with its team's band and disc, and its number on the back."""
        return marked_model(self.name, number, team, disc=self.disc_radius, digit=0.05)

    @property
    def always_allowed(self) -> float:
        """A command none of whose entries is above this needs no clamping."""
        return min(self.max_twist)

    def clamp(self, command: Array) -> Array:
        """Cut forward and turn of commands (n, 2) to ``max_twist``, each by itself."""
        return np.clip(command, np.negative(self.max_twist), self.max_twist)

    def twist_of(self, command: Array) -> Array:
        """Twists (n, 3): never sideways."""
        return np.insert(command, 1, 0.0, axis=1)

    def wheel_turns(self, way: Array) -> Array:
        """Angles [rad] of the wheels (n, 2) after forward and turn came to ``way`` (n, 3)."""
        return way[:, [0, 2]] @ wheel_speeds(self.rolling_radius, self.effective_track).T

    def slew(self, current: Array, target: Array, period: float) -> Array:
        """Commands (n, 2) as near to ``target`` as the accelerations allow in one period."""
        step = np.array([self.limits.acceleration, self.turn_acceleration]) * period
        return current + np.clip(target - current, -step, step)

    def brake(self, twist: Array, period: float) -> Array:
        """Next cycle's command (n, 2) of an emergency stop.

        Forward and turn fall in proportion, so that the path keeps its curvature; the faster
        side's rims slow by ``braking * period``.
        """
        rim = self.rim_speeds(twist)
        keep = np.maximum(0.0, 1.0 - self.braking * period / np.maximum(rim, 1e-300))
        return twist * keep[:, None]

    def rim_speeds(self, command: Array) -> Array:
        """Speeds (n,) [m/s] of the faster side's rims that commands (n, 2) ask for."""
        return np.abs(command[:, 0]) + np.abs(command[:, 1]) * (self.effective_track / 2.0)
