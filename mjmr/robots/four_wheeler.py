"""FourWheeler: a four-wheel skid-steer base, 0.50 m long, 10 kg (assets/four_wheeler/README.md)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from mjmr.robots.diff_drive import WHEELS
from mjmr.robots.platform import Drive
from mjmr.robots.unicycle import Unicycle

if TYPE_CHECKING:
    import mujoco

    from mjmr.sensors.base import Sensor

_GEARED = tuple((f"{wheel}_rear",) for wheel in WHEELS)


class FourWheeler(Unicycle):
    """Four-wheel skid-steer base; commands are (forward [m/s], turn [rad/s]).

    The origin is on the floor below the middle of the four wheels. One motor a side turns both
    wheels of it and carries the encoder. In a turn all wheels scrub: the sides have to run as if
    the track were ``effective_track``, which drive and odometry both use.
    """

    name = "four_wheeler"
    title = "Four-wheel skid-steer base"
    grade = "C"
    radius = 0.351
    height = 0.24
    max_twist = (1.0, 2.0)
    braking = 2.0
    wheels = WHEELS
    rolling_radius = 0.10956
    track = 0.40
    effective_track = 0.64
    disc_radius = 0.09

    def __init__(
        self,
        *,
        acceleration: float = 1.0,
        turn_acceleration: float = 4.0,
        calibrated: bool = True,
    ):
        """Set what the base's firmware allows; see :class:`mjmr.robots.unicycle.Unicycle`.

        Args:
            acceleration: Bound of the forward speed's changes [m/s^2].
            turn_acceleration: Bound of the yaw rate's changes [rad/s^2].
            calibrated: Whether the servos reckon with the scrub of the tyres; else with the
                track itself, as one would who has only measured the robot.
        """
        super().__init__(acceleration=acceleration, turn_acceleration=turn_acceleration)
        self.effective_track = type(self).effective_track if calibrated else self.track

    def bind(self, model: "mujoco.MjModel", prefixes: Sequence[str]) -> Drive:
        """Drive of the robots attached under ``prefixes``."""
        from mjmr.robots.skid_steer import SkidSteerDrive

        return SkidSteerDrive(
            model,
            prefixes,
            geared=_GEARED,
            rolling_radius=self.rolling_radius,
            effective_track=self.effective_track,
        )

    def default_sensors(self) -> "dict[str, Sensor]":
        """The motors' encoders at 50 Hz, 10 000 counts a wheel's turn."""
        from mjmr.sensors.encoders import WheelEncoders

        return {"encoders": WheelEncoders(rate=50.0, counts_per_turn=10000.0)}
