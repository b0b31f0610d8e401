"""Scouts and workers: every robot of a team at once, one call a program loop.

How to drive it (planar or physical), every 0.5 s::

    team = ScoutTeam(n, behaviour=Behaviour(margin=...), codec=Codec(), rng=generator)
    ...
    team.hear(receivers, groups)             # four-byte groups read since the last loop, unchecked
    on_field = place_those(team.released)    # put down in the nest, once there is room
    command = team.step(time, heading, ir, bump, goal_seen, active=on_field)   # (n, 2)
    for i in np.flatnonzero(team.reports):   # begin to send in this loop, if there is anything
        radio.transmit(i, team.message(i))   # 4 bytes or a multiple of it; b"" is silence
    drive(command)                           # v [m/s], w [rad/s], held for 0.5 s

Inputs are what the robots sense, arrays over the team: ``heading`` (n,) [rad], compass, world
axes, anticlockwise; ``ir`` (n, 2) flags of the left and right infrared detector; ``bump`` (n, 2)
flags, left and right half of the front bumper, latched since the last loop (both for a hit in the
middle); ``goal_seen`` (n,). A robot that is not ``active`` (not released, removed at the goal,
dead) neither moves nor counts; it still hears. ``team.action`` is the same command in nominal
units: (n, 2) of units forward (-1, 0, 1) and turn [rad]. ``team.state`` holds numbers of
``machine.STATES``; ``team.done`` says who has finished for good, ``team.found`` who has seen the
goal, ``team.travelled`` each robot's own reckoning in units.

Robots 0 .. scouts-1 are scouts, the rest workers that leave in the order of their numbers.
Everything random comes from ``rng``: three numbers a robot and loop, whatever happens.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.scouting import kernel, machine
from controllers.scouting.behaviour import LOOP, UNIT, Behaviour
from controllers.scouting.coding import Codec
from controllers.scouting.records import Records, kinds_needed
from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]


class ScoutTeam:
    """The controllers of n robots; see the module's text.

    Attributes:
        behaviour: Parameters.
        records: What each robot knows of the goal.
        memory: What each robot remembers of its way.
        action: Units forward and turn [rad] of the coming loop (n, 2).
        reports: Who begins to send in this loop (n,).
        cues: Which of ``machine.CUES`` each robot went by in this loop (n, cues).
        left_at: When each worker left (n,) [s]; NaN before.
        found_at: When each robot saw the goal (n,) [s]; NaN before.
    """

    def __init__(
        self,
        n: int,
        *,
        rng: np.random.Generator,
        behaviour: Behaviour | None = None,
        codec: Codec | None = None,
        scouts: int = 1,
    ):
        """Set up n robots in the nest.

        Args:
            n: Robots.
            rng: Every random decision comes from it.
            behaviour: Parameters; the card's by default.
            codec: How messages are packed and checked.
            scouts: How many of them search, from number 0 on.

        Raises:
            InvalidInputError: No robot, or more scouts than robots.
        """
        if not 0 <= scouts <= n or n < 1:
            raise InvalidInputError(f"a team has 1 robot or more and 0 to n scouts; {n}, {scouts}")
        self.n, self.scouts = n, scouts
        self.behaviour = behaviour or Behaviour()
        rule = self.behaviour.succession
        self.records = Records(n, codec or Codec(kinds=kinds_needed(rule)), rule)
        b = self.behaviour
        self._rules = kernel.Rules(
            b.margin, b.avoid_step, b.bump_turn, int(b.forced), b.tolerance, b.turn_limit,
            b.wander_chance, b.wander_turn, b.arrive, b.spiral_pitch, int(b.spiral_legs),
        )  # fmt: skip
        self._tables = np.stack([machine.table(machine.scout(b)), machine.table(machine.worker(b))])
        role = (np.arange(n) >= scouts).astype(np.int64)
        self.memory = kernel.new_memory(role)
        self._rng = rng
        self.action = np.zeros((n, 2))
        self.reports = np.zeros(n, dtype=bool)
        self.cues = np.zeros((n, kernel.CUE_COUNT), dtype=bool)
        self.left_at = np.full(n, np.nan)
        self.found_at = np.full(n, np.nan)
        self._heard_at = np.full(n, np.nan)
        self._rank = np.maximum(np.arange(n) - scouts, 0)
        self._time = 0.0

    def hear(self, receivers: ArrayLike, groups: ArrayLike) -> Flags:
        """Take groups of four bytes as they were read; those that fail their checks are dropped.

        Args:
            receivers: Robot that read each group (k,).
            groups: Bytes (k, 4).

        Returns:
            Which were valid (k,).
        """
        valid = self.records.hear(np.asarray(receivers), np.asarray(groups, dtype=np.uint8))
        fresh = self.records.known & np.isnan(self._heard_at)
        self._heard_at[fresh] = self._time
        return valid

    def tell(self, vector: ArrayLike) -> None:
        """Give every worker a vector (2,) [units] without a message, for tests and ablations."""
        workers = self.memory.role == 1
        self.records.goal[workers] = np.asarray(vector, dtype=np.float64)
        self.records.known[workers] = True
        self._heard_at[workers] = self._time

    @property
    def released(self) -> Flags:
        """Who is to be on the field: scouts, and workers that know a goal and whose turn it is."""
        due = self._heard_at + self.behaviour.release * self._rank
        with np.errstate(invalid="ignore"):
            return (self.memory.role == 0) | (due <= self._time + 1e-9)

    def step(
        self,
        time: float,
        heading: ArrayLike,
        ir: ArrayLike,
        bump: ArrayLike,
        goal_seen: ArrayLike,
        active: ArrayLike | None = None,
    ) -> Array:
        """One program loop; shapes and units are in the module's text.

        Args:
            time: Now [s].
            heading: (n,) [rad].
            ir: (n, 2) flags.
            bump: (n, 2) flags.
            goal_seen: (n,) flags.
            active: (n,) flags; default: everybody who is released.

        Returns:
            v [m/s] and w [rad/s] for the coming loop (n, 2), nominal.

        Raises:
            InvalidInputError: Another shape, or an active robot without a heading.
        """
        self._time = float(time)
        on = self.released if active is None else np.asarray(active, dtype=bool)
        ahead = np.asarray(heading, dtype=np.float64)
        eyes, feelers = np.asarray(ir, dtype=bool), np.asarray(bump, dtype=bool)
        seen = np.asarray(goal_seen, dtype=bool)
        n = self.n
        if not (ahead.shape == seen.shape == on.shape == (n,)
                and eyes.shape == feelers.shape == (n, 2)):  # fmt: skip
            raise InvalidInputError(
                f"heading, goal_seen and active have shape ({n},), ir and bump ({n}, 2)"
            )
        if not np.isfinite(ahead[on]).all():
            raise InvalidInputError("an active robot needs a finite heading")
        ready = self.released & self.records.known
        random = self._rng.random((n, 3))
        leaving = on & ready & (self.memory.state == machine.WAIT)
        for i in np.flatnonzero(leaving):
            self._set_out(int(i))
        kernel.step(
            self.memory, self._rules, self._tables, ready, on, ahead, eyes, feelers, seen, random,
            self.action, self.reports, self.cues,
        )  # fmt: skip
        for i in np.flatnonzero(self.reports):
            self._finish(int(i))
        return self.action * (UNIT / LOOP, 1.0 / LOOP)

    def message(self, robot: int) -> bytes:
        """What a robot sends since it last reported; empty if it keeps silent."""
        return self.records.outgoing[robot]

    @property
    def state(self) -> Ints:
        """Number of each robot's state (n,), a copy."""
        return self.memory.state.copy()

    @property
    def travelled(self) -> Array:
        """Each robot's reckoning since the nest (n, 2) [units], a copy."""
        return self.memory.travelled.copy()

    @property
    def done(self) -> Flags:
        """Who has finished for good (n,)."""
        return self.memory.state == machine.DONE

    @property
    def found(self) -> Flags:
        """Who has seen the goal (n,)."""
        return ~np.isnan(self.found_at)

    def vector(self, robot: int) -> tuple[float, float]:
        """Direction [rad] and displacement [units] a robot has travelled: Eqs. 3 and 4."""
        x, y = self.memory.travelled[robot]
        return math.atan2(y, x), math.hypot(x, y)

    def _set_out(self, robot: int) -> None:
        m, r = self.memory, self.records
        self.left_at[robot] = self._time
        m.goal[robot] = r.goal[robot]
        m.vias[robot] = np.nan_to_num(r.vias[robot])
        m.via_count[robot] = r.via_count(robot)
        m.via_at[robot] = 0

    def _finish(self, robot: int) -> None:
        self.found_at[robot] = self._time
        m = self.memory
        self.records.finish(
            robot,
            travelled=m.travelled[robot],
            length=float(m.length[robot]),
            trail=m.trail[robot, : m.marks[robot]],
            scout=bool(m.role[robot] == 0),
        )
