"""One explorer and its supporters, step by step, for callers that sense by themselves.

    team = HelpingTeam(4, "chain", AvoidPast(settings), settings)
    team.new_goal([3.0, 2.0])                         # in robot 0's frame
    each step:
        team.share(own, heard, distance, bearing)     # who hears whom, and sees it where
        ask = team.points()                           # what each robot is to look for, in F_i
        team.reflect(sees_goal, sees_ghost)           # whether each sees them
        mode, target = team.decide(sees_goal[0], sees_next)
        vector = team.steer(mode, target, ranges)     # in F_0, length at most 1 step

Talking is fast: in each of ``share`` and ``reflect``, word goes as far as robots see each other.
Every position is in the frame of the robot it belongs to: F_i, fixed where robot i keeps its
odometry. No robot knows another's frame; mutual bearings carry points across.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.helping.explorer import PLAN, Settings, decide, next_point
from controllers.helping.goal_sharing import (
    CHAIN,
    LITERAL,
    check_goal,
    memory,
    new_goal,
    offers,
    reflect,
    share_goals,
)
from controllers.helping.state_sharing import calm, untroubled
from mjmr.errors import InvalidInputError, UnknownNameError

Array = NDArray[np.float64]
READINGS = {"literal": LITERAL, "chain": CHAIN}


class Points(NamedTuple):
    """What robots are to look for.

    Args:
        goal: The explorer's goal in each robot's frame (n, 2) [m]; nan where it knows none.
        ghost: Its ghost (n, 2) [m]; nan where it has none.
        next: Next point of the explorer's offer (2,) [m], in its frame; nan if there is none.
    """

    goal: Array
    ghost: Array
    next: Array


class HelpingTeam:
    """Goal-sharing and state-sharing of n robots; robot 0 explores."""

    def __init__(
        self,
        n: int,
        reading: str,
        planner: Any,
        settings: Settings | None = None,
        *,
        shares_goals: bool = True,
        shares_state: bool = False,
    ):
        """Start without a goal.

        Args:
            n: Robots.
            reading: ``"literal"`` or ``"chain"``; see :mod:`controllers.helping.goal_sharing`.
            planner: Of the explorer; see :mod:`controllers.helping.planners`.
            settings: See there.
            shares_goals: Whether robots share goals.
            shares_state: Whether the explorer goes to mates when in trouble.

        Raises:
            InvalidInputError: Fewer than one robot, or an unknown reading.
        """
        if n < 1:
            raise InvalidInputError(f"a team has at least one robot, not {n}")
        if reading not in READINGS:
            raise UnknownNameError("reading of goal-sharing", reading, READINGS)
        ghosts = READINGS[reading]
        self.n, self.planner = n, planner
        self.settings = settings or Settings()
        self.shares_goals, self.shares_state = shares_goals, shares_state
        self.known, self.offered = memory(n, ghosts), offers(n, ghosts)
        self.state = untroubled(n)
        self._own = np.zeros((n, 2))
        self._heard = np.zeros((n, n), dtype=np.bool_)
        self._distance, self._bearing = np.zeros((n, n)), np.zeros((n, n))

    def new_goal(self, goal: ArrayLike) -> None:
        """The explorer's next goal (2,) [m], in its frame."""
        x, y = np.asarray(goal, dtype=np.float64)
        new_goal(self.known, self.offered, 0, x, y)
        calm(self.state, 0)
        self.planner.begin()

    def share(
        self, own: ArrayLike, heard: ArrayLike, distance: ArrayLike, bearing: ArrayLike
    ) -> None:
        """Start a step: robots in sight tell each other the goals they know.

        Args:
            own: Own positions (n, 2) [m], row i in F_i.
            heard: Whether i hears j (n, n): in sight of each other, and the message came.
            distance: Of j as i perceives it (n, n) [m]; read where i hears j.
            bearing: Of j in F_i as i perceives it (n, n) [rad]; read where i or j hears the other.
        """
        self._own[:], self._heard[:] = np.asarray(own), np.asarray(heard)
        self._distance[:], self._bearing[:] = np.asarray(distance), np.asarray(bearing)
        if self.shares_goals:
            for _ in range(self.n - 1):
                share_goals(self.known, self._own, self._heard, self._distance, self._bearing)

    def points(self) -> Points:
        """What each robot is to look for now."""
        known, rows = self.known, np.arange(self.n)
        goal = np.where(known.number[:, :1] > 0, known.goal[:, 0], np.nan)
        last = known.path[rows, 0, np.maximum(known.ghosts[:, 0] - 1, 0)]
        ghost = np.where(known.ghosts[:, :1] > 0, last, np.nan)
        x, y, more = next_point(self.offered, 0)
        return Points(goal, ghost, np.array([x, y]) if more else np.full(2, np.nan))

    def reflect(self, sees_goal: ArrayLike, sees_ghost: ArrayLike) -> None:
        """Everyone checks what it can offer, and tells those in sight.

        Args:
            sees_goal: Whether each robot sees ``points().goal`` (n,).
            sees_ghost: Whether each robot sees ``points().ghost`` (n,).
        """
        if self.shares_goals:
            sees, ghost = np.asarray(sees_goal), np.asarray(sees_ghost)
            for i in range(1, self.n):
                if self.known.number[i, 0] > 0:
                    check_goal(self.known, self._own, i, 0, bool(sees[i]), bool(ghost[i]))
            for _ in range(self.n - 1):
                reflect(
                    self.known, self.offered, self._own, self._heard, self._distance,
                    self._bearing, self.settings.keep_promise,
                )  # fmt: skip
        self.known.last[:] = self._own

    def decide(self, sees_goal: bool, sees_next: bool) -> tuple[int, Array]:
        """What the explorer goes to.

        Args:
            sees_goal: Whether it sees its goal.
            sees_next: Whether it sees ``points().next`` (asked for after :meth:`reflect`).

        Returns:
            ``GOAL``, ``OFFER``, ``MATE`` (go straight) or ``PLAN``, and the target (2,) [m] in F_0.
        """
        mode, x, y = decide(
            self.known, self.offered, self.state, 0, self._own, self._heard, self._distance,
            self._bearing, bool(sees_goal), bool(sees_next), self.settings, self.shares_state,
        )  # fmt: skip
        return mode, np.array([x, y])

    def steer(self, mode: int, target: ArrayLike, ranges: Array) -> Array:
        """Way of the explorer (2,), in steps and in F_0, no longer than one.

        Args:
            mode: From :meth:`decide`.
            target: From :meth:`decide` (2,) [m].
            ranges: Free way of its centre along ``RAYS`` (32,) [m], in F_0.
        """
        position, target = self._own[0], np.asarray(target, dtype=np.float64)
        if mode == PLAN:
            return self.planner.step(position, target, ranges)
        self.planner.pause(position)
        way = target - position
        return way / max(np.hypot(*way), self.settings.step)
