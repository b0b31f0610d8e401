"""The swap: robots on a circle, every one bound for the place opposite."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.consensus import command_of_velocity, hand_position, hand_velocity
from controllers.motion import Limits
from controllers.safety import SafetyConfig
from mjmr.group import Group
from mjmr.randomness import Streams
from mjmr.robots.four_wheeler import FourWheeler
from mjmr.sensors.localizer import Localizer
from mjmr.world import World

Array = NDArray[np.float64]
PERIOD = 1 / 50
LENGTH = 0.20  # m, of the hand ahead of the axle
SPACING = 1.85  # m, between neighbours on the circle
HOME = 0.10  # m
# of the hand in every direction: sideways it moves by turning
SPEED, ACCELERATION = 0.40, 0.60  # m/s, m/s^2
_JITTER, _YAW = 0.15, 0.30  # m, rad: starts are displaced by up to this
_ROOM = 1.0  # m, from the circle to the walls
YAW_NOISE = 0.005  # rad, of noisy reports


def ring(n: int) -> tuple[Array, float]:
    """Bearings (n,) [rad] of the places, and the circle's radius [m]."""
    radius = max(SPACING * n / (2 * np.pi), 1.5)
    return 2 * np.pi * np.arange(n) / n, radius


def build(condition: Mapping[str, Any], seed: int) -> tuple[World, Group, Array]:
    """World, robots and goals of the hands (n, 2) [m].

    Places are on a circle, 1.85 m apart, hands on them and robots facing the centre. The symmetric
    start has them exactly there, whatever the seed; the other is displaced by up to 0.15 m along x
    and y and 0.3 rad, drawn from the seed.
    """
    n = condition["robots"]
    bearing, radius = ring(n)
    hands = radius * np.column_stack([np.cos(bearing), np.sin(bearing)])
    goals, yaw = -hands, bearing + np.pi
    if condition["scene"] == "swap":
        starts = Streams(seed).generator("starts")
        hands = hands + starts.uniform(-_JITTER, _JITTER, hands.shape)
        yaw = yaw + starts.uniform(-_YAW, _YAW, n)
    axle = hands - LENGTH * np.column_stack([np.cos(yaw), np.sin(yaw)])
    half = radius + FourWheeler.radius + LENGTH + _JITTER + _ROOM
    world = World.rectangle(2 * half, 2 * half)
    robots = world.add_group(FourWheeler(), np.column_stack([axle, yaw]))
    sigma = condition["sigma_mm"] / 1000.0
    noisy = YAW_NOISE if sigma else 0.0
    robots.mount(Localizer(rate=1 / PERIOD, position_noise=sigma, yaw_noise=noisy))
    return world, robots, goals


def safety(robots: Group, condition: Mapping[str, Any]) -> SafetyConfig:
    """What the filter is told: the disc round the hand that holds the body at any heading."""
    limits = Limits(max_speed=SPEED, acceleration=ACCELERATION, deceleration=ACCELERATION)
    return SafetyConfig(
        radius=LENGTH + robots.platform.radius,
        limits=limits,
        period=PERIOD,
        margin=condition["margin_mm"] / 1000.0,
        rate=condition["pace"] * limits.deceleration / limits.max_speed,
        samples=100,
    )


class Hands:
    """The hands as points that a filter commands: sensed by the overhead camera, driven by wheels.

    Attributes:
        position: Of the hands, as reported (n, 2) [m].
    """

    def __init__(self, robots: Group):
        """Args: robots: With a localizer mounted."""
        self._robots = robots
        self._yaw = robots.start[:, 2]
        self.position = hand_position(robots.start, LENGTH)

    def sense(self) -> tuple[Array, Array]:
        """Positions and velocities (n, 2); velocities are those the wheels are set to."""
        report = self._robots.localizer.read()
        self._yaw, self.position = report[:, 2], hand_position(report, LENGTH)
        return self.position, hand_velocity(self._yaw, self._robots.executed, LENGTH)

    def drive(self, velocity: Array) -> None:
        """Let the hands move at ``velocity`` (n, 2) [m/s], world frame."""
        self._robots.drive(command_of_velocity(self._yaw, velocity, LENGTH))
