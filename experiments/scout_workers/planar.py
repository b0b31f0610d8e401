"""The planar field: discs, blocked and sliding, with the same senses, clocks and errors.

Legitimately abstract, and named so in every table (``mode=planar``). Robots have the TJ Pro's
radius, track, detectors and servo spread; the compass has white noise, a drift, a bias that
depends on the place, and whole steps.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from controllers.scouting import LOOP
from controllers.scouting.coding import Codec
from experiments.scout_workers import planar_kernel
from experiments.scout_workers.field import Array, Flags, Senses, Tally
from mjmr.byte_channel import ByteChannel, ByteTiming
from mjmr.geometry import wrap_angle
from mjmr.randomness import Streams
from mjmr.sensors.ambient_field import AmbientField

RADIUS, TRACK = 0.09, 0.13  # m: the TJ Pro's, equal by test
TRIP = 0.10  # m, of the detectors
BEARINGS = np.radians([25.0, -25.0])
FAN = np.radians([-10.0, 0.0, 10.0])
SEEN = 0.15  # m, from where the goal is seen
STEPS = 20  # of the motion in a loop: 3.8 mm each


@dataclass(frozen=True, kw_only=True)
class CompassErrors:
    """Errors of the compass.

    Args:
        noise: Deviation of every reading [rad].
        drift: Deviation of an error that wanders, cut off at 0.2 Hz [rad].
        bias: Bound of an error that depends on the place, in waves about 2 m long [rad].
        step: Readings are whole multiples of it [rad]; 0: not rounded.
    """

    noise: float = math.radians(2.0)
    drift: float = math.radians(1.0)
    bias: float = math.radians(5.0)
    step: float = math.radians(2.0)


EXACT = CompassErrors(noise=0.0, drift=0.0, bias=0.0, step=0.0)
_KEEP = math.exp(-2 * math.pi * 0.2 * LOOP)
_WAVES = 2.0  # m, mean length of the bias's waves


class PlanarField:
    """n discs in a maze; see :class:`experiments.scout_workers.field.Field`."""

    def __init__(
        self,
        n: int,
        *,
        seed: int,
        size: float,
        blocks: Array,
        nest: Array,
        goal: Array,
        compass: CompassErrors | None = None,
        servo_spread: float = 0.05,
        timing: ByteTiming | None = None,
        codec: Codec | None = None,
        blind: Flags | None = None,
    ):
        """An empty maze and n robots beside it.

        Args:
            n: Robots.
            seed: Of the trial.
            size: Side of the arena [m].
            blocks: Corners (k, 4) [m].
            nest: (2,) [m].
            goal: (2,) [m].
            compass: Its errors.
            servo_spread: Each servo is up to this much fast or slow, for good.
            timing: Of the radio.
            codec: What counts accepted groups; the team has its own.
            blind: Whose infrared detectors are dead (n,).
        """
        streams = Streams(seed)
        self.n, self.time = n, 0.0
        self.size, self.blocks = float(size), np.ascontiguousarray(blocks, dtype=np.float64)
        self.nest, self.goal = np.asarray(nest, dtype=float), np.asarray(goal, dtype=float)
        self.compass = compass or CompassErrors()
        self.pose = np.zeros((n, 3))
        self.present, self.alive = np.zeros(n, dtype=bool), np.ones(n, dtype=bool)
        self._blind = np.zeros(n, dtype=bool) if blind is None else np.asarray(blind, dtype=bool)
        gains = streams.generator("servos").uniform(1 - servo_spread, 1 + servo_spread, (n, 2))
        self._gains = gains
        self._headings = streams.generator("nest")
        self._noise = streams.generator("compass")
        self._drift = self._noise.standard_normal(n)
        self._room = AmbientField(streams.generator("ambient field"), self.compass.bias, _WAVES)
        self._channel = ByteChannel(n, timing or ByteTiming(), streams.sequence("radio"))
        self._codec = codec or Codec()
        self._way, self._bumps = np.zeros(n), np.zeros(n, dtype=np.int64)
        self._bump = np.zeros((n, 2), dtype=bool)
        self._touched = np.zeros(n, dtype=bool)
        self._groups = np.zeros(4, dtype=np.int64)

    @property
    def running(self) -> Flags:
        """Who is in the maze and alive (n,)."""
        return self.present & self.alive

    def put_down(self, robot: int) -> bool:
        """Put a robot into the nest, heading anywhere; False if it is not free."""
        away = np.hypot(*(self.pose[:, :2] - self.nest).T)
        if (away[self.present] < 2 * RADIUS + 0.01).any():
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
            self.pose, self.present, self.blocks, self.size, RADIUS, TRIP, BEARINGS, FAN, ir
        )
        ir[self._blind] = False
        bump = self._bump.copy()
        self._bump[:] = False
        self._bumps += bump.any(axis=1)
        seen = np.hypot(*(self.pose[:, :2] - self.goal).T) <= SEEN
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
        half = TRACK / 2
        left = self._gains[:, 0] * (command[:, 0] - half * command[:, 1])
        right = self._gains[:, 1] * (command[:, 0] + half * command[:, 1])
        done = np.column_stack([(left + right) / 2, (right - left) / TRACK])
        done[~self.alive] = 0.0
        planar_kernel.advance(
            self.pose, self.present, done, self.blocks, self.size, RADIUS, LOOP / STEPS, STEPS,
            self._bump, self._way, self._touched,
        )  # fmt: skip
        self.time = round((self.time + LOOP) / LOOP) * LOOP

    def tally(self) -> Tally:
        """What is measured."""
        read, accepted, dropped, undetected = (int(v) for v in self._groups)
        return Tally(
            self._way.copy(), self._bumps.copy(), self.pose[:, :2].copy(),
            (read, accepted, dropped, undetected),
        )  # fmt: skip
