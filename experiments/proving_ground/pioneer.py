"""The Pioneer 2-DX: straight, turn, circle, top speed and stop, and a crowd that pushes."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from experiments.proving_ground.course import (
    LARGE,
    Array,
    Course,
    Metrics,
    apart,
    demand,
    hall,
    profile,
    sheet,
)
from mjmr.claims import Bound, Claim
from mjmr.faults import Fault
from mjmr.randomness import Streams
from mjmr.robots.pioneer2dx import Pioneer2DX
from mjmr.simulation import Simulation
from mjmr.world import World

PERIOD = 0.1
NAME = "pioneer2dx"
_TIPPED = np.radians(30.0)


def _course(condition: Mapping[str, Any], start: Any = (-3.0, 0.0, 0.0)) -> Course:
    world = hall()
    group = world.add_group(Pioneer2DX, [start])
    dt = condition["dt_ms"] / 1000.0
    return Course(Simulation(world, control_period=PERIOD, dt_max=dt), group)


def straight(condition: Mapping[str, Any], seed: int) -> Metrics:
    """5 m ahead at 0.5 m/s."""
    log = _course(condition).drive(profile([0.5, 0.0], 100)).log
    way = log.poses[-1, 0] - log.poses[0, 0]
    over = 100 * (way[0] / 5.0 - 1.0)
    return {"error_pct": abs(over), "over_pct": over, "lateral_mm": 1000 * abs(way[1])}


def turn(condition: Mapping[str, Any], seed: int) -> Metrics:
    """360 degrees on the spot at 1 rad/s."""
    rate = 2 * np.pi / 6.3  # a whole number of periods
    log = _course(condition).drive(profile([0.0, rate], 63)).log
    turned = log.yaw[-1, 0] - log.yaw[0, 0]
    moved = np.linalg.norm(log.poses[-1, 0, :2] - log.poses[0, 0, :2])
    over = 100 * (turned / (2 * np.pi) - 1.0)
    return {"error_pct": abs(over), "over_pct": over, "moved_mm": 1000 * float(moved)}


def circle(condition: Mapping[str, Any], seed: int) -> Metrics:
    """A circle of 1 m radius at 0.4 m/s, against the commanded unicycle, integrated exactly."""
    speed, periods = 0.4, 157
    commands = profile([speed, speed], periods)
    log = _course(condition).drive(commands).log
    ideal = _unicycle(log.poses[0, 0], commands)
    length = speed * periods * PERIOD
    off = np.linalg.norm(log.poses[-1, 0, :2] - ideal[-1, :2])
    turned = log.yaw[-1, 0] - log.yaw[0, 0]
    over = 100 * (turned / (speed * periods * PERIOD) - 1.0)
    return {
        "heading_error_pct": abs(over),
        "heading_over_pct": over,
        "end_error_pct": 100 * float(off) / length,
    }


def stop(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Full speed, then the emergency stop of the base."""
    course = _course(condition, (-7.0, 0.0, 0.0))
    commands = np.zeros((80, 2))
    commands[:55, 0] = 1.6
    log = course.drive(commands[:55]).log
    group = course.group
    top = float(log.twists[:, 0, 0].max())
    before = log.poses[-1, 0, 0]
    group.faults.add(Fault(kind="stopped", robot=0, start=float(log.times[-1])))
    log = course.drive(commands[55:]).log
    return {
        "top_speed": top,
        "tilt_deg": float(np.degrees(log.tilt)),
        "way_m": float(log.poses[-1, 0, 0] - before),
        "left_speed": float(abs(log.twists[-1, 0, 0])),
    }


def crowd(condition: Mapping[str, Any], seed: int) -> Metrics:
    """50 robots among 30 boxes, 60 s: 0.4 m/s forward, or reversed every 5 s; set points jump."""
    n, seconds = 50, 60
    world, group = crowded_world(n, seed)
    dt = condition["dt_ms"] / 1000.0
    course = Course(Simulation(world, control_period=PERIOD, dt_max=dt), group)
    rng = Streams(seed).generator("arcs")
    arcs = np.repeat(rng.uniform(-1.0, 1.0, (seconds, n)), 10, axis=0)
    reverse = condition["variant"] == "reverse"
    sign = np.where(reverse & (np.arange(len(arcs)) // 50 % 2 == 1), -1.0, 1.0)
    speed = np.broadcast_to(0.4 * sign[:, None], arcs.shape)
    log = course.drive(np.stack([speed, arcs], axis=2)).log
    # blind, they soon push on boxes, walls and each other: of 24 m some 2.4 are left, forwards
    demand("mean way [m]", log.ways.mean(), 1.0)
    return {"tilt_deg": float(np.degrees(log.tilt)), "tipped": bool(log.tilt > _TIPPED)}


def crowded_world(n: int, seed: int, platform: Any = None) -> tuple[World, Any]:
    """Work W: n Pioneers and 30 boxes of 0.4 m in a walled square; returns (world, group)."""
    side = max(8.0, 1.5 * np.sqrt(n))
    world = hall(side / 2)
    rng = Streams(seed).generator("places")
    poses = _free_places(rng, side, n + 30)
    for x, y, yaw in poses[n:]:
        world.add_box(x, y, 0.4, 0.4, yaw=yaw, height=0.4)
    fast = platform or Pioneer2DX(acceleration=50.0, turn_acceleration=150.0)
    return world, world.add_group(fast, poses[:n])


def _free_places(rng: np.random.Generator, side: float, count: int) -> Array:
    """Poses (count, 3) whose discs of 0.3 m are apart, uniform in a square of this side."""
    found = np.empty((0, 3))
    half = side / 2 - 0.35
    while len(found) < count:
        pose = rng.uniform([-half, -half, -np.pi], [half, half, np.pi])
        if not len(found) or np.hypot(*(found[:, :2] - pose[:2]).T).min() > 0.6:
            found = np.vstack([found, pose])
    return found


def _unicycle(start: Array, commands: Array) -> Array:
    """Poses (k + 1, 3) of a unicycle whose commands (k, 2) are reached linearly in a period."""
    fine = 200
    poses, before = [start], np.zeros(2)
    x, y, yaw = start
    for command in commands:
        shares = (np.arange(fine) + 0.5) / fine
        speed = before[0] + shares * (command[0] - before[0])
        rate = before[1] + shares * (command[1] - before[1])
        dt = PERIOD / fine
        middle = yaw + np.cumsum(rate) * dt - rate * dt / 2
        x, y = x + (speed * np.cos(middle)).sum() * dt, y + (speed * np.sin(middle)).sum() * dt
        yaw, before = yaw + rate.sum() * dt, command
        poses.append(np.array([x, y, yaw]))
    return np.array(poses)


TESTS = {"straight": straight, "turn": turn, "circle": circle, "stop": stop, "crowd": crowd}


def claims() -> list[Claim]:
    """What the Pioneer must do."""
    exact = "against the commanded unicycle, 2 and 5 ms, largest"
    found = []
    # timesteps are compared by signed errors: +0.3 and -0.3 % are not the same
    for test, name, metric, signed, how in (
        ("straight", "straight", "error_pct", "over_pct", "5 m at 0.5 m/s"),
        ("turn", "turn", "error_pct", "over_pct", "360 degrees on the spot at 1 rad/s"),
        ("circle", "circle-heading", "heading_error_pct", "heading_over_pct",
         "1 m circle at 0.4 m/s, heading"),
        ("circle", "circle-end", "end_error_pct", "end_error_pct",
         "1 m circle at 0.4 m/s, end / way"),
    ):  # fmt: skip
        found.append(
            sheet(NAME, test, name, "the base does what it is told", f"{how}, {exact}",
                  Bound("<=", 0.3), metric, unit="%")
        )  # fmt: skip
        found.append(
            sheet(NAME, test, f"{name}-timestep", "the same at every timestep",
                  f"{how}, difference of the errors at 2 and 5 ms", Bound("<=", 0.1),
                  apart(signed, "dt_ms"), unit="%", sizes=LARGE)
        )  # fmt: skip
    return [
        *found,
        sheet(NAME, "stop", "top-speed", "up to 1.6 m/s", "fastest at 2 and 5 ms",
              Bound("==", 1.6, 0.008), "top_speed", published="1.6 m/s", unit="m/s"),
        sheet(NAME, "stop", "stop-tilt", "an emergency stop from full speed keeps it upright",
              "largest tilt from 1.6 m/s to rest, every timestep", Bound("<", 3.0),
              "tilt_deg", unit="deg"),
        sheet(NAME, "stop", "stop-stops", "an emergency stop ends in rest",
              "speed left 2.5 s later", Bound("<=", 0.01), "left_speed", unit="m/s"),
        sheet(NAME, "crowd", "crowd-tipped", "nobody tips in a crowd",
              "50 robots, 30 boxes, 60 s, forward or reversed every 5 s, 5 and 10 ms, 3 worlds; "
              "trials with a tilt over 30 degrees", Bound("<=", 0.0), "tipped",
              sizes=LARGE),
        sheet(NAME, "crowd", "crowd-tilt", "nobody tips in a crowd", "the same, largest tilt",
              Bound("<", 5.0), "tilt_deg", unit="deg", sizes=LARGE),
    ]  # fmt: skip
