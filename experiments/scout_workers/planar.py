"""The planar field: discs, blocked and sliding, with the same senses, clocks and errors.

Legitimately abstract, and named so in every table (``mode=planar``). Robots have the TJ Pro's
radius, track, detectors and servo spread; the compass has white noise, a drift, a bias that
depends on the place, and whole steps.
"""

import math

import numpy as np
from numpy.typing import NDArray

from controllers.scouting import LOOP
from experiments.scout_workers import planar_kernel
from experiments.scout_workers.field import (
    CLEARANCE,
    DRIFT,
    Array,
    Flags,
    Senses,
    Setting,
    Tally,
)
from experiments.scout_workers.mazes import REACH
from mjmr.byte_channel import ByteChannel
from mjmr.geometry import wrap_angle
from mjmr.randomness import Streams
from mjmr.robots.tj_pro import TJPro, draw_servo_gains
from mjmr.sensors.ambient_field import AmbientField

BEARINGS = np.radians([25.0, -25.0])
FAN = np.radians([-10.0, 0.0, 10.0])
STEPS = 20  # of the motion in a loop: 3.8 mm each


_KEEP = math.exp(-2 * math.pi * DRIFT * LOOP)
_WAVES = 2.0  # m, mean length of the bias's waves


class PlanarField:
    """n discs in a maze; see :class:`experiments.scout_workers.field.Field`."""

    def __init__(self, setting: Setting):
        """An empty maze and robots beside it."""
        n, streams = setting.n, Streams(setting.seed)
        self.n, self.time = n, 0.0
        self.size, self.blocks = float(setting.size), setting.blocks
        self.nest, self.goal, self.compass = setting.nest, setting.goal, setting.compass
        self.pose = np.zeros((n, 3))
        self.present, self.alive = np.zeros(n, dtype=bool), np.ones(n, dtype=bool)
        self._blind = setting.blind
        gains = draw_servo_gains(streams.generator("servos"), n, setting.servo_spread)
        self._robots = TJPro(servo_gains=gains)
        self._headings = streams.generator("nest")
        self._noise = streams.generator("compass")
        self._drift = self._noise.standard_normal(n)
        self._room = AmbientField(streams.generator("ambient field"), self.compass.bias, _WAVES)
        self._channel = ByteChannel(n, setting.timing, streams.sequence("radio"))
        self._codec = setting.codec
        self._way, self._bumps = np.zeros(n), np.zeros(n, dtype=np.int64)
        self._hidden = np.zeros(n, dtype=np.int64)
        self._bump = np.zeros((n, 2), dtype=bool)
        self._groups = np.zeros(4, dtype=np.int64)

    @property
    def running(self) -> Flags:
        """Who is in the maze and alive (n,)."""
        return self.present & self.alive

    def put_down(self, robot: int) -> bool:
        """Put a robot into the nest, heading anywhere; False if it is not free."""
        away = np.hypot(*(self.pose[:, :2] - self.nest).T)
        if (away[self.present] < 2 * TJPro.radius + CLEARANCE).any():
            return False
        self.pose[robot] = (*self.nest, self._headings.uniform(-math.pi, math.pi))
        self.present[robot] = True
        return True

    def take_away(self, robot: int) -> None:
        """Pick a robot up; it can still send and hear."""
        self.present[robot] = False

    def kill(self, robot: int) -> None:
        """From now on the robot stands still, sends nothing and hears nothing."""
        self.alive[robot] = False

    def sense(self) -> Senses:
        """Readings now; what the bumpers noted is cleared."""
        n, c = self.n, self.compass
        white = self._noise.standard_normal((2, n))
        self._drift = _KEEP * self._drift + math.sqrt(1 - _KEEP**2) * white[1]
        bias = self._room.at(self.pose[:, :2])
        heading = self.pose[:, 2] + c.noise * white[0] + c.drift * self._drift + bias
        if c.step > 0:
            heading = np.round(heading / c.step) * c.step
        ir = np.zeros((n, 2), dtype=bool)
        planar_kernel.tripped(
            self.pose,
            self.present,
            self.blocks,
            self.size,
            TJPro.radius,
            TJPro.trip,
            BEARINGS,
            FAN,
            ir,
        )
        self._hidden += self._blind & ir.any(axis=1)
        ir[self._blind] = False
        bump = self._bump.copy()
        self._bump[:] = False
        self._bumps += bump.any(axis=1)
        seen = np.hypot(*(self.pose[:, :2] - self.goal).T) <= REACH
        heading = np.where(self.present, wrap_angle(heading), np.nan)
        return Senses(heading, ir, bump, seen & self.present)

    def transmit(self, robot: int, message: bytes, duration: float) -> None:
        """Let a robot repeat a message from now on, for ``duration`` [s]."""
        if self.alive[robot]:
            self._channel.transmit(robot, message, self.time, duration)

    def listen(self) -> tuple[NDArray[np.int64], NDArray[np.uint8]]:
        """Receivers (k,) and groups (k, 4) read since the last call."""
        reach = np.repeat(self.alive[:, None], self.n, axis=1) & self.alive
        heard = self._channel.listen(self.time, reach)
        good = self._codec.valid(heard.data)
        carrier = heard.carrier
        self._groups += (carrier.sum(), good.sum(), (carrier & ~good).sum(),
                         (good & ~heard.intact).sum())  # fmt: skip
        live = self.alive[heard.receiver]
        return heard.receiver[live], heard.data[live]

    def advance(self, command: Array) -> None:
        """Drive on for one loop with v [m/s] and w [rad/s], (n, 2)."""
        done = np.where(self.alive[:, None], self._robots.mistuned(command), 0.0)
        planar_kernel.advance(
            self.pose, self.present, done, self.blocks, self.size, TJPro.radius, LOOP / STEPS,
            STEPS, self._bump, self._way,
        )  # fmt: skip
        self.time = round((self.time + LOOP) / LOOP) * LOOP

    def tally(self) -> Tally:
        """What is measured."""
        read, accepted, dropped, undetected = (int(v) for v in self._groups)
        return Tally(
            self._way.copy(), self._bumps.copy(), self.pose[:, :2].copy(),
            (read, accepted, dropped, undetected), self._hidden.copy(),
        )  # fmt: skip
