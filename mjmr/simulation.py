"""Simulation: a World in MuJoCo, advanced between the ticks of a control loop."""

import copy
import math
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from mjmr.cart_servos import CartServos
from mjmr.errors import InvalidInputError, SimulationDivergedError
from mjmr.guard import plausible
from mjmr.last_second import LastSecond
from mjmr.lift import Lifter
from mjmr.loop import Snapshot, TickedSimulation
from mjmr.pillar import Pillars
from mjmr.prop_places import PropPlaces
from mjmr.robots.platform import CheckedDrive, FramedDrive, TiltedDrive
from mjmr.start_check import check_start, overlaps

if TYPE_CHECKING:
    from mjmr.group import Group
    from mjmr.world import World

Array = NDArray[np.float64]
_STATE = mujoco.mjtState.mjSTATE_INTEGRATION


class Simulation(TickedSimulation):
    """Contact physics: robots move by their actuators and by what touches them.

    Attributes:
        model: The compiled model.
        data: Its state; not to be written to while ticking.
        last_second: Its states at the control instants of the last second.
    """

    def __init__(
        self,
        world: "World",
        *,
        seed: int = 0,
        control_period: float = 1 / 60,
        dt_max: float = 0.005,
        model: mujoco.MjModel | None = None,
        data: mujoco.MjData | None = None,
        bound: float = 100.0,
    ):
        """Compile the world (or adopt a compiled pair) and put the robots at their starts.

        Args:
            world: What is simulated.
            seed: Of every random stream of the trial.
            control_period: Between two ticks [s].
            dt_max: Largest timestep [s]; the one used divides control_period.
            model: An existing model of this world to adopt, shared with its owner; its timestep
                must divide control_period. The robots are put at their starts all the same.
            data: The existing state that goes with ``model``.
            bound: Any coordinate further than this from the origin [m] counts as diverged.

        Raises:
            InvalidInputError: A model without data, or with a timestep that does not divide; robots
                that start inside each other, props or walls.
        """
        substeps = 0
        if (model is None) != (data is None):
            raise InvalidInputError("give both model and data to adopt a pair, or neither")
        if model is not None:
            substeps = round(control_period / model.opt.timestep)
            if abs(substeps * model.opt.timestep - control_period) > 1e-9:
                raise InvalidInputError(
                    f"the adopted model's timestep {model.opt.timestep:g} s does not divide the "
                    f"control period {control_period:g} s"
                )
        super().__init__(
            world, seed=seed, control_period=control_period, dt_max=dt_max, substeps=substeps
        )
        if model is None or data is None:
            spec = world.spec()
            spec.option.timestep = self.timestep
            model = spec.compile()
            data = mujoco.MjData(model)
        self.model: Any = model
        self.data: Any = data
        self.timestep = self.model.opt.timestep
        self._bound = bound
        self._bounds = _bounds(self.model, bound)
        self._drives = {id(g): g.platform.bind(model, g.prefixes) for g in world.groups}
        self._each = [(g, self._drives[id(g)]) for g in world.groups]
        self._framed = [d for _, d in self._each if isinstance(d, FramedDrive)]
        for drive in self._framed:
            if drive.frame < self.timestep:
                raise InvalidInputError(
                    f"a drive's frame of {drive.frame:g} s is shorter than a timestep of "
                    f"{self.timestep:g} s; set dt_max to at most the frame"
                )
        self._checks = [d.check for _, d in self._each if isinstance(d, CheckedDrive)]
        self._step_watchers: list[Callable[[], None]] = []
        self._lifters: dict[int, Lifter] = {}
        self._sleeps = bool(self.model.opt.enableflags & mujoco.mjtEnableBit.mjENBL_SLEEP)
        self._movers = PropPlaces(self.model, world)
        self._pillars = Pillars(self.model)
        self._pillars.resize(self.model, 0.0)
        for group, drive in self._each:
            drive.place(data, group.start)
        self._carts = CartServos(self.model, world) if world.carts else None
        if self._carts is not None:
            self._carts.place(data, 0.0)
        mujoco.mj_forward(model, data)
        if not world.overlap:
            check_start(self.model, self.data, self.team.names)
        # live views: looking the arrays up again would cost more than the check
        self._qpos, self._warning_counts = self.data.qpos, self.data.warning.number
        self._warnings = int(self._warning_counts.sum())
        self._history: deque[Snapshot] = deque(maxlen=10)
        self._ticks_done = 0
        self.last_second = LastSecond(self.model, self.data, self.control_period)
        self.last_second.keep(0.0)
        self._bind()

    def drive_of(self, group: "Group") -> Any:
        """The actuators of a group's robots; for meters, and sensors only some platforms have."""
        return self._drives[id(group)]

    def poses_of(self, group: "Group") -> Array:
        """True poses (n, 3)."""
        return self._drives[id(group)].poses(self.data)

    def twists_of(self, group: "Group") -> Array:
        """True twists (n, 3), body frame."""
        return self._drives[id(group)].twists(self.data)

    def base_poses_of(self, group: "Group") -> Array:
        """True poses of the base bodies (n, 7): position, quaternion."""
        drive = self._drives[id(group)]
        if isinstance(drive, TiltedDrive):
            return drive.base_poses(self.data)
        return super().base_poses_of(group)

    def wheel_angles_of(self, group: "Group") -> Array:
        """Angles of the wheels (n, k) [rad]."""
        drive: Any = self._drives[id(group)]
        return drive.wheel_angles(self.data)

    def motion_status_of(self, group: "Group") -> Array | None:
        """What a motion engine says each robot is doing (n,); None if nothing says it."""
        return getattr(self._drives[id(group)], "motion_status", None)

    def mover_poses(self) -> Array:
        """Poses (k, 7) of the free props."""
        return self._movers.poses(self.data)

    def cart_boxes(self) -> Array:
        """Carts as boxes (k, 5)."""
        return np.zeros((0, 5)) if self._carts is None else self._carts.boxes(self.data)

    def full_positions(self) -> Array:
        """MuJoCo's ``qpos``, shape (nq,), a copy."""
        return self.data.qpos.copy()

    def visible_state(self) -> tuple[float, Array, Array, Array]:
        """Time, joint positions, and positions and quaternions of mocap bodies."""
        data = self.data
        return self.time, data.qpos.copy(), data.mocap_pos.copy(), data.mocap_quat.copy()

    def watch_steps(self, watcher: Callable[[], None]) -> None:
        """Call ``watcher`` after every physics step; for meters of contact, which are brief."""
        self._step_watchers.append(watcher)

    def snapshot(self) -> Snapshot:
        """State now; see :meth:`mjmr.loop.TickedSimulation.snapshot`."""
        found = super().snapshot()
        # who sleeps is not in the state vector, and what sleeps is where it last was computed
        return replace(found, physics=copy.copy(self.data)) if self._sleeps else found

    def restore(self, snapshot: Snapshot) -> None:
        """Go back (or forward) to ``snapshot``; also out of a divergence."""
        super().restore(snapshot)
        self._warnings = int(self._warning_counts.sum())
        self._history.clear()
        self.diverged = False
        self.last_second.clear()
        self.last_second.keep(self.time)

    def _lift(self, group: "Group", rows: Any, poses: Array) -> None:
        if id(group) not in self._lifters:
            self._lifters[id(group)] = Lifter(self.model, group, self._drives[id(group)])
        # a state vector does not say who sleeps: refused, a lift wakes nobody
        before = copy.copy(self.data) if self._sleeps else self._physics_state()
        self._lifters[id(group)].put_down(self.data, rows, poses)
        self._set_physics_state(self._physics_state())  # contacts are those of the new places
        if not self.world.overlap:
            told = overlaps(self.model, self.data, [group.names[row] for row in rows])
            if told:
                self._set_physics_state(before)
                raise InvalidInputError(f"robots are put down where there is room; {told}")

    def _begin_period(self) -> None:
        time, period, data = self.time, self.control_period, self.data
        for group, drive in self._each:
            start, target = group.next_ramp(time, period)
            mistuned = group.platform.mistuned
            drive.ramp(data, mistuned(start), mistuned(target), period)
        for sensor in self.actuated:
            sensor.actuate(data, period)
        if self._carts is not None:
            self._carts.drive(data, time, period)
        if self._pillars.change:
            self._pillars.resize(self.model, time)

    def _owners(self) -> Sequence[Any]:
        return [*super()._owners(), *self._framed]

    def _advance(self, steps: int) -> None:
        if not self._framed:
            self._integrate(steps)
            return
        now, end = self.step, self.step + steps
        while now < end:
            stop = end
            for drive in self._framed:
                # first frame not before now; told by the step alone, no snapshot need know it
                frame = math.floor((now - 1 + 1e-6) * self.timestep / drive.frame) + 1
                due = self.steps_until(frame * drive.frame)
                if due == now:
                    drive.servo(self.data, now * self.timestep)
                    due = self.steps_until((frame + 1) * drive.frame)
                stop = min(stop, due)
            self._integrate(stop - now)
            now = stop

    def _integrate(self, steps: int) -> None:
        model, data = self.model, self.data
        if not self._step_watchers:
            mujoco.mj_step(model, data, steps)
            return
        for _ in range(steps):
            mujoco.mj_step(model, data)
            for watch in self._step_watchers:
                watch()

    def _end_period(self) -> None:
        if not plausible(self._qpos, self._bounds, self._warning_counts, self._warnings):
            self.diverged = True
            raise self._divergence()
        for check in self._checks:
            wrong = check(self.data)
            if wrong is not None:
                self.diverged = True
                raise self._divergence(wrong)
        self.last_second.keep(self.step * self.timestep)
        self._ticks_done += 1
        if self._ticks_done % 6 == 0:
            self._remember()

    def _remember(self) -> None:
        """Keep the state now, in the memory of the oldest one if it is a whole copy."""
        if not (self._sleeps and len(self._history) == self._history.maxlen):
            self._history.append(self.snapshot())
            return
        physics = self._history.popleft().physics
        mujoco.mj_copyData(physics, self.model, self.data)
        self._history.append(replace(super().snapshot(), physics=physics))

    def _divergence(self, wrong: str = "") -> SimulationDivergedError:
        data = self.data
        counts = data.warning.number
        names = [mujoco.mjtWarning(i).name for i in np.flatnonzero(counts)]
        if wrong:
            why = wrong
        elif names:
            why = f"MuJoCo warned: {', '.join(names)}"
        elif not np.isfinite(data.qpos).all():
            why = "a position is not finite"
        else:
            why = f"a position is beyond {self._bound:g} m, or an angle without bounds"
        error = SimulationDivergedError(f"the physics diverged at t = {self.time:.3f} s: {why}")
        error.snapshots = tuple(self._history)
        return error

    def _physics_state(self) -> Array:
        state = np.empty(mujoco.mj_stateSize(self.model, _STATE))
        mujoco.mj_getState(self.model, self.data, state, _STATE)
        return state

    def _set_physics_state(self, state: Any) -> None:
        # contacts are computed anew here: with the radii of that instant
        self._pillars.resize(self.model, self.time)
        if isinstance(state, mujoco.MjData):
            mujoco.mj_copyData(self.data, self.model, state)
            return
        mujoco.mj_setState(self.model, self.data, state, _STATE)
        mujoco.mj_forward(self.model, self.data)
        # mj_forward recomputes the warm start; put the stored one back
        mujoco.mj_setState(self.model, self.data, state, _STATE)


def _bounds(model: mujoco.MjModel, bound: float) -> Array:
    """Largest plausible magnitude of each entry of qpos: ``bound`` [m] where it is a position."""
    bounds = np.full(model.nq, 1e9)
    for kind, first in zip(model.jnt_type, model.jnt_qposadr, strict=True):
        if kind == mujoco.mjtJoint.mjJNT_SLIDE:
            bounds[first] = bound
        elif kind == mujoco.mjtJoint.mjJNT_FREE:
            bounds[first : first + 3] = bound
    return bounds
