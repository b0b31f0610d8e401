"""The physical field: TJ Pros in MuJoCo, with the same senses, clocks and errors as the planar one.

What is abstract here is the experimenter: robots that are not in the maze stand in a yard beside
it, switched off; one is put into the nest when it is due and picked up when it has finished, by
hand (:meth:`mjmr.simulation.Simulation.lift`). Between that they move by their wheels alone. A
robot's program starts with the first loop after it was put down.
"""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from controllers.scouting import LOOP
from experiments.scout_workers.arena import build_arena, yard_slots
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
from mjmr.byte_radio import ByteRadio
from mjmr.errors import InvalidInputError
from mjmr.faults import Fault
from mjmr.randomness import Streams
from mjmr.robots.tj_pro import TJPro, draw_servo_gains
from mjmr.sensors.bumper import Bumper
from mjmr.sensors.compass import Compass
from mjmr.sensors.floor_patch import FloorPatch
from mjmr.sensors.proximity import InfraredProximity
from mjmr.simulation import Simulation

TICKS = 5  # control periods in a program loop
TIMESTEP = 0.01  # s
SECTORS = 6  # of the bumper; the front ones are 0 ahead, 1 left of it, 5 right


class PhysicalField:
    """n TJ Pros; see :class:`experiments.scout_workers.field.Field`.

    Attributes:
        n: Robots.
        time: Simulated [s].
        simulation: Their simulation.
        robots: Their group.
        touches: Control periods that ended with a robot touching another one (n,).
    """

    def __init__(self, setting: Setting):
        """An empty maze and robots in the yard beside it."""
        n, size, nest, goal = setting.n, setting.size, setting.nest, setting.goal
        self.n, self.time, self.nest = n, 0.0, nest
        streams, c = Streams(setting.seed), setting.compass
        world = build_arena(size, setting.blocks, nest, goal, n)
        self._yard = yard_slots(size, n)
        gains = draw_servo_gains(streams.generator("servos"), n, setting.servo_spread)
        self.robots = robots = world.add_group(TJPro(servo_gains=gains), self._yard)
        rate = 1.0 / LOOP
        self._compass = robots.mount(
            Compass(
                rate=rate, noise=c.noise, step=c.step, drift=c.drift, place_bias=c.bias,
                drift_time=1.0 / (2.0 * math.pi * DRIFT),
            )
        )  # fmt: skip
        self._proximity = robots.mount(InfraredProximity(trip=TJPro.trip, rate=rate))
        self._bumper = robots.mount(Bumper(sectors=SECTORS, threshold=0.5, rate=rate))
        self._patch = robots.mount(FloorPatch([[*goal, REACH]], rate=rate))
        self.simulation = Simulation(
            world, seed=setting.seed, control_period=LOOP / TICKS, dt_max=TIMESTEP
        )
        self._radio = ByteRadio(self.simulation, setting.timing, check=setting.codec.valid)
        self._headings = streams.generator("nest")
        self._present, self._running = np.zeros(n, dtype=bool), np.zeros(n, dtype=bool)
        self._alive = np.ones(n, dtype=bool)
        self._blind = setting.blind
        self._way, self._bumps = np.zeros(n), np.zeros(n, dtype=np.int64)
        self._hidden = np.zeros(n, dtype=np.int64)
        self.touches = np.zeros(n, dtype=np.int64)
        self._place = self._yard[:, :2].copy()
        self._owners = self._rims()
        self._loop: Iterator[float] | None = None
        self.simulation.observe(self._measure)

    @property
    def running(self) -> Flags:
        """Who is in the maze, alive and has been put down before this loop (n,)."""
        return self._running & self._alive

    def put_down(self, robot: int) -> bool:
        """Put a robot into the nest, heading anywhere; False if it is not free."""
        away = np.hypot(*(self._place - self.nest).T)
        if (away[self._present] < 2 * TJPro.radius + CLEARANCE).any():
            return False
        heading = self._headings.uniform(-math.pi, math.pi)
        self._lift(robot, np.array([*self.nest, heading]))
        self._present[robot] = True
        return True

    def take_away(self, robot: int) -> None:
        """Pick a robot up; it can still send and hear."""
        self._present[robot] = self._running[robot] = False
        self._lift(robot, self._yard[robot])

    def kill(self, robot: int) -> None:
        """From now on the robot stands still, sends nothing and hears nothing."""
        self._alive[robot] = False
        self.robots.faults.add(Fault(kind="dead", robot=robot, start=self.time))

    def sense(self) -> Senses:
        """Readings of the loop that begins; from now until :meth:`advance` a controller acts.

        Raises:
            InvalidInputError: The loop has begun already.
        """
        if self._loop is not None:
            raise InvalidInputError("this loop's readings were taken; advance before the next")
        self._loop = self.simulation.ticks(LOOP)
        next(self._loop)
        there = self._present
        bumped = self._bumper.read()
        bump = (bumped[:, [1, 5]] | bumped[:, [0]]) & there[:, None]
        self._bumps += bump.any(axis=1)
        ir = self._proximity.read() & there[:, None]
        self._hidden += self._blind & ir.any(axis=1)
        ir[self._blind] = False
        heading = np.where(there, self._compass.read(), np.nan)
        return Senses(heading, ir, bump, self._patch.read()[:, 0] & there)

    def transmit(self, robot: int, message: bytes, duration: float) -> None:
        """Let a robot repeat a message from now on, for ``duration`` [s]."""
        self._radio.transmit(robot, message, duration)

    def listen(self) -> tuple[NDArray[np.int64], NDArray[np.uint8]]:
        """Receivers (k,) and groups (k, 4) that passed their checks since the last call."""
        groups = self._radio.receive()
        return groups.receiver, groups.data

    def advance(self, command: Array) -> None:
        """Drive on for one loop with v [m/s] and w [rad/s], (n, 2).

        A turn is over by the end of its loop: it takes all control periods but the last, in which
        the servos stop, and is as much faster.

        Raises:
            InvalidInputError: :meth:`sense` has not begun the loop.
        """
        if self._loop is None:
            raise InvalidInputError("a loop begins with its readings; sense before advancing")
        turning = np.where(self.running[:, None], command, 0.0)
        turning[:, 1] *= TICKS / (TICKS - 1)
        ahead = turning * (1.0, 0.0)
        for k in range(TICKS):
            self.robots.drive(turning if k < TICKS - 1 else ahead)
            next(self._loop, None)
        self._loop = None
        self.time = self.simulation.time
        self._running |= self._present

    def tally(self) -> Tally:
        """What is measured, as it was when the last control period ended."""
        r = self._radio
        groups = (r.groups_read, r.groups_accepted, r.groups_dropped, r.groups_undetected)
        read, accepted, dropped, undetected = (int(count.sum()) for count in groups)
        return Tally(
            self._way.copy(), self._bumps.copy(), self._place.copy(),
            (read, accepted, dropped, undetected), self._hidden.copy(),
        )  # fmt: skip

    def _lift(self, robot: int, pose: Array) -> None:
        self.simulation.lift(self.robots, [robot], [pose])
        if self._present[robot] or pose[0] > 0:
            self._place[robot] = pose[:2]

    def _measure(self) -> None:
        """After every control period: ways, places and who touches whom."""
        simulation, there = self.simulation, self._present
        place = simulation.truth.poses(self.robots)[there, :2]
        self._way[there] += np.hypot(*(place - self._place[there]).T)
        self._place[there] = place
        pairs = self._owners[simulation.data.contact.geom]
        meet = (pairs >= 0).all(axis=1) & (pairs[:, 0] != pairs[:, 1])
        self.touches[np.unique(pairs[meet])] += 1

    def _rims(self) -> NDArray[np.int64]:
        """Robot whose rim each geom is, -1 of everything else."""
        model = self.simulation.model
        owners = np.full(model.ngeom, -1)
        for i, prefix in enumerate(self.robots.prefixes):
            owners[model.geom(f"{prefix}rim").id] = i
        return owners
