"""The Ackermann drive: a free body on sprung axles, one drive motor, one steering servo."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mjmr.jit import njit
from mjmr.robots.free_body import FreeBodies
from mjmr.robots.platform import Array
from mjmr.robots.rest import rest

if TYPE_CHECKING:
    import mujoco

WHEELS = ("wheel_rear_left", "wheel_rear_right", "wheel_front_left", "wheel_front_right")
COUNTED = WHEELS[:2]  # never steered: their mean and difference are the bicycle's speed and turn
SPRUNG = ("heave_rear", "roll_rear", "heave_front", "roll_front")


class AckermannDrive(FreeBodies):
    """A velocity servo on the wheels' mean speed and a position servo on the steering.

    It serves any free body with a joint ``free`` whose origin is on the floor below the middle of
    the rear axle, hinges named as ``WHEELS`` on axles with springs named as ``SPRUNG``, a tendon
    ``drive`` that is the wheels' mean angle, and a joint ``steer`` that turns the knuckles and
    whose angle is the bicycle model's. Each has a servo of its name. Speeds of single wheels, yaw
    rate and position are what the differentials and the contacts make of it.

    Attributes:
        wheel_radius: [m], as drawn.
        rolling_radius: At which the wheels roll under the robot's weight [m]: MuJoCo lets a contact
            act half as deep as the shapes overlap. The mean of all four.
        wheelbase: Between the axles [m].
        track: Between the points where an axle's wheels touch the floor [m].
        lock: Largest steering angle [rad].
        steering_rate: Of the steering servo's set point, at most [rad/s].
    """

    def __init__(self, model: "mujoco.MjModel", prefixes: Sequence[str], *, unicycle: bool):
        """Look up every index once, and how the robot stands on its springs.

        Args:
            model: The compiled model.
            prefixes: Of the robots.
            unicycle: Commands are (forward, turn) [m/s, rad/s] if true, (forward, steering)
                [m/s, rad] if not.
        """
        self._unicycle = unicycle
        self._half_step = model.opt.timestep / 2.0
        super().__init__(model, prefixes)
        base = self._base
        # a robot's joints are next to each other, the free one first
        own = np.flatnonzero(model.body_rootid[model.jnt_bodyid] == base)
        size = np.append(model.jnt_qposadr, model.nq)[own[-1] + 1] - self._qpos[0, 0]
        speeds = np.append(model.jnt_dofadr, model.nv)[own[-1] + 1] - self._qvel[0, 0]
        self._all_qpos = self._qpos[:, :1] + np.arange(size)
        self._all_qvel = self._qvel[:, :1] + np.arange(speeds)
        wheels = [[model.joint(f"{p}{w}") for w in WHEELS] for p in prefixes]
        self._counted = np.array([[j.qposadr[0] for j in row[: len(COUNTED)]] for row in wheels])
        servos = [[model.actuator(f"{p}{s}").id for s in ("drive", "steer")] for p in prefixes]
        self._servo = np.array(servos)
        self._act = model.actuator_actadr[self._servo]
        steer = self._servo[0, 1]
        self.lock = float(model.actuator_actrange[steer, 1])
        self.steering_rate = float(model.actuator_ctrlrange[steer, 1])

        sprung = [model.joint(f"{prefixes[0]}{name}").dofadr[0] for name in SPRUNG]
        freedoms = np.array([*self._qvel[0, 2:5], *sprung])
        self._rest = rest(model, base, freedoms)[self._all_qpos[0]]
        hubs = _hubs(model, self._all_qpos[0], self._rest, wheels[0])
        self.track = float(hubs[0, 1] - hubs[1, 1])
        self.wheelbase = float((hubs[2:] - hubs[:2])[:, 0].mean())
        tread = model.geom(f"{prefixes[0]}{WHEELS[0]}".replace("wheel", "tread")).id
        self.wheel_radius = float(model.geom_size[tread, 0])
        self.rolling_radius = (self.wheel_radius + float(hubs[:, 2].mean())) / 2.0

        mass = float(model.body_subtreemass[base])
        spin = sum(float(model.body_inertia[model.jnt_bodyid[j.id], 1]) for j in wheels[0])
        rotors = sum(float(model.dof_armature[j.dofadr[0]]) for j in wheels[0])
        # a servo of gain k gives the torque t when its set point is t / k ahead
        torque = mass * self.rolling_radius + (spin + rotors) / self.rolling_radius
        self._ahead = torque / float(model.actuator_gainprm[self._servo[0, 0], 0])

    def place(self, data: "mujoco.MjData", poses: Array) -> None:
        """Put the robots at rest at ``poses``, on their springs, as deep as weight presses them."""
        c, s = np.cos(poses[:, 2] / 2.0), np.sin(poses[:, 2] / 2.0)
        w, x, y, z = self._rest[3:7]
        rows = np.tile(self._rest, (len(poses), 1))
        rows[:, :2] += poses[:, :2]
        rows[:, 3:7] = np.column_stack([c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w])
        data.qpos[self._all_qpos] = rows
        data.qvel[self._all_qvel] = 0.0
        data.act[self._act] = 0.0

    def wheel_angles(self, data: "mujoco.MjData") -> Array:
        """Angles the rear wheels have turned (n, 2) [rad], left and right, forwards positive."""
        return data.qpos[self._counted]

    def ramp(self, data: "mujoco.MjData", start: Array, target: Array, period: float) -> None:
        """Ramp the set points of speed and steering between two commands (n, 2) over one period.

        The speed's is ahead by what the torque of the ramp takes, and shifted by half a step as in
        :class:`mjmr.robots.planar.PlanarDrive`. The steering's starts where it is and moves at most
        at ``steering_rate``.
        """
        _ramp(
            data.act, data.ctrl, self._act, self._servo, self._unicycle, self.wheelbase,
            self.track, self.rolling_radius, self.lock, self.steering_rate, self._ahead,
            start, target, period, self._half_step,
        )  # fmt: skip


@njit
def mean_path(steering, wheelbase, track):
    """Way of the four hubs, on average, per unit of way of the rear axle's middle.

    It is what open differentials hand the motor: each hub goes round the turn's centre, which is on
    the line of the rear axle.
    """
    curvature = math.tan(steering) / wheelbase
    total = 0.0
    for x in (0.0, wheelbase):
        for y in (-track / 2.0, track / 2.0):
            total += math.hypot(1.0 - curvature * y, curvature * x)
    return total / 4.0


@njit
def _ramp(
    act, ctrl, set_point, servo, unicycle, wheelbase, track, radius, lock, steering_rate, ahead,
    start, target, period, half_step,
):  # fmt: skip
    for i in range(start.shape[0]):
        steering = target[i, 1]
        if unicycle:
            # at rest it steers straight
            forward = target[i, 0]
            steering = math.atan(wheelbase * steering / forward) if forward > 0.0 else 0.0
        steering = min(max(steering, -lock), lock)
        now = act[set_point[i, 1]]
        rate = (steering - now) / period
        rate = min(max(rate, -steering_rate), steering_rate)
        ctrl[servo[i, 1]] = rate
        begin = start[i, 0] * mean_path(now, wheelbase, track) / radius
        end = target[i, 0] * mean_path(now + rate * period, wheelbase, track) / radius
        slope = (end - begin) / period
        torque = ahead * (target[i, 0] - start[i, 0]) / period
        act[set_point[i, 0]] = begin + torque - slope * half_step
        ctrl[servo[i, 0]] = slope


def _hubs(model, rows, positions, wheels) -> Array:
    """Places of the hubs (k, 3) [m], world frame, of the robot with these ``positions``."""
    import mujoco

    data = mujoco.MjData(model)
    data.qpos[rows] = positions
    mujoco.mj_kinematics(model, data)
    return np.array([data.xpos[model.jnt_bodyid[j.id]] for j in wheels])
