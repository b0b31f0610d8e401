"""The study's film: the same swap without and with the barrier, ways drawn."""

import dataclasses
from pathlib import Path

from mjmr.film import Film
from mjmr.film_options import FilmOptions
from mjmr.recording import record
from mjmr.study import Study

_SPEED = 6.0  # times real time, unless asked otherwise
# method, rule, length [s], label; without a filter the heap that it ends in is soon seen
PANELS = (
    ("none", False, 14.0, "straight to the goal"),
    ("barrier", True, 24.0, "through the barrier"),
)


def film(study: Study, path: Path, options: FilmOptions) -> None:
    """Ten robots swap places; one panel a method."""
    options = dataclasses.replace(options, speed=options.speed or _SPEED)
    picture = Film(f"Safety filter: ten robots swap places{study.swapped}", options)
    for method, right, seconds, label in PANELS:
        condition = study.condition(scene="symmetric", method=method, right=right, duration=seconds)
        recording = record(study.bound_trial(), condition, 0)
        picture.add(recording, label, trail=float("inf"))
    picture.write(path)
