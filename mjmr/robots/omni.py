"""The omni drive: a free body that four omni-wheels move by their contact with the floor."""

import copy
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mjmr.jit import njit
from mjmr.robots.free_body import FreeBodies, total_mass, twist_inertia
from mjmr.robots.platform import FLOOR, Array

if TYPE_CHECKING:
    import mujoco

WHEELS = 4


def roll_on_floor(spec: "mujoco.MjSpec", prefixes: Sequence[str]) -> None:
    """Let the wheels of the robots attached under ``prefixes`` touch the floor.

    A wheel's contact shape is a short capsule along the axle, whose contact frame with a plane
    MuJoCo turns to its axis: friction is near zero along the axle, where rollers roll freely, and
    full across it. Only a contact pair can have friction that depends on direction; its numbers
    are the model's default for pairs.
    """
    for prefix in prefixes:
        default = spec.find_default(f"{prefix}wheel")
        for k in range(WHEELS):
            spec.add_pair(
                default,
                name=f"{prefix}wheel{k}_floor",
                geomname1=FLOOR,
                geomname2=f"{prefix}tread{k}",
            )


class OmniDrive(FreeBodies):
    """Wheels' velocity servos whose set points are ramped, with feed-forward.

    Nothing but wheel speeds is closed: heading and position are what the contacts make of them.

    Attributes:
        wheel_speeds: Of one robot (4, 3): wheel speeds [rad/s] = this times twist, by rolling
            without slip.
    """

    def __init__(self, model: "mujoco.MjModel", prefixes: Sequence[str]):
        """Look up every index once, and the geometry of the wheels."""
        self._half_step = model.opt.timestep / 2.0
        super().__init__(model, prefixes)
        wheels = [[model.joint(f"{p}wheel{k}") for k in range(WHEELS)] for p in prefixes]
        self._wheel_qpos = np.array([[j.qposadr[0] for j in row] for row in wheels])
        self._wheel_qvel = np.array([[j.dofadr[0] for j in row] for row in wheels])
        self._servo = np.array(
            [[model.actuator(f"{p}wheel{k}").id for k in range(WHEELS)] for p in prefixes]
        )
        self._act = model.actuator_actadr[self._servo]
        treads = [[model.geom(f"{p}tread{k}").id for k in range(WHEELS)] for p in prefixes]
        apart = _without_collisions(model)
        self._height = _rest_height(apart, self._qpos[0, 2], self._qvel[0, 2])
        # MuJoCo lets a contact act half as deep as the shapes overlap
        self.wheel_speeds = _wheel_speeds(
            model, [j.id for j in wheels[0]], treads[0], self._height / 2.0
        )
        inertia = twist_inertia(apart, self._qvel[0], self._wheel_qvel[0], self.wheel_speeds)
        # least torques that give a force and moment on the body; a servo of gain k gives the
        # torque t when its set point is t / k ahead
        share = np.linalg.pinv(self.wheel_speeds).T
        share /= float(model.actuator_gainprm[self._servo[0, 0], 0])
        self._ahead = share @ inertia
        self._turning = share[:, :2] * total_mass(apart, self._qvel[0])

    def place(self, data: "mujoco.MjData", poses: Array) -> None:
        """Put the robots at rest at ``poses``, as deep in the floor as weight presses them."""
        data.qpos[self._qpos] = 0.0
        data.qpos[self._qpos[:, :2]] = poses[:, :2]
        data.qpos[self._qpos[:, 2]] = self._height
        data.qpos[self._qpos[:, 3]] = np.cos(poses[:, 2] / 2.0)
        data.qpos[self._qpos[:, 6]] = np.sin(poses[:, 2] / 2.0)
        data.qpos[self._wheel_qpos] = 0.0
        data.qvel[self._qvel] = 0.0
        data.qvel[self._wheel_qvel] = 0.0
        data.act[self._act] = 0.0

    def ramp(self, data: "mujoco.MjData", start: Array, target: Array, period: float) -> None:
        """Ramp the wheels' set points from ``start`` to ``target`` over one period.

        The set points are ahead by what the torque of the ramp takes, which includes turning the
        velocity with the body, and shifted by half a step as in
        :class:`mjmr.robots.planar.PlanarDrive`.
        """
        _ramp(
            data.act, data.ctrl, self._act, self._servo, self.wheel_speeds, self._ahead,
            self._turning, start, target, period, self._half_step,
        )  # fmt: skip


@njit
def _ramp(act, ctrl, set_point, servo, speeds, ahead, turning, start, target, period, half_step):
    for i in range(start.shape[0]):
        mean = 0.5 * (start[i, 2] + target[i, 2])
        # acceleration of a velocity that turns with the body, at the middle of the ramp
        turn_x = -mean * 0.5 * (start[i, 1] + target[i, 1])
        turn_y = mean * 0.5 * (start[i, 0] + target[i, 0])
        for k in range(speeds.shape[0]):
            begin = turning[k, 0] * turn_x + turning[k, 1] * turn_y
            slope = 0.0
            for c in range(3):
                rate = (target[i, c] - start[i, c]) / period
                begin += speeds[k, c] * start[i, c] + ahead[k, c] * rate
                slope += speeds[k, c] * rate
            act[set_point[i, k]] = begin - slope * half_step
            ctrl[servo[i, k]] = slope


def _wheel_speeds(
    model: "mujoco.MjModel", joints: Sequence[int], treads: Sequence[int], sink: float
) -> Array:
    """Wheel speeds (k, 3) per unit of twist, from where the model's wheels are and point.

    Args:
        model: The compiled model.
        joints: Of the wheels.
        treads: Geoms that touch the floor.
        sink: What contact takes off the treads' radius [m], below zero.
    """
    import mujoco

    rows = []
    for joint, tread in zip(joints, treads, strict=True):
        body = model.jnt_bodyid[joint]
        axle = np.empty(3)
        mujoco.mju_rotVecQuat(axle, model.jnt_axis[joint], model.body_quat[body])
        # speed of the wheel's lowest point relative to its hub, at 1 rad/s
        rolling = np.cross(axle, [0.0, 0.0, -model.geom_size[tread, 0] - sink])
        radius = np.linalg.norm(rolling)
        x, y = model.body_pos[body, :2]
        along = rolling / radius
        # it must cancel the hub's own: v + w x p
        rows.append(-np.array([along[0], along[1], x * along[1] - y * along[0]]) / radius)
    return np.array(rows)


def _without_collisions(model: "mujoco.MjModel") -> "mujoco.MjModel":
    """Copy of a model in which only contact pairs collide: wheels and the floor."""
    alone = copy.copy(model)
    alone.geom_contype[:] = 0
    alone.geom_conaffinity[:] = 0
    return alone


def _rest_height(model: "mujoco.MjModel", position: int, velocity: int) -> float:
    """Height [m] at which contact carries a robot's weight: a little below zero.

    Args:
        model: Of :func:`_without_collisions`.
        position: Index of the robot's height in ``qpos``.
        velocity: Index of its rate in ``qvel``.
    """
    import mujoco

    data = mujoco.MjData(model)
    low, high = -1e-3, 0.0
    for _ in range(40):
        middle = (low + high) / 2.0
        data.qpos[position] = middle
        mujoco.mj_forward(model, data)
        low, high = (low, middle) if data.qacc[velocity] < 0.0 else (middle, high)
    return high
