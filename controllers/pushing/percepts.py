"""What a pusher perceives, in axes of fixed direction: target, home, teammates, obstacles."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from controllers.perception.arc_objects import MOVER, NOTHING, ROBOT, Objects
from controllers.schemas import Percepts, Things
from mjmr.errors import InvalidInputError
from mjmr.geometry import wrap_angle
from mjmr.jit import njit

Array = NDArray[np.float64]
ZONES = ("square", "disc", "outside")
_SAME = 0.12  # m: a ring point this near to a teammate's surface is that teammate
_PATIENCE = 1.0  # s: how long a turret looks where it lost a target
_SCAN = 1.5  # rad/s: how fast it looks around then


@dataclass(frozen=True, kw_only=True)
class Surroundings:
    """What of the world a pusher is told beforehand.

    Attributes:
        disc_radius: Of what it pushes, known by its colour [m].
        robot_radius: [m].
        zone: Where discs are done, around home: ``square`` (half a side), ``disc`` (radius), or
            ``outside`` a radius.
        size: Of the zone [m]; discs count as done a little further in than is demanded.
    """

    disc_radius: float
    robot_radius: float
    zone: str
    size: float

    def __post_init__(self):
        if self.zone not in ZONES:
            raise InvalidInputError(f"a zone is one of {', '.join(ZONES)}; got {self.zone!r}")
        if not min(self.disc_radius, self.robot_radius, self.size) > 0:
            raise InvalidInputError(
                "radii and sizes must be positive; got "
                f"{self.disc_radius}, {self.robot_radius} and {self.size} m"
            )


@dataclass(frozen=True, kw_only=True)
class Gaze:
    """One look of all robots.

    Attributes:
        objects: In the frames of the turrets.
        bearing: Of the turrets in fixed axes (n,) [rad], when the look was taken.
        heading: Of the robots in fixed axes (n,) [rad].
        home: Bearing relative to the robot and distance (n, 2) [rad, m].
        ring: Ranges of the obstacle ring (n, b) [m], infinite where it feels nothing.
    """

    objects: Objects
    bearing: Array
    heading: Array
    home: Array
    ring: Array


class Fusion:
    """Makes percepts of looks, and remembers where targets were seen last."""

    def __init__(self, n: int, surroundings: Surroundings, ring_angles: Array):
        """Args: n: Robots. surroundings: Of the world. ring_angles: Of the ring's beams (b,)."""
        self._known, self._angles = surroundings, np.array(ring_angles)
        self._disc = np.full((n, 1), surroundings.disc_radius)
        self._seen_at, self._seen_bearing = np.zeros(n), np.zeros(n)

    def percepts(self, gaze: Gaze) -> Percepts:
        """Percepts for :func:`controllers.pushing.machine.pusher_machine`."""
        known, objects = self._known, gaze.objects
        home, target, found, centre, mates = _in_fixed_axes(
            objects.kind, objects.centre, gaze.bearing, gaze.heading, gaze.home, known.disc_radius,
            ZONES.index(known.zone), known.size,
        )  # fmt: skip
        points, felt = _nearest_points(
            gaze.ring, self._angles, gaze.heading, centre, mates, known.robot_radius + _SAME
        )
        return {
            "target": Things(target, self._disc, found),
            "home": home,
            "teammates": Things(centre, np.full(mates.shape, known.robot_radius), mates),
            "obstacles": Things(points, np.zeros(felt.shape), felt),
        }

    def aim(self, percepts: Percepts, heading: Array, time: float) -> Array:
        """Where the turrets shall look, relative to the robots (n,) [rad].

        At the target; where it was lost, for a moment; then round and round.
        """
        target = percepts["target"]
        assert isinstance(target, Things)
        seen = target.valid[:, 0]
        bearing = np.arctan2(target.offset[:, 0, 1], target.offset[:, 0, 0])
        self._seen_at = np.where(seen, time, self._seen_at)
        self._seen_bearing = np.where(seen, bearing, self._seen_bearing)
        since = np.maximum(time - self._seen_at - _PATIENCE, 0.0)
        return wrap_angle(self._seen_bearing + _SCAN * since - heading)


@njit
def _in_fixed_axes(kind, centre, bearing, heading, report, radius, zone, size):
    """Home (n, 2), target (n, 1, 2) and whether there is one (n, 1), objects (n, k, 2), robots.

    The target is the disc whose surface is nearest of those that are not where they shall be.
    """
    n, k = kind.shape
    home, target = np.empty((n, 2)), np.zeros((n, 1, 2))
    found, mates = np.zeros((n, 1), dtype=np.bool_), np.zeros((n, k), dtype=np.bool_)
    turned = np.zeros((n, k, 2))
    for i in range(n):
        way = heading[i] + report[i, 0]
        home[i, 0], home[i, 1] = report[i, 1] * np.cos(way), report[i, 1] * np.sin(way)
        c, s = np.cos(bearing[i]), np.sin(bearing[i])
        best = np.inf
        for j in range(k):
            if kind[i, j] == NOTHING:
                break
            x = c * centre[i, j, 0] - s * centre[i, j, 1]
            y = s * centre[i, j, 0] + c * centre[i, j, 1]
            turned[i, j, 0], turned[i, j, 1] = x, y
            mates[i, j] = kind[i, j] == ROBOT
            if kind[i, j] != MOVER:
                continue
            if _done(x - home[i, 0], y - home[i, 1], zone, size):
                continue
            gap = np.hypot(x, y) - radius
            if gap < best:
                best, found[i, 0] = gap, True
                target[i, 0, 0], target[i, 0, 1] = x, y
    return home, target, found, turned, mates


@njit
def _done(x, y, zone, size):
    """Whether a place relative to home is in the zone."""
    if zone == 0:
        return max(abs(x), abs(y)) < size
    distance = np.hypot(x, y)
    return distance < size if zone == 1 else distance > size


@njit
def _nearest_points(ring, angles, heading, mates, seen, same):
    """Nearest points of separate obstacles (n, k, 2) in fixed axes, and which there are (n, k).

    They are the local minima of the ring's ranges; points on teammates the camera sees are left
    out.
    """
    n, b = ring.shape
    most = 8
    points = np.zeros((n, most, 2))
    felt = np.zeros((n, most), dtype=np.bool_)
    for i in range(n):
        count = 0
        for j in range(b):
            r = ring[i, j]
            if not r < np.inf:
                continue
            # of a plateau the first one; noise makes more minima of a flat wall, so look wider
            least = True
            for step in range(1, 5):
                if ring[i, (j + step) % b] < r or ring[i, (j - step) % b] <= r:
                    least = False
                    break
            if not least or count == most:
                continue
            x = r * np.cos(heading[i] + angles[j])
            y = r * np.sin(heading[i] + angles[j])
            known = False
            for k in range(mates.shape[1]):
                if seen[i, k] and np.hypot(mates[i, k, 0] - x, mates[i, k, 1] - y) < same:
                    known = True
                    break
            if not known:
                points[i, count, 0], points[i, count, 1] = x, y
                felt[i, count] = True
                count += 1
    return points, felt
