"""The TXT-1 truck: circles against the bicycle model, the bound of its turn, and rolling over."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from experiments.proving_ground.course import (
    LARGE,
    Array,
    Course,
    Metrics,
    demand,
    hall,
    sheet,
)
from mjmr.claims import Bound, Claim
from mjmr.geometry import rotation_matrix
from mjmr.robots.tamiya_txt1 import TamiyaTXT1
from mjmr.simulation import Simulation

PERIOD = 0.1
NAME = "tamiya_txt1"
_OVER, _LEANS = np.radians(40.0), np.radians(10.0)


class _Faster(TamiyaTXT1):
    """Without the speed controller's bound, which keeps the real one upright."""

    max_speed = 6.0


def _course(condition: Mapping[str, Any], platform: TamiyaTXT1, half: float = 12.0) -> Course:
    world = hall(half)
    group = world.add_group(platform, [[0.0, -4.0, 0.0]])
    dt = condition["dt_ms"] / 1000.0
    return Course(Simulation(world, control_period=PERIOD, dt_max=dt), group)


def circle(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Two rounds at a steering angle and a speed."""
    platform = TamiyaTXT1(command="steering")
    angle, speed = np.radians(condition["angle_deg"]), condition["speed"]
    ideal = platform.wheelbase / np.tan(angle)  # to the right below zero
    ticks = round(2 * 2 * np.pi * abs(ideal) / speed / PERIOD) + 50
    commands = np.tile([speed, angle], (ticks, 1))
    commands[:20, 0] = 0.0  # steer first
    log = _course(condition, platform).drive(commands).log
    radius = _radius(log.poses[ticks // 2 :, 0, :2]) * np.sign(log.yaw[-1, 0] - log.yaw[0, 0])
    return {
        "radius_m": radius,
        "error_pct": 100 * (radius / ideal - 1.0),
        "tilt_deg": float(np.degrees(log.tilt)),
    }


def unicycle(condition: Mapping[str, Any], seed: int) -> Metrics:
    """0.3 rad/s at 1 m/s from a standstill, or at speeds that change (variant ``changing``).

    In a hall of 24 m, whose wall it meets at speeds that change.
    """
    return _at_full_turn(condition, 12.0)


def unicycle_open(condition: Mapping[str, Any], seed: int) -> Metrics:
    """The same in a hall of 60 m, where nothing is in the way."""
    found = _at_full_turn(condition, 30.0)
    demand("way [m]", found["way_m"], 30.0)
    demand("turn [rad]", found["turned_rad"], 2 * np.pi)
    return found


def _at_full_turn(condition: Mapping[str, Any], half: float) -> Metrics:
    seconds = 60
    commands = np.tile([1.0, 0.3], (round(seconds / PERIOD), 1))
    if condition["variant"] == "changing":
        speeds = np.repeat([0.5, 2.0, 0.7, 1.6, 0.0, 1.0], 100)
        commands[: len(speeds), 0] = speeds
    log = _course(condition, TamiyaTXT1(), half).drive(commands).log
    window = round(0.5 / PERIOD)
    yaw = log.yaw[:, 0]
    rate = np.abs(yaw[window:] - yaw[:-window]) / (window * PERIOD)
    return {
        "way_m": float(log.ways[0]),
        "turned_rad": abs(float(yaw[-1] - yaw[0])),
        "radius_m": _radius(log.poses[len(commands) // 2 :, 0, :2]),
        "largest_turn": float(rate.max()),
        "top_speed": float(np.hypot(*log.twists[:, 0, :2].T).max()),
    }


def roll_over(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Ever faster at full lock, slowly, until it lies on its side; seen every 2 s."""
    platform = _Faster(command="steering", acceleration=0.05)
    course = _course(condition, platform)
    commands = np.tile([5.0, platform.lock], (round(2.0 / PERIOD), 1))
    speed, rolled = 0.0, False
    for _ in range(60):
        log = course.drive(commands).log
        rolled = log.tilt > _OVER
        if rolled:
            break
        speed = float(np.hypot(*log.twists[-1, 0, :2]))
    return {"held_speed": speed, "rolled": rolled}


def roll_over_steps(condition: Mapping[str, Any], seed: int) -> Metrics:
    """20 s at full lock, ever faster from one run to the next, until it lies on its side."""
    platform = _Faster(command="steering")
    held = 0.0
    for speed in np.arange(1.8, 4.0, 0.05):
        commands = np.tile([speed, platform.lock], (round(20.0 / PERIOD), 1))
        course = _course(condition, platform)
        fastest = _FastestUpright(course)
        log = course.drive(commands).log
        if log.tilt > _OVER:
            driven = fastest.speed
            return {"rolls_at": float(speed), "rolls_driven": driven, "held_driven": held}
        held = float(np.hypot(*log.twists[-50:, 0, :2].T).mean())
    return {"rolls_at": float("inf"), "rolls_driven": float("inf"), "held_driven": held}


class _FastestUpright:
    """Fastest speed of the rear axle's middle before the base has ever leaned much [m/s]."""

    def __init__(self, course: Course):
        self.speed, self._leaning = 0.0, False
        self._group, self._simulation = course.group, course.simulation
        course.simulation.watch_steps(self._measure)

    def _measure(self) -> None:
        simulation = self._simulation
        up = rotation_matrix(simulation.base_poses_of(self._group)[0, 3:])[2, 2]
        self._leaning = self._leaning or up < np.cos(_LEANS)
        if not self._leaning:
            twist = simulation.twists_of(self._group)[0]
            self.speed = max(self.speed, float(np.hypot(twist[0], twist[1])))


def _radius(points: Array) -> float:
    """Radius of the circle through points (k, 2), least squares (Kasa 1976)."""
    matrix = np.column_stack([points, np.ones(len(points))])
    x, y, rest = np.linalg.lstsq(matrix, (points**2).sum(axis=1), rcond=None)[0]
    return float(np.sqrt(rest + (x * x + y * y) / 4.0))


TESTS = {
    "circle": circle,
    "unicycle": unicycle,
    "unicycle-open": unicycle_open,
    "roll-over": roll_over,
    "roll-over-steps": roll_over_steps,
}


def claims() -> list[Claim]:
    """What the truck must do."""
    return [
        sheet(NAME, "circle", "circle", "turns as the bicycle model says",
              "radius / (wheelbase / tan steering) - 1 at 10, 20, 28 degrees and 0.5, 1, 2 m/s, "
              "2 and 5 ms", Bound("==", 0.0, 2.0), "error_pct", unit="%",
              angle_deg=(10.0, 20.0, 28.0)),
        sheet(NAME, "circle", "circle-right", "turns as the bicycle model says",
              "the same to the right, 28 degrees", Bound("==", 0.0, 2.0), "error_pct", unit="%",
              angle_deg=-28.0),
        sheet(NAME, "unicycle", "unicycle-radius", "1 m/s at 0.3 rad/s", "radius of the circle, "
              "2 and 5 ms", Bound.within(3.33 * 0.98, 3.33 * 1.02), "radius_m", unit="m",
              published="3.33 m", variant="plain"),
        sheet(NAME, "unicycle", "turn-bound", "turns at no more than 0.3 rad/s",
              "largest mean yaw rate over 0.5 s, from rest and at speeds that change, 2 and 5 ms; "
              "it meets a wall", Bound("<=", 0.305), "largest_turn", unit="rad/s",
              published="0.3 rad/s"),
        sheet(NAME, "unicycle-open", "turn-bound-open", "turns at no more than 0.3 rad/s",
              "largest mean yaw rate over 0.5 s, from rest and at speeds that change, 2 and 5 ms; "
              "nothing in the way", Bound("<=", 0.305), "largest_turn", unit="rad/s",
              published="0.3 rad/s"),
        sheet(NAME, "unicycle", "top-speed", "at most 2 m/s", "fastest, at speeds that change",
              Bound("<=", 2.02), "top_speed", unit="m/s", published="2 m/s", variant="changing"),
        sheet(NAME, "roll-over", "roll-over", "stays upright at all its speeds",
              "fastest it goes at full lock before it rolls over, 2 and 5 ms; slowly faster, seen "
              "every 2 s", Bound(">", 2.0), "held_speed", unit="m/s", sizes=LARGE),
        sheet(NAME, "roll-over-steps", "roll-over-asked", "stays upright at all its speeds",
              "slowest speed asked for at full lock at which it rolls over, in steps of 0.05 m/s, "
              "2 and 5 ms", Bound(">", 2.0), "rolls_at", unit="m/s", sizes=LARGE),
        sheet(NAME, "roll-over-steps", "roll-over-driven", "stays upright at all its speeds",
              "fastest it drove, wheels' slip taken off, before it rolled over, in such steps, 2 "
              "and 5 ms", Bound(">", 2.0), "rolls_driven", unit="m/s", sizes=LARGE),
    ]  # fmt: skip
