"""Crew: Pioneers in an office with their senses, radio and drive, a tick at a time."""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.estimation.odometry import Odometry
from controllers.mapping import way_is_clear
from controllers.motion.steering import Steering
from experiments.helping_navigation.courtesy import Courtesy
from experiments.helping_navigation.mind import Look
from experiments.helping_navigation.perception import TeammateSight, radio_sight
from experiments.helping_navigation.physical_world import add_team, office_world
from mjmr.geometry import compose, invert, rotate, transform_points, wrap_angle
from mjmr.metrics import ContactMeter
from mjmr.radio import Radio
from mjmr.sensors.localizer import Localizer
from mjmr.simulation import Simulation

Array = NDArray[np.float64]
PERIOD = 0.1  # s: of the drives and of making way
STEP_TICKS = 3  # ticks a motion step takes: 0.15 m at 0.5 m/s
CLEAR = 0.32  # m: half of the lane that must be free for a place to be in sight
# the same for a goal in sight already, which a robot in its turns may else lose, or that others saw
# from where it goes: it gets there give or take ten centimetres
KEPT = 0.22  # m


@dataclass(frozen=True, kw_only=True)
class CrewSetup:
    """What a crew is and what goes wrong with it.

    Attributes:
        office: ``size`` (2,) and ``walls`` (k, 4) [m].
        starts: Poses (n, 3), world frame.
        frames: Poses (n, 3) at which the robots' own frames F_i have their bodies at the start:
            what a robot takes its pose for.
        sight: Radius of sight and radio [m].
        noisy: Whether teammates are misperceived, see :class:`TeammateSight`.
        err_max: Of their distances.
        radio_loss: Probability that a message in reach is lost.
        localizer_noise: Deviations [m, rad] of where robots take themselves to be in the office.
        marks: Places (k, 2) [m] painted on the floor: goals, for films.
    """

    office: dict[str, Any]
    starts: Array
    frames: Array
    sight: float = 8.0
    noisy: bool = False
    err_max: float = 0.0
    radio_loss: float = 0.0
    localizer_noise: tuple[float, float] = (0.01, 0.003)
    marks: Array = field(default_factory=lambda: np.empty((0, 2)))


class Crew:
    """The robots' senses, each in its own frame, and their drives.

    What is read here are sensors: encoders, lidars, eyes for teammates, radio and, for where the
    office is around a robot, a localizer. Sharing uses none of the last.

    Attributes:
        n: How many.
        pose: In their own frames F_i, by odometry (n, 3).
        in_office: In the office's frame, by the localizer (n, 3); for patrols, and goals of R1.
        ranges: Scans (n, b) [m].
        angles: Of their beams (b,) [rad].
        sight: Distance and bearing of each teammate (n, n, 2), body frame.
    """

    def __init__(self, setup: CrewSetup, seed: int):
        """Args: setup: What they are. seed: Of the trial."""
        self.setup, self.n = setup, len(setup.starts)
        self.world = office_world(setup.office["size"], setup.office["walls"])
        for x, y in setup.marks:
            self.world.add_mark(x, y, radius=0.3, rgba=(0.95, 0.45, 0.05, 1.0))
        self.robots = add_team(self.world, setup.starts, lidar_rate=1 / PERIOD)
        noise = setup.localizer_noise
        self.robots.mount(Localizer(rate=1 / PERIOD, position_noise=noise[0], yaw_noise=noise[1]))
        self.eyes = self.world.mount(
            TeammateSight(
                radius=setup.sight, noisy=setup.noisy, err_max=setup.err_max, rate=1 / PERIOD
            )
        )
        self.simulation = Simulation(self.world, seed=seed, control_period=PERIOD, dt_max=0.01)
        self.radio = Radio(
            self.simulation,
            range=setup.sight,
            loss=setup.radio_loss,
            visible=lambda: radio_sight(self.simulation, setup.sight),
        )
        self.meter = ContactMeter(self.simulation)
        platform: Any = self.robots.platform
        self._odometry = Odometry(
            setup.frames,
            radius=platform.rolling_radius,
            track=platform.track,
            counts_per_turn=self.robots.encoders.counts_per_turn,
        )
        self.angles = self.robots.lidar.angles
        self._beams = np.cos(self.angles), np.sin(self.angles)
        self._steering, self._courtesy = Steering(), Courtesy(self.n, self.radio)
        self._frame = np.full((self.n, 3), np.nan)

    def sense(self) -> None:
        """Read every sensor."""
        robots = self.robots
        self.pose = self._odometry.step(robots.encoders.read())
        self.in_office = robots.localizer.read()
        self.ranges = np.nan_to_num(robots.lidar.read(), nan=np.inf, neginf=0.0)
        self.sight = self.eyes.read()
        # where the office lies in F_i: odometry drifts slowly, the localizer is noisy
        fresh = compose(self.pose, invert(self.in_office))
        old = np.where(np.isfinite(self._frame), self._frame, fresh)
        turned = wrap_angle(fresh[:, 2] - old[:, 2])
        self._frame = np.column_stack(
            [old[:, :2] + 0.02 * (fresh[:, :2] - old[:, :2]), old[:, 2] + 0.02 * turned]
        )

    def own(self, i: int, point: ArrayLike) -> Array:
        """A point (2,) [m] of the office in F_i, as robot i's localizer and odometry have it."""
        return transform_points(self._frame[i], point)

    def in_the_office(self, i: int, point: ArrayLike) -> Array:
        """A point (2,) [m] of F_i in the office; what :meth:`own` undoes."""
        return transform_points(invert(self._frame[i]), point)

    def look(self, i: int) -> Look:
        """What robot i perceives of its teammates, in F_i."""
        distance, bearing = self.sight[i, :, 0], self.sight[i, :, 1]
        clear = np.zeros(self.n, dtype=bool)
        for j in np.flatnonzero(np.isfinite(distance)):
            clear[j] = self._clear(
                i, distance[j] * math.cos(bearing[j]), distance[j] * math.sin(bearing[j])
            )
        own = wrap_angle(bearing + self.pose[i, 2])
        return Look(self.pose[i, :2].copy(), distance, own, clear)

    def sees(self, i: int, point: Array, lane: float = CLEAR) -> bool:
        """Whether robot i sees a place (2,) [m] in F_i and the straight way there is free.

        Args:
            i: The robot.
            point: The place.
            lane: Half the width that must be free [m].
        """
        x, y = rotate(point - self.pose[i, :2], -self.pose[i, 2])
        return self._clear(i, float(x), float(y), lane)

    def sees_in_office(self, i: int, point: Array) -> bool:
        """Whether the straight way of robot i to a place (2,) [m] of the office is free."""
        at = self.in_office[i]
        x, y = rotate(point - at[:2], -at[2])
        cos, sin = self._beams
        return way_is_clear(self.ranges[i], cos, sin, float(x), float(y), KEPT, math.inf)

    def bearing_to(self, i: int, point: Array) -> tuple[float, float]:
        """Bearing [rad] in the body frame of robot i, and distance [m], of a place in F_i."""
        x, y = rotate(point - self.pose[i, :2], -self.pose[i, 2])
        return math.atan2(y, x), math.hypot(x, y)

    def drive(
        self, time: float, wish: Array, reach: Array, follows: NDArray[np.int64] | None = None
    ) -> None:
        """Make way for who goes first, keep off what is near, and drive.

        Args:
            time: [s].
            wish: Directions (n,) [rad], body frames; NaN: stand.
            reach: Distances to where they go (n,) [m].
            follows: Whom each goes after (n,), -1 nobody.
        """
        sight = self.sight
        way = self._courtesy.step(
            time, wish, self.pose[:, 2], sight, self.ranges, self.angles, follows
        )
        others = sight[..., :1] * np.stack([np.cos(sight[..., 1]), np.sin(sight[..., 1])], axis=-1)
        reach = np.where(way == wish, reach, 1.0)
        self.robots.drive(self._steering.step(way, reach, self.ranges, self.angles, others))

    def _clear(self, i: int, x: float, y: float, lane: float = CLEAR) -> bool:
        cos, sin = self._beams
        return way_is_clear(self.ranges[i], cos, sin, x, y, lane, self.setup.sight)
