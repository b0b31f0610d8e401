"""The numbers of the hybrid controller, the paper's and ours."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError, UnknownNameError

SPACINGS = ("repaired", "literal")


@dataclass(frozen=True, kw_only=True)
class PerimeterConfig:
    """What a team is told before it starts.

    Speeds and turn rates of search and tracking, ``proportional`` and ``dead_band`` are printed in
    the paper (R. Fierro, J. Clark, D. Hougen and S. Commuri, 2005, section 3.1); everything else is
    ours, because the paper's figure with it is lost or because without it the team fails.

    Attributes:
        bounds: The boundary (xmin, ymin, xmax, ymax) [m], world frame.
        period: Between two steps [s].
        search_speed: [m/s].
        track_speed: [m/s]; also of ACQUIRE.
        doubt_speed: While tracking by readings that cannot all be right, at most [m/s].
        top_turn: Largest turn rate [rad/s].
        track_turn: w_t of the bang-bang law at ``track_speed`` [rad/s].
        spiral_turn: a, with which a spiral begins [rad/s].
        spiral_decay: b, by which it unwinds [1/rad].
        wall_trigger: Distance to the boundary at which the robot turns inwards [m].
        wall_release: Distance at which it searches on [m]; nearer to two walls is a corner.
        corner_release: Distance to the farther wall at which a corner is left [m].
        wall_margin: That a turn leaves to every wall, at a lower speed if it must be [m].
        least_speed: Of that turn [m/s]; slower, the steering's lock allows no ``top_turn``.
        approach_gain: k of the potential field's heading law [1/s]: soft 0.3 / 2 pi, stiff 0.3.
        avoid_radius: Within which rule 3 holds [m].
        guard_radius: Within which somebody ahead is waited for [m].
        guard_angle: To each side, what counts as ahead [rad].
        pass_speed: At which one passes who waits [m/s].
        patience: For which one waits for somebody who does not move [s].
        round_radius: Distance at which one goes round who does not move [m].
        close: Within which nobody may be on the way of who goes round [m].
        touching: Within which nobody may be before it at all [m].
        same: From where the radio puts a robot, within which one that is seen is the same [m].
        reach: From a robot's surface, which is seen, to its origin, which is told [m].
        hold: For which one goes on waiting when nobody is ahead any more [s].
        sense_range: D_sen, at which the perimeter is acquired [m].
        look_ahead: Of the sensor's spot before the rear axle [m].
        look_left: And to the left [m].
        nose_margin: Room to turn below which whoever follows the perimeter turns away from it [m].
        hand_over_error: |error| below which bang-bang takes over [m].
        hand_over_angle: |heading error| below which it does [rad].
        lose_after: Without a perimeter in range for so long, it is lost [s].
        desired: d_des, distance between neighbours [m]; 0: estimated on line.
        factor: Of the even chord that an estimated d_des is; 0: 1 - .05 / (N - 1).
        proportional: k_p [1/s].
        dead_band: epsilon [m].
        spacing: ``repaired``: the front robot of a close pair moves; ``literal``: equation 8.
        resume_depth: Of the edge, inside or outside, at which a stopped robot moves on [m].
        settle_error: Of the edge beside it, beyond which none may stop after a zigzag [m].
        news_timeout: After which a told location that shows nothing is given up [s]; besides the
            way there at search speed.
        news_age: Of news that nobody sets out for any more [s].
        forget_after: Age at which what was heard of a robot counts no more [s].
        doubt: For which the own sensors see nobody ahead until one who is said to be there no
            longer counts [s]; infinite: the radio is believed.
    """

    bounds: tuple[float, float, float, float]
    period: float = 0.1
    search_speed: float = 1.0
    track_speed: float = 0.4
    doubt_speed: float = 0.2
    top_turn: float = 0.3
    track_turn: float = 0.1
    spiral_turn: float = 0.3
    spiral_decay: float = 0.1
    wall_trigger: float = 6.0
    wall_release: float = 8.0
    corner_release: float = 10.0
    wall_margin: float = 2.0
    least_speed: float = 0.2
    approach_gain: float = 0.3 / (2.0 * math.pi)
    avoid_radius: float = 2.5
    guard_radius: float = 3.5
    guard_angle: float = math.radians(60.0)
    pass_speed: float = 0.3
    patience: float = 4.0
    round_radius: float = 2.2
    close: float = 1.3
    touching: float = 0.9
    same: float = 1.5
    reach: float = 0.4
    hold: float = 1.0
    sense_range: float = 3.0
    look_ahead: float = 0.5
    look_left: float = 0.6
    nose_margin: float = 0.15
    hand_over_error: float = 0.2
    hand_over_angle: float = 0.35
    lose_after: float = 5.0
    desired: float = 0.0
    factor: float = 0.0
    proportional: float = 0.06
    dead_band: float = 0.01
    spacing: str = "repaired"
    resume_depth: float = 0.15
    settle_error: float = 0.05
    news_timeout: float = 60.0
    news_age: float = 120.0
    forget_after: float = 1.0
    doubt: float = math.inf

    def __post_init__(self):
        if self.spacing not in SPACINGS:
            raise UnknownNameError("spacing rule", self.spacing, SPACINGS)
        x0, y0, x1, y1 = self.bounds
        if min(x1 - x0, y1 - y0) <= 2.0 * self.wall_release:
            raise InvalidInputError(
                f"the boundary must be more than {2.0 * self.wall_release:g} m wide and high; got "
                f"{x1 - x0:g} x {y1 - y0:g} m"
            )
        for name in ("desired", "factor"):
            if not 0 <= getattr(self, name) < math.inf:
                raise InvalidInputError(
                    f"{name} must be 0 or more and finite; got {getattr(self, name)}"
                )
        for name in ("period", "search_speed", "track_speed", "top_turn", "track_turn"):
            if not getattr(self, name) > 0:
                raise InvalidInputError(f"{name} must be positive; got {getattr(self, name)}")


def tracked_radius(radius: float, ahead: float = 0.5, left: float = 0.6) -> float:
    """Radius of the circle a rear axle runs on whose look-ahead point is on a disc's edge [m].

    Args:
        radius: Of the disc [m].
        ahead: Of the look-ahead point before the axle [m].
        left: And to the left [m].

    Raises:
        InvalidInputError: A disc smaller than that point is ahead.
    """
    if radius <= ahead:
        raise InvalidInputError(
            f"a disc that is tracked has a radius above {ahead:g} m; got {radius:g} m"
        )
    return left + math.sqrt(radius * radius - ahead * ahead)


def even_factor(n: int) -> float:
    """Share of the even chord at which n robots end evenly and stopped (our check)."""
    return float(even_factors(np.array(n)))


def even_factors(n: NDArray[np.int64]) -> NDArray[np.float64]:
    """The same of many numbers of robots at once, in n's shape."""
    return np.where(n > 1, 1.0 - 0.05 / np.maximum(n - 1, 1), 1.0)
