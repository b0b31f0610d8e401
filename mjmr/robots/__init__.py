"""The robots, one module each."""

from mjmr.robots.pioneer2dx import Pioneer2DX
from mjmr.robots.soccer_bot import SoccerBot

__all__ = ["Pioneer2DX", "SoccerBot"]
