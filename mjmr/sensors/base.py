"""The base of every sensor: schedule, latency, and samples computed at their first read."""

import math
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError, UnknownNameError

if TYPE_CHECKING:
    import mujoco

    from mjmr.group import Group
    from mjmr.loop import TickedSimulation


@dataclass(slots=True)
class _Sample:
    number: int
    time: float
    ready_step: int
    state: Any
    value: NDArray[Any] | None = None


@runtime_checkable
class Actuated(Protocol):
    """What a sensor has besides if it moves parts of the robot, as a pan-tilt unit does."""

    def actuate(self, data: "mujoco.MjData | None", period: float) -> None:
        """Set its actuators for the control period [s] that begins; called by simulations.

        ``data`` is None in a kinematic simulation.
        """
        ...

    def observe(self, time: float) -> Any:
        """Where its parts are at ``time`` [s], now; a copy."""
        ...

    def place(self, data: "mujoco.MjData", parts: Any) -> None:
        """Put its parts as :meth:`observe` told, for pictures of kinematic simulations."""
        ...


class Sensor(ABC):
    """A sensor on every robot of a group.

    Sample ``k`` is taken at ``phase + k / rate`` and can be read ``latency`` later. At its instant
    only the state it needs is stored; the sample itself is computed at its first read, from that
    state and from random numbers that depend on (sensor, robot, k) alone. So who reads, and how
    often, changes nothing.

    Attributes:
        stands: Whether it can stand in the world, without robots that carry it.
    """

    name = "sensor"
    stands = False

    def __init__(self, *, rate: float, latency: float = 0.0, phase: float = 0.0):
        """Set the schedule.

        Args:
            rate: Samples a second [Hz].
            latency: From a sample's instant to its delivery [s].
            phase: Instant of the first sample [s].

        Raises:
            InvalidInputError: A rate that is not positive, a latency or phase that is negative, or
                one that is not finite.
        """
        if not (rate > 0 and math.isfinite(rate)):
            raise InvalidInputError(f"a sensor's rate must be positive; got {rate} Hz")
        if not (0 <= latency < math.inf and 0 <= phase < math.inf):
            raise InvalidInputError(
                f"latency and phase must be 0 or more and finite; got {latency} s and {phase} s"
            )
        self.rate, self.latency, self.phase = float(rate), float(latency), float(phase)
        self.carrier: Group | None = None
        self._simulation: TickedSimulation | None = None
        self._listener: Callable[[_Sample], None] | None = None

    def bind(self, simulation: "TickedSimulation", group: "Group | None", stream: str) -> None:
        """Start afresh in ``simulation``; called once by it.

        Args:
            simulation: Whose time the schedule follows.
            group: The robots that carry the sensor; None for one that stands in the world.
            stream: Name of the sensor's random stream.

        Raises:
            InvalidInputError: It samples more often than physics steps.
        """
        if self.rate * simulation.timestep > 1.0 + 1e-9:
            raise InvalidInputError(
                f"the {self.name} of {stream} takes {self.rate:g} samples a second, which needs "
                f"timesteps of at most {1.0 / self.rate:g} s; they are {simulation.timestep:g} s: "
                "set dt_max"
            )
        self._simulation = simulation
        self._group: Any = group
        self._samples: deque[_Sample] = deque()
        self._next_number = 0
        self._listener = None
        self._latency_steps = simulation.steps_until(self.latency)
        self.due_step = simulation.steps_until(self.phase)
        self.prepare(simulation.streams.sequence(stream), group)

    def capture(self, step: int, time: float) -> None:
        """Store what the sample due now needs, and find the next due step; for simulations."""
        assert self._simulation is not None
        number = self._next_number
        state = self.observe(time)
        sample = _Sample(number, time, step + self._latency_steps, state)
        self._samples.append(sample)
        if self._listener is not None:
            self._listener(sample)
        self._next_number = number + 1
        self.due_step = max(
            step + 1, self._simulation.steps_until(self.phase + (number + 1) / self.rate)
        )
        # keep what is still on its way and the newest that has arrived
        while len(self._samples) > 1 and self._samples[1].ready_step <= step:
            self._samples.popleft()

    def read(self) -> NDArray[Any]:
        """Newest sample delivered by now; read-only.

        Raises:
            InvalidInputError: The group is in no simulation yet.
        """
        sample = self._newest()
        if sample is None:
            value = self.nothing()
        else:
            value = self._value(sample).view()
        value.setflags(write=False)
        return value

    def follow(
        self, hear: Callable[[int, float, float, Callable[[], NDArray[np.float64]]], None]
    ) -> None:
        """Call ``hear(number, sampled, delivered, value)`` at every sample to come; for traces.

        Instants are in seconds. ``value()`` computes the sample, which changes nothing for those
        who read it later.
        """
        simulation = self._simulation
        assert simulation is not None

        def listen(sample: _Sample) -> None:
            delivered = sample.ready_step * simulation.timestep
            hear(sample.number, sample.time, delivered, lambda: self._value(sample))

        self._listener = listen

    @property
    def reading_bounds(self) -> tuple[ArrayLike, ArrayLike]:
        """Least and largest value :meth:`read` can return; they broadcast to a reading's shape.

        Without bounds unless a sensor knows better. NaN, where a sensor delivers it, is neither.
        """
        return -np.inf, np.inf

    @property
    def sampled_at(self) -> float:
        """Instant of the sample :meth:`read` returns [s]; NaN before the first delivery."""
        sample = self._newest()
        return math.nan if sample is None else sample.time

    def state(self) -> Any:
        """What the sensor remembers, for snapshots."""
        copies = tuple(_Sample(s.number, s.time, s.ready_step, s.state) for s in self._samples)
        return copies, self._next_number, self.due_step

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        copies, self._next_number, self.due_step = state
        self._samples = deque(_Sample(s.number, s.time, s.ready_step, s.state) for s in copies)

    def add_to(  # noqa: B027
        self, spec: "mujoco.MjSpec", prefixes: Sequence[str], key: str
    ) -> None:
        """Add what the sensor needs to a model under construction; by default nothing.

        Args:
            spec: The world's, with every robot attached.
            prefixes: MJCF name prefixes of the robots that carry it; one empty prefix for a sensor
                that stands in the world.
            key: Name it is mounted under.
        """

    @abstractmethod
    def prepare(self, sequence: np.random.SeedSequence, group: Any) -> None:
        """Set up random streams and indices; ``group`` is what :meth:`bind` was given."""

    @abstractmethod
    def observe(self, time: float) -> Any:
        """State of the world that a sample taken now needs; copies, never views."""

    @abstractmethod
    def compute(self, state: Any, number: int) -> NDArray[Any]:
        """The sample, from what :meth:`observe` stored and its number."""

    @abstractmethod
    def nothing(self) -> NDArray[Any]:
        """What is read before the first delivery."""

    def _value(self, sample: _Sample) -> NDArray[np.float64]:
        if sample.value is None:
            sample.value = self.compute(sample.state, sample.number)
        return sample.value

    def _newest(self) -> _Sample | None:
        if self._simulation is None:
            raise InvalidInputError(
                f"the {self.name} can be read once its group is in a simulation"
            )
        now, found = self._simulation.step, None
        for sample in self._samples:
            if sample.ready_step > now:
                break
            found = sample
        return found


def carrier_body(spec: "mujoco.MjSpec", prefix: str, body: str = "") -> Any:
    """The body called ``body`` of the robot with this prefix, or its first one.

    Args:
        spec: With every robot attached.
        prefix: MJCF name prefix of the robot; empty for the world itself.
        body: Name in the robot's own model.

    Raises:
        UnknownNameError: No such body; lists the robot's.
    """
    if not prefix:
        return spec.worldbody
    own = [b for b in spec.bodies if b.name.startswith(prefix)]
    for candidate in own:
        if not body or candidate.name == prefix + body:
            return candidate
    raise UnknownNameError("body of the robot", body, [b.name.removeprefix(prefix) for b in own])


def physics_of(sensor: Sensor, group: "Group") -> Any:
    """The :class:`mjmr.simulation.Simulation` of a sensor that feels forces; from ``prepare``.

    Raises:
        InvalidInputError: It is in a kinematic simulation, in which there are none.
    """
    simulation: Any = sensor._simulation
    if not hasattr(simulation, "model"):
        raise InvalidInputError(
            f"{group.name} cannot carry a sensor of kind {sensor.name!r} in a "
            f"{type(simulation).__name__}, which knows no forces and no joints; use Simulation"
        )
    return simulation


def check_errors(**deviations: float) -> None:
    """Check standard deviations and the like, given by name.

    Raises:
        InvalidInputError: One is negative or not finite.
    """
    for name, value in deviations.items():
        if not 0 <= value < math.inf:
            raise InvalidInputError(f"{name} must be 0 or more and finite; got {value}")
