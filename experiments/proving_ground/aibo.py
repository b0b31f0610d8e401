"""The AIBO ERS-7: walking in every direction, getting up, kicking, and its ball."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from controllers.legged.ers7_gaits import ERS7_TROT
from controllers.legged.heading import HeadingLoop
from controllers.legged.motion import AiboMotion
from experiments.proving_ground.aibo_trials import LegRates, get_up, kick, roll, world_with
from experiments.proving_ground.course import (
    LARGE,
    Course,
    Measure,
    Metrics,
    apart,
    by_condition,
    means,
    sheet,
    worst,
)
from mjmr.claims import Bound, Claim, Evidence, Table
from mjmr.robots.aibo_ers7 import AiboERS7
from mjmr.sensors.compass import Compass
from mjmr.sensors.localizer import Localizer
from mjmr.simulation import Simulation

NAME = "aibo_ers7"
PERIOD = 0.032
# forward, left [m/s], turn [rad/s]: the largest commands of each kind, and a slower walk
COMMANDS = {
    "forward": (0.42, 0.0, 0.0),
    "slow": (0.30, 0.0, 0.0),
    "backward": (-0.25, 0.0, 0.0),
    "left": (0.0, 0.185, 0.0),
    "right": (0.0, -0.185, 0.0),
    "turn-left": (0.0, 0.0, 2.8),
    "turn-right": (0.0, 0.0, -2.8),
}
_START, _MEASURED = 2.0, 6.0  # s


def engine() -> AiboMotion:
    """What walks and acts: the trot, the head at home, and every action."""
    return AiboMotion(ERS7_TROT)


def _dog(condition: Mapping[str, Any], start: Any) -> tuple[Any, Any]:
    world = world_with(condition["friction"], 4.0)
    return world, world.add_group(AiboERS7(engine()), [start])


def walk(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Obey one command for 8 s; what is measured leaves the first 2 s out."""
    asked = np.array(COMMANDS[condition["variant"]])
    world, group = _dog(condition, (0.0, 0.0, 0.0))
    simulation = Simulation(
        world, seed=seed, control_period=PERIOD, dt_max=condition["dt_ms"] / 1000.0
    )
    course = Course(simulation, group)
    rates = LegRates(simulation, group)
    ticks = round((_START + _MEASURED) / PERIOD)
    log = course.drive(np.tile(engine().command(asked), (ticks, 1))).log
    late = log.times > _START
    mean = log.twists[late, 0].mean(axis=0)
    yaw, times = log.yaw[late, 0], log.times[late]
    return {
        "forward_mm_s": 1000 * float(mean[0]),
        "left_mm_s": 1000 * float(mean[1]),
        "turn_rad_s": float((yaw[-1] - yaw[0]) / (times[-1] - times[0])),
        "rate_p99": rates.p99(since=round(_START / simulation.timestep)),
        "tilt_deg": float(np.degrees(log.tilt)),
    }


def straight(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Walk 3 m with the heading held by a compass."""
    world, group = _dog(condition, (-2.0, 0.0, 0.0))
    compass = group.mount(Compass(rate=1 / PERIOD, noise=np.radians(1.0)))
    localizer = group.mount(Localizer(rate=1 / PERIOD))
    simulation = Simulation(
        world, seed=seed, control_period=PERIOD, dt_max=condition["dt_ms"] / 1000.0
    )
    course = Course(simulation, group)
    loop, motion = HeadingLoop(), engine()
    for _ in simulation.ticks(14.0):
        # where it is decides when the course ends, not how it walks
        if localizer.read()[0, 0] > 1.0:
            break
        turn = loop.turn(compass.read(), 0.0)
        group.drive(motion.command([[0.30, 0.0, turn[0]]]))
    pose = course.log.poses[-1, 0]
    return {
        "way_m": float(pose[0] + 2.0),
        "lateral_mm": 1000 * abs(float(pose[1])),
        "heading_deg": abs(float(np.degrees(pose[2]))),
    }


TESTS = {"walk": walk, "straight": straight, "get-up": get_up, "kick": kick, "roll": roll}


def _share(metric: str, at_least: float) -> Measure:
    """Share of trials with a metric above a value: the smallest, over friction and timestep."""

    def evaluate(table: Table, bound: Bound) -> Evidence:
        shares = by_condition(table, metric, lambda values: np.mean(values > at_least))
        return worst(shares, bound, table.finished)

    return evaluate


def _deviations(metric: str) -> Measure:
    """Deviation of a metric: the largest, over friction and timestep."""

    def evaluate(table: Table, bound: Bound) -> Evidence:
        found = by_condition(table, metric, lambda values: np.std(values, ddof=1))
        return worst(found, bound, table.finished)

    return evaluate


def _in_time(seconds: float) -> Measure:
    """Share of robots that stand within ``seconds``: the smallest, over friction and timestep."""

    def evaluate(table: Table, bound: Bound) -> Evidence:
        table.values("up")
        shares = []
        for condition in table.conditions:
            rows = table.where(**condition)
            shares.append(float(np.mean(rows.values("up") & (rows.values("seconds") <= seconds))))
        return worst(shares, bound, table.finished)

    return evaluate


_WHERE = "friction 0.6 and 1.0, 2 and 4 ms, self-collision on"


def _walking() -> list[Claim]:
    real = "rUNSWift 2005: 349 mm/s, 171 mm/s, 2.8 rad/s"
    found = []
    for variant, name, metric, bound, published in (
        ("forward", "forward", "forward_mm_s", Bound.within(350, 430), "349 mm/s"),
        ("slow", "forward-300", "forward_mm_s", Bound.within(270, 320), "no number"),
        ("backward", "backward", "forward_mm_s", Bound("<=", -180), "no number"),
        ("left", "left", "left_mm_s", Bound.within(160, 200), "171 mm/s"),
        ("right", "right", "left_mm_s", Bound.within(-200, -160), "171 mm/s"),
        ("turn-left", "turn-left", "turn_rad_s", Bound.within(2.3, 3.0), "2.8 rad/s"),
        ("turn-right", "turn-right", "turn_rad_s", Bound.within(-3.0, -2.3), "2.8 rad/s"),
    ):
        unit = "rad/s" if metric.startswith("turn") else "mm/s"
        found.append(
            sheet(NAME, "walk", f"walk-{name}", f"walks as the real one ({real})",
                  f"mean over 6 s at command {COMMANDS[variant]}, {_WHERE}", bound,
                  metric, unit=unit, published=published, sizes=LARGE, variant=variant)
        )  # fmt: skip
    for pair, metric in ((("left", "right"), "left_mm_s"), (("turn-left", "turn-right"),
                         "turn_rad_s")):  # fmt: skip
        found.append(
            sheet(NAME, "walk", f"walk-{pair[0]}-and-right",
                  "left and right are equal", f"difference / mean, largest over {_WHERE}",
                  Bound("<=", 0.05), apart(metric, "variant", relative=True, absolute=True),
                  sizes=LARGE, variant=pair)
        )  # fmt: skip
    for metric, kinds in (
        ("forward_mm_s", ("forward", "slow", "backward")),
        ("left_mm_s", ("left", "right")),
        ("turn_rad_s", ("turn-left", "turn-right")),
    ):
        found.append(
            sheet(NAME, "walk", f"walk-timestep-{metric.split('_')[0]}",
                  "the same at every timestep", "difference at 2 and 4 ms / mean, largest",
                  Bound("<=", 0.05), apart(metric, "dt_ms", relative=True), sizes=LARGE,
                  variant=kinds)
        )  # fmt: skip
    return [
        *found,
        sheet(NAME, "walk", "walk-rates", "servos turn no faster than the real ones",
              f"speed of leg joints / limit, 99th percentile, largest over commands, {_WHERE}",
              Bound("<=", 1.15), "rate_p99"),
        sheet(NAME, "walk", "walk-upright", "stays on its feet",
              f"largest tilt of the trunk, over commands, {_WHERE}", Bound("<=", 20.0), "tilt_deg",
              unit="deg"),
        sheet(NAME, "straight", "straight-heading", "walks 3 m straight with its heading held",
              f"heading at the end, compass of 1 degree, largest over {_WHERE}",
              Bound("<=", 5.0), "heading_deg", unit="deg"),
        sheet(NAME, "straight", "straight-lateral", "walks 3 m straight with its heading held",
              f"off the line at the end, largest over {_WHERE}", Bound("<=", 100.0),
              "lateral_mm", unit="mm"),
        sheet(NAME, "straight", "straight-way", "walks 3 m straight with its heading held",
              f"way, smallest over {_WHERE}", Bound(">=", 2.95), "way_m", unit="m"),
    ]  # fmt: skip


def _acting() -> list[Claim]:
    found = []
    for variant, seconds, share in (("front", 3.0, 1.0), ("left", 6.0, 0.9), ("right", 6.0, 0.9),
                                    ("back", 6.0, 0.9)):  # fmt: skip
        found.append(
            sheet(NAME, "get-up", f"up-from-{variant}", "gets up when it has fallen",
                  f"share of random falls on the {variant} that stand within {seconds:g} s, "
                  f"smallest over {_WHERE}", Bound(">=", share), _in_time(seconds), sizes=LARGE,
                  variant=variant)
        )  # fmt: skip
    rates = "speed of leg joints / limit, 99th percentile of a trial, mean of trials, largest over"
    words = "servos turn no faster than the real ones"
    found += [
        sheet(NAME, "get-up", "up-rates", words, f"{rates} falls, {_WHERE}", Bound("<=", 1.15),
              means("rate_p99"), sizes=LARGE),
        sheet(NAME, "kick", "kick-rates", words, f"{rates} kicks, {_WHERE}", Bound("<=", 1.15),
              means("rate_p99"), sizes=LARGE),
        sheet(NAME, "kick", "kick-upright", "stands after a kick",
              f"whether it fell, any trial of every kick, {_WHERE}", Bound("<=", 0.0), "fell",
              sizes=LARGE),
        sheet(NAME, "roll", "ball-rolls", "the ball rolls some 3 m from 1 m/s",
              "way from 1 m/s to rest, 2 and 4 ms", Bound.within(2.5, 4.0),
              "distance_m", unit="m"),
        sheet(NAME, "kick", "kick-forward-mean", "kicks the ball ahead",
              f"mean way of the ball, smallest over {_WHERE}", Bound(">=", 2.0),
              means("distance_m"), unit="m", sizes=LARGE, variant="forward"),
        sheet(NAME, "kick", "kick-forward-share", "kicks the ball ahead",
              f"share of balls that go 1.5 m, smallest over {_WHERE}", Bound(">=", 28 / 30),
              _share("distance_m", 1.5), sizes=LARGE, variant="forward"),
        sheet(NAME, "kick", "kick-forward-deviation", "kicks the ball ahead",
              f"deviation of the ball's direction, largest over {_WHERE}", Bound("<=", 5.0),
              _deviations("angle_deg"), unit="deg", sizes=LARGE, variant="forward"),
    ]  # fmt: skip
    for side, low, high in (("left", 80.0, 100.0), ("right", -100.0, -80.0)):
        found += [
            sheet(NAME, "kick", f"kick-{side}-mean", f"heads the ball to the {side}",
                  f"mean way of the ball, smallest over {_WHERE}", Bound(">=", 1.6),
                  means("distance_m"), unit="m", sizes=LARGE, variant=side),
            sheet(NAME, "kick", f"kick-{side}-share", f"heads the ball to the {side}",
                  f"share of balls that go 0.6 m, smallest over {_WHERE}", Bound(">=", 0.9),
                  _share("distance_m", 0.6), sizes=LARGE, variant=side),
            sheet(NAME, "kick", f"kick-{side}-direction", f"heads the ball to the {side}",
                  f"mean direction of the ball, range over {_WHERE}", Bound.within(low, high),
                  means("angle_deg"), unit="deg", sizes=LARGE,
                  variant=side),
        ]  # fmt: skip
    return found


def claims() -> list[Claim]:
    """What the AIBO must do."""
    return [*_walking(), *_acting()]
