"""Teammates that lend their eyes: goal-sharing, state-sharing and local planners.

Robot 0 explores: it has goals one after another and a weak local planner. The others patrol or
stand; they tell it whether they see, have seen, or can relay sight of its goal (goal-sharing), and
whether they are in trouble themselves (state-sharing).

* :mod:`controllers.helping.point_team` is the paper's own simulation of point robots, compiled.
* The parts are modules of compiled functions over named tuples of arrays: ``goal_sharing``,
  ``state_sharing``, ``explorer`` (what goes first), ``frames`` (mutual bearings), ``visibility``,
  ``patrol``, and the planners ``potential_field`` and ``visbug``; Avoid Past is
  :mod:`controllers.schemas.visits`.

Source: A. Sgorbissa and R. C. Arkin, Local Navigation Strategies for a Team of Robots (c. 2003).
"""

from controllers.helping.explorer import GOAL, MATE, OFFER, PLAN, PLANNERS, Settings
from controllers.helping.goal_sharing import CHAIN, LITERAL, READINGS
from controllers.helping.planners import AvoidPast, PotentialField, VisBug
from controllers.helping.visibility import RAYS, Walls

__all__ = [
    "CHAIN",
    "GOAL",
    "LITERAL",
    "MATE",
    "OFFER",
    "PLAN",
    "PLANNERS",
    "RAYS",
    "READINGS",
    "AvoidPast",
    "PotentialField",
    "Settings",
    "VisBug",
    "Walls",
]
