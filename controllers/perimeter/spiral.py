"""Random coverage: an outward spiral, and the boundary."""

import numpy as np
from numpy.typing import NDArray

from controllers.perimeter.config import PerimeterConfig
from mjmr.geometry import wrap_angle

Array = NDArray[np.float64]
_NEARLY = 0.5  # rad, off the way inwards, from which on a turn is not reversed


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
    """Turns inwards before the boundary, the short way; both walls count in a corner.

    The paper's rule, always right until clear, triggered at 5 m, hits walls in 50 of 60 runs of our
    check.

    Attributes:
        active: Who is turning away from the boundary (n,).
    """

    def __init__(self, n: int, config: PerimeterConfig):
        """Args: n: How many robots. config: With the boundary."""
        self._config = config
        self.active = np.zeros(n, dtype=bool)
        self._sense = np.ones(n)

    def command(self, pose: Array) -> Array:
        """(forward, turn) (n, 2) of those who are ``active``, which is updated.

        Args:
            pose: (n, 3); NaN rows keep what they do.
        """
        c = self._config
        x0, y0, x1, y1 = c.bounds
        x, y, yaw = pose.T
        west, east, south, north = x - x0, x1 - x, y - y0, y1 - y
        near = np.minimum.reduce([west, east, south, north])
        beside = 1.25 * c.wall_release
        # what is within a little more than the release distance counts: a corner's second wall
        inward_x = (west < beside) * 1.0 - (east < beside)
        inward_y = (south < beside) * 1.0 - (north < beside)
        error = wrap_angle(np.arctan2(inward_y, inward_x) - yaw)
        inward = (inward_x != 0) | (inward_y != 0)
        # straight into a corner the way round takes 5.7 m towards one of its walls
        corner = (inward_x != 0) & (inward_y != 0)
        with np.errstate(invalid="ignore"):
            triggered = corner | (near < c.wall_trigger)
            was = self.active
            self.active = np.where(was, ~(near > c.wall_release), triggered)
            # a corner's other wall, met while turning, must not turn it back towards the first
            self._sense = np.where(was, self._sense, np.where(error < 0, -1.0, 1.0))
            against = (error * self._sense < 0) & (np.abs(error) > _NEARLY)
        turn = np.where(against, self._sense, np.clip(2.0 * error, -1.0, 1.0))
        turn = np.where(inward & np.isfinite(error), turn, 0.0)
        return np.column_stack([np.full(len(x), c.search_speed), c.top_turn * turn])
