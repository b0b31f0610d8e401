"""What every platform offers: a model to attach, a drive to bind, limits of its commands."""

import itertools
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import mujoco

    from mjmr.sensors.base import Sensor
    from mjmr.world import World

Array = NDArray[np.float64]
FLOOR = "floor"  # name of every world's floor geom


@dataclass(frozen=True, kw_only=True)
class DriveLimits:
    """What a drive follows in every direction of travel; what a planner may plan with.

    Attributes:
        max_speed: [m/s].
        acceleration: Bound while speed grows [m/s^2].
        deceleration: Bound while speed falls [m/s^2].
    """

    max_speed: float
    acceleration: float
    deceleration: float


class Drive(Protocol):
    """The actuators of n robots in one compiled model, as arrays."""

    def place(self, data: "mujoco.MjData", poses: Array) -> None:
        """Put the robots at rest at poses (n, 3), world frame; before a run, never inside one."""
        ...

    def poses(self, data: "mujoco.MjData") -> Array:
        """Poses (n, 3), world frame, yaw in (-pi, pi]; a new array."""
        ...

    def twists(self, data: "mujoco.MjData") -> Array:
        """Twists (n, 3): forward, left [m/s] and anticlockwise [rad/s], body frame; a new array."""
        ...

    def ramp(self, data: "mujoco.MjData", start: Array, target: Array, period: float) -> None:
        """Set the actuators for one period, from command ``start`` to ``target``, (n, c)."""
        ...


@runtime_checkable
class TiltedDrive(Protocol):
    """What a drive has besides if its robots can tilt or leave the floor."""

    def base_poses(self, data: "mujoco.MjData") -> Array:
        """Poses of the base bodies (n, 7), world frame: position [m], quaternion (w, x, y, z)."""
        ...


@runtime_checkable
class FramedDrive(Protocol):
    """What a drive has besides if its firmware runs at a frame rate of its own.

    Attributes:
        frame: Between two calls of :meth:`servo` [s].
    """

    frame: float

    def servo(self, data: "mujoco.MjData", time: float) -> None:
        """Set the actuators for one frame, which begins at ``time`` [s].

        Called at every ``k * frame``, or the first physics step after it; at the start of a control
        period after ``ramp``, which only has to store what it was given.
        """
        ...

    def state(self) -> Any:
        """What the firmware remembers, for snapshots; a copy."""
        ...

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        ...


@runtime_checkable
class CheckedDrive(Protocol):
    """What a drive has besides if its model can fail without MuJoCo's noticing."""

    def check(self, data: "mujoco.MjData") -> str | None:
        """Why the state that a control period ended in is wrong, in one phrase; None if it isn't.

        Called after every control period; what it returns ends the trial as diverged.
        """
        ...


class Platform(ABC):
    """A kind of robot.

    Commands are what the real robot takes; ``command_names`` says what their columns are. A robot
    that can drive in any direction takes twists: forward and left [m/s], anticlockwise [rad/s],
    body frame.

    Attributes:
        name: Used for body names: ``soccer_bot0/base``.
        title: Maker and product.
        grade: Of the model against its source, A, B or C; see the README beside the model.
        command_names: Of the columns of a command, in order.
        idle: Command in force until the first one; zeros if empty.
        radius: Of the smallest upright cylinder around the body [m].
        height: Of the same cylinder [m].
        max_twist: Largest speed in the plane [m/s] and yaw rate [rad/s] that a command can ask for.
        braking: Deceleration of the robot's own emergency stop [m/s^2].
        limits: What its drive follows; measured, see the platform.
        wheels: Names of the wheels that encoders can count, in order.
        anchored: Whether part of the robot is fixed in the world: its model is attached where it
            was put, and the drive moves what can move. Others are attached at the origin.
    """

    name: str
    title: str
    grade: str
    command_names: tuple[str, ...] = ("forward", "left", "turn")
    idle: tuple[float, ...] = ()
    radius: float
    height: float
    max_twist: tuple[float, float]
    braking: float
    limits: DriveLimits
    wheels: tuple[str, ...] = ()
    anchored: bool = False

    def starts(self, poses: Array) -> Array:
        """Poses (n, 3) at which robots start that are put at ``poses``; by default the same."""
        return poses

    def heights(self, poses: Array, sites: Array) -> Array:
        """Heights (n,) [m] of the bases of robots put at ``sites`` (n, 3), for kinematic runs."""
        return np.zeros(len(poses))

    def check_site(  # noqa: B027
        self, world: "World", poses: Array, names: Sequence[str]
    ) -> None:
        """Refuse a world in which robots put at ``poses`` (n, 3) cannot stand.

        Called when they are added, after their starts were checked against the walls; by default
        there is nothing more to check.

        Args:
            world: What they are added to.
            poses: Where they are put.
            names: Of the robots.
        """

    @abstractmethod
    def model(self, number: int, team: str) -> "mujoco.MjSpec":
        """Model of one robot, marked with its number and its team's colour."""

    def finish(self, spec: "mujoco.MjSpec", prefixes: Sequence[str]) -> None:  # noqa: B027
        """Add what needs both the robots and the world, once all of a group are attached.

        Called while the world is built, when the floor (geom ``FLOOR``) and the robots under
        ``prefixes`` are in ``spec``. Does nothing unless a platform has something to add, such as
        contact pairs of wheels and floor.
        """

    @abstractmethod
    def bind(self, model: "mujoco.MjModel", prefixes: Sequence[str]) -> Drive:
        """Drive of the robots attached under ``prefixes``."""

    @abstractmethod
    def default_sensors(self) -> "dict[str, Sensor]":
        """Sensors every robot of this platform has unless others are mounted in their place."""

    @property
    def always_allowed(self) -> float:
        """A command none of whose entries is above this needs no clamping."""
        # neither the speed nor the yaw rate can then be over its limit
        return min(self.max_twist[0] / 2**0.5, self.max_twist[1])

    @property
    def command_bounds(self) -> Array:
        """Least and largest value of each column of a command (2, c) that :meth:`clamp` lets pass.

        Of columns that limit each other only some combinations pass; here they are asked for alone
        and in pairs.
        """
        large, columns = 2.0**20, len(self.command_names)
        asked = []
        for i, j in itertools.combinations_with_replacement(range(columns), 2):
            for a, b in itertools.product((-large, large), repeat=2):
                asked.append(np.zeros(columns))
                asked[-1][[i, j]] = a, b
        passed = self.clamp(np.array(asked))
        bounds = np.array([passed.min(axis=0), passed.max(axis=0)]) + 0.0  # no -0
        return np.where(np.abs(bounds) < large, bounds, np.copysign(np.inf, bounds))

    def twist_of(self, command: Array) -> Array:
        """Twists (n, 3) that commands (n, c) ask for, body frame; may be the argument itself."""
        return command

    def mistuned(self, command: Array) -> Array:
        """Commands (n, c) that exact servos would need to do what these do with ``command``.

        By default servos are exact, and it is the argument itself. Simulations apply it to the set
        points; telemetry and traces show what was commanded.
        """
        return command

    def pace_of(self, command: Array) -> Array:
        """Speeds (n, 3) that ``wheel_turns`` needs the integrals of; by default the twists."""
        return self.twist_of(command)

    def wheel_turns(self, way: Array) -> Array:
        """Angles [rad] of ``wheels`` (n, k) by rolling without slip, for kinematic runs.

        Args:
            way: Integrals of :meth:`pace_of` (n, 3); of twists [m, m, rad], body frame.
        """
        return np.zeros((len(way), 0))

    def slew(self, current: Array, target: Array, period: float) -> Array:
        """Commands (n, c) the base gets to in one period from ``current``; its own limits.

        By default it follows any command within a period.
        """
        return target

    def clamp(self, command: Array) -> Array:
        """Scale commands (n, 3) into ``max_twist``; returns the argument when nothing is over."""
        speed, rate = self.max_twist
        planar = np.hypot(command[:, 0], command[:, 1])
        over = planar > speed
        turn_over = np.abs(command[:, 2]) > rate
        if not (over.any() or turn_over.any()):
            return command
        clamped = command.copy()
        clamped[over, :2] *= (speed / planar[over])[:, None]
        clamped[:, 2] = np.clip(clamped[:, 2], -rate, rate)
        return clamped

    def brake(self, twist: Array, period: float) -> Array:
        """Next cycle's twist of an emergency stop; (n, 3) -> (n, 3).

        The speed falls by ``braking * period`` along its own direction, to zero in the last cycle;
        the yaw rate falls as if it were carried at the radius of the body.
        """
        speed = np.hypot(twist[:, 0], twist[:, 1])
        step = self.braking * period
        keep = np.maximum(0.0, 1.0 - step / np.maximum(speed, 1e-300))
        rate = twist[:, 2]
        slower = np.sign(rate) * np.maximum(0.0, np.abs(rate) - step / self.radius)
        return np.column_stack([twist[:, :2] * keep[:, None], slower])
