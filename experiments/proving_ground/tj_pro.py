"""The TJ Pro: straight, turns by the program loop, arcs of unequal servos, and tyres that slip."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from experiments.proving_ground.course import (
    LARGE,
    Course,
    Metrics,
    apart,
    demand,
    hall,
    profile,
    sheet,
)
from mjmr.claims import Bound, Claim
from mjmr.contacts import normal_forces
from mjmr.randomness import Streams
from mjmr.robots.tj_pro import TJPro, draw_servo_gains
from mjmr.simulation import Simulation

PERIOD = 0.1
NAME = "tj_pro"
SPEED = 0.0762 / 0.5  # m/s, 3 inches a program loop


def _course(condition: Mapping[str, Any], seed: int, half: float = 4.0, **options: Any) -> Course:
    """One robot in the middle of a hall, heading anywhere."""
    world = hall(half)
    yaw = Streams(seed).generator("yaw").uniform(-np.pi, np.pi)
    group = world.add_group(TJPro(**options), [[0.0, 0.0, yaw]])
    dt = condition["dt_ms"] / 1000.0
    return Course(Simulation(world, control_period=PERIOD, dt_max=dt), group)


def straight(condition: Mapping[str, Any], seed: int) -> Metrics:
    """3.05 m ahead, 40 program loops, with exact servos."""
    log = _course(condition, seed).drive(profile([SPEED, 0.0], 200)).log
    way = log.poses[-1, 0] - log.poses[0, 0]
    heading = log.poses[0, 0, 2]
    ahead = way[0] * np.cos(heading) + way[1] * np.sin(heading)
    aside = way[1] * np.cos(heading) - way[0] * np.sin(heading)
    over = 100 * (ahead / (200 * PERIOD * SPEED) - 1.0)
    return {"error_pct": abs(over), "over_pct": over, "lateral_mm": 1000 * abs(aside)}


def turn(condition: Mapping[str, Any], seed: int) -> Metrics:
    """18 turns of 20 degrees, each done within a program loop of 0.5 s."""
    rate = np.radians(20.0) / 0.4
    once = np.repeat([[0.0, rate], [0.0, 0.0]], [4, 1], axis=0)
    log = _course(condition, seed).drive(np.concatenate([np.tile(once, (18, 1)), np.zeros((5, 2))]))
    log = log.log
    over = 100 * ((log.yaw[-1, 0] - log.yaw[0, 0]) / (2 * np.pi) - 1.0)
    moved = np.linalg.norm(log.poses[-1, 0, :2] - log.poses[0, 0, :2])
    return {"error_pct": abs(over), "over_pct": over, "moved_mm": 1000 * float(moved)}


def circle(condition: Mapping[str, Any], seed: int) -> Metrics:
    """20 s straight on as it is told, with servos drawn within 5 %: an arc."""
    gains = draw_servo_gains(Streams(seed).generator("servos"), 1, 0.05)
    log = _course(condition, seed, servo_gains=gains).drive(profile([SPEED, 0.0], 200)).log
    left, right = gains[0]
    mean, way = (left + right) / 2, 200 * PERIOD * SPEED
    expected = way * (right - left) / TJPro.track
    turned = log.yaw[-1, 0] - log.yaw[0, 0]
    return {
        "heading_off_deg": float(np.degrees(abs(turned - expected))),
        "way_error_pct": 100 * abs(float(log.ways[0]) / (way * mean) - 1.0),
        "turned_deg": float(np.degrees(turned)),
    }


def stop(condition: Mapping[str, Any], seed: int) -> Metrics:
    """6 s against a wall at any angle up to 30 degrees: what it pushes with, and its tilt."""
    world = hall(2.0)
    yaw = Streams(seed).generator("yaw").uniform(-np.pi / 6, np.pi / 6)
    group = world.add_group(TJPro, [[1.85, 0.0, yaw]])
    dt = condition["dt_ms"] / 1000.0
    course = Course(Simulation(world, control_period=PERIOD, dt_max=dt), group)
    simulation, pushes = course.simulation, []
    wall = simulation.model.geom("wall_east").id

    def feel() -> None:
        on_wall = (simulation.data.contact.geom == wall).any(axis=1)
        pushes.append(float(normal_forces(simulation.model, simulation.data)[on_wall].sum()))

    simulation.watch_steps(feel)
    log = course.drive(np.tile([SPEED, 0.0], (60, 1))).log
    pushed = np.array(pushes[len(pushes) // 2 :])
    demand("mean push [N]", pushed.mean(), 1.0)
    return {
        "push_n": float(pushed.mean()),
        "ripple_n": float(pushed.std()),
        "tilt_deg": float(np.degrees(log.tilt)),
    }


TESTS = {"straight": straight, "turn": turn, "circle": circle, "stop": stop}


def claims() -> list[Claim]:
    """What the TJ Pro must do."""
    words = "a base of our choice does what its README says"
    how = "5 and 10 ms, 5 directions"
    return [
        sheet(NAME, "straight", "straight", words, f"way / 3.05 m - 1, {how}, largest",
              Bound("<=", 0.3), "error_pct", unit="%"),
        sheet(NAME, "straight", "straight-aside", words, f"sideways after 3.05 m, {how}, largest",
              Bound("<=", 3.0), "lateral_mm", unit="mm"),
        sheet(NAME, "straight", "straight-timestep", "the same at every timestep",
              "way, difference of the errors at 5 and 10 ms", Bound("<=", 0.1),
              apart("over_pct", "dt_ms"), unit="%", sizes=LARGE),
        sheet(NAME, "turn", "turn", words,
              f"18 turns of 20 degrees / turned - 1, {how}, largest", Bound("<=", 0.5),
              "error_pct", unit="%"),
        sheet(NAME, "circle", "arc", "unequal servos make it drive an arc",
              "20 s told straight on, servos drawn within 5 %, 5 and 10 ms, 5 draws; heading "
              "against way x difference / track, largest", Bound("<=", 1.0), "heading_off_deg",
              unit="deg"),
        sheet(NAME, "circle", "arc-way", "unequal servos make it drive an arc",
              "the same, way / its mean servo's - 1", Bound("<=", 0.5), "way_error_pct", unit="%"),
        sheet(NAME, "stop", "slip", "its tyres slip before its servos stall at 17 N",
              "mean push on a wall, within 30 degrees of its normal, 5 and 10 ms, 5 directions, "
              "largest; friction x weight is 7.1 N", Bound("<=", 7.1), "push_n", unit="N"),
        sheet(NAME, "stop", "slip-smooth", "its tyres slip and do not hop",
              "standard deviation of that push, largest", Bound("<=", 1.0), "ripple_n", unit="N"),
        sheet(NAME, "stop", "slip-tilt", "pushing does not tip it", "the same, largest tilt",
              Bound("<=", 3.0), "tilt_deg", unit="deg"),
    ]  # fmt: skip
