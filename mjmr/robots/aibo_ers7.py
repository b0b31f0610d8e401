"""AiboERS7: Sony's four-legged robot, 20 joints, 1.65 kg (assets/aibo_ers7/README.md)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mjmr.assets import model_path
from mjmr.errors import InvalidInputError
from mjmr.robots.joint_servos import JointServos
from mjmr.robots.markings import TEAM_COLOURS, draw_digit
from mjmr.robots.motion import Motion
from mjmr.robots.platform import Array, Drive, DriveLimits, Platform

if TYPE_CHECKING:
    import mujoco

    from mjmr.sensors.base import Sensor


class Joint(NamedTuple):
    """A servoed joint.

    Attributes:
        name: Of joint and actuator in the model.
        low: [deg].
        high: [deg].
        rate: Fastest it turns [rad/s].
        home: Where it stands at the start [deg].
    """

    name: str
    low: float
    high: float
    rate: float
    home: float


def _leg(leg: str, low: float, high: float, home: tuple[float, float, float]) -> list[Joint]:
    return [
        Joint(f"{leg}_rotator", low, high, 4.865, home[0]),
        Joint(f"{leg}_elevator", -10, 88, 5.280, home[1]),
        Joint(f"{leg}_knee", -25, 122, 5.280, home[2]),
    ]


_FORE, _HIND = (-15.0, 7.0, 63.0), (-30.0, 8.0, 81.0)
# limits and rates: Tekkotsu's ERS7Info.h; the ears' are assumed
JOINTS: tuple[Joint, ...] = (
    *_leg("fl", -115, 130, _FORE),
    *_leg("fr", -115, 130, _FORE),
    *_leg("hl", -130, 115, _HIND),
    *_leg("hr", -130, 115, _HIND),
    Joint("tilt1", -75, 0, 3.185, -20),
    Joint("pan", -88, 88, 10.057, 0),
    Joint("tilt2", -15, 45, 5.781, 20),
    Joint("mouth", -55, -3, 10.14, -5),
    Joint("tail_tilt", 5, 60, 15.16, 30),
    Joint("tail_pan", -45, 45, 15.16, 0),
    Joint("ear_left", 0, 10, 10.0, 2),
    Joint("ear_right", 0, 10, 10.0, 2),
)
FRAME = 0.008  # s, OPEN-R's


class AiboERS7(Platform):
    """Sony AIBO ERS-7; commands are 20 joint angles [rad], or a motion engine's own.

    The origin is midway between the hips, x forward, some 0.13 m above the floor. Joints, in the
    order of ``JOINTS``, with OPEN-R's signs: rotators swing forelegs forwards and hind legs
    backwards, elevators raise legs outwards, knees bend; the neck (tilt1) rises, the head turns
    left (pan) and nods up (tilt2).

    Attributes:
        motion: The engine, or None.
        joint_limits: Lowest and highest angles (20, 2) [rad].
        joint_rates: Fastest the joints turn (20,) [rad/s].
        home: Angles in which it is placed (20,) [rad].
    """

    name = "aibo_ers7"
    title = "Sony AIBO ERS-7"
    grade = "C"
    command_names = tuple(joint.name for joint in JOINTS)
    radius = 0.18
    height = 0.28
    max_twist = (0.42, 2.8)
    braking = 1.0
    limits = DriveLimits(max_speed=0.42, acceleration=0.4, deceleration=0.4)
    joint_limits: Array = np.radians([(joint.low, joint.high) for joint in JOINTS])
    joint_rates: Array = np.array([joint.rate for joint in JOINTS])
    home: Array = np.radians([joint.home for joint in JOINTS])

    def __init__(self, motion: Motion | None = None):
        """Choose what commands are.

        Args:
            motion: Engine that takes commands of its own; without one they are joint angles.

        Raises:
            InvalidInputError: The engine's limits do not go with its names, or leave out zero.
        """
        self.motion = motion
        self._bounds = self.joint_limits
        self.idle = tuple(self.home.tolist())
        if motion is not None:
            self.command_names = tuple(motion.command_names)
            self._bounds = np.array(motion.command_limits, dtype=np.float64)
            self.idle = ()
            if (
                self._bounds.shape != (len(self.command_names), 2)
                or not ((self._bounds[:, 0] <= 0) & (self._bounds[:, 1] >= 0)).all()
            ):
                raise InvalidInputError(
                    f"command_limits of {type(motion).__name__} must be a lowest value <= 0 and a "
                    f"highest >= 0 for each of {', '.join(self.command_names)}"
                )

    def model(self, number: int, team: str) -> "mujoco.MjSpec":
        """Model of one robot in its team's colour, with its number on the rump."""
        import mujoco

        spec = mujoco.MjSpec.from_file(str(model_path(self.name)))
        for key in list(spec.keys):
            spec.delete(key)
        spec.material("team").rgba = TEAM_COLOURS[team]
        draw_digit(spec.site("back"), spec.body("base"), number % 10, height=0.03)
        return spec

    def bind(self, model: "mujoco.MjModel", prefixes: Sequence[str]) -> Drive:
        """Drive of the robots attached under ``prefixes``."""
        return JointServos(
            model,
            prefixes,
            joints=[joint.name for joint in JOINTS],
            rates=self.joint_rates,
            home=self.home,
            frame=FRAME,
            motion=None if self.motion is None else self.motion.bind(len(prefixes)),
        )

    def default_sensors(self) -> "dict[str, Sensor]":
        """None: mount what is needed."""
        return {}

    @property
    def always_allowed(self) -> float:
        """Below nothing: joints' ranges are not all around zero."""
        return -1.0

    def clamp(self, command: Array) -> Array:
        """Clip each column of commands (n, c) to its own range."""
        clipped = np.clip(command, self._bounds[:, 0], self._bounds[:, 1])
        return command if (clipped == command).all() else clipped

    def twist_of(self, command: Array) -> Array:
        """Not told by commands of a legged robot.

        Raises:
            InvalidInputError: Always; kinematic runs need it.
        """
        raise InvalidInputError(
            "the AIBO has legs: where it goes is what contacts make of it; use Simulation, not "
            "KinematicSimulation"
        )

    def brake(self, twist: Array, period: float) -> Array:
        """Next cycle's command of an emergency stop: an engine's zero, or joints as they are."""
        return twist if self.motion is None else np.zeros_like(twist)
