"""mjmr: a MuJoCo multi-robot testbed.

Names are imported when first used, so that ``import mjmr`` loads no MuJoCo.
"""

import importlib
import os
import sys
from typing import Any

# MuJoCo picks its off-screen GL when it is first imported; without a display only EGL works.
if sys.platform == "linux" and not os.environ.get("DISPLAY"):
    os.environ.setdefault("MUJOCO_GL", "egl")

_WHERE = {
    "Film": "mjmr.film",
    "Fault": "mjmr.faults",
    "Group": "mjmr.group",
    "KinematicSimulation": "mjmr.kinematics",
    "Localizer": "mjmr.sensors.localizer",
    "MjmrError": "mjmr.errors",
    "Recording": "mjmr.recording",
    "Simulation": "mjmr.simulation",
    "SoccerBot": "mjmr.robots.soccer_bot",
    "Team": "mjmr.team",
    "World": "mjmr.world",
}
__all__ = sorted(_WHERE)  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    if name in _WHERE:
        return getattr(importlib.import_module(_WHERE[name]), name)
    raise AttributeError(f"module 'mjmr' has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
