"""Safety filters that any controller's velocities can be put through."""

from controllers.safety.barrier import BarrierConfig, BarrierFilter, keep_right

__all__ = ["BarrierConfig", "BarrierFilter", "keep_right"]
