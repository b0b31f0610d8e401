"""What a study swaps: rules that give weights to those who are heard, and laws that use them.

Each is a class of the form a study's roles ``gains`` and ``law`` ask for.
"""

import numpy as np
from numpy.typing import NDArray

from controllers.consensus.gains import equal_gains, metropolis_gains, neighbour_gains
from controllers.consensus.relative import acceleration

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


class NeighbourGains:
    """The paper's example: those heard share ``weight``, the robot keeps the rest for itself."""

    def __init__(self, n: int):
        """Args: n: Robots."""

    def step(self, heard: Flags, weight: float) -> Array:
        """Gains (n, n) of a graph (n, n), its diagonal set; see :func:`neighbour_gains`."""
        return neighbour_gains(heard, weight)


class EqualGains:
    """Everybody weights all it hears alike, itself included, whatever ``weight`` says."""

    def __init__(self, n: int):
        """Args: n: Robots."""

    def step(self, heard: Flags, weight: float) -> Array:
        """Gains (n, n) of a graph (n, n); see :func:`equal_gains`."""
        return equal_gains(heard)


class MetropolisGains:
    """Doubly stochastic weights, for graphs with links both ways alone: all have equal weight."""

    def __init__(self, n: int):
        """Args: n: Robots."""

    def step(self, heard: Flags, weight: float) -> Array:
        """Gains (n, n) of a graph (n, n), links both ways; see :func:`metropolis_gains`."""
        return metropolis_gains(heard)


class RelativeForm:
    """The paper's law in relative form, v_i = -2 w_i + sum_j g_ij (y_j - y_i)."""

    def __init__(self, n: int):
        """Args: n: Robots."""

    def step(self, velocity: Array, relative: Array, gains: Array) -> Array:
        """Accelerations (n, 2) [m/s^2]; see :func:`acceleration`."""
        return acceleration(velocity, relative, gains)
