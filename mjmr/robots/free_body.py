"""Planar poses, twists and inertia of robots that are free bodies on wheels."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mjmr.jit import njit
from mjmr.robots.platform import Array

if TYPE_CHECKING:
    import mujoco

Indices = NDArray[np.int64]


@njit
def _yaw(qpos, free):
    w, x, y, z = qpos[free[3]], qpos[free[4]], qpos[free[5]], qpos[free[6]]
    return math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)


@njit
def free_poses(qpos, free):
    """Poses (n, 3), world frame, of the free joints at ``free`` (n, 7) in ``qpos``.

    Yaw is the heading of the body's x axis in the plane, in (-pi, pi].
    """
    poses = np.empty((free.shape[0], 3))
    for i in range(free.shape[0]):
        poses[i, 0], poses[i, 1] = qpos[free[i, 0]], qpos[free[i, 1]]
        yaw = _yaw(qpos, free[i])
        poses[i, 2] = math.pi if yaw == -math.pi else yaw
    return poses


@njit
def free_twists(qpos, qvel, free, velocity):
    """Twists (n, 3) of free joints in the frame of their heading.

    Args:
        qpos: Positions.
        qvel: Velocities.
        free: Indices of the joints in ``qpos`` (n, 7).
        velocity: Indices in ``qvel`` (n, 6).
    """
    twists = np.empty((free.shape[0], 3))
    for i in range(free.shape[0]):
        yaw = _yaw(qpos, free[i])
        c, s = math.cos(yaw), math.sin(yaw)
        # of a free joint the linear velocity is in the world frame and the angular in the body's
        vx, vy = qvel[velocity[i, 0]], qvel[velocity[i, 1]]
        twists[i, 0], twists[i, 1] = c * vx + s * vy, c * vy - s * vx
        w, x, y, z = qpos[free[i, 3]], qpos[free[i, 4]], qpos[free[i, 5]], qpos[free[i, 6]]
        p, q, r = qvel[velocity[i, 3]], qvel[velocity[i, 4]], qvel[velocity[i, 5]]
        twists[i, 2] = (
            2.0 * (x * z - w * y) * p + 2.0 * (y * z + w * x) * q
            + (w * w - x * x - y * y + z * z) * r
        )  # fmt: skip
    return twists


class FreeBodies:
    """Robots whose base is a free body, with a joint ``free``: where they are and how they move."""

    def __init__(self, model: "mujoco.MjModel", prefixes: Sequence[str]):
        """Look the joints up once; arguments as of :meth:`mjmr.robots.platform.Platform.bind`."""
        free = [model.joint(f"{p}free") for p in prefixes]
        self._qpos = np.array([j.qposadr[0] for j in free])[:, None] + np.arange(7)
        self._qvel = np.array([j.dofadr[0] for j in free])[:, None] + np.arange(6)
        self._base = int(model.jnt_bodyid[free[0].id])  # of the first robot

    def poses(self, data: "mujoco.MjData") -> Array:
        """Poses (n, 3) of the bases' origins, world frame; yaw is the heading of their x axis."""
        return free_poses(data.qpos, self._qpos)

    def base_poses(self, data: "mujoco.MjData") -> Array:
        """Poses of the bases (n, 7): position, quaternion."""
        return data.qpos[self._qpos]

    def twists(self, data: "mujoco.MjData") -> Array:
        """Twists (n, 3) in the frame of the heading: velocity of the origin, and yaw rate."""
        return free_twists(data.qpos, data.qvel, self._qpos, self._qvel)


def twist_inertia(
    model: "mujoco.MjModel", velocity: Indices, wheels: Indices, speeds: Array
) -> Array:
    """Inertia (3, 3) of one robot to its twist, wheels and rotors turning.

    Args:
        model: The compiled model.
        velocity: Indices of the robot's free joint in ``qvel`` (6,).
        wheels: Indices of its wheels (k,).
        speeds: Wheel speeds per unit of twist (k, 3).
    """
    motion = np.zeros((model.nv, 3))
    motion[velocity[[0, 1, 5]], [0, 1, 2]] = 1.0
    motion[wheels] = speeds
    return motion.T @ _full_inertia(model) @ motion


def total_mass(model: "mujoco.MjModel", velocity: Indices) -> float:
    """Mass of one robot [kg], its parts included; arguments as in :func:`twist_inertia`."""
    return float(_full_inertia(model)[velocity[0], velocity[0]])


def _full_inertia(model: "mujoco.MjModel") -> Array:
    import mujoco

    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    full = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, full)
    return full
