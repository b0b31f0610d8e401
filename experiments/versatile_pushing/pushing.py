"""What pushing is made of, checked: how hard one robot pushes, what holds a disc, what moves it.

Every trial draws a direction, or turns its nominal one a little, by seed; and robots abreast are
not quite in line with the disc's middle.
"""

import math
from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError
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
WEDGE = (math.radians(20.0), math.radians(85.0))  # off the normal, of robots that wedge anywhere
SHIFT = 0.03  # m, by which it shifts the robots to the side, at most


def friction_force(weight: float) -> float:
    """Floor friction [N] of a disc that ``weight + 1`` robots move and ``weight`` do not.

    (w + 0.6) times one robot's push.
    """
    return (weight + SPARE) * RoundPusher.push_force


def stall(condition: Mapping[str, Any], seed: int) -> Metrics:
    """One robot pushes, head on, at a disc that nothing moves, in a direction drawn by seed."""
    simulation, robots, heading = _simulate(condition, seed)
    meter = _PushMeter(simulation, robots)
    _straight_on(simulation, robots, 6.0)
    push = meter.mean(3.0, heading)
    return {"push": push, "error_pct": 100.0 * (push / RoundPusher.push_force - 1.0)}


def held(condition: Mapping[str, Any], seed: int) -> Metrics:
    """As many robots as the weight, abreast, push straight for a minute: how far the disc creeps.

    What the disc is knocked along by their arrival, in the first 3 s, is told apart. Their push,
    as a share of what they can do, says that they did push all the time.
    """
    simulation, robots, heading = _simulate(condition, seed)
    meter = _PushMeter(simulation, robots)
    way = _straight_on(simulation, robots, 63.0)
    settled = way[round(3.0 / PERIOD)]
    return {
        "push_share": meter.mean(3.0, heading) / (robots.n * RoundPusher.push_force),
        "creep_mm": 1e3 * float(np.hypot(*(way[-1] - settled))),
        "arrival_mm": 1e3 * float(np.hypot(*(settled - way[0]))),
    }


def moved(condition: Mapping[str, Any], seed: int) -> Metrics:
    """One robot more than the weight, abreast and parallel: way of the disc in 5 s of contact.

    They drive up from ``RUN_UP`` away. Time counts from the last control instant before the disc
    has moved by a millimetre.
    """
    simulation, robots, heading = _simulate(condition, seed)
    way = _straight_on(simulation, robots, 7.0)
    begun = np.flatnonzero(np.hypot(*(way - way[0]).T) > 1e-3)
    if not len(begun):
        return {"way": 0.0, "aside": 0.0}
    first = max(int(begun[0]) - 1, 0)
    gone = way[first + round(5.0 / PERIOD)] - way[first]
    c, s = math.cos(heading), math.sin(heading)
    return {"way": float(c * gone[0] + s * gone[1]), "aside": float(abs(c * gone[1] - s * gone[0]))}


def wedged(condition: Mapping[str, Any], seed: int) -> Metrics:
    """One robot heads off the normal of a disc of weight 1, for 20 s.

    By ``off_normal_deg``, or ``wedged-anywhere`` by 20 to 85 degrees: everything is alike in every
    direction, so that the former says the same with every seed. The bearing of the point where it
    touches, and the side it heads off to, are drawn by seed.
    """
    simulation, robots, _ = _simulate(condition, seed)
    way = _straight_on(simulation, robots, 20.0)
    return {"way": float(np.hypot(*(way[-1] - way[0])))}


TESTS = {
    "stall": stall,
    "held": held,
    "moved": moved,
    "moved-from-rest": moved,  # what excess force alone accelerates
    "wedged": wedged,
    "wedged-anywhere": wedged,
}


def scene(condition: Mapping[str, Any], seed: int) -> tuple[World, Group, float]:
    """World of a check, with its one disc and robots that touch it or are about to.

    Returns:
        World, robots, and where they head [rad].

    Raises:
        InvalidInputError: Nobody holds the disc.
    """
    test, weight = condition["task"], int(condition["weight"])
    if test.startswith("wedged"):
        return _askew(_off_normal(condition, seed), seed)
    if test == "stall":
        heading = float(np.random.default_rng([seed, 1]).uniform(-np.pi, np.pi))
        return _abreast(1, 1e4, heading, 0.02, 0.0)
    heading, shift = _heading(condition, seed), _shift(seed)
    if test == "held":
        if weight < 1:
            raise InvalidInputError(f"task=held takes a weight of 1 or more; got {weight}")
        return _abreast(weight, friction_force(weight), heading, 0.02, shift)
    gap = RUN_UP if test == "moved" else 0.0
    return _abreast(weight + 1, friction_force(weight), heading, gap, shift)


def _off_normal(condition: Mapping[str, Any], seed: int) -> float:
    if condition["task"] == "wedged":
        return math.radians(float(condition["off_normal_deg"]))
    return float(np.random.default_rng([seed, 5]).uniform(*WEDGE))


def _askew(off_normal: float, seed: int) -> tuple[World, Group, float]:
    rng = np.random.default_rng([seed, 2])
    off = float(rng.choice([-1.0, 1.0])) * off_normal
    bearing = float(rng.uniform(-np.pi, np.pi))
    world = _hall()
    world.add_disc(0.0, 0.0, RADIUS, friction_force(1))
    away = RADIUS + RoundPusher.radius + 0.01
    pose = [-away * math.cos(bearing), -away * math.sin(bearing), bearing + off]
    return world, world.add_group(RoundPusher, [pose]), bearing + off


def _heading(condition: Mapping[str, Any], seed: int) -> float:
    turned = np.random.default_rng([seed, 3]).uniform(-JITTER, JITTER)
    return math.radians(float(condition["heading_deg"])) + float(turned)


def _shift(seed: int) -> float:
    return float(np.random.default_rng([seed, 4]).uniform(-SHIFT, SHIFT))


def _hall() -> World:
    return World(bounds=[-8, -8, 8, 8], wall_height=0.3, floor="concrete")


def _abreast(
    n: int, force: float, heading: float, gap: float, shift: float
) -> tuple[World, Group, float]:
    """A disc and ``n`` robots abreast behind it, all heading the same way, ``gap`` [m] off it.

    Their middle is ``shift`` [m] left of the line through the disc's middle.
    """
    world = _hall()
    world.add_disc(0.0, 0.0, RADIUS, force, mass=min(force / 5.9, 20.0))
    aside = (np.arange(n) - (n - 1) / 2) * ABREAST + shift
    behind = np.sqrt((RADIUS + RoundPusher.radius) ** 2 - aside**2) + gap
    c, s = math.cos(heading), math.sin(heading)
    x, y = -c * behind - s * aside, -s * behind + c * aside
    poses = np.column_stack([x, y, np.full(n, heading)])
    return world, world.add_group(RoundPusher, poses), heading


def _simulate(condition: Mapping[str, Any], seed: int) -> tuple[Simulation, Group, float]:
    world, robots, heading = scene(condition, seed)
    dt = float(condition["dt_ms"]) / 1000.0
    return Simulation(world, control_period=PERIOD, dt_max=dt), robots, heading


def _straight_on(simulation: Simulation, robots: Group, duration: float) -> Array:
    """All robots drive straight on at top speed; places (k, 2) of the disc at control instants."""
    places: list[Array] = []
    simulation.observe(lambda: places.append(simulation.truth.movers()[0, :2]))
    command = np.tile([RoundPusher.max_twist[0], 0.0], (robots.n, 1))
    for _ in simulation.ticks(duration):
        robots.drive(command)
    return np.array(places)


class _PushMeter:
    """Force that robots put on the mover, at every control instant."""

    def __init__(self, simulation: Simulation, robots: Group):
        model = simulation.model
        self._simulation = simulation
        self._rims = {model.geom(f"{name}/rim").id for name in robots.names}
        self._disc = model.geom(f"{simulation.world.movers[0][0]}_rim").id
        self._times: list[float] = []
        self._forces: list[Array] = []
        simulation.observe(self._see)

    def _see(self) -> None:
        model, data = self._simulation.model, self._simulation.data
        total, force = np.zeros(3), np.zeros(6)
        for k in range(data.ncon):
            contact = data.contact[k]
            a, b = (int(g) for g in contact.geom)
            if self._disc not in (a, b) or not self._rims.intersection((a, b)):
                continue
            mujoco.mj_contactForce(model, data, k, force)
            # in the contact's frame, from its first geom to its second
            world = contact.frame.reshape(3, 3).T @ force[:3]
            total += world if b == self._disc else -world
        self._times.append(float(data.time))
        self._forces.append(total[:2])

    def mean(self, since: float, heading: float) -> float:
        """Mean force along a heading [rad] since an instant [s], in newtons."""
        kept = np.array(self._times) >= since
        x, y = np.array(self._forces)[kept].mean(axis=0)
        return float(x * math.cos(heading) + y * math.sin(heading))
