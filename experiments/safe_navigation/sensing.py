"""What the pilot sees the robots with: a Gaussian report, or rendered images and a pattern finder.

Both read as (report, instant of its sample); the filter behind them is the same.
"""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from experiments.safe_navigation.vision import overhead_camera, pattern_finder
from mjmr.group import Group
from mjmr.sensors.localizer import Localizer
from mjmr.world import World

Array = NDArray[np.float64]
# of the camera, and of the report that stands for it: a cycle for exposure and transfer, a cycle
# for finding the robots
RATE, LATENCY = 30.0, 2 / 60
# [rad]: the heading's error of the vision, measured on images of other seeds
YAW_NOISE = 0.006
LOSS = 0.05


class Eyes(Protocol):
    """Reports poses."""

    def read(self) -> tuple[Array, float]:
        """Newest report (n, 3), NaN rows where lost, and when it was taken [s]."""
        ...


class Reports:
    """A localizer's reports."""

    def __init__(self, localizer: Localizer):
        """Args: localizer: Of the robots."""
        self._localizer = localizer

    def read(self) -> tuple[Array, float]:
        """See :class:`Eyes`."""
        return self._localizer.read(), self._localizer.sampled_at


class Vision:
    """An overhead camera whose images are searched for the robots, each image once."""

    def __init__(self, world: World, robots: Group):
        """Stand the camera in the world.

        Args:
            world: The field, before its simulation is built.
            robots: Whom to look for.
        """
        self._camera = overhead_camera(world, rate=RATE, latency=LATENCY)
        self._finder = pattern_finder(world, self._camera)
        self._report = np.full((robots.n, 3), np.nan)
        self._taken = np.nan

    def read(self) -> tuple[Array, float]:
        """See :class:`Eyes`."""
        taken = self._camera.sampled_at
        if not np.isnan(taken) and taken != self._taken:
            self._report, self._taken = self._finder.find(self._camera.read()), taken
        return self._report, self._taken


def make_eyes(kind: str, world: World, robots: Group, sigma: float, lossy: bool) -> Eyes:
    """Mount what the pilot sees with.

    Args:
        kind: ``report``, ``late-report`` or ``vision``.
        world: The field, before its simulation is built.
        robots: Whom to see.
        sigma: Deviation of reported positions [m]; vision has errors of its own.
        lossy: Whether 5 % of reports are lost.
    """
    if kind == "vision":
        return Vision(world, robots)
    late = kind == "late-report"
    localizer = Localizer(
        rate=RATE if late else 60.0,
        latency=LATENCY if late else 0.0,
        position_noise=sigma,
        yaw_noise=YAW_NOISE if late else 0.0,
        loss=LOSS if lossy else 0.0,
    )
    robots.mount(localizer)
    return Reports(localizer)
