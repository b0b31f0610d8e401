"""Loaded before any test module: mjmr must choose the off-screen GL before mujoco is imported."""

import mjmr  # noqa: F401
