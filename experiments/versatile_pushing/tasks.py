"""One trial of foraging, transport or construction: the same loop for all three."""

from collections.abc import Mapping
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from controllers.perception.arc_objects import Objects
from controllers.pushing import Gaze, Parameters, Pusher, Recovery, Surroundings
from experiments.versatile_pushing.sight import nothing, sight
from experiments.versatile_pushing.worlds import HALF, PERIOD, TASKS, build
from mjmr.faults import Fault
from mjmr.group import Group
from mjmr.sensors.lidar import Lidar
from mjmr.simulation import Simulation

Array = NDArray[np.float64]
Metrics = dict[str, float | int | bool | str | None]
MARGIN = {"square": -0.03, "disc": -0.05, "outside": 0.05}  # m, of the zone as robots know it
STOPS, DARK = 4.0, (4.0, 9.0)  # s: when the stopped robot stops, when cameras deliver nothing
_ON_WALL = 0.03  # m, from a disc to a wall


class Watch:
    """Keeps what the metrics need; reads truth after every control period."""

    def __init__(self, simulation: Simulation, task: str):
        """Args: simulation: To be watched. task: One of ``TASKS``."""
        self._simulation, self._task = simulation, TASKS[task]
        self.start = self.places = self._places()
        self.done = self._task.done(self.places)
        self.finished = np.inf
        self.far = 0.0
        simulation.observe(self._look)

    def _places(self) -> Array:
        return self._simulation.truth.movers()[:, :2].copy()

    def _look(self) -> None:
        places = self._places()
        self.places, self.done = places, self._task.done(places)
        self.far = max(self.far, float(np.hypot(*(places - self.start).T).max()))
        if self.done.all() and self.finished == np.inf:
            self.finished = self._simulation.time


def run(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Run one trial of a task.

    Args:
        condition: See the study's parameters.
        seed: Of noise; the small discs' places depend on ``map`` alone.
    """
    task, n = TASKS[condition["task"]], condition["robots"]
    world, robots = build(
        condition["task"],
        robots=n,
        weight=condition["weight"],
        map_seed=condition["map"],
        vision=condition["vision"],
        jitter=seed,
    )
    if condition["failure"] == "stopped":
        robots.faults.add(Fault(kind="dead", robot=0, start=STOPS))
    simulation = Simulation(
        world, seed=seed, control_period=PERIOD, dt_max=condition["dt_ms"] / 1000
    )
    watch = Watch(simulation, condition["task"])
    eyes = sight(condition["vision"], robots, task.disc_radius)
    pusher = make_pusher(condition, simulation, robots)
    tally = Tally(n)
    simulation.caption = lambda: (
        f"{int(watch.done.sum())} of {len(watch.done)} discs done, "
        f"robots {' '.join(pusher.behaviour.state_names)}"
    )
    turret: Any = robots.sensors["turret"]
    for t in simulation.ticks(condition["duration"]):
        dark = condition["failure"] == "camera" and DARK[0] <= t < DARK[1]
        gaze = take_in(robots, nothing(n) if dark else eyes.look())
        command, pan = pusher.step(gaze, t)
        robots.drive(command)
        turret.aim(pan)
        tally.count(pusher.behaviour.state, dark, t)
        if watch.finished < np.inf:
            break
    simulation.close()
    return metrics(watch, tally, pusher, condition)


def take_in(robots: Group, objects: Objects) -> Gaze:
    """What robots perceive now: objects of the camera's, and what every other sensor reads."""
    sensors = robots.sensors
    heading = sensors["compass"].read()
    return Gaze(
        objects=objects,
        bearing=heading + sensors["turret"].read(),
        heading=heading,
        home=sensors["beacon"].read(),
        ring=sensors["ring"].read(),
    )


def make_pusher(condition: Mapping[str, Any], simulation: Simulation, robots: Group) -> Pusher:
    """The controller a condition names."""
    task, ring = TASKS[condition["task"]], cast(Lidar, robots.sensors["ring"])
    recovery = None
    if condition["recovery"]:
        recovery = Recovery(robots.n, condition["p"], simulation.rng("recovery"))
    return Pusher(
        robots.n,
        Parameters(c=condition["c"], p=condition["p"], b=condition["b"]),
        Surroundings(
            disc_radius=task.disc_radius,
            robot_radius=robots.platform.radius,
            zone=task.zone,
            size=task.size + MARGIN[task.zone],
        ),
        ring.angles,
        rng=simulation.rng("schemas"),
        top_speed=robots.platform.max_twist[0],
        top_turn=robots.platform.max_twist[1],
        recovery=recovery,
    )


class Tally:
    """How long robots were in which state, and what a dark camera did."""

    def __init__(self, n: int):
        """Args: n: Robots."""
        self.ticks = np.zeros(3)
        self.dark_ticks = np.zeros(3)
        self.back = np.full(n, np.nan)

    def count(self, state: NDArray[np.int64], dark: bool, time: float) -> None:
        """Count one step."""
        counts = np.bincount(state, minlength=3)
        self.ticks += counts
        if dark and time > DARK[0] + 1e-6:
            self.dark_ticks += counts
        if time > DARK[1]:
            first = np.isnan(self.back) & (state != 0)
            self.back[first] = time - DARK[1]

    @property
    def dark_wander_share(self) -> float:
        """Share of the dark time spent wandering; NaN if it never was dark."""
        total = self.dark_ticks.sum()
        return float(self.dark_ticks[0] / total) if total else float("nan")


def metrics(watch: Watch, tally: Tally, pusher: Pusher, condition: Mapping[str, Any]) -> Metrics:
    """Numbers of a finished run."""
    finished = watch.finished < np.inf
    radius = TASKS[condition["task"]].disc_radius
    wall = np.abs(watch.places).max(axis=1) > HALF - radius - _ON_WALL
    found: Metrics = {
        "success": bool(finished),
        "share": float(watch.done.mean()),
        "time_s": float(min(watch.finished, condition["duration"])),
        "travel_m": float(watch.far),
        "on_wall": int((wall & ~watch.done).sum()),
        "wander": float(tally.ticks[0] / tally.ticks.sum()),
        "push": float(tally.ticks[2] / tally.ticks.sum()),
        "switches": int(pusher.behaviour.transitions.sum()),
    }
    if condition["failure"] == "camera":
        found["dark_wander"] = tally.dark_wander_share
        # when the last robot had left wandering again; None if one never did
        found["back_s"] = None if np.isnan(tally.back).any() else float(tally.back.max())
    if pusher.recovery is not None:
        found["p_changes"] = pusher.recovery.changes
    if condition["task"] == "construction":
        found["ring_gap_deg"] = largest_gap(watch.places)
        # where the discs are in the end, for a plot
        found["places"] = " ".join(f"{x:.2f},{y:.2f}" for x, y in watch.places)
    return found


def largest_gap(places: Array) -> float:
    """Largest angle [deg] between neighbours of places (k, 2), seen from home."""
    bearings = np.sort(np.arctan2(places[:, 1], places[:, 0]))
    return float(np.degrees(np.diff(bearings, append=bearings[0] + 2 * np.pi).max()))
