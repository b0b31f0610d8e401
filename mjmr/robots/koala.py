"""Koala: a six-wheel research base, 0.32 m long, 4 kg (assets/koala/README.md)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mjmr.robots.diff_drive import WHEELS
from mjmr.robots.platform import Array, Drive
from mjmr.robots.unicycle import Unicycle

if TYPE_CHECKING:
    import mujoco

    from mjmr.sensors.base import Sensor


class Koala(Unicycle):
    """K-Team Koala, skid-steered; commands are (forward [m/s], turn [rad/s]).

    The origin is on the floor below the middle of the six wheels. One motor a side turns three
    wheels and carries the encoder: the sides are what counts. Commands that ask a side for more
    than its top speed are scaled down as a whole, so that the path keeps its curvature.
    """

    name = "koala"
    title = "K-Team Koala"
    grade = "B"
    radius = 0.209
    height = 0.20
    max_twist = (0.6, 3.75)
    braking = 2.0
    wheels = WHEELS
    rolling_radius = 0.04142
    track = 0.285
    effective_track = 0.3196
    disc_radius = 0.05

    def __init__(self, *, acceleration: float = 1.0, turn_acceleration: float = 4.0):
        """Set what the base's firmware allows; see :class:`mjmr.robots.unicycle.Unicycle`."""
        super().__init__(acceleration=acceleration, turn_acceleration=turn_acceleration)

    def bind(self, model: "mujoco.MjModel", prefixes: Sequence[str]) -> Drive:
        """Drive of the robots attached under ``prefixes``."""
        from mjmr.robots.skid_steer import SkidSteerDrive

        return SkidSteerDrive(
            model,
            prefixes,
            rolling_radius=self.rolling_radius,
            effective_track=self.effective_track,
        )

    def default_sensors(self) -> "dict[str, Sensor]":
        """The motors' encoders at 10 Hz, 23 400 counts a wheel's turn."""
        from mjmr.sensors.encoders import WheelEncoders

        return {"encoders": WheelEncoders(rate=10.0, counts_per_turn=23400.0)}

    @property
    def always_allowed(self) -> float:
        """A command none of whose entries is above this needs no clamping."""
        return self.max_twist[0] / (1.0 + self.effective_track / 2.0)

    def clamp(self, command: Array) -> Array:
        """Scale commands (n, 2) so that no side's rims are faster than ``max_twist[0]``."""
        rim = self.rim_speeds(command)
        over = rim > self.max_twist[0]
        if not over.any():
            return command
        return command * np.where(over, self.max_twist[0] / np.maximum(rim, 1e-300), 1.0)[:, None]
