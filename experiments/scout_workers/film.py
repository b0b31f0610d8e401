"""The study's film: a scout's wandering and its worker's run, in two mazes side by side."""

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from controllers.scouting import UNIT, machine
from experiments.scout_workers.mazes import maze
from experiments.scout_workers.run import run
from mjmr.film import Film
from mjmr.film_options import FilmOptions
from mjmr.recording import Recording
from mjmr.study import Study

SHOWN = (("m3", 1), ("m4", 0))
"""Mazes and seeds."""
_SPEED = 6.0  # times real time, unless asked otherwise


def world(condition: Mapping[str, Any]) -> Any:
    """The maze of a condition with its robots in the yard, for ``mjmr mjcf``."""
    from experiments.scout_workers.arena import build_arena, yard_slots
    from mjmr.robots.tj_pro import TJPro

    place = maze(condition["maze"])
    n = condition["robots"]
    arena = build_arena(place.size, place.blocks, place.nest, place.goal, n)
    arena.add_group(TJPro(), yard_slots(place.size, n))
    return arena


def show(name: str, seed: int) -> Recording:
    """Run a scout and a worker in a maze in MuJoCo and record it.

    The mark is where the worker takes the goal to be: the scout's vector.
    """
    from experiments.scout_workers import study
    from experiments.scout_workers.trial import build

    field, team, plan = build(study.condition(mode="physical", maze=name), seed)
    simulation: Any = field.simulation  # pyright: ignore[reportAttributeAccessIssue]
    place = maze(name)

    def caption() -> str:
        states = [machine.STATES[s] for s in team.memory.state]
        d = float(np.hypot(*team.memory.travelled[0]))
        told = team.records.goal[1]
        if np.isfinite(told).all():
            simulation.note(points=[place.nest + told * UNIT])
        return f"scout: {states[0]}, {d:.0f} units from the nest; worker: {states[1]}"

    recording = Recording(simulation, caption)
    run(field, team, plan)
    return recording


def film(study: Study, path: Path, options: FilmOptions) -> None:
    """Write the film."""
    options = dataclasses.replace(options, speed=options.speed or _SPEED)
    picture = Film(
        f"Scout workers: one vector leads the worker to the goal{study.swapped}", options
    )
    for name, seed in SHOWN:
        picture.add(show(name, seed), f"maze {name}", trail=float("inf"))
    picture.write(path)
