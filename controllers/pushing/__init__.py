"""The versatile pusher: one schema controller for foraging, transport and construction."""

from controllers.pushing.machine import Parameters, pusher_machine
from controllers.pushing.percepts import Gaze, Surroundings
from controllers.pushing.pusher import Pusher
from controllers.pushing.recovery import Recovery

__all__ = ["Gaze", "Parameters", "Pusher", "Recovery", "Surroundings", "pusher_machine"]
