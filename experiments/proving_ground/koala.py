"""The Koala: how six wheels scrub in a turn, and what its odometry is worth."""

from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np

from controllers.estimation.odometry import Odometry
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
from mjmr.geometry import angle_difference
from mjmr.randomness import Streams
from mjmr.robots.koala import Koala
from mjmr.simulation import Simulation

PERIOD = 0.1
NAME = "koala"


def _course(
    condition: Mapping[str, Any], uneven: int | None = None, start: Any = (0.0, 0.0, 0.0)
) -> Course:
    """One Koala; ``uneven`` is a seed by which each wheel's friction differs by up to 10 %."""
    world = hall(4.0)
    group = world.add_group(Koala(), [start])
    factors = np.ones(6)
    if uneven is not None:
        factors = Streams(uneven).generator("grip").uniform(0.9, 1.1, 6)
    friction = condition["friction"]

    def grip(spec: mujoco.MjSpec) -> None:
        treads = [g for g in spec.geoms if "tread" in g.name]
        for tread, factor in zip(treads, factors, strict=True):
            tread.friction[0] = (friction or tread.friction[0]) * factor

    world.edit(grip)
    dt = condition["dt_ms"] / 1000.0
    return Course(Simulation(world, control_period=PERIOD, dt_max=dt), group)


def _follow(course: Course, commands: Array, track: float) -> Array:
    """Drive, and integrate the encoders: odometry's poses (k, 3) at the control instants.

    Headings are not wrapped.
    """
    group, platform = course.group, Koala()
    encoders: Any = group.sensors["encoders"]
    odometry = Odometry(
        group.start,
        radius=platform.rolling_radius,
        track=track,
        counts_per_turn=encoders.counts_per_turn,
    )
    found = []
    for command, _ in zip(commands, course.simulation.ticks(len(commands) * PERIOD), strict=True):
        found.append(odometry.step(encoders.read())[0])
        group.drive(np.broadcast_to(command, (1, 2)))
    found.append(odometry.step(encoders.read())[0])
    poses = np.array(found)
    poses[:, 2] = np.unwrap(poses[:, 2])
    return poses


def turn(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Three turns on the spot: turn by encoders and the wheels' own track / true turn; loads."""
    rate = condition["turn"]
    course = _course(condition)
    loads = _Loads(course.simulation)
    periods = round(3 * 2 * np.pi / rate / PERIOD)
    told = _follow(course, profile([0.0, rate], periods), Koala.track)
    yaw = course.log.yaw[:, 0]
    demand("turn [rad]", abs(yaw[-1] - yaw[0]), 3 * np.pi)
    return {
        "scrub": float((told[-1, 2] - told[0, 2]) / (yaw[-1] - yaw[0])),
        "unloaded_share": loads.unloaded_share,
    }


def straight(condition: Mapping[str, Any], seed: int) -> Metrics:
    """5 m ahead at 0.3 m/s on wheels whose grip differs."""
    course = _course(condition, uneven=seed, start=(-2.5, 0.0, 0.0))
    log = course.drive(profile([0.3, 0.0], round(5.0 / 0.3 / PERIOD))).log
    demand("way [m]", log.ways[0], 4.5)
    return {
        "lateral_mm": 1000 * abs(float(log.poses[-1, 0, 1])),
        "way_m": float(log.poses[-1, 0, 0] + 2.5),
    }


def odometry(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Five turns on wheels whose grip differs; error of the heading, with the track as fitted."""
    return _turns(condition, uneven=seed)


def odometry_even(condition: Mapping[str, Any], seed: int) -> Metrics:
    """The same on wheels that grip alike."""
    return _turns(condition)


def _turns(condition: Mapping[str, Any], uneven: int | None = None) -> Metrics:
    rate = condition["turn"]
    course = _course(condition, uneven)
    periods = round(5 * 2 * np.pi / rate / PERIOD)
    told = _follow(course, profile([0.0, rate], periods), Koala.effective_track)
    yaw = course.log.yaw[:, 0]
    demand("turn [rad]", abs(yaw[-1] - yaw[0]), 5 * np.pi)
    error = (told[-1, 2] - told[0, 2]) - (yaw[-1] - yaw[0])
    return {"error_deg": abs(float(np.degrees(error)))}


def square(condition: Mapping[str, Any], seed: int) -> Metrics:
    """A square of 2 m by dead reckoning alone; where it thinks it is against where it is."""
    sign = 1.0 if condition["variant"] == "left" else -1.0
    speed = condition["speed"]
    side = profile([speed, 0.0], round(2.0 / speed / PERIOD))
    corner = profile([0.0, sign * np.pi / 2 / 2.0], 20)  # 90 degrees in 2 s
    commands = np.concatenate([side, corner] * 4)
    course = _course(condition, start=(-1.0, -sign, 0.0))
    told = _follow(course, commands, Koala.effective_track)
    demand("way [m]", course.log.ways[0], 6.0)
    true = course.log.poses[-1, 0]
    return {
        "error_mm": 1000 * float(np.hypot(*(told[-1, :2] - true[:2]))),
        "heading_deg": abs(float(np.degrees(angle_difference(told[-1, 2], true[2])))),
    }


class _Loads:
    """Share of physics steps, while it turns, in which a wheel carries nothing."""

    def __init__(self, simulation: Simulation):
        model = simulation.model
        names = [model.geom(i).name for i in range(model.ngeom)]
        self._treads = np.array([i for i, name in enumerate(names) if "tread" in name])
        self._simulation, self._steps, self._unloaded = simulation, 0, 0
        simulation.watch_steps(self._measure)

    def _measure(self) -> None:
        data, model = self._simulation.data, self._simulation.model
        self._steps += 1
        force, carried = np.zeros(6), set()
        for k, geoms in enumerate(data.contact.geom):
            mujoco.mj_contactForce(model, data, k, force)
            if force[0] > 1e-3:
                carried.update(int(g) for g in geoms)
        self._unloaded += not carried.issuperset(self._treads.tolist())

    @property
    def unloaded_share(self) -> float:
        return self._unloaded / max(1, self._steps)


TESTS = {
    "turn": turn,
    "straight": straight,
    "odometry": odometry,
    "odometry-even": odometry_even,
    "square": square,
}


def claims() -> list[Claim]:
    """What the Koala must do."""
    return [
        sheet(NAME, "turn", "scrub", "quarter turn of 5580 counts: effective track 1.12 x 285 mm",
              "turn by encoders and the wheels' track / true turn, three turns on the spot at 0.3 "
              "to 2 rad/s, 2 and 5 ms", Bound.within(1.05, 1.25), "scrub", published="1.12"),
        sheet(NAME, "turn", "scrub-timestep", "the same at every timestep",
              "difference at 2 and 5 ms, largest over 0.3 to 2 rad/s", Bound("<=", 0.02),
              apart("scrub", "dt_ms"), sizes=LARGE),
        sheet(NAME, "turn", "loads", "all six wheels carry in a turn",
              "share of steps with an unloaded wheel, up to 0.8 rad/s, 2 and 5 ms",
              Bound("<=", 0.0), "unloaded_share", turn=(0.3, 0.5, 0.8)),
        sheet(NAME, "straight", "straight", "runs straight",
              "off the line after 5 m, every wheel's grip up to 10 % different",
              Bound("<=", 5.0), "lateral_mm", unit="mm"),
        sheet(NAME, "odometry", "odometry-fitted", "odometry with the effective track",
              "heading after 5 turns at 0.8 rad/s, where the track was fitted, uneven grip",
              Bound("<=", 15.0), "error_deg", unit="deg", turn=0.8, friction=0.0, sizes=LARGE),
        sheet(NAME, "odometry", "odometry-elsewhere", "odometry with the effective track",
              "heading after 5 turns at 0.4 to 2 rad/s, and with other tyres (friction 0.5 and "
              "1.1), uneven grip", Bound("<=", 40.0), "error_deg", unit="deg", sizes=LARGE),
        sheet(NAME, "odometry-even", "odometry-even-fitted", "odometry with the effective track",
              "heading after 5 turns at 1 rad/s, where the track was fitted, all wheels alike",
              Bound("<=", 15.0), "error_deg", unit="deg", turn=1.0, friction=0.0),
        sheet(NAME, "odometry-even", "odometry-even-elsewhere",
              "odometry with the effective track",
              "heading after 5 turns at 0.4 to 2 rad/s, and with other tyres (friction 0.5 and "
              "1.1), all wheels alike", Bound("<=", 40.0), "error_deg", unit="deg", sizes=LARGE),
        sheet(NAME, "square", "square", "odometry with the effective track",
              "error of dead reckoning round a 2 m square, both ways, 0.2 and 0.4 m/s",
              Bound("<=", 50.0), "error_mm", unit="mm"),
    ]  # fmt: skip
