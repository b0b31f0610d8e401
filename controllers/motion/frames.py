"""Velocities between the world frame and the robots' own, compiled for use in every cycle."""

import math

import numpy as np

from mjmr.jit import njit


@njit
def world_velocity(twist, yaw):
    """Planar part of body-frame twists in the world frame.

    Args:
        twist: Shape (n, 3): forward, left [m/s], anticlockwise [rad/s].
        yaw: Shape (n,) [rad].

    Returns:
        Shape (n, 2) [m/s].
    """
    velocity = np.empty((twist.shape[0], 2))
    for i in range(twist.shape[0]):
        c, s = math.cos(yaw[i]), math.sin(yaw[i])
        velocity[i, 0] = c * twist[i, 0] - s * twist[i, 1]
        velocity[i, 1] = s * twist[i, 0] + c * twist[i, 1]
    return velocity


@njit
def body_twist(velocity, yaw):
    """Body-frame twists, not turning, of velocities given in the world frame.

    Args:
        velocity: Shape (n, 2) [m/s].
        yaw: Shape (n,) [rad].

    Returns:
        Shape (n, 3): forward, left [m/s], anticlockwise [rad/s].
    """
    twist = np.zeros((velocity.shape[0], 3))
    for i in range(velocity.shape[0]):
        c, s = math.cos(yaw[i]), math.sin(yaw[i])
        twist[i, 0] = c * velocity[i, 0] + s * velocity[i, 1]
        twist[i, 1] = c * velocity[i, 1] - s * velocity[i, 0]
    return twist
