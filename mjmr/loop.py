"""The loop both simulations share: control ticks, due sensors, observers, guarded truth."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError, LiftError, TruthError
from mjmr.lift import check_lift
from mjmr.notes import check_note
from mjmr.randomness import Streams
from mjmr.sensors.base import Actuated
from mjmr.team import Team
from mjmr.watch import announce

if TYPE_CHECKING:
    from mjmr.bus import Bus
    from mjmr.byte_radio import ByteRadio
    from mjmr.group import Group
    from mjmr.radio import Radio
    from mjmr.sensors.base import Sensor
    from mjmr.sensors.ray_scene import RayScene
    from mjmr.sensors.studio import Studio
    from mjmr.world import World

Array = NDArray[np.float64]


class Truth:
    """What really is: for metrics and films, never for a controller.

    Every read raises :class:`TruthError` while a controller is to act, that is inside the body of
    ``for t in simulation.ticks(...)``; an observer is called outside of it.
    """

    def __init__(self, simulation: "TickedSimulation"):
        self._simulation = simulation

    def poses(self, group: "Group") -> Array:
        """True poses of a group, shape (n, 3) [m, m, rad], world frame."""
        self._guard()
        return self._simulation.poses_of(group)

    def twists(self, group: "Group") -> Array:
        """True twists of a group, shape (n, 3) [m/s, m/s, rad/s], body frame."""
        self._guard()
        return self._simulation.twists_of(group)

    def movers(self) -> Array:
        """True poses of the props that can move, shape (k, 7): position [m], quaternion (wxyz)."""
        self._guard()
        return self._simulation.mover_poses()

    def carts(self) -> Array:
        """The carts as boxes, shape (k, 5): x, y, yaw, half-length, half-width [m, rad]."""
        self._guard()
        return self._simulation.cart_boxes()

    def _guard(self) -> None:
        if self._simulation.acting:
            raise TruthError(
                "truth cannot be read while a controller is to act; read a sensor, or register "
                "an observer"
            )


@dataclass(frozen=True)
class Snapshot:
    """State of a simulation at one instant; opaque, bit-exact when put back.

    Attributes:
        time: Simulated seconds.
        step: Physics steps since the start.
        physics: State of the physics.
        parts: States of groups and sensors.
    """

    time: float
    step: int
    physics: Any
    parts: tuple[Any, ...]


class TickedSimulation(ABC):
    """Base of :class:`Simulation` and :class:`KinematicSimulation`.

    Attributes:
        world: What is simulated.
        team: Every robot of the world, in the groups' order.
        control_period: Between two ticks [s].
        timestep: Of the physics [s]: control_period divided by a whole number.
        substeps: That whole number.
        step: Physics steps since the start.
        truth: What really is; guarded.
        streams: The trial's random streams, by name.
        acting: True while the body of a ``ticks`` loop runs.
        noted: True if somebody keeps what :meth:`note` says; saves computing it otherwise.
        notes: What was noted last; see :meth:`note`.
        caption: Returns a line of text for films; it may read truth.
        diverged: True once the physics has left the plausible range.
        actuated: Sensors that move parts of the robots.
        radios: By name, in the order they were set up.
        buses: In the order they were set up; part of snapshots.
        message_followers: Called by radios with every message: when sent [s], when delivered (k,)
            [s] or NaN, sender, receivers (k,), bytes. For traces.
        lift_followers: Called with every :meth:`lift`: robots' indices in the team (k,), poses
            (k, 3).
    """

    def __init__(
        self, world: "World", *, seed: int, control_period: float, dt_max: float, substeps: int = 0
    ):
        if not (0 < control_period < math.inf and 0 < dt_max < math.inf):
            raise InvalidInputError(
                f"control_period and dt_max must be positive and finite; got {control_period} and "
                f"{dt_max} s"
            )
        if not world.groups:
            raise InvalidInputError("the world has no robots; add a group first")
        self.world = world
        self.team = Team(world.groups)
        self.control_period = float(control_period)
        self.substeps = substeps or math.ceil(control_period / dt_max - 1e-9)
        self.timestep = self.control_period / self.substeps
        self.step = 0
        self.streams = Streams(seed)
        self.truth = Truth(self)
        self.acting = False
        self.noted = False
        self.notes: dict[str, Array] = {}
        self.caption: Callable[[], str] = str
        self.diverged = False
        self.actuated: list[Actuated] = []
        self.radios: dict[str, Radio | ByteRadio] = {}
        self.buses: list[Bus] = []
        self.message_followers: list[Callable[[float, Array, int, Any, int], None]] = []
        self.lift_followers: list[Callable[[Any, Array], None]] = []
        self._observers: list[Callable[[], None]] = []
        self._started = False
        self._studio: Studio | None = None
        self._rays: RayScene | None = None

    def _bind(self) -> None:
        """Take the groups and their sensors; called at the end of a subclass's __init__."""
        self.world.simulation = self
        for group in self.world.groups:
            group.reset()
            for name, sensor in group.sensors.items():
                sensor.bind(self, group, f"{group.name}/{name}")
        for name, sensor in self.world.sensors.items():
            sensor.bind(self, None, f"world/{name}")
        self._sensors: list[Sensor] = [s for g in self.world.groups for s in g.sensors.values()]
        self._sensors.extend(self.world.sensors.values())
        self.actuated.extend(s for s in self._sensors if isinstance(s, Actuated))
        announce(self)

    def note(self, **arrays: ArrayLike) -> None:
        """Say what films and traces shall show from now on; free when nobody keeps it.

        Args:
            arrays: ``goals`` (rings), ``waypoints`` (the path to the goal leads through them) and
                ``stops`` (where the planned command followed by braking ends), each of shape
                (n, 2) over the team [m], world frame; ``links`` (n, n), lines from robot to robot
                where above 0; ``points`` (k, 2), marks anywhere. NaN rows are not drawn.

        Raises:
            UnknownNameError: Another name.
            InvalidInputError: Another shape.
        """
        if not self.noted:
            return
        fresh = dict(self.notes)
        for key, value in arrays.items():
            fresh[key] = check_note(key, value, self.team.n)
        self.notes = fresh

    def add_radio(self, radio: "Radio | ByteRadio") -> None:
        """Make a radio part of snapshots; it calls this itself.

        Raises:
            InvalidInputError: There is one of that name already.
        """
        if radio.name in self.radios:
            raise InvalidInputError(
                f"this simulation has a radio named {radio.name!r} already; name the other one"
            )
        self.radios[radio.name] = radio

    @property
    def time(self) -> float:
        """Simulated seconds since the start."""
        return self.step * self.timestep

    @property
    def studio(self) -> "Studio":
        """Where this simulation's cameras take their pictures; made when first used."""
        if self._studio is None:
            from mjmr.sensors.studio import Studio

            self._studio = Studio(self)
        return self._studio

    @property
    def rays(self) -> "RayScene":
        """Where this simulation's ray-based sensors cast their rays; made when first used."""
        if self._rays is None:
            from mjmr.sensors.ray_scene import RayScene

            self._rays = RayScene(self)
        return self._rays

    def close(self) -> None:
        """Free the GL contexts of cameras; the next picture opens new ones.

        A simulation nobody holds any more does so by itself, when Python's collector gets to it.
        """
        if self._studio is not None:
            self._studio.close()

    def rng(self, name: str) -> np.random.Generator:
        """A fresh generator of the trial's stream called ``name``."""
        return self.streams.generator(name)

    def steps_until(self, time: float) -> int:
        """First physics step at or after ``time`` [s]."""
        return math.ceil(time / self.timestep - 1e-9)

    def observe(self, observer: Callable[[], None]) -> None:
        """Call ``observer`` at the start and after every control period; it may read truth."""
        self._observers.append(observer)

    def lift(self, group: "Group", rows: ArrayLike, poses: ArrayLike) -> None:
        """Pick robots up and put them down elsewhere, at rest, as an operator does by hand.

        For observers, and between two calls of :meth:`ticks`: a controller cannot do it. What the
        robots were commanded is forgotten; their sensors and radios go on, wheels keep the angles
        they had. Traces have every lift.

        Args:
            group: Whose robots.
            rows: Their indices in the group (k,).
            poses: Where to (k, 3) [m, m, rad], world frame, within the walls.

        Raises:
            LiftError: It is called while a controller is to act.
            InvalidInputError: No such robots, poses that cannot be, or a place that is not free
                (says what is there); then nothing was moved.
        """
        if self.acting:
            raise LiftError(
                "robots cannot be lifted while a controller is to act; lift them in an observer, "
                "or between two runs of ticks"
            )
        which, where = check_lift(group, rows, poses)
        if not len(which):
            return
        self.world.check_inside(group, which, where, "are put down")
        self._lift(group, which, where)
        group.halt(which)
        first = self.team.rows(group).start
        for follow in self.lift_followers:
            follow(first + which, where)

    def ticks(self, duration: float) -> Iterator[float]:
        """Run for ``duration`` [s]; yields the time [s] at every control instant.

        The physics advances between ticks, under the commands given inside the body. Every sensor
        is sampled at its own instants on the way. Can be called again to go on.

        Raises:
            SimulationDivergedError: The physics left the plausible range.
            InvalidInputError: A duration that is negative or not finite, or another simulation has
                taken this world's robots since.
        """
        if not (math.isfinite(duration) and duration >= 0):
            raise InvalidInputError(f"a duration is finite and 0 or more; got {duration} s")
        if self.world.simulation is not self:
            raise InvalidInputError(
                "another simulation has taken this world's robots; build a world for each"
            )
        count = round(duration / self.control_period)
        observers = self._observers
        # at the start, or after a restore to before it
        self._sample_due()
        if not self._started:
            self._started = True
            for observe in observers:
                observe()
        for _ in range(count):
            self.acting = True
            try:
                yield self.step * self.timestep
            finally:
                self.acting = False
            self._begin_period()
            end = self.step + self.substeps
            while self.step < end:
                stop = end
                for sensor in self._sensors:
                    if sensor.due_step < stop:
                        stop = sensor.due_step
                self._advance(stop - self.step)
                self.step = stop
                self._sample_due()
            self._end_period()
            for observe in observers:
                observe()

    def _sample_due(self) -> None:
        step = self.step
        for sensor in self._sensors:
            if sensor.due_step <= step:
                sensor.capture(step, step * self.timestep)

    def snapshot(self) -> Snapshot:
        """State now; :meth:`restore` puts it back bit for bit.

        Observers keep their own state and are not part of it.
        """
        parts = tuple(owner.state() for owner in self._owners())
        return Snapshot(self.time, self.step, self._physics_state(), parts)

    def restore(self, snapshot: Snapshot) -> None:
        """Go back (or forward) to ``snapshot``, taken in a simulation of the same world.

        Raises:
            InvalidInputError: It has other groups, sensors, radios or buses.
        """
        if len(snapshot.parts) != len(self._owners()):
            raise InvalidInputError(
                "this snapshot was taken with other groups, sensors, radios or buses; set up the "
                "same before restoring it"
            )
        self.step = snapshot.step
        self._set_physics_state(snapshot.physics)
        for owner, state in zip(self._owners(), snapshot.parts, strict=True):
            owner.set_state(state)

    def _owners(self) -> Sequence[Any]:
        """Who has a state besides the physics, in the order of a snapshot's parts."""
        return [*self.world.groups, *self._sensors, *self.radios.values(), *self.buses]

    @abstractmethod
    def poses_of(self, group: "Group") -> Array:
        """True poses (n, 3), a new array; for sensors and :class:`Truth`."""

    @abstractmethod
    def twists_of(self, group: "Group") -> Array:
        """True twists (n, 3), body frame, a new array; for sensors and :class:`Truth`."""

    def base_poses_of(self, group: "Group") -> Array:
        """True poses of the base bodies (n, 7), a new array; for sensors.

        Position [m] and quaternion (w, x, y, z), world frame: with height and tilt.
        """
        poses = self.poses_of(group)
        half, nil = poses[:, 2] / 2.0, np.zeros(len(poses))
        z = group.platform.heights(poses, group.sites)
        return np.column_stack([poses[:, :2], z, np.cos(half), nil, nil, np.sin(half)])

    @abstractmethod
    def wheel_angles_of(self, group: "Group") -> Array:
        """Angles of the wheels that encoders count (n, k) [rad], a new array; for sensors."""

    @abstractmethod
    def cart_boxes(self) -> Array:
        """Carts as boxes (k, 5), a new array; for sensors and :class:`Truth`."""

    @abstractmethod
    def mover_poses(self) -> Array:
        """Poses (k, 7) of the props that can move."""

    def full_positions(self) -> Array | None:
        """Every coordinate of the physics (nq,), a copy; None if there is none but the poses."""
        return None

    def moved_parts(self) -> tuple[Any, ...]:
        """Where the parts are that sensors move, in the order of ``actuated``."""
        return tuple(sensor.observe(self.time) for sensor in self.actuated)

    @abstractmethod
    def visible_state(self) -> Any:
        """What a picture of this instant is made from; copies. See :class:`Studio`."""

    @abstractmethod
    def _lift(self, group: "Group", rows: Any, poses: Array) -> None:
        """Put robots ``rows`` (k,) down at rest at ``poses`` (k, 3), or move nothing and raise."""

    @abstractmethod
    def _begin_period(self) -> None: ...

    @abstractmethod
    def _advance(self, steps: int) -> None: ...

    @abstractmethod
    def _end_period(self) -> None:
        """Check the state that the period ended in."""

    @abstractmethod
    def _physics_state(self) -> Array: ...

    @abstractmethod
    def _set_physics_state(self, state: Array) -> None: ...
