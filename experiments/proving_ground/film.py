"""The study's film: every platform at work in one hall, from above and behind the AIBO."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from controllers.legged.motion import KICK_FORWARD, WALK
from mjmr.sensors.lidar import Lidar

from controllers.motion.swing_free import swing_free
from experiments.proving_ground.aibo import engine
from mjmr.film import Film
from mjmr.film_options import FilmOptions
from mjmr.group import Group
from mjmr.recording import Recording
from mjmr.robots.aibo_ers7 import AiboERS7
from mjmr.robots.koala import Koala
from mjmr.robots.nims import Nims
from mjmr.robots.pioneer2dx import Pioneer2DX
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.robots.tamiya_txt1 import TamiyaTXT1
from mjmr.simulation import Simulation
from mjmr.study import Study
from mjmr.world import World

PERIOD = 0.04
_SECONDS = 24.0
_NEAR, _SPEED = 0.8, 0.4  # m, m/s: the Pioneers'
_ALONG = 4.0  # m, the carriage's way
_DOG = (0.6, -1.9)


def build() -> tuple[World, dict[str, Group]]:
    """The hall and a group of each platform, by name."""
    hall = World(bounds=[-5.5, -3.2, 5.5, 3.6], wall_height=0.35, floor="concrete")
    for x, y in ((-4.6, 0.2), (-3.2, -1.6), (-2.3, 0.4), (-4.7, -2.4)):
        hall.add_box(x, y, 0.4, 0.4, height=0.5, yaw=x)
    hall.add_ball(_DOG[0] + 1.6, _DOG[1])
    groups = {
        "pioneers": hall.add_group(Pioneer2DX, [[-3.6, -0.5, 0.3], [-2.2, -2.3, 2.0]]),
        "koala": hall.add_group(Koala, [[-1.0, 0.9, 0.0]], team="blue"),
        "truck": hall.add_group(TamiyaTXT1, [[2.6, -0.35, 0.0]], team="blue"),
        "dog": hall.add_group(AiboERS7(engine()), [[*_DOG, 0.0]]),
        "bots": hall.add_group(
            SoccerBot("omni"), [[4.6, -2.6, np.pi / 2], [4.6, -2.2, -np.pi / 2]], team="blue"
        ),
        "nims": hall.add_group(Nims(along=-_ALONG / 2), [[0.0, 2.7, 0.0]]),
    }
    groups["pioneers"].mount(Lidar.lms200(rate=10.0))
    return hall, groups


def world(condition: Mapping[str, Any]) -> World:
    """The film's hall, whatever the condition; for ``mjmr mjcf``."""
    return build()[0]


class _Directors:
    """What every group is told, by the time."""

    def __init__(self, groups: Mapping[str, Group]):
        self.groups = groups
        rig: Any = groups["nims"].platform
        self._travel = swing_free(_ALONG, 0.6, rig.swing_period(rig.line))
        self._motion = engine()
        self._scanner: Any = groups["pioneers"].sensors["lidar"]

    def drive(self, now: float) -> None:
        groups = self.groups
        groups["pioneers"].drive(self._keep_clear())
        # a square of 1 m: 2.5 s ahead, 1.5 s of turning
        leg = now % 4.0
        groups["koala"].drive([[0.4, 0.0] if leg < 2.5 else [0.0, np.pi / 2 / 1.5]])
        groups["truck"].drive([[0.42, 0.3]])
        angle = 1.5 * now
        circle = 0.5 * np.array([np.cos(angle), np.sin(angle)])
        groups["bots"].drive([[*circle, 0.6], [*circle, -0.6]])
        travel = self._travel.velocity(now + PERIOD) if now < 14.0 else 0.0
        winch = 0.2 if 14.0 < now < 16.0 else -0.2 if 18.0 < now < 20.0 else 0.0
        groups["nims"].drive([[travel, winch]])
        groups["dog"].drive(self._dog(now))

    def _keep_clear(self) -> np.ndarray:
        """Straight on, and away from what is near ahead."""
        ranges = self._scanner.read()
        ahead = np.where(np.isfinite(ranges), ranges, np.inf)[:, 30:-30]
        left, right = ahead[:, ahead.shape[1] // 2 :].min(1), ahead[:, : ahead.shape[1] // 2].min(1)
        near = np.minimum(left, right) < _NEAR
        turn = np.where(near, np.where(left > right, 1.5, -1.5), 0.0)
        return np.column_stack([np.where(near, 0.1, _SPEED), turn])

    def _dog(self, now: float) -> np.ndarray:
        """To the ball, kick, then about."""
        motion = self._motion
        if now < 4.4:
            return motion.command([[0.30, 0.0, 0.0]])
        if now < 9.0:
            return motion.command(action=KICK_FORWARD if now > 5.4 else WALK)
        if now < 13.0:
            return motion.command([[0.0, 0.0, 0.8]])
        return motion.command([[0.25, 0.0, 0.3]])


def show() -> Recording:
    """Run the hall and record it."""
    hall, groups = build()
    simulation = Simulation(hall, control_period=PERIOD, dt_max=0.004)
    recording = Recording(simulation)
    directors = _Directors(groups)
    for now in simulation.ticks(_SECONDS):
        directors.drive(now)
    return recording


def film(study: Study, path: Path, options: FilmOptions) -> None:
    """Write the film."""
    picture = Film("Proving ground: every platform at work", options)
    recording = show()
    picture.add(recording, "from above")
    picture.add(recording, "behind the AIBO", camera="chase", follow=4)
    picture.write(path)
