"""Pioneer2DX: a two-wheel research base, 0.44 m long, 9 kg (assets/pioneer2dx/README.md)."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mjmr.assets import model_path
from mjmr.errors import InvalidInputError
from mjmr.robots.diff_drive import WHEELS, DiffDrive, wheel_speeds
from mjmr.robots.markings import TEAM_COLOURS, draw_digit
from mjmr.robots.platform import Array, Drive, DriveLimits, Platform

if TYPE_CHECKING:
    import mujoco

    from mjmr.sensors.base import Sensor

_HALF_DISC = 0.0008  # m, half the thickness of the disc on top


class Pioneer2DX(Platform):
    """ActivMedia Pioneer 2-DX; commands are (forward [m/s], turn [rad/s]).

    The origin is on the floor below the middle of the axle. ``braking`` is along the path of the
    faster wheel: an emergency stop keeps the curvature of the path.

    Attributes:
        wheel_radius: [m].
        rolling_radius: At which the wheels roll under the robot's weight [m]; what odometry needs.
        track: Between the wheels [m].
        turn_acceleration: Bound of the yaw rate's changes [rad/s^2].
    """

    name = "pioneer2dx"
    title = "ActivMedia Pioneer 2-DX"
    grade = "B"
    command_names = ("forward", "turn")
    radius = 0.291
    height = 0.22
    max_twist = (1.6, 5.24)
    braking = 3.5
    wheels = WHEELS
    wheel_radius = 0.0975
    rolling_radius = 0.09735
    track = 0.331

    def __init__(self, *, acceleration: float = 1.0, turn_acceleration: float = 3.0):
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
        import mujoco

        spec = mujoco.MjSpec.from_file(str(model_path(self.name)))
        for key in list(spec.keys):
            spec.delete(key)
        rgba = TEAM_COLOURS[team]
        spec.material("team").rgba = rgba
        base = spec.body("base")
        base.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            pos=np.array(spec.site("top").pos) + [0.0, 0.0, _HALF_DISC],
            size=[0.06, _HALF_DISC, 0],
            rgba=rgba,
            contype=0,
            conaffinity=0,
            group=1,
            mass=0,
        )
        draw_digit(spec.site("back"), base, number % 10, height=0.05)
        return spec

    def bind(self, model: "mujoco.MjModel", prefixes: Sequence[str]) -> Drive:
        """Drive of the robots attached under ``prefixes``."""
        return DiffDrive(model, prefixes)

    def default_sensors(self) -> "dict[str, Sensor]":
        """Wheel encoders at 10 Hz, the rate of the base's reports."""
        from mjmr.sensors.encoders import WheelEncoders

        return {"encoders": WheelEncoders(rate=10.0)}

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
        return way[:, [0, 2]] @ wheel_speeds(self.rolling_radius, self.track).T

    def slew(self, current: Array, target: Array, period: float) -> Array:
        """Commands (n, 2) as near to ``target`` as the accelerations allow in one period."""
        step = np.array([self.limits.acceleration, self.turn_acceleration]) * period
        return current + np.clip(target - current, -step, step)

    def brake(self, twist: Array, period: float) -> Array:
        """Next cycle's command (n, 2) of an emergency stop.

        Forward and turn fall in proportion, so that the path keeps its curvature; the faster
        wheel's rim slows by ``braking * period``.
        """
        rim = np.abs(twist[:, 0]) + np.abs(twist[:, 1]) * (self.track / 2.0)
        keep = np.maximum(0.0, 1.0 - self.braking * period / np.maximum(rim, 1e-300))
        return twist * keep[:, None]
