"""The robots, one module each."""

from mjmr.robots.soccer_bot import SoccerBot

__all__ = ["SoccerBot"]
