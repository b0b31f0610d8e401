"""Safety filters that any controller's velocities can be put through."""

from controllers.safety.barrier import BarrierConfig, BarrierFilter, keep_right
from controllers.safety.filters import Barrier, SafetyConfig, SafetyFilter, Unfiltered, reachable
from controllers.safety.navigator import BarrierNavigator
from controllers.safety.obstacles import NearestPoints
from controllers.safety.search import VelocitySearch

__all__ = [
    "Barrier",
    "BarrierConfig",
    "BarrierFilter",
    "BarrierNavigator",
    "NearestPoints",
    "SafetyConfig",
    "SafetyFilter",
    "Unfiltered",
    "VelocitySearch",
    "keep_right",
    "reachable",
]
