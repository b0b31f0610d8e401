"""The four-wheeler: straight, turn on the spot with its scrub, and reversing."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from experiments.proving_ground.course import ALL, Course, Metrics, demand, hall, profile, sheet
from mjmr.claims import Bound, Claim
from mjmr.randomness import Streams
from mjmr.robots.four_wheeler import FourWheeler
from mjmr.simulation import Simulation

PERIOD = 0.1
NAME = "four_wheeler"


def _course(condition: Mapping[str, Any], pose: Any, **limits: float) -> Course:
    world = hall()
    group = world.add_group(FourWheeler(**limits), [pose])  # pyright: ignore[reportArgumentType]
    dt = condition["dt_ms"] / 1000.0
    return Course(Simulation(world, control_period=PERIOD, dt_max=dt), group)


def straight(condition: Mapping[str, Any], seed: int) -> Metrics:
    """5 m ahead at 0.5 m/s, in a direction drawn by seed."""
    yaw = _drawn(seed)
    start = [-3.0 * np.cos(yaw), -3.0 * np.sin(yaw), yaw]
    log = _course(condition, start).drive(profile([0.5, 0.0], 100, ramp=7)).log
    way = log.poses[-1, 0, :2] - log.poses[0, 0, :2]
    ahead = np.array([np.cos(yaw), np.sin(yaw)])
    return {
        "error_pct": 100 * abs(float(way @ ahead) / 5.0 - 1.0),
        "lateral_mm": 1000 * abs(float(ahead[0] * way[1] - ahead[1] * way[0])),
    }


def turn(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Three turns on the spot at about 1 rad/s, from a heading drawn by seed."""
    periods = round(6 * np.pi / PERIOD)
    rate = 6 * np.pi / periods / PERIOD
    course = _course(condition, [0.0, 0.0, _drawn(seed)])
    simulation, group = course.simulation, course.group
    before = simulation.wheel_angles_of(group)[0]
    log = course.drive(profile([0.0, rate], periods)).log
    angles = simulation.wheel_angles_of(group)[0] - before
    turned = log.yaw[-1, 0] - log.yaw[0, 0]
    demand("turn [rad]", abs(turned), 3 * np.pi)
    told = (angles[1] - angles[0]) * FourWheeler.rolling_radius / FourWheeler.track
    return {
        "error_pct": 100 * abs(turned / (6 * np.pi) - 1.0),
        "scrub": float(told / turned),
        "moved_mm": 1000 * float(np.linalg.norm(log.poses[-1, 0, :2] - log.poses[0, 0, :2])),
    }


def stop(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Top speed, then top speed backwards as fast as the motors can: how far it tips."""
    course = _course(condition, [0, 0, _drawn(seed)], acceleration=50.0, turn_acceleration=50.0)
    commands = np.zeros((60, 2))
    commands[:20, 0], commands[20:40, 0], commands[40:, 0] = 1.0, -1.0, 1.0
    log = course.drive(commands).log
    demand("speed [m/s]", float(np.abs(log.twists[:, 0, 0]).max()), 0.9)
    return {"tilt_deg": float(np.degrees(log.tilt)), "top_speed": float(log.twists[19, 0, 0])}


def _drawn(seed: int) -> float:
    return float(Streams(seed).generator("draw").uniform(-np.pi, np.pi))


TESTS = {"straight": straight, "turn": turn, "stop": stop}


def claims() -> list[Claim]:
    """What the four-wheeler must do."""
    words = "a base of our choice does what its README says"
    how = "5 and 10 ms, 5 directions, largest"
    return [
        sheet(NAME, "straight", "straight", words, f"way / 5 m - 1, {how}", Bound("<=", 0.2),
              "error_pct", unit="%", sizes=ALL),
        sheet(NAME, "straight", "straight-aside", words, f"sideways after 5 m, {how}",
              Bound("<=", 10.0), "lateral_mm", unit="mm", sizes=ALL),
        sheet(NAME, "turn", "turn", words, f"three turns at 1 rad/s / turned - 1, {how}",
              Bound("<=", 1.0), "error_pct", unit="%", sizes=ALL),
        sheet(NAME, "turn", "scrub", words, "turn by encoders and track / true turn, "
              "5 and 10 ms, 5 headings; furthest off", Bound("==", 1.6, 0.03), "scrub", sizes=ALL),
        sheet(NAME, "stop", "stop-tilt", words,
              "1 m/s, reversed and reversed again as fast as the motors can; largest tilt",
              Bound("<=", 5.0), "tilt_deg", unit="deg", sizes=ALL),
        sheet(NAME, "stop", "top-speed", words, "forwards, after 2 s",
              Bound("==", 1.0, 0.01), "top_speed", unit="m/s", sizes=ALL),
    ]  # fmt: skip
