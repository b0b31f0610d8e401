"""What a condition must not ask for, each in one sentence, before anything is built."""

import math
from collections.abc import Mapping
from typing import Any

from controllers.perimeter.config import tracked_radius
from mjmr.conditions import format_value
from mjmr.errors import InvalidInputError

HALF = 50.0  # m, of the hall
CLEAR = 8.0  # m, from walls, spill and others where a truck starts
SPREAD = 15.0  # m, of the spill's centre from the hall's, along x and y
LIMIT_GROWTH = 20.0  # m, radius at which a spill stops growing
LEAST = 2.0  # m, radius at which one stops shrinking
BUNCH = (3.6, 4.5)  # m, from truck to truck along the circle they track
OFF = 15.0  # m, from that circle, where one starts that is added
MOST_ADDED = 17.0  # m, radius of a spill that leaves room for it on all sides
PACKED = 0.35  # of the free floor, by discs of CLEAR that are put down at random: easily reached
SETTLE = 30.0  # s, until which errors of a formation do not count

# what tasks that do not look for a spill read; everything else must be as it is by default
_READS = {
    "envelope": {"task", "mode", "dt_ms"},
    "formation": {"task", "mode", "dt_ms", "path", "heard", "d_com", "duration"},
}
_FORMATION_ONLY = ("path", "heard")


def check(condition: Mapping[str, Any]) -> None:
    """Refuse what cannot be run as asked.

    Raises:
        InvalidInputError: With what was given and what is allowed.
    """
    _ignored(condition)
    if condition["task"] in _READS:
        if condition["task"] == "formation" and condition["duration"] <= SETTLE:
            raise InvalidInputError(
                f"errors of task=formation count from {SETTLE:g} s on: duration must be more than "
                f"{SETTLE:g} s; got {condition['duration']:g} s"
            )
        usual = _defaults()["d_com"]
        if condition["heard"] == "nothing" and condition["d_com"] != usual:
            raise InvalidInputError(
                "followers that hear nothing have no radio: with heard=nothing leave d_com at "
                f"{format_value(usual)}; got {format_value(condition['d_com'])}"
            )
        return
    largest_radius(condition)
    _robots(condition)


def largest_radius(condition: Mapping[str, Any]) -> float:
    """Largest radius the spill ever has [m].

    Raises:
        InvalidInputError: The hall cannot hold it with room for trucks around it.
    """
    largest = max(condition["radius"], limit_of(condition))
    room = HALF - 2.0 * CLEAR
    if largest > room:
        raise InvalidInputError(
            f"a spill of {largest:g} m radius does not fit: in a hall of {2 * HALF:g} m, with "
            f"{2 * CLEAR:g} m for trucks around it, the largest has {room:g} m"
        )
    return largest


def limit_of(condition: Mapping[str, Any]) -> float:
    """Radius at which the spill's change ends [m]."""
    radius, growth = condition["radius"], condition["growth"]
    if growth > 0:
        return max(LIMIT_GROWTH, radius)
    return min(LEAST, radius) if growth < 0 else radius


def _defaults() -> dict[str, Any]:
    from experiments.perimeter import study

    return {p.name: p.default for p in study.parameters}


def _ignored(condition: Mapping[str, Any]) -> None:
    task = condition["task"]
    usual = _defaults()
    reads = _READS.get(task, set(usual) - set(_FORMATION_ONLY))
    for name, value in condition.items():
        if name not in reads and value != usual[name]:
            raise InvalidInputError(
                f"task={task} does not read {name}: leave it at {format_value(usual[name])}; got "
                f"{name}={format_value(value)}"
            )
    if condition["sensing"] == "camera" and condition["wrong"] != usual["wrong"]:
        raise InvalidInputError(
            "wrong is of readings of the ray, and sensing=camera has none: give sensing=rays or "
            f"both, or leave wrong at {format_value(usual['wrong'])}; got "
            f"{format_value(condition['wrong'])}"
        )


def _robots(condition: Mapping[str, Any]) -> None:
    n, start, failure = condition["robots"], condition["start"], condition["failure"]
    if failure in ("added", "removed") and n < 2:
        raise InvalidInputError(
            f"failure={failure} needs 2 robots or more, of which one is {failure}; got {n}"
        )
    if start == "scattered":
        most = _most_scattered(condition)
        words = f"scattered over the hall, {CLEAR:g} m from each other, walls and spill"
    else:
        if condition["edge"] != "disc":
            raise InvalidInputError(
                f"start={start} puts trucks on a circle: give edge=disc with it, or "
                f"start=scattered; got edge={condition['edge']}"
            )
        way = 2.0 * math.pi * tracked_radius(condition["radius"])
        there = 1 + int((way - BUNCH[0]) / BUNCH[1]) if start == "bunch" else int(way / BUNCH[0])
        late = int(failure == "added")
        most = max(there, 1) + late
        words = f"{BUNCH[0]:g} m or more apart on the edge of a disc of {condition['radius']:g} m"
        if late and condition["radius"] > MOST_ADDED:
            raise InvalidInputError(
                f"a truck that is added starts {OFF:g} m off the spill: radius must be at most "
                f"{MOST_ADDED:g} m for that; got {condition['radius']:g} m"
            )
    if n > most:
        raise InvalidInputError(f"robots={n} do not fit {words}: at most {most} do")


def _most_scattered(condition: Mapping[str, Any]) -> int:
    side = 2.0 * (HALF - CLEAR)
    free = side * side - math.pi * (condition["radius"] + CLEAR) ** 2
    return max(1, int(PACKED * free / (math.pi * (CLEAR / 2.0) ** 2)))
