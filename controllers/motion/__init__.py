"""Safe motion of several fast omnidirectional robots (Bruce and Veloso 2005)."""

from controllers.motion.errt import ErrtConfig, Plan, Planner
from controllers.motion.frames import body_twist, world_velocity
from controllers.motion.navigator import Navigator, NavigatorConfig
from controllers.motion.plane import along_perpendicular, synchronised
from controllers.motion.prediction import Piece, forward_predict, predict
from controllers.motion.trapezoid import Limits, Profile, profile

__all__ = [
    "ErrtConfig",
    "Limits",
    "Navigator",
    "NavigatorConfig",
    "Piece",
    "Plan",
    "Planner",
    "Profile",
    "along_perpendicular",
    "body_twist",
    "forward_predict",
    "predict",
    "profile",
    "synchronised",
    "world_velocity",
]
