"""The robots, one module each."""

from mjmr.robots.soccer_bot import SoccerBot

PLATFORMS = {"soccer_bot": SoccerBot}
