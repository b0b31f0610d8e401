"""Ways to the perimeter: the potential field's heading law, and ACQUIRE (ours)."""

import numpy as np
from numpy.typing import NDArray

from controllers.perimeter.config import PerimeterConfig
from mjmr.geometry import wrap_angle

Array = NDArray[np.float64]


class Edge:
    """How the nearest point of a perimeter lies to n robots; NaN: none is in range.

    Attributes:
        distance: From the robot's origin (n,) [m].
        bearing: From its heading (n,) [rad].
        error: Of the distance beyond the sensor's side distance (n,) [m].
        tangent: Heading error to the anticlockwise tangent, perimeter on the left (n,) [rad].
        onto: Heading of :func:`acquire` from its own, to the tangent plus atan(error) (n,) [rad].
    """

    def __init__(self, nearest: Array, config: PerimeterConfig):
        """Work them out.

        Args:
            nearest: That point (n, 2) [m], frame of the robot.
            config: With the sensor's place.
        """
        self.distance = np.hypot(nearest[:, 0], nearest[:, 1])
        self.bearing = np.arctan2(nearest[:, 1], nearest[:, 0])
        self.error = self.distance - config.look_left
        self.tangent = wrap_angle(self.bearing - np.pi / 2)
        self.onto = wrap_angle(self.tangent + np.arctan(self.error))


def approach(error: Array, config: PerimeterConfig) -> Array:
    """(forward, turn) (n, 2) towards goals that are ``error`` (n,) off: equations 3 to 6.

    The potential's force points at the goal whatever its gain; the quotient printed in equation 5
    is taken as arctan2(F_y, F_x), and the shortest way round as the wrapped difference
    (:func:`way_off`). The paper gives no speed: search speed.
    """
    turn = np.clip(config.approach_gain * error, -config.top_turn, config.top_turn)
    forward = np.full(len(error), config.search_speed)
    return np.column_stack([forward, np.nan_to_num(turn)])


def way_off(pose: Array, goal: Array) -> Array:
    """Directions of goals (n, 2) from the headings of poses (n, 3): (n,) [rad]."""
    way = goal - pose[:, :2]
    return wrap_angle(np.arctan2(way[:, 1], way[:, 0]) - pose[:, 2])


def acquire(edge: Edge, config: PerimeterConfig) -> Array:
    """(forward, turn) (n, 2) onto the perimeter: to its tangent plus atan(error).

    Head on, bang-bang needs 4 m of radius and drives up to 9 m into the disc (our check). Who comes
    with the perimeter on the right turns through it: slower where the turn would reach it.
    """
    turn = np.clip(edge.onto, -config.top_turn, config.top_turn)
    # a turn of radius r comes r (1 + sin(sense beta)) nearer to what is at bearing beta
    beta = np.sign(turn) * edge.bearing
    nearer = np.where(beta < -np.pi / 2, 0.0, 1.0 + np.sin(beta))
    room = config.top_turn * edge.error
    slow = np.clip(room / np.maximum(nearer, 1e-9), config.least_speed, config.track_speed)
    forward = np.where(np.abs(edge.onto) > config.top_turn, slow, config.track_speed)
    return np.column_stack([forward, np.nan_to_num(turn)])
