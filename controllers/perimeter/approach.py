"""Ways to the perimeter: the potential field's heading law, and ACQUIRE (ours)."""

import numpy as np
from numpy.typing import NDArray

from controllers.perimeter.config import PerimeterConfig
from mjmr.geometry import wrap_angle

Array = NDArray[np.float64]


def approach(pose: Array, goal: Array, config: PerimeterConfig) -> Array:
    """(forward, turn) (n, 2) towards ``goal`` (n, 2): equations 3 to 6.

    The potential's force points at the goal whatever its gain; the quotient printed in equation 5
    is taken as arctan2(F_y, F_x), and the shortest way round as the wrapped difference. The paper
    gives no speed: search speed.
    """
    error = way_off(pose, goal)
    turn = np.clip(config.approach_gain * error, -config.top_turn, config.top_turn)
    forward = np.full(len(pose), config.search_speed)
    return np.column_stack([forward, np.nan_to_num(turn)])


def way_off(pose: Array, goal: Array) -> Array:
    """Directions of goals (n, 2) from the headings of poses (n, 3): (n,) [rad]."""
    way = goal - pose[:, :2]
    return wrap_angle(np.arctan2(way[:, 1], way[:, 0]) - pose[:, 2])


def edge_errors(edge: Array, config: PerimeterConfig) -> tuple[Array, Array]:
    """Distance of the perimeter beyond the sensor's side distance (n,) [m], and heading error (n,).

    Args:
        edge: Nearest point of the perimeter (n, 2) [m], frame of the robot.
        config: With the sensor's place.

    Returns:
        Both NaN where no perimeter is in range; the heading error is that of the anticlockwise
        tangent, perimeter on the left [rad].
    """
    error = np.hypot(edge[:, 0], edge[:, 1]) - config.look_left
    tangent = wrap_angle(np.arctan2(edge[:, 1], edge[:, 0]) - np.pi / 2)
    return error, tangent


def onto(edge: Array, config: PerimeterConfig) -> Array:
    """Heading of :func:`acquire` from the robot's own (n,) [rad]."""
    error, tangent = edge_errors(edge, config)
    return wrap_angle(tangent + np.arctan(error))


def acquire(edge: Array, config: PerimeterConfig) -> Array:
    """(forward, turn) (n, 2) onto the perimeter: to its tangent plus atan(error).

    Head on, bang-bang needs 4 m of radius and drives up to 9 m into the disc (our check). Who comes
    with the perimeter on the right turns through it: slower where the turn would reach it.
    """
    wanted = onto(edge, config)
    turn = np.clip(wanted, -config.top_turn, config.top_turn)
    # a turn of radius r comes r (1 + sin(sense beta)) nearer to what is at bearing beta
    beta = np.sign(turn) * np.arctan2(edge[:, 1], edge[:, 0])
    nearer = np.where(beta < -np.pi / 2, 0.0, 1.0 + np.sin(beta))
    room = config.top_turn * (np.hypot(edge[:, 0], edge[:, 1]) - config.look_left)
    slow = np.clip(room / np.maximum(nearer, 1e-9), config.least_speed, config.track_speed)
    forward = np.where(np.abs(wanted) > config.top_turn, slow, config.track_speed)
    return np.column_stack([forward, np.nan_to_num(turn)])
