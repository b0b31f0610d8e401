"""What a scout or worker is told once: increments, margins, and what follows the goal."""

import math
from dataclasses import dataclass

from mjmr.errors import InvalidInputError, UnknownNameError

UNIT = 0.0762
"""What a robot drives in a program loop [m]: about 3 inches (MacKunis and Raviv 2003, 3.2)."""
LOOP = 0.5
"""Of the program [s]: the heading is sampled about twice a second (3.2)."""
AFTER_GOAL = ("stop", "home")
SCOUT_AFTER = ("search", "stop")
SUCCESSIONS = ("none", "average", "via", "both")


@dataclass(frozen=True, kw_only=True)
class Behaviour:
    """Parameters of scouts and workers; the paper prints none of the angles.

    Args:
        margin: Heading error a worker tolerates before it turns back to its course [rad].
        avoid_step: Of a turn away from what the infrared detectors see, one a loop [rad].
        bump_turn: Away from the side that was hit, after backing up [rad].
        forced: Units a worker drives forward after a turn away before it compares its heading
            with its course again; 0: it compares in every loop.
        tolerance: Heading error at which a turn to the course is finished, if below the margin
            [rad].
        turn_limit: Most a robot turns in one loop [rad].
        wander_chance: Of a random turn of a scout, per loop.
        wander_turn: Random turns are uniform between plus and minus this [rad].
        arrive: Where the goal should be nearer than this and is not seen, the worker spirals
            [units].
        spiral_pitch: Between the turns of the (square) spiral [units].
        spiral_legs: Sides of a spiral before it starts again from its centre.
        after_goal: A worker that has reported the goal stops, or drives home.
        scout_after: A scout that has reported the goal searches on, or stops.
        succession: What a finisher tells those that wait: nothing, the vector averaged over
            finishers, via-points of a shorter path, or both.
        release: Workers leave in turn, this long after each other [s].

    Raises:
        InvalidInputError: A value out of range.
    """

    margin: float = math.radians(35.0)
    avoid_step: float = math.radians(20.0)
    bump_turn: float = math.radians(45.0)
    forced: int = 1
    tolerance: float = math.radians(10.0)
    turn_limit: float = math.radians(60.0)
    wander_chance: float = 0.1
    wander_turn: float = math.radians(60.0)
    arrive: float = 1.5
    spiral_pitch: float = 2.0
    spiral_legs: int = 12
    after_goal: str = "stop"
    scout_after: str = "search"
    succession: str = "none"
    release: float = 5.0

    def __post_init__(self):
        turns = (self.margin, self.avoid_step, self.bump_turn, self.turn_limit, self.tolerance)
        if not all(0 < turn <= math.pi for turn in turns) or not 0 <= self.wander_turn <= math.pi:
            raise InvalidInputError("a margin, tolerance or turn lies above 0 and up to pi rad")
        if self.avoid_step > self.turn_limit or self.bump_turn > self.turn_limit:
            raise InvalidInputError("a step of a turn is no larger than turn_limit")
        if not 0 <= self.wander_chance <= 1:
            raise InvalidInputError(f"a chance is 0 to 1; got {self.wander_chance}")
        if self.forced < 0 or self.forced != int(self.forced):
            raise InvalidInputError(f"forced units are a whole number, 0 or more; {self.forced}")
        if not (self.arrive > 0 and self.spiral_pitch > 0 and self.spiral_legs >= 1):
            raise InvalidInputError("arrive and spiral_pitch are above 0, spiral_legs 1 or more")
        if not self.release >= 0:
            raise InvalidInputError(f"release is 0 s or more; got {self.release}")
        for kind, value, valid in (
            ("after_goal", self.after_goal, AFTER_GOAL),
            ("scout_after", self.scout_after, SCOUT_AFTER),
            ("succession", self.succession, SUCCESSIONS),
        ):
            if value not in valid:
                raise UnknownNameError(kind, value, valid)
