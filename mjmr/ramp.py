"""Compiled integration of body-frame twists that ramp linearly."""

import math

import numpy as np

from mjmr.jit import njit

# Gauss-Legendre, five points on [0, 1]
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(5)
_NODES, _WEIGHTS = (_NODES + 1) / 2, _WEIGHTS / 2


@njit
def integrate_ramp(pose, start, end, dt):
    """Poses after twists went linearly from ``start`` to ``end`` in ``dt``.

    Without turning the result is the exact mean velocity; with it the error is below 1e-12 m for
    the turns of a control period (five-point quadrature of the turning velocity).

    Args:
        pose: (n, 3) [m, m, rad], world frame.
        start: (n, 3) [m/s, m/s, rad/s], body frame.
        end: The same.
        dt: [s].

    Returns:
        Poses (n, 3), yaw in (-pi, pi].
    """
    moved = np.empty_like(pose)
    for i in range(pose.shape[0]):
        x, y, yaw = pose[i, 0], pose[i, 1], pose[i, 2]
        if start[i, 2] == 0.0 and end[i, 2] == 0.0:
            c, s = math.cos(yaw), math.sin(yaw)
            vx, vy = 0.5 * (start[i, 0] + end[i, 0]), 0.5 * (start[i, 1] + end[i, 1])
            moved[i, 0] = x + (c * vx - s * vy) * dt
            moved[i, 1] = y + (s * vx + c * vy) * dt
            moved[i, 2] = yaw
            continue
        for k in range(5):
            share = _NODES[k]
            vx = start[i, 0] + (end[i, 0] - start[i, 0]) * share
            vy = start[i, 1] + (end[i, 1] - start[i, 1]) * share
            rate = start[i, 2] + (end[i, 2] - start[i, 2]) * share
            heading = yaw + 0.5 * (start[i, 2] + rate) * share * dt
            c, s = math.cos(heading), math.sin(heading)
            x += (c * vx - s * vy) * dt * _WEIGHTS[k]
            y += (s * vx + c * vy) * dt * _WEIGHTS[k]
        moved[i, 0], moved[i, 1] = x, y
        turned = yaw + 0.5 * (start[i, 2] + end[i, 2]) * dt
        moved[i, 2] = math.pi - (math.pi - turned) % (2.0 * math.pi)
    return moved
