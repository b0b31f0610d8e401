"""The worlds: the field with a scene's boxes, carts and robots, and what the pilot sees with."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from experiments.safe_navigation.scenes import Scene, scene
from experiments.safe_navigation.sensing import Eyes, make_eyes
from mjmr.errors import InvalidInputError
from mjmr.faults import Fault
from mjmr.group import Group
from mjmr.randomness import Streams
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.sensors.cart_report import CartReport
from mjmr.world import World

_SPREAD = 0.02  # [m]


def build(condition: Mapping[str, Any], seed: int) -> tuple[World, Group, Scene, Eyes]:
    """World, robots, scene and sensing of one trial.

    Starts on the field are displaced by up to 20 mm along x and y, drawn from the seed: with exact
    reports and no search nothing else differs from run to run. The one robot of the straight scene
    starts at its place with a heading drawn from the seed, so that it drives in any direction of
    its own.

    Raises:
        InvalidInputError: A drive or a sensing that needs bodies, without them, or that the scene
            does not take.
    """
    if condition["mode"] == "metric":
        for name, without in (("drive", "planar"), ("sensing", "report")):
            if condition[name] != without:
                raise InvalidInputError(
                    f"{name}={condition[name]} needs mode=physical; mode=metric takes "
                    f"{name}={without}"
                )
    sigma = condition["sigma_mm"] / 1000.0
    place = scene(condition["scene"])
    if place.carts and condition["sensing"] != "report":
        raise InvalidInputError(
            f"scene={condition['scene']} takes sensing=report, since carts are reported at once; "
            f"not sensing={condition['sensing']}"
        )
    starts = place.starts
    headings = np.zeros(len(starts))
    if condition["scene"] == "straight":
        headings = Streams(seed).generator("yaw").uniform(-np.pi, np.pi, len(starts))
    elif condition["scene"] != "overlap":
        starts = starts + Streams(seed).generator("starts").uniform(-_SPREAD, _SPREAD, starts.shape)
    lighting = "uneven" if condition["sensing"] == "vision" else "even"
    world = World.rectangle(
        4.9, 3.8, border=0.30, lighting=lighting, overlap=condition["scene"] == "overlap"
    )
    for x, y, length, width in place.boxes:
        world.add_box(x, y, length, width)
    for k, (x, y, yaw, length, width, travel, speed) in enumerate(place.carts):
        world.add_cart(
            x, y, length, width, yaw=yaw, travel=travel, speed=speed,
            start=float(Streams(seed).generator(f"cart {k}").uniform()),
        )  # fmt: skip
    if place.carts:
        world.mount(CartReport(rate=60.0, position_noise=sigma))
    robots = world.add_group(
        SoccerBot(condition["drive"]),
        np.column_stack([starts, headings]),
        command_latency=condition["latency"],
    )
    lossy = condition["failure"] == "reports-lost"
    eyes = make_eyes(condition["sensing"], world, robots, sigma, lossy)
    start, victim = condition["duration"] / 3, min(1, robots.n - 1)
    if condition["failure"] in ("dead", "stopped"):
        robots.faults.add(Fault(kind=condition["failure"], robot=victim, start=start))
    elif condition["failure"] == "commands-lost":
        robots.faults.add(Fault(kind="commands-lost", robot=victim, start=start, end=2 * start))
    return world, robots, place, eyes


def world(condition: Mapping[str, Any]) -> World:
    """World of a condition, for ``mjmr mjcf``."""
    return build(condition, 0)[0]
