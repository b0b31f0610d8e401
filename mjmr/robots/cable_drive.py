"""Drives of a carriage on a cable: on a curve, or between two winches that pull it.

The firmware runs every 10 ms. From the ramp of the commands it makes set points of where the
carriage and the package's line should be, slows down before the ends of either, and sets servos. It
knows the carriage's place from the encoders, which turn with the joints.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mjmr.errors import InvalidInputError
from mjmr.jit import njit
from mjmr.robots.cable import GRAVITY, pulls
from mjmr.robots.platform import Array

if TYPE_CHECKING:
    import mujoco

FRAME = 0.01  # of the firmware [s]
_POSITION_GAIN = 8.0  # 1/s, of the loop around the velocity servos
# Of the carriage's stiffest mode, w dt. Explicit stiffness with implicit damping of a share z holds
# while (w dt)^2 < 4 + 4 z w dt: to 2.34 with a tenth of critical, 2 without; failures are silent.
_LARGEST_PHASE = 2.0
JOINTS = ("along", "line")


class CableDrive(ABC):
    """What both cables share: joints, set points, the winch and the check against the curve.

    Commands are (travel, winch): horizontal speed along the cable and speed of the line, downwards
    positive [m/s].

    Attributes:
        frame: Of the firmware [s].
        carriage_mass: [kg].
        package_mass: [kg].
        weight: Of both, line included [N].
        tolerance: Between the carriage and the curve [m]; more than this is a failed simulation.
    """

    frame = FRAME
    tolerance: float

    def __init__(
        self, model: "mujoco.MjModel", prefixes: Sequence[str], radii: Sequence[float], stop: Array
    ):
        """Look up every index and number once.

        Args:
            model: The compiled model; the cable's shape and all masses are read from it.
            prefixes: Of the robots.
            radii: Of the counters' wheels, travel and winch [m].
            stop: Deceleration before the ends of travel and line (2,) [m/s^2].
        """
        self._names = [p.removesuffix("/") for p in prefixes]
        self._half_step = model.opt.timestep / 2.0
        joints = [[model.joint(f"{p}{j}") for j in JOINTS] for p in prefixes]
        self._qpos = np.array([[j.qposadr[0] for j in row] for row in joints])
        self._qvel = np.array([[j.dofadr[0] for j in row] for row in joints])
        ends = np.array([j.range for j in joints[0]])
        self._low, self._high = ends[:, 0].copy(), ends[:, 1].copy()
        self._line = np.array([model.qpos0[row[1].qposadr[0]] for row in joints])
        lifts = [model.joint(f"{p}lift") for p in prefixes]
        self._lift = np.array([j.qposadr[0] for j in lifts])
        self._lift_vel = np.array([j.dofadr[0] for j in lifts])
        hinges = [[model.joint(f"{p}{j}") for j in ("swing", "sway")] for p in prefixes]
        self._hinges = np.array([[j.qposadr[0] for j in row] for row in hinges])
        self._hinge_vel = np.array([[j.dofadr[0] for j in row] for row in hinges])
        towers = [model.body(f"{p}towers") for p in prefixes]
        self._middle = np.array([t.pos[:2] for t in towers])
        self._quat = np.array([t.quat for t in towers])
        yaw = 2.0 * np.arctan2(self._quat[:, 3], self._quat[:, 0])
        self._yaw = np.pi - (np.pi - yaw) % (2.0 * np.pi)
        self._heading = np.column_stack([np.cos(yaw), np.sin(yaw)])
        end = model.site(f"{prefixes[0]}anchor_front").pos
        base = model.body(f"{prefixes[0]}base")
        self._half, self._height = float(end[0]), float(end[2])
        self._lowest = float(base.pos[2])
        self._bend = (self._height - self._lowest) / self._half**2
        self.carriage_mass = float(base.mass[0])
        self.package_mass = float(model.body(f"{prefixes[0]}package").mass[0])
        self.weight = float(base.subtreemass[0]) * GRAVITY
        self._radii, self._stop = np.array(radii), np.array(stop)
        winches = [model.actuator(f"{p}winch") for p in prefixes]
        self._winch = np.array([a.id for a in winches])
        self._winch_act = model.actuator_actadr[self._winch]
        self._winch_gain = float(model.actuator_gainprm[self._winch[0], 0])
        n = len(prefixes)
        self._start = np.column_stack([np.zeros(n), self._line])
        self._reset(self._start)

    def place(self, data: "mujoco.MjData", poses: Array) -> None:
        """Put the carriages at rest on their cables where these come nearest to ``poses``."""
        along = ((poses[:, :2] - self._middle) * self._heading).sum(axis=1)
        self._start = np.column_stack([along, self._line])
        data.qpos[self._qpos] = self._start
        data.qpos[self._lift] = self._bend * along**2
        data.qpos[self._hinges] = 0.0
        for velocities in (self._qvel, self._lift_vel, self._hinge_vel):
            data.qvel[velocities] = 0.0
        self._reset(self._start)
        self._set(data, 0.0)

    def poses(self, data: "mujoco.MjData") -> Array:
        """Poses (n, 3) of the carriages, world frame; yaw is the cable's."""
        xy = self._middle + data.qpos[self._qpos[:, :1]] * self._heading
        return np.column_stack([xy, self._yaw])

    def base_poses(self, data: "mujoco.MjData") -> Array:
        """Poses of the carriages (n, 7): position, with height, and quaternion."""
        xy = self._middle + data.qpos[self._qpos[:, :1]] * self._heading
        return np.column_stack([xy, self._lowest + data.qpos[self._lift], self._quat])

    def twists(self, data: "mujoco.MjData") -> Array:
        """Twists (n, 3): along the cable, horizontally; it never goes sideways or turns."""
        twists = np.zeros((len(self._qvel), 3))
        twists[:, 0] = data.qvel[self._qvel[:, 0]]
        return twists

    def wheel_angles(self, data: "mujoco.MjData") -> Array:
        """Angles (n, 2) [rad] of travel and winch counters since the start."""
        return (data.qpos[self._qpos] - self._start) / self._radii

    @abstractmethod
    def tensions(self, data: "mujoco.MjData") -> Array:
        """Tensions of the cable (n, 2) [N], behind and in front of the carriages."""

    def check(self, data: "mujoco.MjData") -> str | None:
        """Say so if a carriage is off its curve, which no warning of MuJoCo's does."""
        worst, off = _off_curve(data.qpos, self._qpos, self._lift, self._bend)
        if off <= self.tolerance:
            return None
        return (
            f"the carriage of {self._names[worst]} is {1e3 * off:.0f} mm off its cable's curve, "
            f"{1e3 * self.tolerance:.0f} are allowed: the cable's model failed, or something "
            "holds the carriage"
        )

    def ramp(self, data: "mujoco.MjData", start: Array, target: Array, period: float) -> None:
        """Store the ramp of the commands (n, 2); :meth:`servo` follows it."""
        self._ramp = (start, target, self._ramp[2] + self._ramp[3], period)

    def servo(self, data: "mujoco.MjData", time: float) -> None:
        """Move the set points on to ``time`` [s] and set every actuator for one frame."""
        start, target, begin, period = self._ramp
        _advance(
            self._point, self._rate, self._rise, start, target, begin, period, self._time, time,
            self._low, self._high, self._stop,
        )  # fmt: skip
        self._time = time
        self._set(data, time)

    def state(self) -> Any:
        """Set points, their rates, the ramp and how far it has gone."""
        return self._point.copy(), self._rate.copy(), self._rise.copy(), self._ramp, self._time

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        point, rate, rise, self._ramp, self._time = state
        self._point, self._rate, self._rise = point.copy(), rate.copy(), rise.copy()

    def _reset(self, start: Array) -> None:
        self._point = start.copy()
        self._rate, self._rise = np.zeros_like(start), np.zeros_like(start)
        still = np.zeros_like(start)
        # start and target of the commands, begin and length of the ramp
        self._ramp = (still, still, 0.0, 0.0)
        self._time = 0.0

    @abstractmethod
    def _set(self, data: "mujoco.MjData", time: float) -> None:
        """Set every actuator from the set points."""


class CurveDrive(CableDrive):
    """The carriage slides on the curve, pulled by a motor that grips the cable."""

    tolerance = 0.010

    def __init__(
        self, model: "mujoco.MjModel", prefixes: Sequence[str], radii: Sequence[float], stop: Array
    ):
        """Look up every index once."""
        super().__init__(model, prefixes, radii, stop)
        self._travel = np.array([model.actuator(f"{p}travel").id for p in prefixes])
        self._travel_act = model.actuator_actadr[self._travel]
        self._travel_gain = float(model.actuator_gainprm[self._travel[0], 0])

    def tensions(self, data: "mujoco.MjData") -> Array:
        """Tensions (n, 2) [N] that add up to what motor and curve press on the carriage."""
        total = data.qfrc_actuator + data.qfrc_constraint
        return pulls(
            data.qpos[self._qpos[:, 0]], self._lowest + data.qpos[self._lift], self._half,
            self._height, total[self._qvel[:, 0]], total[self._lift_vel],
        )  # fmt: skip

    def _set(self, data: "mujoco.MjData", time: float) -> None:
        _set_servos(
            data.qpos, data.act, data.ctrl, self._qpos, self._travel, self._travel_act,
            self._travel_gain, self._winch, self._winch_act, self._winch_gain, self._point,
            self._rate, self._rise, self.carriage_mass, self.weight, self.package_mass,
            self._bend, self._half_step,
        )  # fmt: skip


class TendonDrive(CableDrive):
    """Two winches on the supports pull the carriage by straight elastic cables.

    They pay out what the geometry of the curve asks for, less what the cables' stretch at rest
    adds; nothing corrects a carriage that is elsewhere.
    """

    def __init__(
        self, model: "mujoco.MjModel", prefixes: Sequence[str], radii: Sequence[float], stop: Array
    ):
        """Look up every index once.

        Raises:
            InvalidInputError: A timestep too large for the cable's stiffness.
        """
        super().__init__(model, prefixes, radii, stop)
        names = [[f"{p}{t}" for t in ("cable_rear", "cable_front")] for p in prefixes]
        self._cables = np.array([[model.actuator(name).id for name in row] for row in names])
        self._cable_act = model.actuator_actadr[self._cables]
        first = self._cables[0, 0]
        self._stiffness = float(model.actuator_gainprm[first, 0])
        self._ahead = float(-model.actuator_biasprm[first, 2]) / self._stiffness
        frequency = math.sqrt(2.0 * self._stiffness / self.carriage_mass)
        largest = _LARGEST_PHASE / frequency
        if model.opt.timestep > largest:
            raise InvalidInputError(
                f"a timestep of {1e3 * model.opt.timestep:.3g} ms is too large for this cable: "
                f"a carriage of {self.carriage_mass:.3g} kg between {self._stiffness:.3g} N/m on "
                f"either side needs at most {1e3 * largest:.3g} ms; set dt_max, or take a softer "
                "cable"
            )
        # a package that lands on something lets the carriage rise by a third of this, and bounce
        rise = self._height - self._lowest
        soft = 2.0 * self._stiffness * (rise / math.hypot(self._half, rise)) ** 2
        soft += self.weight / rise
        self.tolerance = 3.0 * self.package_mass * GRAVITY / soft

    def tensions(self, data: "mujoco.MjData") -> Array:
        """Tensions (n, 2) [N] of the cables."""
        return -data.actuator_force[self._cables]

    def _set(self, data: "mujoco.MjData", time: float) -> None:
        _set_cables(
            data.qpos, data.act, data.ctrl, self._qpos, self._cables, self._cable_act,
            self._stiffness, self._ahead, self._winch, self._winch_act, self._winch_gain,
            self._point, self._rate, self._rise, self.weight, self.package_mass, self._half,
            self._height, self._lowest, self._bend, self._half_step,
        )  # fmt: skip


@njit
def _off_curve(qpos, joints, lift, bend):
    """The carriage furthest off the curve, and how far [m]; NaN counts as infinitely far."""
    worst, most = 0, 0.0
    for i in range(lift.shape[0]):
        off = abs(qpos[lift[i]] - bend * qpos[joints[i, 0]] ** 2)
        if not off <= most:
            worst, most = i, off if off == off else math.inf
    return worst, most


@njit
def _wanted(start, target, begin, period, time, point, low, high, stop):
    """Rate of a set point at ``time``: the ramp's, but slow enough to stop before the ends."""
    share = 1.0
    if period > 0.0:
        share = min(max((time - begin) / period, 0.0), 1.0)
    rate = start + (target - start) * share
    room = high - point if rate > 0.0 else point - low
    most = math.sqrt(2.0 * stop * max(room, 0.0))
    return min(max(rate, -most), most)


@njit
def _advance(
    point, rate, rise, start, target, begin, period, last, time, low, high, stop
):  # fmt: skip
    """Move set points and rates on from ``last`` to ``time``; ``rise`` is the rates' slope."""
    for i in range(point.shape[0]):
        for c in range(2):
            wanted = _wanted(
                start[i, c], target[i, c], begin, period, time, point[i, c], low[c], high[c],
                stop[c],
            )  # fmt: skip
            step = 0.5 * (rate[i, c] + wanted) * (time - last)
            point[i, c] = min(max(point[i, c] + step, low[c]), high[c])
            rate[i, c] = wanted
            later = _wanted(
                start[i, c], target[i, c], begin, period, time + FRAME,
                point[i, c] + wanted * FRAME, low[c], high[c], stop[c],
            )  # fmt: skip
            rise[i, c] = (later - wanted) / FRAME


@njit
def _set_winch(act, ctrl, servo, set_point, gain, q, point, rate, rise, mass, half_step):
    force = mass * (rise - GRAVITY)
    want = rate + _POSITION_GAIN * (point - q) - rise * half_step
    act[set_point] = want + force / gain
    ctrl[servo] = rise


@njit
def _set_servos(
    qpos, act, ctrl, joints, travel, travel_act, travel_gain, winch, winch_act, winch_gain, point,
    rate, rise, mass, weight, package, bend, half_step,
):  # fmt: skip
    for i in range(joints.shape[0]):
        x = qpos[joints[i, 0]]
        slope = 2.0 * bend * x
        # a servo of gain k gives a force f when its set point is f / k ahead
        force = weight * slope + mass * (1.0 + slope * slope) * rise[i, 0]
        want = rate[i, 0] + _POSITION_GAIN * (point[i, 0] - x) - rise[i, 0] * half_step
        act[travel_act[i]] = want + force / travel_gain
        ctrl[travel[i]] = rise[i, 0]
        _set_winch(
            act, ctrl, winch[i], winch_act[i], winch_gain, qpos[joints[i, 1]], point[i, 1],
            rate[i, 1], rise[i, 1], package, half_step,
        )  # fmt: skip


@njit
def _lengths(x, rate, stiffness, ahead, weight, half, height, lowest, bend, which):
    """Unstretched length [m] to pay out, ahead by what the cable's damping takes."""
    z = lowest + bend * x * x
    reach = half + x if which == 0 else half - x
    rise = height - z
    length = math.hypot(reach, rise)
    tension = weight * length * (2.0 * half - reach) / (2.0 * half * rise)
    toward = 1.0 if which == 0 else -1.0
    speed = (toward * reach - rise * 2.0 * bend * x) / length * rate
    return length - tension / stiffness + ahead * speed


@njit
def _set_cables(
    qpos, act, ctrl, joints, cables, cable_act, stiffness, ahead, winch, winch_act, winch_gain,
    point, rate, rise, weight, package, half, height, lowest, bend, half_step,
):  # fmt: skip
    for i in range(joints.shape[0]):
        x, v = point[i, 0], rate[i, 0]
        v_next = v + rise[i, 0] * FRAME
        x_next = x + 0.5 * (v + v_next) * FRAME
        for k in range(2):
            now = _lengths(x, v, stiffness, ahead, weight, half, height, lowest, bend, k)
            then = _lengths(x_next, v_next, stiffness, ahead, weight, half, height, lowest, bend, k)
            act[cable_act[i, k]] = now
            ctrl[cables[i, k]] = (then - now) / FRAME
        _set_winch(
            act, ctrl, winch[i], winch_act[i], winch_gain, qpos[joints[i, 1]], point[i, 1],
            rate[i, 1], rise[i, 1], package, half_step,
        )  # fmt: skip
