"""The robots, one module each, and where to find them by name."""

import importlib
from typing import TYPE_CHECKING

from mjmr.errors import UnknownNameError
from mjmr.robots.koala import Koala
from mjmr.robots.pioneer2dx import Pioneer2DX
from mjmr.robots.soccer_bot import SoccerBot

if TYPE_CHECKING:
    from mjmr.robots.platform import Platform

PLATFORMS = {
    "koala": "mjmr.robots.koala:Koala",
    "pioneer2dx": "mjmr.robots.pioneer2dx:Pioneer2DX",
    "soccer_bot": "mjmr.robots.soccer_bot:SoccerBot",
}
__all__ = ["PLATFORMS", "Koala", "Pioneer2DX", "SoccerBot", "platform_class"]


def platform_class(name: str) -> "type[Platform]":
    """The platform called ``name``.

    Raises:
        UnknownNameError: No such robot; lists those there are.
    """
    if name not in PLATFORMS:
        raise UnknownNameError("robot", name, PLATFORMS)
    module, _, attribute = PLATFORMS[name].partition(":")
    return getattr(importlib.import_module(module), attribute)
