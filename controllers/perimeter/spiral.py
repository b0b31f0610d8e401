"""Random coverage: an outward spiral, and the boundary."""

import numpy as np
from numpy.typing import NDArray

from controllers.perimeter.config import PerimeterConfig
from mjmr.geometry import wrap_angle

Array = NDArray[np.float64]
_NEARLY = 0.5  # rad, off the way inwards, from which on a turn is not reversed
_NORMALS = np.array([0.0, 0.5, 1.0, -0.5]) * np.pi  # of the walls in the east, north, west, south


class Spiral:
    """Equation 2 in its outward form: w = s a exp(-b |theta - theta_0|), v = v_s (1 - e^-t).

    As printed, a > 0 winds inwards with the heading unwrapped. The spiral goes on after everything
    that interrupts it: begun anew after every wall, it covers the middle alone (11 of 60 trackings
    in our check, 60 of 60 so).

    Attributes:
        wound: How far each robot's spiral has turned (n,) [rad].
        sense: +1 anticlockwise, -1 clockwise (n,).
    """

    def __init__(self, n: int, config: PerimeterConfig, rng: np.random.Generator):
        """Draw the senses."""
        self._config = config
        self.sense = rng.choice([-1.0, 1.0], n)
        self.wound = np.zeros(n)

    def command(self, time: float, active: NDArray[np.bool_]) -> Array:
        """(forward, turn) (n, 2); the spirals of those ``active`` (n,) go on."""
        c = self._config
        forward = c.search_speed * (1.0 - np.exp(-time))
        turn = np.minimum(c.spiral_turn, c.top_turn) * np.exp(-c.spiral_decay * self.wound)
        self.wound = self.wound + np.where(active, turn * c.period, 0.0)
        return np.column_stack([np.full(len(turn), forward), self.sense * turn])


class Boundary:
    """Turns inwards before the boundary; both walls count in a corner.

    The paper's rule, always right until clear, triggered at 5 m, hits walls in 50 of 60 runs of our
    check. It turns the way that comes less near to a wall, keeps to that way, and slows down where
    the turn at full speed would not leave ``wall_margin`` (ours): at v the radius is v / w.

    Attributes:
        active: Who is turning away from the boundary (n,).
    """

    def __init__(self, n: int, config: PerimeterConfig):
        """Args: n: How many robots. config: With the boundary."""
        self._config = config
        self.active = np.zeros(n, dtype=bool)
        self._sense = np.ones(n)
        # speeds at which a turn stays off, left and right
        self._limits = np.zeros(n), np.zeros(n)
        self._known = np.zeros(n, dtype=bool)

    def command(self, pose: Array) -> Array:
        """(forward, turn) (n, 2) of those who are ``active``, which is updated.

        Args:
            pose: (n, 3); NaN rows keep what they do.
        """
        c = self._config
        x0, y0, x1, y1 = c.bounds
        x, y, yaw = pose.T
        walls = np.column_stack([x1 - x, y1 - y, x - x0, y - y0])  # their normals as in _NORMALS
        across, along = np.minimum(walls[:, 0], walls[:, 2]), np.minimum(walls[:, 1], walls[:, 3])
        near, far = np.minimum(across, along), np.maximum(across, along)
        with np.errstate(invalid="ignore"):
            # a corner is left where its farther wall no longer counts, later than it is entered
            triggered = (near < c.wall_trigger) | (far < c.wall_release)
            clear = (near > c.wall_release) & (far > c.corner_release)
            was = self.active
            self.active = np.where(was, ~clear, triggered)
            beside = walls < c.corner_release
        east, north, west, south = beside.T * 1.0
        error = wrap_angle(np.arctan2(south - north, west - east) - yaw)
        left, right = self._speeds(walls, yaw, 1.0), self._speeds(walls, yaw, -1.0)
        self._limits, self._known = (left, right), np.isfinite(x)
        short = np.where(error < 0, -1.0, 1.0)
        roomier = np.where(left > right, 1.0, np.where(right > left, -1.0, short))
        # a corner's other wall, met while turning, must not turn it back towards the first
        self._sense = np.where(was, self._sense, roomier)
        turns = (error * self._sense < 0) & (np.abs(error) > _NEARLY)
        turn = np.where(turns, self._sense, np.clip(2.0 * error, -1.0, 1.0))
        turn = np.where(beside.any(axis=1) & np.isfinite(error), turn, 0.0)
        forward = np.where(turn < 0, right, left)
        return np.column_stack([forward, c.top_turn * turn])

    def bound(self, command: Array, wanted: Array, roams: NDArray[np.bool_]) -> Array:
        """Commands (n, 2) that keep off the boundary whatever others made of them.

        Robots are where :meth:`command` of this step was told.

        Args:
            command: After everything that changed it (n, 2).
            wanted: Of :meth:`command` at this step (n, 2).
            roams: Who heeds the boundary (n,).
        """
        c = self._config
        left, right = self._limits
        forward, turn = command.T
        limit = np.where(turn < 0, right, np.where(turn > 0, left, np.maximum(left, right)))
        heeds = roams & self.active & self._known
        # where no speed leaves the margin, nobody is given way to
        turn = np.where(heeds & (limit <= c.least_speed), wanted[:, 1], turn)
        forward = np.where(heeds, np.minimum(forward, limit), forward)
        return np.column_stack([forward, turn])

    def _speeds(self, walls: Array, yaw: Array, sense: float) -> Array:
        """Speeds (n,) at which a turn at ``top_turn`` stays off the walls (n, 4), at most search's.

        A turn of radius r comes r (1 - sin(sense phi)) nearer to a wall, phi the heading from the
        wall's normal, unless it is past it already.
        """
        c = self._config
        heading = sense * wrap_angle(yaw[:, None] - _NORMALS)
        nearer = np.where(heading > np.pi / 2, 0.0, 1.0 - np.sin(heading))
        room = c.top_turn * np.maximum(walls - c.wall_margin, 0.0)
        with np.errstate(invalid="ignore", divide="ignore"):
            allowed = np.where(nearer > 1e-9, room / nearer, np.inf).min(axis=1)
        return np.clip(np.nan_to_num(allowed, nan=0.0), c.least_speed, c.search_speed)
