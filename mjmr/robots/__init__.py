"""The robots, one module each, and where to find them by name."""

import importlib
from typing import TYPE_CHECKING

from mjmr.errors import UnknownNameError
from mjmr.robots.aibo_ers7 import AiboERS7
from mjmr.robots.four_wheeler import FourWheeler
from mjmr.robots.koala import Koala
from mjmr.robots.nims import Nims
from mjmr.robots.pioneer2dx import Pioneer2DX
from mjmr.robots.round_pusher import RoundPusher
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.robots.tamiya_txt1 import TamiyaTXT1
from mjmr.robots.tj_pro import TJPro

if TYPE_CHECKING:
    from mjmr.robots.platform import Platform

PLATFORMS = {
    "aibo_ers7": "mjmr.robots.aibo_ers7:AiboERS7",
    "four_wheeler": "mjmr.robots.four_wheeler:FourWheeler",
    "koala": "mjmr.robots.koala:Koala",
    "nims": "mjmr.robots.nims:Nims",
    "pioneer2dx": "mjmr.robots.pioneer2dx:Pioneer2DX",
    "round_pusher": "mjmr.robots.round_pusher:RoundPusher",
    "soccer_bot": "mjmr.robots.soccer_bot:SoccerBot",
    "tamiya_txt1": "mjmr.robots.tamiya_txt1:TamiyaTXT1",
    "tj_pro": "mjmr.robots.tj_pro:TJPro",
}
__all__ = [
    "PLATFORMS",
    "AiboERS7",
    "FourWheeler",
    "Koala",
    "Nims",
    "Pioneer2DX",
    "RoundPusher",
    "SoccerBot",
    "TJPro",
    "TamiyaTXT1",
    "platform_class",
]


def platform_class(name: str) -> "type[Platform]":
    """The platform called ``name``.

    Raises:
        UnknownNameError: No such robot; lists those there are.
    """
    if name not in PLATFORMS:
        raise UnknownNameError("robot", name, PLATFORMS)
    module, _, attribute = PLATFORMS[name].partition(":")
    return getattr(importlib.import_module(module), attribute)
