"""The hand point: a unicycle's point ahead of its axle moves in any direction at once.

h = r + L (cos th, sin th). Its acceleration v is met by accelerations of forward speed V and turn
rate W: [V'; W'] = [[cos, sin], [-sin / L, cos / L]] (v - n), n = (-V W sin - L W^2 cos,
V W cos - L W^2 sin). Standard feedback linearization; not spelled out in the paper.
"""

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]


def _check(length: float) -> None:
    if not length > 0:
        raise InvalidInputError(f"the hand is ahead of the axle; length must be > 0, got {length}")


def hand_position(poses: Array, length: float) -> Array:
    """Hand points (n, 2) [m] of poses (n, 3), the frame of the poses."""
    _check(length)
    ahead = np.column_stack([np.cos(poses[:, 2]), np.sin(poses[:, 2])])
    return poses[:, :2] + length * ahead


def hand_velocity(yaw: Array, command: Array, length: float) -> Array:
    """Velocities (n, 2) [m/s] of hand points from (forward, turn) (n, 2); axes of the yaws (n,)."""
    _check(length)
    c, s = np.cos(yaw), np.sin(yaw)
    forward, turn = command[:, 0], command[:, 1]
    return np.column_stack([forward * c - length * turn * s, forward * s + length * turn * c])


def command_of_velocity(yaw: Array, velocity: Array, length: float) -> Array:
    """(forward, turn) (n, 2) that give hand points these velocities (n, 2)."""
    _check(length)
    c, s = np.cos(yaw), np.sin(yaw)
    along = c * velocity[:, 0] + s * velocity[:, 1]
    across = -s * velocity[:, 0] + c * velocity[:, 1]
    return np.column_stack([along, across / length])


def command_rates(yaw: Array, command: Array, acceleration: Array, length: float) -> Array:
    """Rates (n, 2) of (forward [m/s^2], turn [rad/s^2]) for accelerations of hand points (n, 2)."""
    _check(length)
    c, s = np.cos(yaw), np.sin(yaw)
    forward, turn = command[:, 0], command[:, 1]
    x = acceleration[:, 0] + forward * turn * s + length * turn**2 * c
    y = acceleration[:, 1] - forward * turn * c + length * turn**2 * s
    return np.column_stack([c * x + s * y, (-s * x + c * y) / length])
