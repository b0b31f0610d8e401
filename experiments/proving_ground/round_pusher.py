"""The round pusher: straight, turn, push, reverse, and its turret."""

from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np

from experiments.proving_ground.course import ALL, Course, Metrics, demand, hall, profile, sheet
from mjmr.claims import Bound, Claim
from mjmr.randomness import Streams
from mjmr.robots.round_pusher import RoundPusher
from mjmr.simulation import Simulation

PERIOD = 0.1
NAME = "round_pusher"


def _course(condition: Mapping[str, Any], pose: Any, **options: Any) -> Course:
    world = hall(**options)
    group = world.add_group(RoundPusher, [pose])
    dt = condition["dt_ms"] / 1000.0
    return Course(Simulation(world, control_period=PERIOD, dt_max=dt), group)


def straight(condition: Mapping[str, Any], seed: int) -> Metrics:
    """5 m ahead at 0.5 m/s, in a direction drawn by seed."""
    yaw = _drawn(seed, -np.pi, np.pi)
    start = [-3.0 * np.cos(yaw), -3.0 * np.sin(yaw), yaw]
    # ramps of 0.08 m/s a period: within what the base's firmware allows
    log = _course(condition, start).drive(profile([0.5, 0.0], 100, ramp=7)).log
    way = log.poses[-1, 0, :2] - log.poses[0, 0, :2]
    ahead = np.array([np.cos(yaw), np.sin(yaw)])
    return {
        "error_pct": 100 * abs(float(way @ ahead) / 5.0 - 1.0),
        "lateral_mm": 1000 * abs(float(ahead[0] * way[1] - ahead[1] * way[0])),
    }


def turn(condition: Mapping[str, Any], seed: int) -> Metrics:
    """360 degrees on the spot at 1 rad/s, from a heading drawn by seed."""
    rate = 2 * np.pi / 6.3  # a whole number of periods
    start = [0.0, 0.0, _drawn(seed, -np.pi, np.pi)]
    log = _course(condition, start).drive(profile([0.0, rate], 63)).log
    turned = log.yaw[-1, 0] - log.yaw[0, 0]
    moved = np.linalg.norm(log.poses[-1, 0, :2] - log.poses[0, 0, :2])
    return {
        "error_pct": 100 * abs(turned / (2 * np.pi) - 1.0),
        "moved_mm": 1000 * float(moved),
    }


def push(condition: Mapping[str, Any], seed: int) -> Metrics:
    """4 s against a wall, head on but for at most 3 degrees; mean of the wall's force."""
    yaw = _drawn(seed, -0.05, 0.05)
    course = _course(condition, [8.0 - RoundPusher.radius - 0.02, 0.0, yaw])
    course.drive(np.tile([0.5, 0.0], (20, 1)))
    model, data = course.simulation.model, course.simulation.data
    rim, forces, force = model.geom("round_pusher0/rim").id, [], np.zeros(6)

    def see() -> None:
        total = 0.0
        for k in range(data.ncon):
            if rim in data.contact[k].geom:
                mujoco.mj_contactForce(model, data, k, force)
                total += force[0]
        forces.append(total)

    course.simulation.watch_steps(see)
    course.drive(np.tile([0.5, 0.0], (40, 1)))
    measured = float(np.mean(forces))
    demand("push [N]", measured, 1.0)
    return {"push": measured, "error_pct": 100 * (measured / RoundPusher.push_force - 1.0)}


def stop(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Top speed, then top speed backwards as fast as the motors can: how far it tips."""
    yaw = _drawn(seed, -np.pi, np.pi)
    world = hall()
    group = world.add_group(RoundPusher(acceleration=50.0, turn_acceleration=50.0), [[0, 0, yaw]])
    dt = condition["dt_ms"] / 1000.0
    course = Course(Simulation(world, control_period=PERIOD, dt_max=dt), group)
    commands = np.zeros((60, 2))
    commands[:20, 0], commands[20:40, 0], commands[40:, 0] = 0.5, -0.5, 0.5
    log = course.drive(commands).log
    demand("speed [m/s]", float(np.abs(log.twists[:, 0, 0]).max()), 0.45)
    return {"tilt_deg": float(np.degrees(log.tilt)), "top_speed": float(log.twists[19, 0, 0])}


def aim(condition: Mapping[str, Any], seed: int) -> Metrics:
    """The turret is aimed at an angle drawn by seed while the robot turns; half a second more."""
    goal = _drawn(seed, -np.pi, np.pi)
    course = _course(condition, [0.0, 0.0, 0.0])
    turret: Any = course.group.sensors["turret"]
    for k, _ in enumerate(course.simulation.ticks(1.6)):
        course.group.drive([[0.2, 1.0]])
        if k == 0:
            turret.aim(goal)
    # half a turn takes a second
    off = float(turret.observe(1.6)[0]) - goal
    return {"off_deg": abs(float(np.degrees((off + np.pi) % (2 * np.pi) - np.pi)))}


def _drawn(seed: int, low: float, high: float) -> float:
    return float(Streams(seed).generator("draw").uniform(low, high))


TESTS = {"straight": straight, "turn": turn, "push": push, "stop": stop, "aim": aim}


def claims() -> list[Claim]:
    """What the round pusher must do."""
    words = "a base of our choice does what its README says"
    how = "5 and 10 ms, 5 directions, largest"
    return [
        sheet(NAME, "straight", "straight", words, f"way / 5 m - 1, {how}", Bound("<=", 0.2),
              "error_pct", unit="%", sizes=ALL),
        sheet(NAME, "straight", "straight-aside", words, f"sideways after 5 m, {how}",
              Bound("<=", 10.0), "lateral_mm", unit="mm", sizes=ALL),
        sheet(NAME, "turn", "turn", words, f"360 degrees in place / turned - 1, {how}",
              Bound("<=", 0.5), "error_pct", unit="%", sizes=ALL),
        sheet(NAME, "push", "push", words, f"force on a wall / stated - 1, {how}",
              Bound.within(-2.0, 2.0), "error_pct", unit="%", sizes=ALL),
        sheet(NAME, "stop", "stop-tilt", words,
              "0.5 m/s, reversed and reversed again as fast as the motors can; largest tilt",
              Bound("<=", 5.0), "tilt_deg", unit="deg", sizes=ALL),
        sheet(NAME, "stop", "top-speed", words, "forwards, after 2 s",
              Bound("==", 0.5, 0.005), "top_speed", unit="m/s", sizes=ALL),
        sheet(NAME, "aim", "aim", words, "turret off its aim half a second after it can be there",
              Bound("<=", 0.5), "off_deg", unit="deg", sizes=ALL),
    ]  # fmt: skip
