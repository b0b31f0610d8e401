"""mjmr: a MuJoCo multi-robot testbed.

Names are imported when first used, so that ``import mjmr`` loads no MuJoCo.
"""

import ctypes
import importlib
import os
import sys
from typing import Any


def _choose_gl() -> None:
    """Tell MuJoCo which off-screen GL to use; it picks one when it is first imported.

    Without a display only EGL works, and where its library is missing ``import mujoco`` itself
    would fail: then GL is switched off, and everything without cameras still runs.
    """
    if sys.platform != "linux":
        return
    if not os.environ.get("DISPLAY"):
        os.environ.setdefault("MUJOCO_GL", "egl")
    if os.environ.get("MUJOCO_GL", "").lower() == "egl":
        try:
            ctypes.CDLL("libEGL.so.1")
        except OSError:
            os.environ["MUJOCO_GL"] = "disable"


_choose_gl()

_WHERE = {
    "AiboERS7": "mjmr.robots.aibo_ers7",
    "Beacon": "mjmr.sensors.beacon",
    "Bumper": "mjmr.sensors.bumper",
    "Bus": "mjmr.bus",
    "ByteRadio": "mjmr.byte_radio",
    "ByteTiming": "mjmr.byte_channel",
    "CableTension": "mjmr.sensors.cable_tension",
    "Camera": "mjmr.sensors.camera",
    "Compass": "mjmr.sensors.compass",
    "ConeSight": "mjmr.sensors.cone_sight",
    "Film": "mjmr.film",
    "FilmOptions": "mjmr.film_options",
    "Fault": "mjmr.faults",
    "FloorPatch": "mjmr.sensors.floor_patch",
    "ForceTorque": "mjmr.sensors.force_torque",
    "FourWheeler": "mjmr.robots.four_wheeler",
    "Group": "mjmr.group",
    "IMU": "mjmr.sensors.imu",
    "InfraredProximity": "mjmr.sensors.proximity",
    "InfraredRanger": "mjmr.sensors.rangers",
    "KinematicSimulation": "mjmr.kinematics",
    "Koala": "mjmr.robots.koala",
    "Lidar": "mjmr.sensors.lidar",
    "LineOfSight": "mjmr.sensors.line_of_sight",
    "Localizer": "mjmr.sensors.localizer",
    "MjmrError": "mjmr.errors",
    "MotionStatus": "mjmr.sensors.motion_status",
    "Nims": "mjmr.robots.nims",
    "PanTilt": "mjmr.sensors.pan_tilt",
    "Pillar": "mjmr.pillar",
    "Pioneer2DX": "mjmr.robots.pioneer2dx",
    "Radio": "mjmr.radio",
    "Recording": "mjmr.recording",
    "RoundPusher": "mjmr.robots.round_pusher",
    "Simulation": "mjmr.simulation",
    "SoccerBot": "mjmr.robots.soccer_bot",
    "Sonar": "mjmr.sensors.rangers",
    "TJPro": "mjmr.robots.tj_pro",
    "TamiyaTXT1": "mjmr.robots.tamiya_txt1",
    "Spot": "mjmr.sensors.spot",
    "Team": "mjmr.team",
    "Turret": "mjmr.sensors.turret",
    "VisualArc": "mjmr.sensors.visual_arc",
    "WheelEncoders": "mjmr.sensors.encoders",
    "World": "mjmr.world",
    "environment": "mjmr.env",
}
__all__ = sorted(_WHERE)  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    if name in _WHERE:
        return getattr(importlib.import_module(_WHERE[name]), name)
    raise AttributeError(f"module 'mjmr' has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
