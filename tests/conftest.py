"""Loaded before any test module: mjmr must choose the off-screen GL before mujoco is imported."""

import mjmr  # noqa: F401, I001
from hypothesis import settings

# a first call compiles, and machines are noisy: no test asserts how long it takes
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")
