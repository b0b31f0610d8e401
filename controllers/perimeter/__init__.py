"""Perimeter detection and tracking by a team with limited senses (Fierro et al. 2005)."""

from controllers.perimeter.config import PerimeterConfig
from controllers.perimeter.percepts import Percepts
from controllers.perimeter.states import ACQUIRE, MOVING, SEARCHING, STATES, TRACKING
from controllers.perimeter.team import PerimeterTeam

__all__ = [
    "ACQUIRE",
    "MOVING",
    "SEARCHING",
    "STATES",
    "TRACKING",
    "Percepts",
    "PerimeterConfig",
    "PerimeterTeam",
]
