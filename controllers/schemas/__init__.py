"""Motor schemas and state machines over them, for whole teams at once."""

from controllers.schemas.approach import Draw, Follow, MoveTo
from controllers.schemas.avoid import Avoid, Swirl
from controllers.schemas.base import Blend, Schema, View, unit
from controllers.schemas.cues import After, Condition, Cue, Hysteresis, Sees, Within
from controllers.schemas.machine import Behaviour, StateMachine, Transition
from controllers.schemas.noise import Noise
from controllers.schemas.past import AvoidPast
from controllers.schemas.percepts import Percept, Percepts, Things
from controllers.schemas.steering import steer
from controllers.schemas.walls import FollowWall

__all__ = [
    "After",
    "Avoid",
    "AvoidPast",
    "Behaviour",
    "Blend",
    "Condition",
    "Cue",
    "Draw",
    "Follow",
    "FollowWall",
    "Hysteresis",
    "MoveTo",
    "Noise",
    "Percept",
    "Percepts",
    "Schema",
    "Sees",
    "StateMachine",
    "Swirl",
    "Things",
    "Transition",
    "View",
    "Within",
    "steer",
    "unit",
]
