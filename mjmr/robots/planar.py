"""The planar drive: two slides and a hinge with force-limited velocity servos."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mjmr.geometry import wrap_angle
from mjmr.jit import njit
from mjmr.robots.platform import Array

if TYPE_CHECKING:
    import mujoco


class PlanarDrive:
    """Slide, slide, hinge: velocity servos whose set point is ramped, with feed-forward."""

    def __init__(self, model: "mujoco.MjModel", prefixes: Sequence[str]):
        """Look up every index once."""
        self._half_step = model.opt.timestep / 2.0
        joints = [[model.joint(f"{p}{j}") for j in ("x", "y", "yaw")] for p in prefixes]
        self._qpos = np.array([[j.qposadr[0] for j in row] for row in joints])
        self._qvel = np.array([[j.dofadr[0] for j in row] for row in joints])
        servos = [[model.actuator(f"{p}{a}") for a in ("x", "y", "yaw")] for p in prefixes]
        self._servo = np.array([[a.id for a in row] for row in servos])
        self._act = np.array([[model.actuator_actadr[a.id] for a in row] for row in servos])
        self._feed = np.array(
            [[model.actuator(f"{p}{a}_feed").id for a in ("x", "y", "yaw")] for p in prefixes]
        )
        for row, prefix, actuators in zip(joints, prefixes, servos, strict=True):
            limits = model.numeric(f"{prefix}drive_limit").data
            for joint, limit, servo in zip(row, limits, actuators, strict=True):
                _limit_force(model, joint.id, float(limit), servo.id)

    def place(self, data: "mujoco.MjData", poses: Array) -> None:
        """Put the robots at rest at ``poses``."""
        data.qpos[self._qpos] = poses
        data.qvel[self._qvel] = 0.0
        data.act[self._act] = 0.0

    def poses(self, data: "mujoco.MjData") -> Array:
        """Poses (n, 3), world frame."""
        poses = data.qpos[self._qpos]
        poses[:, 2] = wrap_angle(poses[:, 2])
        return poses

    def twists(self, data: "mujoco.MjData") -> Array:
        """Twists (n, 3), body frame."""
        return _body_twists(data.qpos, data.qvel, self._qpos, self._qvel)

    def ramp(self, data: "mujoco.MjData", start: Array, target: Array, period: float) -> None:
        """Ramp the servos' set points from ``start`` to ``target`` over one period.

        The drive pushes in the body frame, so the end of the ramp is turned by the yaw the ramp
        itself will add. MuJoCo's integrator moves a body for a whole step at the velocity of the
        step's end, so that velocities belong half a step before their positions; the set point is
        shifted by as much, which makes the distance covered in a period that of the ramp.
        """
        _ramp(
            data.qpos, data.act, data.ctrl, self._qpos, self._act, self._servo, self._feed,
            start, target, period, self._half_step,
        )  # fmt: skip


@njit
def _ramp(qpos, act, ctrl, pose, set_point, servo, feed, start, target, period, half_step):
    for i in range(start.shape[0]):
        yaw = qpos[pose[i, 2]]
        turned = yaw + 0.5 * (start[i, 2] + target[i, 2]) * period
        c, s, d, e = math.cos(yaw), math.sin(yaw), math.cos(turned), math.sin(turned)
        begin = (
            c * start[i, 0] - s * start[i, 1], s * start[i, 0] + c * start[i, 1], start[i, 2]
        )  # fmt: skip
        end = (
            d * target[i, 0] - e * target[i, 1], e * target[i, 0] + d * target[i, 1], target[i, 2]
        )  # fmt: skip
        for k in range(3):
            acceleration = (end[k] - begin[k]) / period
            act[set_point[i, k]] = begin[k] - acceleration * half_step
            ctrl[servo[i, k]] = acceleration
            ctrl[feed[i, k]] = acceleration


@njit
def _body_twists(qpos, qvel, pose, velocity):
    twists = np.empty((pose.shape[0], 3))
    for i in range(pose.shape[0]):
        yaw = qpos[pose[i, 2]]
        c, s = math.cos(yaw), math.sin(yaw)
        x, y = qvel[velocity[i, 0]], qvel[velocity[i, 1]]
        twists[i, 0] = c * x + s * y
        twists[i, 1] = c * y - s * x
        twists[i, 2] = qvel[velocity[i, 2]]
    return twists


def _limit_force(model: "mujoco.MjModel", joint: int, limit: float, servo: int) -> None:
    """Limit what a servoed joint really applies to ``limit`` [N or Nm].

    MuJoCo clamps the force before the implicit integrator takes off what the servo's damping will
    undo within the step, a factor of 1 + kv dt / m; the clamp is widened by it.
    """
    import mujoco

    gain = model.actuator_gainprm[servo, 0]
    body = model.jnt_bodyid[joint]
    slides = model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_SLIDE
    inertia = model.body_mass[body] if slides else model.body_inertia[body].max()
    clamp = limit * (1.0 + gain * model.opt.timestep / inertia)
    model.jnt_actfrcrange[joint] = (-clamp, clamp)
