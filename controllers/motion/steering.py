"""From a direction to (forward, turn): drive where the way is free, near the direction wanted.

What turns a planner's direction into commands of a two-wheel robot, and keeps its body off walls
and other robots. It knows what the robot's own rangers and eyes tell, in its body frame, alone.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.motion.free_way import free_past
from mjmr.errors import InvalidInputError
from mjmr.jit import njit

Array = NDArray[np.float64]
_STEP = math.radians(5.0)  # between headings tried
_WIDEST = math.radians(100.0)  # furthest off the direction wanted that is tried
_WEDGED = 0.025  # m: what is this far within the radius kept from it may meet a turning hull


@dataclass(frozen=True, kw_only=True)
class SteeringConfig:
    """How robots drive.

    Attributes:
        speed: Where nothing is in the way [m/s].
        radius: Of the disc around a robot that must stay clear of walls [m].
        robot_radius: Of other robots' discs [m].
        look_ahead: A way that is free this far is as good as any [m].
        braking: What the way to a stop is planned with [m/s^2].
        gain: Turn for each radian off the heading chosen [1/s].
        max_turn: [rad/s].
    """

    speed: float = 0.5
    radius: float = 0.32
    robot_radius: float = 0.30
    look_ahead: float = 0.6
    braking: float = 0.7
    gain: float = 4.0
    max_turn: float = 2.5

    def __post_init__(self):
        for name, value in vars(self).items():
            if not 0 < value < math.inf:
                raise InvalidInputError(f"{name} must be positive and finite; got {value}")


class Steering:
    """Commands of n robots."""

    def __init__(self, config: SteeringConfig | None = None):
        """Args: config: How they drive."""
        self.config = config or SteeringConfig()

    def step(
        self, wish: ArrayLike, distance: ArrayLike, ranges: Array, angles: Array, others: ArrayLike
    ) -> Array:
        """Commands of this instant.

        Args:
            wish: Directions wanted (n,) [rad], body frame; NaN stands still.
            distance: To where each wants to go (n,) [m]; the way beyond need not be free.
            ranges: Of each robot's scan (n, b) [m]; not finite where nothing returned.
            angles: Of its beams (b,) [rad], body frame.
            others: Other robots seen (n, k, 2) [m], body frame; NaN where there is none.

        Returns:
            Forward [m/s] and turn [rad/s], (n, 2).
        """
        c = self.config
        return steer(
            np.asarray(wish, dtype=np.float64),
            np.asarray(distance, dtype=np.float64),
            np.ascontiguousarray(ranges),
            np.cos(angles),
            np.sin(angles),
            np.ascontiguousarray(others, dtype=np.float64),
            (c.speed, c.radius, c.robot_radius, c.look_ahead, c.braking, c.gain, c.max_turn),
        )


@njit
def free_way(cos, sin, points, radii, count, reach):
    """How far a disc gets along a direction before it touches a point, at most ``reach`` [m].

    Args:
        cos: Of the direction.
        sin: Of the direction.
        points: What is in the way (m, 3): x, y and distance [m], the disc's middle at the origin.
        radii: Distance each keeps (m,) [m].
        count: Of the points that count.
        reach: [m].
    """
    free = reach
    for k in range(count):
        free = min(free, free_past(cos, sin, points[k, 0], points[k, 1], points[k, 2], radii[k]))
    return free


@njit
def near_points(ranges, cos, sin, others, radius, robot_radius, reach, points, radii):
    """Collect what is within ``reach`` of one robot; returns how many.

    Args:
        ranges: Scan (b,) [m].
        cos: Of its beams (b,).
        sin: Of its beams (b,).
        others: Robots (k, 2) [m], NaN: none.
        radius: Kept from walls [m].
        robot_radius: Of other robots [m], on top of it.
        reach: [m].
        points: Filled (b + k, 3): x, y and distance.
        radii: Filled (b + k,).
    """
    count = 0
    for k in range(ranges.shape[0]):
        r = ranges[k]
        if 0.0 < r < reach:
            x, y = r * cos[k], r * sin[k]
            points[count, 0], points[count, 1], points[count, 2] = x, y, math.hypot(x, y)
            radii[count] = radius
            count += 1
    for k in range(others.shape[0]):
        x, y = others[k, 0], others[k, 1]
        distance = math.hypot(x, y)
        if distance < reach + robot_radius:  # False for NaN
            points[count, 0], points[count, 1], points[count, 2] = x, y, distance
            radii[count] = radius + robot_radius
            count += 1
    return count


@njit
def steer(wish, distance, ranges, cos, sin, others, config):
    """See :meth:`Steering.step`; ``config`` are its numbers in their order."""
    speed, radius, robot_radius, look_ahead, braking, gain, max_turn = config
    n = wish.shape[0]
    command = np.zeros((n, 2))
    most = ranges.shape[1] + others.shape[1]
    points, radii = np.empty((most, 3)), np.empty(most)
    for i in range(n):
        if not math.isfinite(wish[i]):
            continue
        count = near_points(
            ranges[i], cos, sin, others[i], radius, robot_radius, look_ahead + 1.0, points, radii
        )
        wanted = min(look_ahead, max(distance[i], 0.05))
        chosen, best, way = 0.0, -math.inf, 0.0
        for k in range(int(_WIDEST / _STEP) + 1):
            for side in (1.0, -1.0):
                if k == 0 and side < 0:
                    continue
                off = side * k * _STEP
                angle = wish[i] + off
                free = free_way(math.cos(angle), math.sin(angle), points, radii, count, wanted)
                value = free / wanted - 0.25 * abs(off)
                if value > best:
                    chosen, best, way = angle, value, free
            # further off cannot be better than a way that is free
            if best >= 1.0 - 0.25 * (k + 1) * _STEP:
                break
        error = math.pi - (math.pi - chosen) % (2.0 * math.pi)
        command[i, 1] = min(max(gain * error, -max_turn), max_turn)
        nearest, side = math.inf, 1.0
        for k in range(count):
            gap = points[k, 2] - radii[k]
            if gap < nearest:
                nearest, side = gap, points[k, 0]
        if nearest < -_WEDGED and abs(error) > math.pi / 9:
            # a corner would swing into what is that near: first straight away from it
            back = -1.0 if side > 0.0 else 1.0
            if free_way(back, 0.0, points, radii, count, 0.1) > 0.03:
                command[i, 0], command[i, 1] = 0.3 * speed * back, 0.0
                continue
        if abs(error) < math.pi / 3:
            ahead = free_way(1.0, 0.0, points, radii, count, look_ahead)
            stop = min(way if way < wanted else look_ahead, ahead)
            forward = min(speed, math.sqrt(2.0 * braking * max(stop - 0.01, 0.0)))
            command[i, 0] = forward * math.cos(1.5 * error)
    return command
