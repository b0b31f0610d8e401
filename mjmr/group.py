"""Group: n robots of one platform as arrays."""

from collections import deque
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError, UnknownNameError, UnknownSensorError
from mjmr.faults import FaultSchedule
from mjmr.robots.markings import TEAM_COLOURS

if TYPE_CHECKING:
    import mujoco

    from mjmr.robots.platform import Platform
    from mjmr.sensors.base import Sensor
    from mjmr.world import World

Array = NDArray[np.float64]


class Group:
    """n robots of one platform; every array has the leading axis n.

    Attributes:
        n: Number of robots.
        platform: What they are.
        start: Start poses (n, 3) [m, m, rad], world frame.
        sites: Where the robots were put (n, 3); other than ``start`` for anchored ones only.
        names: ``name0 ...``.
        faults: What goes wrong, and when.
        clamped: Commands scaled down to the platform's limits so far, shape (n,).
    """

    def __init__(
        self,
        platform: "Platform",
        poses: ArrayLike,
        *,
        name: str,
        team: str = "yellow",
        first_number: int = 0,
        command_latency: int = 0,
    ):
        """Declare the group; :meth:`mjmr.world.World.add_group` calls this.

        Args:
            platform: The platform.
            poses: Start poses, shape (n, 3).
            name: Prefix of the robots' names.
            team: One of the team colours.
            first_number: Number painted on the first robot.
            command_latency: Control periods between :meth:`drive` and the drive's obeying.

        Raises:
            InvalidInputError: Poses of another shape or not finite, or a negative latency.
            UnknownNameError: Unknown team.
        """
        start = _start(poses)
        if command_latency < 0 or command_latency != int(command_latency):
            raise InvalidInputError(
                f"command_latency counts control periods, 0 or more; got {command_latency}"
            )
        if team not in TEAM_COLOURS:
            raise UnknownNameError("team", team, TEAM_COLOURS)
        start.setflags(write=False)
        self.sites, start = start, platform.starts(start)
        start.setflags(write=False)
        self.platform, self.start, self.n, self.name = platform, start, len(start), name
        self.team, self.first_number = team, first_number
        self.command_latency = int(command_latency)
        self.names = tuple(f"{name}{i}" for i in range(self.n))
        self.faults = FaultSchedule(self.n)
        self._columns = len(platform.command_names)
        self._always_allowed = platform.always_allowed
        self._everyone = np.ones(self.n, dtype=bool)
        self._everyone.setflags(write=False)
        self.sensors: dict[str, Sensor] = {}
        self._replaceable: set[str] = set()
        for key, sensor in platform.default_sensors().items():
            self.mount(sensor, key)
        self._replaceable = set(self.sensors)
        self.reset()

    def reset(self) -> None:
        """Forget commands; called when a simulation takes the group."""
        self.clamped = np.zeros(self.n, dtype=np.int64)
        idle = self.platform.idle or np.zeros(self._columns)
        self._command = np.tile(idle, (self.n, 1))
        self._executed = self._command.copy()
        self._pending = deque([self._command] * self.command_latency)
        self._acknowledged = self._everyone

    def halt(self, rows: NDArray[np.int64]) -> None:
        """Forget what robots ``rows`` (k,) were commanded, as one does that is switched off and on.

        :meth:`mjmr.loop.TickedSimulation.lift` calls this.
        """
        idle = self.platform.idle or 0.0

        def without(command: Array) -> Array:
            fresh = command.copy()
            fresh[rows] = idle
            return fresh

        self._command, self._executed = without(self._command), without(self._executed)
        self._pending = deque(without(command) for command in self._pending)

    def start_at(self, poses: ArrayLike) -> None:
        """Start elsewhere in the next simulation; :meth:`mjmr.world.World.start_at` calls this.

        Raises:
            InvalidInputError: Poses of another shape or not finite, or a rig that cannot be moved.
        """
        start = _start(poses)
        if self.platform.anchored:
            raise InvalidInputError(
                f"{self.name}: a rig stands where its world was built; build another world"
            )
        if start.shape != self.start.shape:
            raise InvalidInputError(
                f"{self.name}: start poses must have shape ({self.n}, 3); got {start.shape}"
            )
        start.setflags(write=False)
        self.start = start

    def __getattr__(self, name: str) -> Any:
        """Refuse what is neither mounted nor an attribute.

        Raises:
            UnknownSensorError: Lists the sensors that are mounted.
        """
        sensors = self.__dict__.get("sensors", {})
        raise UnknownSensorError(f"sensor of {self.__dict__.get('name', 'a group')}", name, sensors)

    def mount(self, sensor: "Sensor", name: str | None = None) -> Any:
        """Mount a sensor on every robot and make it ``group.<name>``.

        A platform's default sensor of the same name is replaced.

        Args:
            sensor: The sensor, not mounted elsewhere.
            name: Default: the sensor's own name.

        Returns:
            The sensor.

        Raises:
            InvalidInputError: The name is taken, or the sensor is mounted already.
        """
        key = name or sensor.name
        if sensor.carrier is not None:
            raise InvalidInputError(
                f"this {sensor.name} is mounted on group {sensor.carrier.name!r} already; make "
                "another one"
            )
        if key not in self.sensors and (key in self.__dict__ or hasattr(type(self), key)):
            raise InvalidInputError(
                f"{key!r} is an attribute that every group has; mount the {sensor.name} under "
                "another name"
            )
        if key in self.sensors and (
            key not in self._replaceable or self.sensors[key].name != sensor.name
        ):
            raise InvalidInputError(
                f"group {self.name!r} has a sensor named {key!r} already; mount it under another "
                f"name than {', '.join(self.sensors)}"
            )
        self._replaceable.discard(key)
        sensor.carrier = self
        self.sensors[key] = sensor
        setattr(self, key, sensor)
        return sensor

    def drive(self, command: ArrayLike) -> None:
        """Radio a command to every robot; it holds until the next one.

        Each drive ramps linearly from its present command to this one over one control period.
        Commands over the platform's limits are scaled down and counted in ``clamped``.

        Args:
            command: Shape (n, c), what the platform takes (:attr:`Platform.command_names`); of a
                robot that drives in any direction twists (n, 3): forward and left [m/s],
                anticlockwise [rad/s], body frame.

        Raises:
            InvalidInputError: Another shape, or NaN or infinity (names the robots).
        """
        twist = np.array(command, dtype=np.float64)
        if twist.shape != (self.n, self._columns):
            raise InvalidInputError(
                f"{self.name}: a command must have shape ({self.n}, {self._columns}) "
                f"({', '.join(self.platform.command_names)}); got {twist.shape}"
            )
        largest = float(np.abs(twist).max())
        if not largest < np.inf:
            bad = np.flatnonzero(~np.isfinite(twist).all(axis=1))
            names = ", ".join(self.names[i] for i in bad)
            raise InvalidInputError(f"a command must be finite; it is not for {names}")
        if largest > self._always_allowed:
            allowed = self.platform.clamp(twist)
            if allowed is not twist:
                self.clamped += (allowed != twist).any(axis=1)
                twist = allowed
        self._command = twist

    @property
    def command(self) -> Array:
        """The command in force, (n, c), scaled down to the limits; read-only."""
        view = self._command.view()
        view.setflags(write=False)
        return view

    @property
    def executed(self) -> Array:
        """Command the drives' set points have reached, (n, c): telemetry.

        It is what a robot's firmware tries to do, not what the robot does: one pressed against a
        wall still reports its set point.
        """
        view = self._executed.view()
        view.setflags(write=False)
        return view

    @property
    def acknowledged(self) -> NDArray[np.bool_]:
        """Robots that acknowledge the command of the period just over, (n,): telemetry."""
        return self._acknowledged

    def stopping(self, time: float) -> NDArray[np.bool_]:
        """Robots whose telemetry says at ``time`` [s] that they stop by themselves, shape (n,)."""
        return self.faults.announced(time)

    def next_ramp(self, time: float, period: float) -> tuple[Array, Array]:
        """Start and end of the ramp of the control period that begins at ``time``; for simulations.

        Returns:
            Two commands (n, c); latency, the base's limits and faults applied.
        """
        target = self._command
        if self.command_latency:
            self._pending.append(target)
            target = self._pending.popleft()
        target = self.platform.slew(self._executed, target, period)
        braked = self.faults.braked(time)
        self._acknowledged = self._everyone if braked is None else ~braked
        if braked is not None:
            stop = self.platform.brake(self._executed, period)
            target = np.where(braked[:, None], stop, target)
        start, self._executed = self._executed, target
        return start, target

    def state(self) -> tuple[Any, ...]:
        """What :meth:`next_ramp` depends on, for snapshots."""
        pending, clamped = tuple(self._pending), self.clamped.copy()
        return self._command, self._executed, pending, clamped, self._acknowledged

    def set_state(self, state: tuple[Any, ...]) -> None:
        """Put back what :meth:`state` returned."""
        self._command, self._executed, pending, clamped, self._acknowledged = state
        self._pending, self.clamped = deque(pending), clamped.copy()

    def add_to(self, spec: "mujoco.MjSpec") -> None:
        """Attach every robot to ``spec`` under the prefix ``name<i>/``."""
        for i in range(self.n):
            robot = self.platform.model(self.first_number + i, self.team)
            frame = spec.worldbody.add_frame()
            if self.platform.anchored:
                x, y, yaw = self.sites[i]
                frame.pos, frame.quat = [x, y, 0], [np.cos(yaw / 2), 0, 0, np.sin(yaw / 2)]
            spec.attach(robot, prefix=f"{self.names[i]}/", frame=frame)
        for key, sensor in self.sensors.items():
            sensor.add_to(spec, self.prefixes, key)
        self.platform.finish(spec, self.prefixes)

    def check_site(self, world: "World") -> None:
        """Refuse a world in which the robots cannot stand; :meth:`World.add_group` calls this."""
        self.platform.check_site(world, self.sites, self.names)

    @property
    def prefixes(self) -> list[str]:
        """MJCF name prefixes of the robots."""
        return [f"{name}/" for name in self.names]


def _start(poses: ArrayLike) -> Array:
    """Start poses, checked; a copy."""
    start = np.array(poses, dtype=np.float64)
    if start.ndim != 2 or start.shape[1] != 3 or not len(start):
        raise InvalidInputError(f"poses must have shape (n, 3), n >= 1; got {start.shape}")
    if not np.isfinite(start).all():
        raise InvalidInputError("poses must be finite")
    return start
