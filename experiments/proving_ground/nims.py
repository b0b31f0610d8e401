"""NIMS: travel, swing, pendulum and tension, both sizes, both models of the cable."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from controllers.motion.swing_free import swing_free
from experiments.proving_ground.course import LARGE, Array, Metrics, apart, sheet
from mjmr.claims import Bound, Claim
from mjmr.robots.nims import Nims
from mjmr.sensors.cable_tension import CableTension
from mjmr.simulation import Simulation
from mjmr.world import World

PERIOD = 0.1
NAME = "nims"
BOUNDS = {"lab": [-4.0, -2.0, 4.0, 2.0], "field": [-38.0, -4.0, 38.0, 4.0]}
WAY = {"lab": 4.0, "field": 20.0}
VARIANTS = tuple(f"{size}-{cable}" for size in BOUNDS for cable in ("curve", "tendon"))


def _rig(condition: Mapping[str, Any], **options: Any) -> tuple[Nims, Any, Simulation]:
    size, cable = condition["variant"].split("-")
    platform = Nims(size=size, cable=cable, **options)
    world = World(bounds=BOUNDS[size])
    group = world.add_group(platform, [[0.0, 0.0, 0.0]])
    group.mount(CableTension())
    dt = condition["dt_ms"] / 1000.0
    return platform, group, Simulation(world, control_period=PERIOD, dt_max=dt)


# along, lift, swing, sway and line in ``qpos``: the rig's only joints, the world's first
_ALONG, _LIFT, _SWING = 0, 1, 2


def move(condition: Mapping[str, Any], seed: int) -> Metrics:
    """A move whose ramps last one swing each, then rest for 30 s."""
    size = condition["variant"].split("-")[0]
    way, speed = WAY[size], condition["speed"]
    platform, group, simulation = _rig(condition, along=-way / 2)
    period = platform.swing_period(platform.line)
    plan = swing_free(way, speed, period)
    ticks = int(np.ceil(plan.duration / PERIOD))
    seen: list[Array] = []
    simulation.watch_steps(lambda: seen.append(simulation.data.qpos[: _SWING + 1].copy()))
    for k, _ in enumerate(simulation.ticks(ticks * PERIOD + 30.0)):
        group.drive([[plan.velocity((k + 1) * PERIOD), 0.0]])
    along, lift, swing = np.array(seen)[:, [_ALONG, _LIFT, _SWING]].T
    arrived = round(ticks * PERIOD / simulation.timestep)
    # rows are of the ends of steps: this one is half way at every timestep, arrived // 2 is later
    half = round(ticks * PERIOD / simulation.timestep / 2) - 1
    curve = platform.cable.sag * (along / (platform.cable.span / 2)) ** 2
    per_swing = round(2 * period / simulation.timestep)
    return {
        "arrival_mm": 1000 * abs(float(along[arrived]) - way / 2),
        "settled_mm": 1000 * abs(float(along[-1]) - way / 2),
        "off_curve_mm": 1000 * float(np.abs(lift - curve).max()),
        "residual_deg": float(np.degrees(np.abs(swing[arrived : arrived + per_swing]).max())),
        "peak_deg": float(np.degrees(np.abs(swing).max())),
        # where it was on the way, for comparing timesteps
        "middle_mm": 1000 * float(along[arrived // 2]),
        "middle_lift_mm": 1000 * float(lift[arrived // 2]),
        "half_way_mm": 1000 * float(along[half]),
        "half_way_lift_mm": 1000 * float(lift[half]),
    }


def pendulum(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Let the package swing from 0.1 rad; its period against that of a point on the line."""
    platform, _, simulation = _rig(condition)
    simulation.data.qpos[_SWING] = 0.1
    angle: list[float] = []
    simulation.watch_steps(lambda: angle.append(float(simulation.data.qpos[_SWING])))
    ideal = 2 * np.pi * np.sqrt(platform.line / 9.81)
    for _ in simulation.ticks(12 * ideal):
        pass
    a = np.array(angle)
    up = np.flatnonzero((a[:-1] < 0) & (a[1:] >= 0))
    crossed = up - a[up] / (a[up + 1] - a[up])
    measured = float(np.diff(crossed).mean() * simulation.timestep)
    return {"period_s": measured, "error_pct": 100 * abs(measured / ideal - 1.0)}


def tension(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Tensions at rest, in the middle and far out, against statics of straight cables."""
    away = {"lab": 2.0, "field": 25.0}[condition["variant"].split("-")[0]]
    errors = []
    for along in (0.0, away):
        platform, group, simulation = _rig(condition, along=along)
        for _ in simulation.ticks(5.0):
            pass
        weight, half = 9.81 * platform.mass, platform.cable.span / 2
        rise = platform.cable.sag * (1 - (along / half) ** 2)
        # both pulls along their lines: horizontal parts cancel, vertical ones carry the weight
        slopes = np.array([[-(half + along), half - along], [rise, rise]])
        lines = slopes / np.hypot(slopes[0], slopes[1])
        statics = np.linalg.solve(lines, [0.0, weight])
        errors.append(np.abs(group.tension.read()[0] / statics - 1.0).max())
    return {"error_pct": 100 * float(max(errors))}


TESTS = {"move": move, "pendulum": pendulum, "tension": tension}


def claims() -> list[Claim]:
    """What NIMS must do."""
    how = "lab and field, both cables, 0.1 and 1 m/s, 2 and 10 ms"
    return [
        sheet(NAME, "move", "arrival", "arrives", f"off its goal when the command ends, {how}",
              Bound("<=", 20.0), "arrival_mm", unit="mm"),
        sheet(NAME, "move", "settled", "stays where it arrived", f"off its goal 30 s later, {how}",
              Bound("<=", 5.0), "settled_mm", unit="mm"),
        sheet(NAME, "move", "residual-swing", "ramps of one swing leave the package at rest",
              f"largest swing in two periods after arrival, {how}", Bound("<=", 0.5),
              "residual_deg", unit="deg"),
        sheet(NAME, "move", "on-curve", "the carriage is on the cable",
              f"largest distance from the curve at any physics step, {how}", Bound("<=", 5.0),
              "off_curve_mm", unit="mm"),
        sheet(NAME, "move", "timestep-along", "the same at every timestep",
              "place a step after half way at 2 and 10 ms, which is 8 ms apart, difference",
              Bound("<=", 2.0),
              apart("middle_mm", "dt_ms"), unit="mm", sizes=LARGE),
        sheet(NAME, "move", "timestep-lift", "the same at every timestep",
              "height a step after half way at 2 and 10 ms, difference", Bound("<=", 2.0),
              apart("middle_lift_mm", "dt_ms"), unit="mm", sizes=LARGE),
        sheet(NAME, "move", "same-instant-along", "the same at every timestep",
              "place half way, at one instant, at 2 and 10 ms, difference", Bound("<=", 2.0),
              apart("half_way_mm", "dt_ms"), unit="mm", sizes=LARGE),
        sheet(NAME, "move", "same-instant-lift", "the same at every timestep",
              "height half way, at one instant, at 2 and 10 ms, difference", Bound("<=", 2.0),
              apart("half_way_lift_mm", "dt_ms"), unit="mm", sizes=LARGE),
        sheet(NAME, "pendulum", "period", "the package swings as a pendulum",
              "period / that of a point on the line - 1, lab and field, both cables",
              Bound("<=", 2.0), "error_pct", unit="%"),
        sheet(NAME, "tension", "tension", "tensions at rest are those of statics",
              "largest deviation, middle and far out, lab and field, both cables",
              Bound("<=", 1.0), "error_pct", unit="%"),
    ]  # fmt: skip
