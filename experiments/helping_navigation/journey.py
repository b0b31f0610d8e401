"""Journey: R1 visits targets in MuJoCo, R2 to R4 patrol and help."""

import contextlib
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.helping.explorer import GOAL, MATE, OFFER, PLAN, Settings
from controllers.helping.goal_sharing import CHAIN, LITERAL
from controllers.motion.patrol import Patrol
from experiments.helping_navigation.crew import CLEAR, KEPT, STEP_TICKS, Crew, CrewSetup
from experiments.helping_navigation.guide import Guide
from experiments.helping_navigation.mind import Mind
from mjmr.faults import Fault
from mjmr.geometry import wrap_angle

Array = NDArray[np.float64]
ASKING = 1.0  # s: R1 stands so long with a new goal if there is somebody to answer
ARRIVE = 0.10  # m: at a ghost, more exactly than which no body gets
STAND_OFF = 0.9  # m: R1 keeps from a mate it goes after
AT_POST = 0.15  # m: a supporter that stands is where it belongs
MODES = {GOAL: "sees its goal", OFFER: "follows an offer", MATE: "follows a mate", PLAN: "plans"}


@dataclass(frozen=True, kw_only=True)
class JourneySetup:
    """What R1 is to do, and with whose help.

    Attributes:
        crew: The robots.
        targets: Of R1 (k, 2) [m], the office's frame, in order.
        planner: Of R1.
        chain: Whether offers are whole ways; else places.
        shares_state: Whether R1 goes to mates when in trouble.
        routes: Of the other robots (n - 1), waypoints (k, 2) [m]; empty: they stand.
        phase: Waypoint each makes for first; None: spread evenly.
        leg_time: After which a target is given up [s].
        faults: That are scheduled.
        settings: Numbers of the controllers.
    """

    crew: CrewSetup
    targets: Array
    planner: str
    chain: bool = True
    shares_state: bool = False
    routes: Sequence[Array] = ()
    phase: Sequence[int] | None = None
    leg_time: float = 900.0
    faults: Sequence[Fault] = ()
    settings: Settings = Settings(arrive=ARRIVE)


@dataclass
class Leg:
    """One target's way.

    Attributes:
        reached: Whether R1 came within epsilon by what it knows itself.
        seconds: It took [s].
        metres: R1 went [m], true.
        calls: Motion steps at which its planner led.
        miss: True distance at the end [m].
    """

    reached: bool = False
    seconds: float = 0.0
    metres: float = 0.0
    calls: int = 0
    miss: float = math.nan


class Journey:
    """A run and what came of it.

    Attributes:
        legs: One a target that was begun.
        mode: Of R1 now.
        decisions: Motion steps so far.
        follows: Length of each follow of a mate [motion steps].
    """

    def __init__(self, setup: JourneySetup, seed: int, planner: Any = None):
        """Args: setup: What R1 is to do. seed: Of the trial. planner: A class of one's own, if any.

        See :mod:`controllers.helping.planners` for what it has; it is given no walls.
        """
        self.setup, self.crew = setup, Crew(setup.crew, seed)
        n = self.crew.n
        for fault in setup.faults:
            self.crew.robots.faults.add(fault)
        ghosts = CHAIN if setup.chain else LITERAL
        self.minds = [
            Mind(i, n, ghosts, setup.settings, setup.shares_state and i == 0) for i in range(n)
        ]
        self.guide = Guide(
            setup.planner, setup.settings, np.asarray(setup.crew.office["size"]), planner
        )
        self._patrol = Patrol(setup.routes, phase=setup.phase) if len(setup.routes) else None
        self.decisions = 0
        self.follows: list[int] = []
        self._stands = np.array([len(route) == 1 for route in setup.routes])
        self.legs: list[Leg] = []
        self.mode = PLAN
        self._target = -1
        self._place: Array | None = None
        self._direction = np.array([1.0, 0.0])
        self._hears = np.zeros(n, dtype=bool)
        self._track = _Track(self.crew)

    def run(self, duration: float = math.inf) -> list[Leg]:
        """Visit all targets, or as many as ``duration`` [s] allows; returns the legs."""
        crew, setup = self.crew, self.setup
        most = len(setup.targets) * setup.leg_time if math.isinf(duration) else duration
        n = crew.n
        crew.simulation.caption = self.caption
        with contextlib.closing(crew.simulation):
            for k, now in enumerate(crew.simulation.ticks(most)):
                crew.sense()
                if k == 0:
                    self._next_target(now)
                if self._arrived() and not self._next_target(now, reached=True):
                    break
                if now - self._since > setup.leg_time and not self._next_target(now):
                    break
                self._talk()
                if k % STEP_TICKS == 0:
                    self._step(now)
                wish, reach = np.full(n, np.nan), np.ones(n)
                wish[0], reach[0] = self._wish()
                if self._patrol is not None and n > 1:
                    at = crew.in_office[1:]
                    goals = self._patrol.step(
                        at[:, :2], now, lambda i, p: crew.sees_in_office(i + 1, p)
                    )
                    way = goals - at[:, :2]
                    wish[1:] = wrap_angle(np.arctan2(way[:, 1], way[:, 0]) - at[:, 2])
                    reach[1:] = np.hypot(*way.T)
                    # who has but one waypoint stands there
                    wish[1:][self._stands & (reach[1:] < AT_POST)] = np.nan
                follows = np.full(n, -1)
                if self.mode == MATE and self.minds[0].state.mate[0] >= 0:
                    follows[0] = self.minds[0].state.mate[0]
                    # as near as bodies allow; from there it goes where the mate goes
                    if np.isfinite(crew.sight[0, follows[0], 0]):
                        reach[0] -= STAND_OFF
                        wish[0] = wish[0] if reach[0] > 0 else np.nan
                crew.drive(now, wish, reach, follows)
                if crew.simulation.noted:
                    self._note()
            else:
                self._close_leg(most, False)
        return self.legs

    def _talk(self) -> None:
        """Hear what was said a tick ago, look, and say what is known now."""
        crew = self.crew
        inbox = [
            [(m.sender, np.asarray(m.payload)) for m in crew.radio.receive(i)]
            for i in range(crew.n)
        ]
        for i, mind in enumerate(self.minds):
            if i == 0:
                mind.place_goal(crew.own(0, self._goal))
            mind.listen(inbox[i])
        for i, mind in enumerate(self.minds):
            words = mind.look(crew.look(i), lambda p, i=i: crew.sees(i, p))
            if crew.n > 1:
                crew.radio.broadcast(i, words)
        self._hears[:] = False
        self._hears[[sender for sender, _ in inbox[0]]] = True

    def _step(self, now: float) -> None:
        """One motion step of R1: decide, and let the planner lead if nothing else does."""
        crew, me = self.crew, self.minds[0]
        sees_goal = crew.sees(0, me.known.goal[0, 0], KEPT if self.mode in (GOAL, OFFER) else CLEAR)
        self.mode, target = me.decide(lambda p: crew.sees(0, p), sees_goal, self._hears)
        self.decisions += 1
        if self.mode == MATE and me.state.mate[0] >= 0:
            while len(self.follows) < me.state.follows[0]:
                self.follows.append(0)
            self.follows[-1] += 1
        pose = crew.pose[0]
        self.guide.look(pose, crew.ranges[0], crew.angles)
        asks = now - self._since < ASKING and self._hears.any()
        if self.mode == PLAN and asks:
            self._direction, self._place = np.zeros(2), None
        elif self.mode == PLAN:
            self.legs[-1].calls += 1
            self._direction = self.guide.step(pose, target, crew.ranges[0], crew.angles)
            self._place = None
        else:
            self.guide.pause(pose)
            self._place = target

    def _wish(self) -> tuple[float, float]:
        """Direction [rad], body frame, and distance [m] of where R1 goes."""
        if self._place is not None:
            return self.crew.bearing_to(0, self._place)
        size = float(np.linalg.norm(self._direction))
        if size < 0.05:  # in balance
            return math.nan, 1.0
        way = math.atan2(self._direction[1], self._direction[0])
        return float(wrap_angle(way - self.crew.pose[0, 2])), 1.0

    def _arrived(self) -> bool:
        far = self.crew.own(0, self._goal) - self.crew.pose[0, :2]
        return float(np.linalg.norm(far)) < self.setup.settings.epsilon

    def _next_target(self, now: float, reached: bool = False) -> bool:
        if self.legs:
            self._close_leg(now, reached)
        self._target += 1
        if self._target >= len(self.setup.targets):
            return False
        self._goal = self.setup.targets[self._target]
        self._since, self._from = now, self._track.metres
        self.minds[0].aim_at(self.crew.own(0, self._goal))
        self.guide.new_goal()
        self.legs.append(Leg())
        return True

    def _close_leg(self, now: float, reached: bool) -> None:
        leg = self.legs[-1]
        leg.reached, leg.seconds = reached, now - self._since
        leg.metres = self._track.metres - self._from
        x, y = self._track.place - self._goal
        leg.miss = math.hypot(x, y)

    @property
    def skipped(self) -> int:
        """Waypoints that patrols gave up."""
        return 0 if self._patrol is None else int(self._patrol.skipped.sum())

    def caption(self) -> str:
        """What R1 does, for films."""
        trouble = ", in trouble" if self.minds[0].state.trouble[0] else ""
        return f"R1 {MODES[self.mode]}{trouble}   target {self._target + 1}"

    def _note(self) -> None:
        crew = self.crew
        goals = np.full((crew.n, 2), np.nan)
        goals[0] = self._goal
        waypoints = goals.copy()
        if self._place is not None:
            # where R1 goes now, from F_1 back to the office, for the picture alone
            waypoints[0] = crew.in_the_office(0, self._place)
        links = np.isfinite(crew.sight[..., 0]).astype(float)
        crew.simulation.note(goals=goals, waypoints=waypoints, links=links)


class _Track:
    """Way and place of R1, true, taken by an observer.

    Attributes:
        metres: Way so far [m].
        place: Now (2,) [m].
    """

    def __init__(self, crew: Crew):
        self.metres = 0.0
        self.place = crew.robots.start[0, :2].copy()
        self._crew: Any = crew
        crew.simulation.observe(self._follow)

    def _follow(self) -> None:
        now = self._crew.simulation.truth.poses(self._crew.robots)[0, :2]
        self.metres += float(np.hypot(*(now - self.place)))
        self.place = now
