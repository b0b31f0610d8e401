"""What pushing is made of, checked: how hard one robot pushes, what holds a disc, what moves it.

Every trial draws a direction, or turns its nominal one a little, by seed.
"""

import math
from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from mjmr.disc import Disc
from mjmr.group import Group
from mjmr.robots.round_pusher import RoundPusher
from mjmr.simulation import Simulation
from mjmr.world import World

Array = NDArray[np.float64]
Metrics = dict[str, Any]

PERIOD = 0.1  # s, of control
RADIUS = 1.0  # m, of a heavy disc
SPARE = 0.6  # of one robot's push that a disc of weight w resists beyond w of them
ABREAST = 0.5  # m, between robots side by side
RUN_UP = 0.15  # m, that they drive before they touch the disc
JITTER = math.radians(3.0)  # by which a seed turns a nominal direction, at most


def friction_force(weight: float) -> float:
    """Floor friction [N] of a disc that ``weight + 1`` robots move and ``weight`` do not.

    (w + 0.6) times one robot's push.
    """
    return (weight + SPARE) * RoundPusher.push_force


def stall(condition: Mapping[str, Any], seed: int) -> Metrics:
    """One robot pushes, head on, at a disc that nothing moves, in a direction drawn by seed."""
    rng = np.random.default_rng([seed, 1])
    heading = rng.uniform(-np.pi, np.pi)
    simulation, robots, _ = _scene(condition, 1, 1e4, heading, gap=0.02)
    meter = _PushMeter(simulation, robots)
    for _ in simulation.ticks(6.0):
        robots.drive([[0.5, 0.0]])
    push = meter.mean(3.0) @ [math.cos(heading), math.sin(heading)]
    stated = RoundPusher.push_force
    return {"push": float(push), "error_pct": 100.0 * float(push / stated - 1.0)}


def held(condition: Mapping[str, Any], seed: int) -> Metrics:
    """As many robots as the weight, abreast, push straight for a minute: how far the disc creeps.

    The first 3 s, in which robots arrive and the contacts settle, are told apart.
    """
    heading = _heading(condition, seed)
    weight = int(condition["weight"])
    simulation, robots, _ = _scene(condition, weight, friction_force(weight), heading, gap=0.02)
    places = _follow(simulation)
    for _ in simulation.ticks(63.0):
        robots.drive(np.tile([0.5, 0.0], (robots.n, 1)))
    way = np.array(places)
    start, settled = way[0], way[round(3.0 / PERIOD)]
    return {
        "creep_mm": 1e3 * float(np.hypot(*(way[-1] - settled))),
        "arrival_mm": 1e3 * float(np.hypot(*(settled - start))),
    }


def moved(condition: Mapping[str, Any], seed: int) -> Metrics:
    """One robot more than the weight, abreast and parallel: way of the disc in 5 s of contact.

    The robots drive up from ``RUN_UP`` away; time counts from the first period in which the disc
    has moved by a millimetre.
    """
    heading = _heading(condition, seed)
    weight = int(condition["weight"])
    simulation, robots, _ = _scene(
        condition, weight + 1, friction_force(weight), heading, gap=float(condition["gap"])
    )
    places = _follow(simulation)
    for _ in simulation.ticks(7.0):
        robots.drive(np.tile([0.5, 0.0], (robots.n, 1)))
    way = np.array(places) - places[0]
    begun = np.flatnonzero(np.hypot(*way.T) > 1e-3)
    if not len(begun):
        return {"way": 0.0, "aside": 0.0}
    first = max(int(begun[0]) - 1, 0)
    end = way[min(first + round(5.0 / PERIOD), len(way) - 1)] - way[first]
    ahead = np.array([math.cos(heading), math.sin(heading)])
    return {
        "way": float(end @ ahead),
        "aside": float(np.abs(ahead[0] * end[1] - ahead[1] * end[0])),
    }


def wedged(condition: Mapping[str, Any], seed: int) -> Metrics:
    """One robot heads ``off_normal_deg`` off the normal of a disc of weight 1, for 20 s."""
    rng = np.random.default_rng([seed, 2])
    side = rng.choice([-1.0, 1.0])
    bearing = rng.uniform(-np.pi, np.pi)
    off = side * math.radians(float(condition["off_normal_deg"]))
    world = _hall()
    world.add_disc(0.0, 0.0, RADIUS, friction_force(1))
    away = RADIUS + RoundPusher.radius + 0.01
    pose = [-away * math.cos(bearing), -away * math.sin(bearing), bearing + off]
    robots = world.add_group(RoundPusher, [pose])
    simulation = Simulation(world, seed=seed, control_period=PERIOD, dt_max=_dt(condition))
    places = _follow(simulation)
    for _ in simulation.ticks(20.0):
        robots.drive([[0.5, 0.0]])
    way = np.array(places)
    return {"way": float(np.hypot(*(way[-1] - way[0])))}


TESTS = {"stall": stall, "held": held, "moved": moved, "wedged": wedged}


def _dt(condition: Mapping[str, Any]) -> float:
    return float(condition["dt_ms"]) / 1000.0


def _heading(condition: Mapping[str, Any], seed: int) -> float:
    turned = np.random.default_rng([seed, 3]).uniform(-JITTER, JITTER)
    return math.radians(float(condition["heading_deg"])) + float(turned)


def _hall() -> World:
    return World(bounds=[-8, -8, 8, 8], wall_height=0.3, floor="concrete")


def _scene(
    condition: Mapping[str, Any], n: int, force: float, heading: float, gap: float
) -> tuple[Simulation, Group, Disc]:
    """A disc and ``n`` robots abreast behind it, all heading the same way, ``gap`` [m] off it."""
    world = _hall()
    disc = world.add_disc(0.0, 0.0, RADIUS, force, mass=min(force / 5.9, 20.0))
    aside = (np.arange(n) - (n - 1) / 2) * ABREAST
    behind = np.sqrt((RADIUS + RoundPusher.radius) ** 2 - aside**2) + gap
    c, s = math.cos(heading), math.sin(heading)
    poses = np.column_stack(
        [-c * behind - s * aside, -s * behind + c * aside, 0.0 * aside + heading]
    )
    robots = world.add_group(RoundPusher, poses)
    return (
        Simulation(world, control_period=PERIOD, dt_max=_dt(condition)),
        robots,
        disc,
    )


def _follow(simulation: Simulation) -> list[Array]:
    """Places (2,) of the only mover, at the start and after every control period."""
    places: list[Array] = []
    simulation.observe(lambda: places.append(simulation.truth.movers()[0, :2]))
    return places


class _PushMeter:
    """Force that robots' hulls put on the mover, world frame, at every physics step."""

    def __init__(self, simulation: Simulation, robots: Group):
        model = simulation.model
        self._simulation = simulation
        self._hulls = {model.geom(f"{name}/rim").id for name in robots.names}
        self._disc = model.geom(simulation.world.movers[0][0]).id
        self._times: list[float] = []
        self._forces: list[Array] = []
        simulation.watch_steps(self._see)

    def _see(self) -> None:
        model, data = self._simulation.model, self._simulation.data
        total, force = np.zeros(3), np.zeros(6)
        for k in range(data.ncon):
            contact = data.contact[k]
            a, b = (int(g) for g in contact.geom)
            if self._disc not in (a, b) or not self._hulls.intersection((a, b)):
                continue
            mujoco.mj_contactForce(model, data, k, force)
            # in the contact's frame, from its first geom to its second
            world = contact.frame.reshape(3, 3).T @ force[:3]
            total += world if b == self._disc else -world
        self._times.append(float(data.time))
        self._forces.append(total[:2])

    def mean(self, since: float) -> Array:
        """Mean force (2,) [N] since an instant [s]."""
        kept = np.array(self._times) >= since
        return np.array(self._forces)[kept].mean(axis=0)
