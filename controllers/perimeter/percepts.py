"""What each robot of a team knows at one step, from its own sensors and its own radio."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError
from mjmr.geometry import wrap_angle

Array = NDArray[np.float64]
SPOKEN = ("x", "y", "yaw", "state", "news_x", "news_y", "news_at", "news_of", "hops", "radius",
          "speed")  # fmt: skip
"""Columns of what a robot broadcasts; news: where a perimeter was sensed, when, by whom."""
X, Y, YAW, STATE, NEWS_X, NEWS_Y, NEWS_AT, NEWS_OF, HOPS, RADIUS, SPEED = range(len(SPOKEN))


@dataclass(frozen=True, kw_only=True)
class Percepts:
    """One step's knowledge of n robots, rows that nobody else's are mixed into.

    Attributes:
        time: [s].
        pose: (n, 3) [m, m, rad], world frame; NaN rows: not known.
        edge: Nearest point of a perimeter (n, 2) [m], frame of the robot; NaN rows: none in range.
        inside: Whether the look-ahead point is inside (n,): 1 or 0, NaN: nothing is known.
        room: Of the perimeter beyond what a sharp turn to the right sweeps (n,) [m]; NaN: unknown.
        body: Nearest robot seen (n, 2) [m], frame of the robot; NaN rows: none.
        heard: Newest row of ``SPOKEN`` heard (n, n, c), receiver first; NaN: never.
        sent: When that was sent (n, n) [s].
    """

    time: float
    pose: Array
    edge: Array
    inside: Array
    room: Array
    body: Array
    heard: Array
    sent: Array

    def __post_init__(self):
        n = len(self.pose)
        wanted = {
            "pose": (n, 3),
            "edge": (n, 2),
            "inside": (n,),
            "room": (n,),
            "body": (n, 2),
            "heard": (n, n, len(SPOKEN)),
            "sent": (n, n),
        }
        for name, shape in wanted.items():
            found = getattr(self, name).shape
            if found != shape:
                raise InvalidInputError(f"{name} of {n} robots has shape {shape}; got {found}")


def nearest_of_kind(looks: Array, angles: Array, kind: int, mount: Array, reach: float) -> Array:
    """Nearest point of one kind that a fan of rays meets (n, 2) [m], frame of the robot.

    Args:
        looks: Range [m] and kind of every ray (n, c, 2).
        angles: Of the rays (c,) [rad].
        kind: Which.
        mount: Where on the robot the fan begins and its yaw (3,) [m, m, rad].
        reach: Further away than this from there nothing counts [m].

    Returns:
        NaN rows where there is none.
    """
    ranges = np.where(looks[..., 1] == kind, looks[..., 0], np.inf)
    column = np.argmin(ranges, axis=1)
    near = np.take_along_axis(ranges, column[:, None], axis=1)[:, 0]
    near = np.where(near <= reach, near, np.nan)
    way = angles[column] + mount[2]
    return mount[:2] + near[:, None] * np.column_stack([np.cos(way), np.sin(way)])


def foot_of_edge(looks: Array, angles: Array, kind: int, mount: Array, reach: float) -> Array:
    """Nearest points of a perimeter to the robots' origins (n, 2) [m], frame of the robot.

    Of a line through what rays meet within 0.4 m of the nearest return: the nearest ray alone, in a
    flat minimum, says little about the direction.

    Args:
        looks: Range [m] and kind of every ray (n, c, 2).
        angles: Of the rays (c,) [rad].
        kind: Of the perimeter.
        mount: Where on the robot the fan begins and its yaw (3,) [m, m, rad].
        reach: Further away than this from there nothing counts [m].

    Returns:
        NaN rows where there is none in reach.
    """
    ranges = np.where(looks[..., 1] == kind, looks[..., 0], np.inf)
    near = ranges.min(axis=1)
    found = near <= reach
    part = np.isfinite(ranges) & (ranges <= (near + 0.4)[:, None])
    length = np.where(part, ranges, 0.0)
    way = angles + mount[2]
    points = length[..., None] * np.column_stack([np.cos(way), np.sin(way)])
    count = np.maximum(part.sum(axis=1), 1)
    middle = points.sum(axis=1) / count[:, None]
    off = np.where(part[..., None], points - middle[:, None], 0.0)
    xx, yy = (off**2).sum(axis=1).T
    xy = (off[..., 0] * off[..., 1]).sum(axis=1)
    along = 0.5 * np.arctan2(2.0 * xy, xx - yy)
    normal = np.column_stack([-np.sin(along), np.cos(along)])
    # of a single point, straight towards it
    straight = middle / np.maximum(np.hypot(middle[:, 0], middle[:, 1]), 1e-9)[:, None]
    normal = np.where((count >= 3)[:, None], normal, straight)
    normal *= np.where((normal * middle).sum(axis=1) < 0, -1.0, 1.0)[:, None]
    foot = normal * (((middle + mount[:2]) * normal).sum(axis=1))[:, None]
    return np.where(found[:, None], foot, np.nan)


def room_to_turn(looks: Array, angles: Array, kind: int, mount: Array, radius: float, nose: Array
                 ) -> Array:  # fmt: skip
    """How far a perimeter ahead or to the left is from what a turn to the right sweeps (n,) [m].

    Args:
        looks: Range [m] and kind of every ray (n, c, 2).
        angles: Of the rays (c,) [rad].
        kind: Of the perimeter.
        mount: Where on the robot the fan begins and its yaw (3,) [m, m, rad].
        radius: Of the turn [m].
        nose: The robot's front left corner (2,) [m].

    Returns:
        inf where no ray from 45 degrees to the right to 90 to the left meets one.
    """
    way = wrap_angle(angles + mount[2])
    part = (way > -np.pi / 4) & (way < np.pi / 2)
    looks, way = looks[:, part], way[part]
    met = looks[..., 1] == kind
    length = np.where(met, looks[..., 0], 0.0)
    x, y = mount[0] + length * np.cos(way), mount[1] + length * np.sin(way)
    room = np.hypot(x, y + radius) - np.hypot(nose[0], radius + nose[1])
    return np.where(met, room, np.inf).min(axis=1)
