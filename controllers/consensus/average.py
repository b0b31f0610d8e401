"""Average consensus on a number a robot, as a service to other systems."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.consensus.gains import metropolis_gains
from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]


class AverageConsensus:
    """Robots agree on the mean of their numbers by talking to neighbours.

    Each round every robot replaces its estimate by a weighted mean of those it hears (Metropolis
    weights, links both ways). The sum is kept in every round, whatever the graph, so that joint
    connection over time is enough for the mean.

    Attributes:
        estimate: Of each robot (n, ...).
        rounds: Done so far.
    """

    def __init__(self, values: ArrayLike):
        """Begin with the robots' own numbers (n, ...)."""
        self.estimate = np.array(values, dtype=np.float64)
        if not self.estimate.ndim or not len(self.estimate):
            raise InvalidInputError("average consensus is of the numbers of 1 robot or more")
        self.rounds = 0

    def step(self, linked: ArrayLike) -> Array:
        """One round over the links (n, n) there are now; the new estimates, a copy."""
        gains = metropolis_gains(linked)
        if len(gains) != len(self.estimate):
            raise InvalidInputError(
                f"links of {len(self.estimate)} robots; got shape {gains.shape}"
            )
        self.estimate = np.tensordot(gains, self.estimate, axes=1)
        self.rounds += 1
        return self.estimate.copy()
