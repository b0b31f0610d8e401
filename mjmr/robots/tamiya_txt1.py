"""TamiyaTXT1: a monster truck of scale 1:10 with a payload box (assets/tamiya_txt1/README.md)."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.robots.ackermann import COUNTED, AckermannDrive
from mjmr.robots.diff_drive import wheel_speeds
from mjmr.robots.markings import marked_model
from mjmr.robots.platform import Array, Drive, DriveLimits, Platform

if TYPE_CHECKING:
    import mujoco

    from mjmr.sensors.base import Sensor

COMMANDS = {"unicycle": ("forward", "turn"), "steering": ("forward", "steering")}


class TamiyaTXT1(Platform):
    """Tamiya TXT-1 as the MARHES testbed drives it; the origin is below the rear axle's middle.

    There are two sets of commands:

    - ``unicycle``: (forward [m/s], turn [rad/s]), 0 to 2 m/s and +-0.3 rad/s as published, and no
      more turn than the steering's lock allows at that speed. The speed servo is told at most
      1.998 m/s, so that what it makes of it stays below 2. It steers for the larger of the speed
      it has and the one it goes to, and speeding up waits for the steering, so that changing both
      at once does not turn it faster than 0.3 rad/s. At rest it steers straight.
    - ``steering``: (forward [m/s], steering [rad], the bicycle model's), +-2 m/s and +-28 degrees.

    Only set points enter: the base has no gyroscope in its loop.

    Attributes:
        command: Which of them.
        wheelbase: [m].
        track: [m].
        wheel_radius: [m].
        rolling_radius: At which the wheels roll under the robot's weight [m]; what odometry needs.
        lock: Largest steering angle [rad].
        steering_rate: Largest [rad/s].
        speed_margin: Share of ``max_speed`` that ``unicycle`` commands leave to the servo's error.
    """

    name = "tamiya_txt1"
    title = "Tamiya TXT-1, MARHES testbed"
    grade = "C"
    radius = 0.43  # around the origin, to the corners of the front bumper
    height = 0.45
    braking = 3.0
    wheels = COUNTED
    wheelbase = 0.31
    track = 0.28
    wheel_radius = 0.0825
    rolling_radius = 0.08225
    lock = math.radians(28.0)
    steering_rate = math.radians(60.0)
    max_speed = 2.0
    # told 2 m/s, the speed servo drives 2.0004 over half a second; as published is the speed driven
    speed_margin = 0.001
    max_turn = 0.3

    def __init__(self, *, command: str = "unicycle", acceleration: float = 1.0):
        """Choose the commands and what the speed controller allows.

        Args:
            command: One of ``COMMANDS``.
            acceleration: Bound of the speed's changes [m/s^2], speeding up and braking.

        Raises:
            UnknownNameError: Another set of commands.
            InvalidInputError: A bound that is not positive and finite.
        """
        if command not in COMMANDS:
            raise UnknownNameError("set of commands", command, COMMANDS)
        if not (acceleration > 0 and math.isfinite(acceleration)):
            raise InvalidInputError(
                f"the acceleration of {type(self).__name__} must be positive and finite; "
                f"got {acceleration}"
            )
        self.command = command
        self.command_names = COMMANDS[command]
        turn = self.max_speed * math.tan(self.lock) / self.wheelbase
        self.max_twist = (self.max_speed, self.max_turn if self._unicycle else turn)
        self.limits = DriveLimits(
            max_speed=self.max_speed, acceleration=acceleration, deceleration=acceleration
        )

    @property
    def _unicycle(self) -> bool:
        return self.command == "unicycle"

    def model(self, number: int, team: str) -> "mujoco.MjSpec":
        """Model of one robot with its team's band and disc, and its number on the back."""
        return marked_model(self.name, number, team, disc=0.05, digit=0.06)

    def bind(self, model: "mujoco.MjModel", prefixes: Sequence[str]) -> Drive:
        """Drive of the robots attached under ``prefixes``."""
        return AckermannDrive(model, prefixes, unicycle=self._unicycle)

    def default_sensors(self) -> "dict[str, Sensor]":
        """Encoders of the rear wheels at 10 Hz."""
        from mjmr.sensors.encoders import WheelEncoders

        return {"encoders": WheelEncoders(rate=10.0, counts_per_turn=1024.0)}

    @property
    def always_allowed(self) -> float:
        """A command none of whose entries is above this needs no clamping: only rest."""
        return 0.0

    def clamp(self, command: Array) -> Array:
        """Cut commands (n, 2) to what speed control and steering can do."""
        top = self.max_speed * (1.0 - self.speed_margin * self._unicycle)
        forward = np.clip(command[:, 0], 0.0 if self._unicycle else -self.max_speed, top)
        bound: float | Array = self.lock
        if self._unicycle:
            bound = np.minimum(self.max_turn, forward * (math.tan(self.lock) / self.wheelbase))
        return np.column_stack([forward, np.clip(command[:, 1], -bound, bound)])

    def twist_of(self, command: Array) -> Array:
        """Twists (n, 3) of the rear axle's middle: never sideways."""
        turn = command[:, 1]
        if not self._unicycle:
            turn = command[:, 0] * np.tan(turn) / self.wheelbase
        return np.column_stack([command[:, 0], np.zeros(len(command)), turn])

    def wheel_turns(self, way: Array) -> Array:
        """Angles [rad] of the rear wheels (n, 2) after forward and turn came to ``way`` (n, 3)."""
        return way[:, [0, 2]] @ wheel_speeds(self.rolling_radius, self.track).T

    def slew(self, current: Array, target: Array, period: float) -> Array:
        """Commands (n, 2) as near to ``target`` as the drive gets in one period."""
        step = self.limits.acceleration * period
        swing = self.steering_rate * period
        forward = current[:, 0] + np.clip(target[:, 0] - current[:, 0], -step, step)
        if not self._unicycle:
            turned = np.clip(target[:, 1] - current[:, 1], -swing, swing)
            return np.column_stack([forward, current[:, 1] + turned])
        # steered for the present speed alone, it would turn too fast as soon as it speeds up
        faster = np.maximum(target[:, 0], current[:, 0])
        now = np.arctan2(self.wheelbase * current[:, 1], current[:, 0])
        wanted = np.arctan2(self.wheelbase * target[:, 1], faster)
        steering = now + np.clip(wanted - now, -swing, swing)
        # the wheels follow the servo late: what bounds the speed is the sharper end of the period
        sharpest = np.tan(np.maximum(np.abs(now), np.abs(steering)))
        forward = np.minimum(forward, self.max_turn * self.wheelbase / np.maximum(sharpest, 1e-300))
        return np.column_stack([forward, forward * np.tan(steering) / self.wheelbase])

    def brake(self, twist: Array, period: float) -> Array:
        """Next cycle's command (n, 2) of an emergency stop, which keeps the path's curvature."""
        speed = np.abs(twist[:, 0])
        keep = np.maximum(0.0, 1.0 - self.braking * period / np.maximum(speed, 1e-300))
        if not self._unicycle:
            return np.column_stack([twist[:, 0] * keep, twist[:, 1]])
        return twist * keep[:, None]
