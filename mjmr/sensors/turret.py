"""Turret: turns the camera on every robot about the vertical, round and round."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.geometry import wrap_angle
from mjmr.jit import njit
from mjmr.sensors.aim import aimed_angles
from mjmr.sensors.base import Sensor

if TYPE_CHECKING:
    import mujoco

    from mjmr.group import Group

Array = NDArray[np.float64]


class Turret(Sensor):
    """A turret the robot has of its own: a hinge ``pan`` without ends and a servo of that name.

    It is aimed by :meth:`aim`, goes there by the shorter way and reads its own angle; pan is
    anticlockwise seen from above, 0 straight ahead. The servo's set point is the integral of a
    rate, within what the model's ``ctrlrange`` says the turret can do. In a kinematic simulation
    it moves exactly as fast as that.

    A unit that tilts too, or has ends, is a :class:`mjmr.sensors.pan_tilt.PanTilt`.
    """

    name = "turret"

    def __init__(
        self,
        *,
        joint: str = "pan",
        step: float = math.radians(0.1),
        rate: float = 30.0,
        latency: float = 0.0,
        phase: float = 0.0,
    ):
        """Set the schedule.

        Args:
            joint: Of the robot's model, and of its servo.
            step: Of the angles it reports [rad].
            rate: Reports of the angle a second [Hz].
            latency: Of the reports [s].
            phase: Instant of the first report [s].

        Raises:
            InvalidInputError: A step that is not positive.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        if not 0 < step < math.pi:
            raise InvalidInputError(f"step must lie between 0 and pi rad; got {step}")
        self._joint, self._step = joint, float(step)

    def aim(self, pan: ArrayLike) -> None:
        """Turn to an angle by the shorter way; it holds until the next call.

        The set point moves in a straight line over every control period.

        Args:
            pan: Shape (n,), or one for all [rad], anticlockwise from straight ahead.

        Raises:
            InvalidInputError: Another shape, NaN or infinity (names the robots), or no simulation.
        """
        self._in_simulation()
        self._goal = wrap_angle(aimed_angles(self._group, pan=pan)[:, 0])

    @property
    def aimed(self) -> Array:
        """Angles aimed at (n,) [rad], in (-pi, pi]; a copy."""
        self._in_simulation()
        return self._goal.copy()

    @property
    def top_rate(self) -> float:
        """At most [rad/s]."""
        self._in_simulation()
        return self._fastest

    def read(self) -> Array:
        """Newest angle delivered by now, shape (n,), in whole steps [rad], in about (-pi, pi].

        NaN before the first delivery.
        """
        return super().read()

    @property
    def reading_bounds(self) -> tuple[ArrayLike, ArrayLike]:
        """Least and largest angle that :meth:`read` can return [rad]."""
        return -math.pi - self._step / 2.0, math.pi + self._step / 2.0

    def add_to(self, spec: "mujoco.MjSpec", prefixes: Sequence[str], key: str) -> None:
        """Check that every robot has the turret.

        Raises:
            UnknownNameError: The model has no such hinge or servo; lists those there are.
        """
        for prefix in prefixes:
            for kind, elements in (("joint", spec.joints), ("actuator", spec.actuators)):
                own = [e.name.removeprefix(prefix) for e in elements if e.name.startswith(prefix)]
                if self._joint not in own:
                    raise UnknownNameError(f"{kind} of the robot's model", self._joint, own)

    def prepare(self, sequence: np.random.SeedSequence, group: "Group") -> None:
        """Look up hinges and servos; nothing is random."""
        simulation: Any = self._simulation
        self._data: Any = getattr(simulation, "data", None)
        model = simulation.studio.model if self._data is None else simulation.model
        names = [f"{prefix}{self._joint}" for prefix in group.prefixes]
        self._angles = np.array([model.joint(name).qposadr[0] for name in names])
        self._servos = np.array([model.actuator(name).id for name in names])
        self._points = model.actuator_actadr[self._servos]
        self._fastest = float(model.actuator_ctrlrange[self._servos[0], 1])
        self._goal = np.zeros(group.n)
        # of a kinematic simulation: angles, rates, and the instant they hold from
        self._motion = np.zeros(group.n), np.zeros(group.n), 0.0

    def actuate(self, data: "mujoco.MjData | None", period: float) -> None:
        """Let the set points go towards what was aimed at during the period that begins."""
        assert self._simulation is not None
        time = self._simulation.time
        if data is not None:
            _turn(
                data.act, data.ctrl, self._points, self._servos, self._goal, period, self._fastest
            )
            return
        at = self.observe(time)
        rates = np.clip(wrap_angle(self._goal - at) / period, -self._fastest, self._fastest)
        self._motion = at, rates, time

    def observe(self, time: float) -> Array:
        """Angles now (n,), turns counted."""
        if self._data is not None:
            return self._data.qpos[self._angles]
        angles, rates, since = self._motion
        return angles + rates * (time - since)

    def place(self, data: "mujoco.MjData", parts: Array) -> None:
        """Put the turrets at angles (n,), for pictures."""
        data.qpos[self._angles] = parts

    def compute(self, state: Any, number: int) -> Array:
        """Whole steps."""
        return np.round(wrap_angle(state) / self._step) * self._step + 0.0  # no -0

    def nothing(self) -> Array:
        """All NaN."""
        return np.full(self._group.n, np.nan)

    def state(self) -> Any:
        """What the turret remembers, for snapshots."""
        return super().state(), self._goal, self._motion

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        samples, self._goal, self._motion = state
        super().set_state(samples)

    def _in_simulation(self) -> None:
        if self._simulation is None:
            raise InvalidInputError(
                f"the {self.name} can be used once its group is in a simulation"
            )


@njit
def _turn(act, ctrl, points, servos, goal, period, fastest):
    """Rates (n,) of the servos' set points towards ``goal`` by the shorter way."""
    for i in range(goal.shape[0]):
        way = math.pi - (math.pi - (goal[i] - act[points[i]])) % (2.0 * math.pi)
        ctrl[servos[i]] = min(max(way / period, -fastest), fastest)
