"""Scouts and workers that share one vector (MacKunis and Raviv 2003)."""

from controllers.scouting.behaviour import LOOP, UNIT, Behaviour
from controllers.scouting.coding import Codec
from controllers.scouting.team import ScoutTeam

__all__ = ["LOOP", "UNIT", "Behaviour", "Codec", "ScoutTeam"]
