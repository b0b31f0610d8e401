"""Pusher: from looks to commands of base and turret, for a whole team at once."""

import numpy as np
from numpy.typing import NDArray

from controllers.pushing.machine import Parameters, pusher_machine
from controllers.pushing.percepts import Fusion, Gaze, Surroundings
from controllers.pushing.recovery import Recovery
from controllers.schemas import Percepts, steer

Array = NDArray[np.float64]


class Pusher:
    """The controller of all three tasks; robots share nothing but its code.

    Attributes:
        behaviour: States, cues and transitions of the robots.
        percepts: What was perceived in the last step.
        recovery: From stagnation, or None.
        vector: What the schemas summed up to in the last step (n, 2).
    """

    def __init__(
        self,
        n: int,
        parameters: Parameters,
        surroundings: Surroundings,
        ring_angles: Array,
        *,
        rng: np.random.Generator,
        top_speed: float,
        top_turn: float,
        recovery: Recovery | None = None,
    ):
        """Start n robots.

        Args:
            n: Robots.
            parameters: c, p and b.
            surroundings: Of the world.
            ring_angles: Of the obstacle ring's beams (b,) [rad], to the robot's x axis.
            rng: Of the schemas' noise.
            top_speed: [m/s].
            top_turn: [rad/s].
            recovery: From stagnation; None: as published, without.
        """
        self._fusion = Fusion(n, surroundings, ring_angles)
        self.recovery = recovery
        machine = pusher_machine(
            parameters, radius=surroundings.robot_radius, share="tolerance" if recovery else ""
        )
        self.behaviour = machine.start(n, rng)
        self._top = {"top_speed": top_speed, "top_turn": top_turn}
        self.percepts: Percepts = {}
        self.vector = np.zeros((n, 2))

    def step(self, gaze: Gaze, time: float) -> tuple[Array, Array]:
        """Look, decide, steer.

        Args:
            gaze: Of all robots.
            time: Of this step [s].

        Returns:
            Commands (n, 2): forward [m/s] and turn [rad/s]; pans of the turrets (n,) [rad],
            relative to the robots.
        """
        percepts = dict(self._fusion.percepts(gaze))
        if self.recovery is not None:
            percepts["tolerance"] = self.recovery.step(percepts, time)
        self.percepts = percepts
        self.vector = self.behaviour.step(percepts, time)
        command = steer(self.vector, gaze.heading, **self._top)
        # the turret turns with the base until the next step
        pan = self._fusion.aim(percepts, gaze.heading, time)
        return command, pan
