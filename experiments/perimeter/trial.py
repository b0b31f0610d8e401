"""One trial: the paper's loop, top to bottom."""

import contextlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from controllers.perimeter import STATES, PerimeterConfig, PerimeterTeam
from controllers.perimeter.config import even_factor, tracked_radius
from experiments.perimeter.checks import check
from experiments.perimeter.crew import Crew
from experiments.perimeter.failures import Failure
from experiments.perimeter.measures import Log
from experiments.perimeter.sensing import Senses, mount
from experiments.perimeter.worlds import HALF, build
from mjmr.kinematics import KinematicSimulation
from mjmr.parts import Parts

PERIOD = 0.1
# poses that drift put others metres away from where they are, and own sensors know better
DRIFTING = {"same": 3.0, "doubt": 10.0}  # m, s
SETTLED = 90.0  # s, that a trial of joining goes on after the last truck joined
Metrics = dict[str, Any]


def trial(condition: Mapping[str, Any], seed: int, parts: Parts | None = None) -> Metrics:
    """Run one condition with one seed.

    Args:
        condition: See the study's parameters.
        seed: Of the trial.
        parts: What takes the role ``team``; None: the published one.

    Returns:
        Metrics; see :class:`experiments.perimeter.measures.Log`.
    """
    check(condition)
    if condition["task"] == "formation":
        from experiments.perimeter.formation import formation

        return formation(condition, seed)
    if condition["task"] == "envelope":
        from experiments.perimeter.envelope import envelope

        return envelope(condition, seed)
    scene = build(condition, seed)
    mount(scene, condition)
    trucks = scene.trucks
    simulation = _simulation(condition, scene.world, seed)
    senses = Senses(simulation, scene, condition)
    config = configuration(condition)
    kind = PerimeterTeam if parts is None else parts["team"]
    team = Crew(kind(trucks.n, config, simulation.rng("controller")), trucks.n)
    failure = Failure(condition, scene, simulation, senses, team)
    log = Log(simulation, scene, senses, team, failure, condition)
    simulation.caption = lambda: caption(team)
    command = np.zeros((trucks.n, 2))
    with contextlib.closing(simulation):
        for now in simulation.ticks(condition["duration"]):
            failure.act(now)
            known = senses.look(now, failure.on)
            if known is not None:
                command = team.step(known)
                command[~failure.on] = 0.0
                spoken = team.speak(known)
                if spoken is not None:
                    senses.radio.broadcast_arrays(spoken, failure.speaks)
            trucks.drive(command)
            if simulation.noted:
                simulation.note(links=log.links())
            if condition["task"] == "join" and log.settled(SETTLED):
                break
    return log.metrics()


def configuration(condition: Mapping[str, Any]) -> PerimeterConfig:
    """What the team of a condition is told."""
    n = condition["robots"]
    factor, desired = condition["factor"], 0.0
    if not condition["estimated"] and n > 1:
        way = tracked_radius(condition["radius"])
        desired = (factor or even_factor(n)) * 2.0 * way * float(np.sin(np.pi / n))
    return PerimeterConfig(
        bounds=(-HALF, -HALF, HALF, HALF),
        period=PERIOD,
        approach_gain=0.3 if condition["gain"] == "stiff" else 0.3 / (2 * np.pi),
        desired=desired,
        factor=factor,
        spacing=condition["spacing"],
        **({} if condition["localization"] == "localizer" else DRIFTING),
    )


def caption(team: Any) -> str:
    """States of the trucks, for films."""
    return "   ".join(f"{i} {STATES[k]}" for i, k in enumerate(team.state))


def _simulation(condition: Mapping[str, Any], world: Any, seed: int) -> Any:
    options = {"seed": seed, "control_period": PERIOD, "dt_max": condition["dt_ms"] / 1000.0}
    if condition["mode"] == "unicycle":
        return KinematicSimulation(world, **options)
    from mjmr.simulation import Simulation

    return Simulation(world, **options)


def prepare() -> None:
    """Compile everything a trial calls, by running a short one."""
    from experiments.perimeter import study

    trial(study.condition(duration=1.0), 0)
