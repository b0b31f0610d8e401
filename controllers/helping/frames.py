"""Frames by mutual bearings: two robots that see each other need no common frame.

Every robot i keeps its positions, goals and ghosts in a frame F_i of its own. Robot i sees j at
bearing ``alpha_ij`` and distance ``d_ij`` in F_i, and j sees i at ``alpha_ji`` in F_j. The heading
of F_j in F_i is then ``180 degrees + alpha_ij - alpha_ji``.

Source: Sgorbissa and Arkin, section 3.1 and figure 4, whose theta_12 is ``turn(alpha_12,
alpha_21)`` here.
"""

import numpy as np

from mjmr.jit import njit


@njit
def turn(seen_at, sees_me_at):
    """Heading [rad] of the other's frame in mine.

    Args:
        seen_at: Bearing of the other in my frame [rad].
        sees_me_at: Bearing of me in the other's frame [rad].
    """
    return np.pi + seen_at - sees_me_at


@njit
def to_mine(px, py, qx, qy, x, y, distance, seen_at, sees_me_at):
    """A point told by another robot, in my frame.

    Args:
        px: The point in the other's frame [m].
        py: The point in the other's frame [m].
        qx: The other's position in its own frame [m].
        qy: The other's position in its own frame [m].
        x: My position in my frame [m].
        y: My position in my frame [m].
        distance: Of the other, as I perceive it [m].
        seen_at: Bearing of the other in my frame [rad].
        sees_me_at: Bearing of me in the other's frame, as it told me [rad].
    """
    theta = turn(seen_at, sees_me_at)
    c, s = np.cos(theta), np.sin(theta)
    vx, vy = px - qx, py - qy
    return (
        x + distance * np.cos(seen_at) + c * vx - s * vy,
        y + distance * np.sin(seen_at) + s * vx + c * vy,
    )
