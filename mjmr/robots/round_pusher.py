"""RoundPusher: a round base that pushes, with a camera in a turret (assets/round_pusher)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from mjmr.robots.diff_drive import WHEELS, DiffDrive
from mjmr.robots.platform import Drive
from mjmr.robots.unicycle import Unicycle

if TYPE_CHECKING:
    import mujoco

    from mjmr.sensors.base import Sensor


class RoundPusher(Unicycle):
    """A two-wheel base in an upright cylinder; commands are (forward [m/s], turn [rad/s]).

    The origin is on the floor below the middle of the axle, which is the middle of the cylinder.
    What it pushes with is limited by the torque of its wheels, not by their grip. Its camera is on
    the turret's axis; :class:`mjmr.sensors.turret.Turret` turns it.

    Attributes:
        push_force: Most that one robot pushes with at a standstill [N].
    """

    name = "round_pusher"
    title = "Round pusher with a turret camera"
    grade = "C"
    radius = 0.24
    height = 0.26
    max_twist = (0.5, 2.5)
    braking = 1.2
    wheels = WHEELS
    rolling_radius = 0.07985
    track = 0.32
    effective_track = track
    disc_radius = 0.08
    push_force = 12.0

    def __init__(self, *, acceleration: float = 0.8, turn_acceleration: float = 4.0):
        """Set what the base's firmware allows; see :class:`mjmr.robots.unicycle.Unicycle`."""
        super().__init__(acceleration=acceleration, turn_acceleration=turn_acceleration)

    def bind(self, model: "mujoco.MjModel", prefixes: Sequence[str]) -> Drive:
        """Drive of the robots attached under ``prefixes``."""
        return DiffDrive(model, prefixes)

    def default_sensors(self) -> "dict[str, Sensor]":
        """Wheel encoders at 10 Hz, and the turret."""
        from mjmr.sensors.encoders import WheelEncoders
        from mjmr.sensors.turret import Turret

        return {"encoders": WheelEncoders(rate=10.0), "turret": Turret()}
