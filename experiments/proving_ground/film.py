"""The study's film: every platform at work in one hall, from above and behind the AIBO."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from controllers.legged.ers7_keyframes import ERS7_KICKS
from controllers.legged.heading import HeadingLoop
from controllers.legged.motion import KICK_FORWARD, WALK
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
from mjmr.sensors.lidar import Lidar
from mjmr.sensors.localizer import Localizer
from mjmr.simulation import Simulation
from mjmr.study import Study
from mjmr.world import World

PERIOD = 0.04
_SECONDS = 16.0
_NEAR, _SPEED = 0.8, 0.4  # m, m/s: the Pioneers'
_ALONG = 4.0  # m, the carriage's way
_DOG, _BALL = (-0.9, -2.5), (0.6, -2.5)


def build() -> tuple[World, dict[str, Group]]:
    """The hall and a group of each platform, by name."""
    hall = World(bounds=[-4.2, -3.4, 4.2, 3.4], wall_height=0.35, floor="concrete")
    for x, y in ((-3.4, 0.6), (-2.0, -1.1), (-3.5, -2.8)):
        hall.add_box(x, y, 0.4, 0.4, height=0.5, yaw=x)
    hall.add_ball(*_BALL)
    groups = {
        "pioneers": hall.add_group(Pioneer2DX, [[-3.3, -0.9, 0.3], [-2.3, -2.4, 2.0]]),
        "koala": hall.add_group(Koala, [[-1.2, 0.6, 0.0]], team="blue"),
        "truck": hall.add_group(TamiyaTXT1, [[1.9, -0.6, 0.0]], team="blue"),
        "dog": hall.add_group(AiboERS7(engine()), [[*_DOG, 0.0]]),
        "bots": hall.add_group(
            SoccerBot("omni"), [[3.5, -2.4, np.pi / 2], [2.9, -2.4, -np.pi / 2]], team="blue"
        ),
        "nims": hall.add_group(Nims(along=-_ALONG / 2), [[0.0, 2.6, 0.0]]),
    }
    groups["pioneers"].mount(Lidar.lms200(rate=10.0))
    groups["dog"].mount(Localizer(rate=25.0))
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
        self._walk, self._kicked = HeadingLoop(), 0.0
        self._reported: Any = groups["dog"].sensors["localizer"]
        self._scanner: Any = groups["pioneers"].sensors["lidar"]

    def drive(self, now: float) -> None:
        groups = self.groups
        groups["pioneers"].drive(self._keep_clear())
        # a square of 1 m: 2.5 s ahead, 1.5 s of turning
        leg = now % 4.0
        groups["koala"].drive([[0.4, 0.0] if leg < 2.5 else [0.0, np.pi / 2 / 1.5]])
        groups["truck"].drive([[0.42, 0.3]])
        # round each other, facing outwards
        groups["bots"].drive([[0.0, -0.45, 1.5], [0.0, -0.45, 1.5]])
        travel = self._travel.velocity(now + PERIOD) if now < 10.0 else 0.0
        winch = 0.2 if 10.0 < now < 12.0 else -0.2 if 13.0 < now < 15.0 else 0.0
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
        """Up to the ball, kick, then about."""
        motion, kick = self._motion, ERS7_KICKS[KICK_FORWARD]
        pose = self._reported.read()[0]
        gap = _BALL[0] - pose[0] - kick.ball[0]
        if not self._kicked and gap > 0.004:
            turn = float(self._walk.turn(pose[2], 2.0 * (_BALL[1] - pose[1])))
            return motion.command([[min(0.3, 2.0 * gap + 0.03), 0.0, turn]])
        self._kicked = self._kicked or now
        since = now - self._kicked
        if since < 3.5:
            return motion.command(action=KICK_FORWARD if since > 0.4 else WALK)
        return motion.command([[0.0, 0.0, 0.9] if since < 6.0 else [0.25, 0.0, 0.3]])


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
    picture.add(recording, "the hall", camera="corner")
    picture.add(recording, "behind the AIBO", camera="chase", follow=4)
    picture.write(path)
