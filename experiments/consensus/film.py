"""The study's film: three robots close on their formation, the graph drawn as it switches."""

import dataclasses
from pathlib import Path
from typing import Any

from experiments.consensus.teams import team_of
from mjmr.film import Film
from mjmr.film_options import FilmOptions
from mjmr.parts import Parts
from mjmr.recording import Recording
from mjmr.study import Study

SECONDS = 40.0
_SPEED = 8.0  # times real time, unless asked otherwise
SHOWN: tuple[tuple[str, dict[str, Any]], ...] = (
    ("graphs given, a new leader every 5 s", {}),
    ("graphs from sight, cones of 90 degrees", {"sight": "rays", "scan": True}),
    (
        "robot 0 goes round a circle and tells its velocity",
        {
            "experiment": "moving", "schedule": "case-i", "path": "circle", "feedforward": "told",
            "weight": 0.8, "side": 4.0, "duration": 80.0,
        },
    ),
)  # fmt: skip


def show(study: Study, changes: dict[str, Any], seed: int) -> Recording:
    """Run robots in MuJoCo, with the study's choice of parts, and record them."""
    parts = Parts(study.parts, study.chosen)
    condition = study.condition(mode="physical", **changes)
    team = team_of(condition, seed, parts)
    recording = Recording(team.simulation, team.caption)
    team.run(SECONDS)
    return recording


def film(study: Study, path: Path, options: FilmOptions) -> None:
    """Write the film."""
    options = dataclasses.replace(options, speed=options.speed or _SPEED)
    picture = Film(f"Consensus over graphs that switch{study.swapped}", options)
    for label, changes in SHOWN:
        picture.add(show(study, changes, 1), label, trail=float("inf"))
    picture.write(path)
