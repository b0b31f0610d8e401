"""State estimation from noisy reports."""

from controllers.estimation.pose_filter import PoseFilter, PoseFilterConfig

__all__ = ["PoseFilter", "PoseFilterConfig"]
