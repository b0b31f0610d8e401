"""One trial: the paper's loop, top to bottom."""

import contextlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from controllers.estimation import PoseFilterConfig
from controllers.motion import Limits, NavigatorConfig
from experiments.safe_navigation.pilot import Pilot
from experiments.safe_navigation.sensing import YAW_NOISE
from experiments.safe_navigation.trackers import CartTracker, FilterTracker, RawTracker
from experiments.safe_navigation.worlds import build
from mjmr.geometry import angle_difference
from mjmr.kinematics import KinematicSimulation
from mjmr.loop import TickedSimulation
from mjmr.metrics import ContactMeter, OverlapMeter
from mjmr.parts import Parts

PERIOD = 1 / 60
# [s]: a stranger is foreseen as long as braking takes; a cart, longer, since it comes to robots at
# rest, which must have got out of its way
FORESIGHT, CART_FORESIGHT = 0.35, 0.7
# [m] between body and boxes in plans: omni-wheels follow less exactly
BOX_CLEARANCE = {"planar": 0.015, "omni": 0.040}
GALLERY_RATE = 10.0  # images a simulated second of the gallery
Metrics = dict[str, float | int]


def trial(condition: Mapping[str, Any], seed: int, parts: Parts) -> Metrics:
    """Run one condition with one seed.

    Args:
        condition: See the study's parameters.
        seed: Of the trial.
        parts: The navigator.

    Returns:
        Metrics; lengths in mm, as tables show them.
    """
    if condition["scene"] == "gallery":
        from experiments.safe_navigation.vision import vision_accuracy

        return vision_accuracy(max(1, round(condition["duration"] * GALLERY_RATE)), seed)
    world, robots, scene, eyes = build(condition, seed)
    platform = robots.platform
    sigma = condition["sigma_mm"] / 1000.0
    if condition["mode"] == "physical":
        from mjmr.simulation import Simulation

        simulation: Any = Simulation(
            world, seed=seed, control_period=PERIOD, dt_max=condition["dt_ms"] / 1000.0
        )
        meter: Any = ContactMeter(simulation, scene.strangers)
        tracker: Any = FilterTracker(
            scene.starts,
            PERIOD,
            filter_noises(condition),
            # wheels creep: commands that start at the body's velocity would add that up
            ramp_from_command=condition["drive"] == "omni",
        )
    else:
        simulation = KinematicSimulation(world, seed=seed, control_period=PERIOD)
        meter = OverlapMeter(simulation, outsiders=scene.strangers)
        tracker = RawTracker(scene.starts, PERIOD)
    config = NavigatorConfig(
        radius=platform.radius,
        limits=_limits(platform) if condition["limits"] == "measured" else Limits(),
        period=PERIOD,
        margin=condition["margin_mm"] / 1000.0,
        search=condition["search"],
        samples=scene.samples,
        plan_around_robots=scene.sees_robots,
        box_clearance=BOX_CLEARANCE[condition["drive"]],
        fail_safe=condition["fail_safe"],
        motion=condition["motion"],
        strangers=scene.strangers if condition["foresee"] else (),
        foresight=CART_FORESIGHT if scene.carts else FORESIGHT,
    )
    carts = None
    if scene.carts:
        carts = CartTracker(world, PERIOD, sigma, FORESIGHT)
    boxes = carts.boxes if carts else world.boxes
    navigator = parts["navigator"](
        world.bounds, boxes, robots.n, config, simulation.rng("navigator")
    )
    pilot = Pilot(
        scene, world.bounds, navigator, config, tracker, condition["latency"], condition["predict"]
    )
    see_boxes = getattr(navigator, "see_boxes", lambda boxes, velocity: None)
    motion = _Motion(simulation, robots) if condition["scene"] == "straight" else None
    simulation.caption = lambda: _caption(meter)

    cycles = round(condition["duration"] / PERIOD)
    spent, sampled = np.zeros(cycles), 0
    # carts are shown where they will be when the command takes effect
    lead = condition["latency"] * PERIOD if condition["predict"] else 0.0
    with contextlib.closing(simulation):
        for k, now in enumerate(simulation.ticks(condition["duration"])):
            report, sampled_at = eyes.read()
            hearing = robots.acknowledged & ~robots.stopping(now)
            if carts:
                carts.update()
                see_boxes(carts.ahead(lead), carts.velocity)
            command = pilot.step(now, report, sampled_at, robots.executed, hearing)
            spent[k] = pilot.seconds
            robots.drive(command)
            sampled += int(np.count_nonzero(getattr(navigator, "sampled", False)))
            if simulation.noted:
                goals = pilot.shuttle.goals
                waypoints = getattr(navigator, "waypoints", goals)
                simulation.note(goals=goals, waypoints=waypoints, stops=pilot.stops)

    each = 1e6 * spent / robots.n
    return {
        "goals": int(pilot.shuttle.reached.sum()),
        "sampled_share": sampled / (cycles * robots.n),
        **_read(meter),
        **(motion.metrics() if motion else {}),
        "wall_step_mean_us": float(each.mean()),
        "wall_step_p95_us": float(np.percentile(each, 95)),
    }


def _limits(platform: Any) -> Limits:
    """What the platform was measured to be able to do."""
    measured = platform.limits
    return Limits(
        max_speed=measured.max_speed,
        acceleration=measured.acceleration,
        deceleration=measured.deceleration,
    )


def filter_noises(condition: Mapping[str, Any]) -> PoseFilterConfig:
    """What the filter expects of reports and of bodies."""
    late = condition["sensing"] != "report"
    return PoseFilterConfig(
        position_noise=max(condition["sigma_mm"] / 1000.0, 1e-4),
        yaw_noise=YAW_NOISE if late else 1e-3,
        speed_noise=0.01,
    )


def _read(meter: Any) -> Metrics:
    if isinstance(meter, OverlapMeter):
        last = meter.last_overlap
        return {
            "overlap_mm_s": 1e3 * meter.robots,
            "stranger_overlap_mm_s": 1e3 * meter.outsiders,
            "obstacle_overlap_mm_s": 1e3 * meter.obstacles,
            "deepest_mm": 1e3 * meter.deepest,
            "last_overlap_s": 0.0 if np.isnan(last) else float(last),
        }
    return {
        "contact_s": meter.robots,
        "stranger_contact_s": meter.outsiders,
        "obstacle_contact_s": meter.obstacles,
        "contacts": meter.episodes,
        "impulse_Ns": meter.robot_impulse,
        "obstacle_impulse_Ns": meter.obstacle_impulse,
    }


def _caption(meter: Any) -> str:
    if isinstance(meter, OverlapMeter):
        return f"overlap {1e3 * meter.robots:.1f} mm s"
    return f"robot contact {meter.robots:.2f} s, wall or box {meter.obstacles:.2f} s"


class _Motion:
    """Realised speed, acceleration and braking of the first robot, from its true velocity.

    Acceleration is the slope from 20 % to 80 % of 2 m/s, braking that from 80 % to 20 %; averages
    over the passages of the run.
    """

    def __init__(self, simulation: TickedSimulation, robots: Any):
        self._speeds: list[float] = []
        self._period = simulation.control_period
        self._yaw = 0.0
        truth = simulation.truth

        def observe() -> None:
            self._speeds.append(float(np.hypot(*truth.twists(robots)[0, :2])))
            turned = angle_difference(truth.poses(robots)[0, 2], robots.start[0, 2])
            self._yaw = max(self._yaw, abs(float(turned)))

        simulation.observe(observe)

    def metrics(self) -> Metrics:
        """Speeds [m/s], accelerations [m/s^2] and yaw [deg] realised."""
        speed = np.array(self._speeds)
        return {
            "top_speed": float(speed.max()),
            "acceleration": slope(speed, 0.4, 1.6, self._period),
            "braking": -slope(speed, 1.6, 0.4, self._period),
            "yaw_deg": float(np.degrees(self._yaw)),
        }


def slope(speed: np.ndarray, start: float, end: float, period: float) -> float:
    """Mean slope of the passages of ``speed`` from one level straight to another.

    Args:
        speed: Samples (k,) [m/s], ``period`` [s] apart.
        start: [m/s].
        end: [m/s].
        period: [s].

    Returns:
        [m/s^2]; NaN where there is no passage.
    """
    first, last = _crossings(speed, start), _crossings(speed, end)
    slopes = []
    for k, moment in enumerate(first):
        following = first[k + 1] if k + 1 < len(first) else np.inf
        arrivals = [t for t in last if moment < t < following]
        if arrivals:
            slopes.append((end - start) / ((arrivals[0] - moment) * period))
    return float(np.mean(slopes)) if slopes else float("nan")


def _crossings(speed: np.ndarray, level: float) -> list[float]:
    """Instants, in samples, at which ``speed`` passes ``level`` either way."""
    below = speed < level
    at = np.flatnonzero(below[1:] != below[:-1])
    return [float(k + (level - speed[k]) / (speed[k + 1] - speed[k])) for k in at]


def prepare() -> None:
    """Compile everything a trial calls, by running short ones."""
    from experiments.safe_navigation import study

    for mode in ("metric", "physical"):
        study.bound_trial()(study.condition(mode=mode, scene="A", latency=1, duration=0.05), 0)
