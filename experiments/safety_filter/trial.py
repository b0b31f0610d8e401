"""One trial: a team, its wishes, a filter; swaps on wheels and safe-navigation's own scenes."""

import contextlib
import functools
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from controllers.motion import Limits, Navigator, NavigatorConfig
from controllers.safety import SafetyConfig, Unfiltered, VelocitySearch
from experiments import safe_navigation, safety_filter
from experiments.safe_navigation import worlds as fields
from experiments.safe_navigation.pilot import Pilot
from experiments.safe_navigation.trackers import FilterTracker
from experiments.safe_navigation.trial import BOX_CLEARANCE, filter_noises
from experiments.safe_navigation.trial import PERIOD as FIELD_PERIOD
from experiments.safety_filter import swap
from experiments.safety_filter.guarded import GoToGoal, Guarded, PlainConsensus
from experiments.safety_filter.measures import Ways, measure
from mjmr.errors import InvalidInputError
from mjmr.metrics import ContactMeter
from mjmr.parts import Parts
from mjmr.simulation import Simulation

SWAPS = ("swap", "symmetric")
ROBOT_CLEARANCE = 0.03  # m, between two bodies in plans, besides the margins
Metrics = dict[str, Any]


def trial(condition: Mapping[str, Any], seed: int, parts: Parts) -> Metrics:
    """Run one condition with one seed.

    Args:
        condition: See the study's parameters.
        seed: Of the trial.
        parts: The filter of method ``barrier``.

    Returns:
        Metrics; see :func:`experiments.safety_filter.measures.measure`.
    """
    run = _swap if condition["scene"] in SWAPS else _crossing
    return run(condition, seed, parts)


def _filter(method: str, parts: Parts, within_reach: bool) -> Any:
    return {
        "none": Unfiltered,
        "consensus": Unfiltered,
        "barrier": parts["filter"],
        "search": functools.partial(VelocitySearch, within_reach=within_reach),
    }[method]


def _swap(condition: Mapping[str, Any], seed: int, parts: Parts) -> Metrics:
    world, robots, goals = swap.build(condition, seed)
    config, n = swap.safety(robots, condition), robots.n
    simulation = Simulation(world, seed=seed, control_period=swap.PERIOD)
    method = condition["method"]
    part = _filter(method, parts, False)(
        world.bounds, world.boxes, n, config, simulation.rng("filter")
    )
    wisher: Any = GoToGoal(config.limits)
    if method == "consensus":
        wisher = PlainConsensus(n, config.limits, swap.PERIOD)
    guarded = Guarded(wisher, part, condition["right"], 2 * (config.radius + config.margin))
    hands, log, everyone = swap.Hands(robots), _Log(), np.ones(n, dtype=bool)
    meter, ways = _watch(simulation, robots, swap.LENGTH)
    at_home = 0
    with contextlib.closing(simulation):
        for _ in simulation.ticks(condition["duration"]):
            position, velocity = hands.sense()
            command = guarded.step(position, velocity, goals, everyone)
            hands.drive(command)
            log.add(guarded)
            simulation.note(goals=goals, stops=position + command)
            away = goals - position
            home = bool(((away**2).sum(axis=1) < (0.6 * swap.HOME) ** 2).all())
            at_home = at_home + 1 if home else 0
            if at_home * swap.PERIOD >= 1.0:
                break
    way = ways.positions
    home = ((way - goals) ** 2).sum(axis=2) < swap.HOME**2
    return {
        **_contacts(meter),
        **measure(way, swap.PERIOD, 2 * config.radius, home),
        **log.metrics(),
    }


def _crossing(condition: Mapping[str, Any], seed: int, parts: Parts) -> Metrics:
    """A run of safe-navigation's physical mode, its planner and motion control, another safety."""
    method = condition["method"]
    if method == "consensus":
        raise InvalidInputError(
            f"method=consensus needs scene={' or '.join(SWAPS)}; robots that shuttle agree on "
            "nothing"
        )
    given = field_condition(condition)
    world, robots, scene, eyes = fields.build(given, seed)
    simulation = Simulation(world, seed=seed, control_period=FIELD_PERIOD)
    limits, radius = Limits(), robots.platform.radius
    safety = SafetyConfig(
        radius=radius, limits=limits, period=FIELD_PERIOD, margin=condition["margin_mm"] / 1000.0,
        rate=condition["pace"] * limits.deceleration / limits.max_speed, samples=scene.samples,
    )  # fmt: skip
    config = NavigatorConfig(
        radius=radius, limits=limits, period=FIELD_PERIOD, search=False,
        plan_around_robots=scene.sees_robots,
        # plans that lead through what the filter keeps clear would be braked all the way
        box_clearance=safety.margin + BOX_CLEARANCE["planar"],
        robot_clearance=2 * safety.margin + ROBOT_CLEARANCE,
    )  # fmt: skip
    rng = simulation.rng
    planner = Navigator(world.bounds, world.boxes, robots.n, config, rng("navigator"))
    part = _filter(method, parts, not condition["right"])(
        world.bounds, world.boxes, robots.n, safety, rng("filter")
    )
    guarded = Guarded(planner, part, condition["right"], 2 * (radius + safety.margin))
    tracker = FilterTracker(scene.starts, FIELD_PERIOD, filter_noises(given))
    pilot = Pilot(scene, world.bounds, guarded, config, tracker, 0, True)
    meter, ways = _watch(simulation, robots, 0.0)
    log = _Log()
    with contextlib.closing(simulation):
        for now in simulation.ticks(condition["duration"]):
            report, sampled_at = eyes.read()
            hearing = robots.acknowledged & ~robots.stopping(now)
            robots.drive(pilot.step(now, report, sampled_at, robots.executed, hearing))
            log.add(guarded)
            if simulation.noted:
                simulation.note(goals=pilot.shuttle.goals, stops=pilot.stops)
    return {
        **_contacts(meter),
        "goals": int(pilot.shuttle.reached.sum()),
        **measure(ways.positions, FIELD_PERIOD, 2 * radius, None),
        **log.metrics(),
    }


def field_condition(condition: Mapping[str, Any]) -> Mapping[str, Any]:
    """The condition of safe-navigation whose world this one's is.

    Raises:
        InvalidInputError: Another number of robots than the parameter's default.
    """
    usual = safety_filter.study.condition()["robots"]
    if condition["robots"] != usual:
        raise InvalidInputError(
            f"robots={condition['robots']} needs scene={' or '.join(SWAPS)}; scene "
            f"{condition['scene']} has its own robots, so leave it at {usual}"
        )
    return safe_navigation.study.condition(
        mode="physical", scene=condition["scene"], sigma_mm=condition["sigma_mm"],
        duration=condition["duration"],
    )  # fmt: skip


def _watch(simulation: Simulation, robots: Any, length: float) -> tuple[ContactMeter, Ways]:
    meter = ContactMeter(simulation)
    simulation.caption = lambda: f"contacts {meter.episodes}, {meter.robots:.1f} s in contact"
    return meter, Ways(simulation, robots, length)


def _contacts(meter: ContactMeter) -> Metrics:
    return {
        "contacts": meter.episodes,
        "contact_s": meter.robots,
        "obstacle_contact_s": meter.obstacles,
    }


class _Log:
    """What the filter and the rule did, tick by tick."""

    def __init__(self):
        self._seconds: list[float] = []
        self._turned = self._turned_robots = self._stopped = 0

    def add(self, guarded: Guarded) -> None:
        count = int(np.count_nonzero(guarded.turned))
        self._turned += count > 0
        self._turned_robots += count
        self._stopped += guarded.stopped
        self._seconds.append(guarded.seconds)

    def metrics(self) -> Metrics:
        spent = 1e3 * np.array(self._seconds)
        return {
            "ticks": len(spent),
            "right_ticks": self._turned,
            "right_robot_ticks": self._turned_robots,
            "infeasible_ticks": self._stopped,
            "wall_filter_mean_ms": float(spent.mean()),
            "wall_filter_p95_ms": float(np.percentile(spent, 95)),
            "wall_filter_worst_ms": float(spent.max()),
        }


def world(condition: Mapping[str, Any]) -> Any:
    """World of a condition, for ``mjmr mjcf``."""
    if condition["scene"] in SWAPS:
        return swap.build(condition, 0)[0]
    return fields.build(field_condition(condition), 0)[0]


def _short() -> Iterator[dict[str, Any]]:
    for method in ("barrier", "search"):
        yield {"scene": "swap", "method": method, "duration": 0.1}
        yield {"scene": "A", "method": method, "duration": 0.1}


def prepare() -> None:
    """Compile everything a trial calls, by running short ones."""
    from experiments.safety_filter import study

    for given in _short():
        study.bound_trial()(study.condition(**given), 0)
