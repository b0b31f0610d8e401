"""Pioneer2DX: a two-wheel research base, 0.44 m long, 9 kg (assets/pioneer2dx/README.md)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from mjmr.robots.diff_drive import WHEELS, DiffDrive
from mjmr.robots.platform import Drive
from mjmr.robots.unicycle import Unicycle

if TYPE_CHECKING:
    import mujoco

    from mjmr.sensors.base import Sensor


class Pioneer2DX(Unicycle):
    """ActivMedia Pioneer 2-DX; commands are (forward [m/s], turn [rad/s]).

    The origin is on the floor below the middle of the axle.

    Attributes:
        wheel_radius: [m].
    """

    name = "pioneer2dx"
    title = "ActivMedia Pioneer 2-DX"
    grade = "B"
    radius = 0.291
    height = 0.22
    max_twist = (1.6, 5.24)
    braking = 3.5
    wheels = WHEELS
    wheel_radius = 0.0975
    rolling_radius = 0.09735
    track = 0.331
    effective_track = track
    disc_radius = 0.06

    def __init__(self, *, acceleration: float = 1.0, turn_acceleration: float = 3.0):
        """Set what the base's firmware allows; see :class:`mjmr.robots.unicycle.Unicycle`."""
        super().__init__(acceleration=acceleration, turn_acceleration=turn_acceleration)

    def bind(self, model: "mujoco.MjModel", prefixes: Sequence[str]) -> Drive:
        """Drive of the robots attached under ``prefixes``."""
        return DiffDrive(model, prefixes)

    def default_sensors(self) -> "dict[str, Sensor]":
        """Wheel encoders at 10 Hz, the rate of the base's reports."""
        from mjmr.sensors.encoders import WheelEncoders

        return {"encoders": WheelEncoders(rate=10.0)}
