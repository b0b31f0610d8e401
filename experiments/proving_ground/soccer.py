"""The soccer robot: both drives, each within the limits it states."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from experiments.proving_ground.course import Course, Metrics, hall, sheet
from mjmr.claims import Bound, Claim
from mjmr.robots.soccer_bot import DRIVES, SoccerBot
from mjmr.simulation import Simulation

PERIOD = 1 / 60
NAME = "soccer_bot"


def dash(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Speed up to 2 m/s and stop, as fast as the drive states, in 12 directions of its own."""
    drive = condition["variant"]
    limits = DRIVES[drive]
    world = hall(8.0)
    angles = 2 * np.pi * np.arange(12) / 12
    places = np.column_stack([2.0 * np.cos(angles), 2.0 * np.sin(angles), 0.0 * angles])
    group = world.add_group(SoccerBot(drive), places)
    dt = condition["dt_ms"] / 1000.0
    course = Course(Simulation(world, control_period=PERIOD, dt_max=dt), group)
    up = np.arange(0.0, 2.0, limits.acceleration * PERIOD)
    down = np.arange(2.0, 0.0, -limits.deceleration * PERIOD)
    speeds = np.concatenate([up, np.full(30, 2.0), down, np.zeros(30)])
    way = np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=-1)
    log = course.drive(speeds[:, None, None] * way).log
    speed = np.hypot(log.twists[:, :, 0], log.twists[:, :, 1])
    rise = slice(len(up) // 4, 3 * len(up) // 4)
    fall = slice(len(up) + 30 + len(down) // 4, len(up) + 30 + 3 * len(down) // 4)
    slopes = [np.polyfit(log.times[part], speed[part], 1)[0] for part in (rise, fall)]
    return {
        "acceleration_error_pct": 100 * float(np.abs(slopes[0] / limits.acceleration - 1).max()),
        "braking_error_pct": 100 * float(np.abs(-slopes[1] / limits.deceleration - 1).max()),
        "top_speed": float(speed.max(axis=0).min()),
        "turned_deg": float(np.degrees(np.abs(log.yaw[-1] - log.yaw[0]).max())),
    }


TESTS = {"dash": dash}


def claims() -> list[Claim]:
    """What the soccer robot must do."""
    how = "12 directions, both drives, 2 and 5 ms, largest"
    words = "a drive does what it states"
    return [
        sheet(NAME, "dash", "acceleration", words, f"slope of the speed / stated - 1, {how}",
              Bound("<=", 2.0), "acceleration_error_pct", unit="%"),
        sheet(NAME, "dash", "braking", words, f"slope of the speed / stated - 1, {how}",
              Bound("<=", 2.0), "braking_error_pct", unit="%"),
        sheet(NAME, "dash", "top-speed", words, "fastest, 12 directions, both drives",
              Bound("==", 2.0, 0.02), "top_speed", unit="m/s"),
        sheet(NAME, "dash", "straight", words, f"turned by the end, {how}", Bound("<=", 0.5),
              "turned_deg", unit="deg"),
    ]  # fmt: skip
