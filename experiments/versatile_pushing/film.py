"""The study's film: discs pushed to the home zone, and out to a ring, side by side."""

from pathlib import Path

from mjmr.film import Film
from mjmr.film_options import FilmOptions
from mjmr.recording import record
from mjmr.study import Study

SECONDS = 130.0
SPEED = 8.0  # simulated seconds a second, unless asked otherwise
TRAIL = 15.0  # s
_SEED = 0


def film(study: Study, path: Path, options: FilmOptions) -> None:
    """Foraging on the left, construction on the right, the same controller."""
    picture(study, options).write(path)


def picture(study: Study, options: FilmOptions) -> Film:
    """The film, to be written or looked at."""
    import dataclasses

    speed = options.speed or SPEED
    made = Film(
        f"Versatile pushing: one controller, two of its tasks{study.swapped}",
        dataclasses.replace(options, speed=speed),
    )
    for task, b, label in (
        ("foraging", False, "foraging: c = 0, p = 1, b = false"),
        ("construction", True, "construction: c = 0, p = 1, b = true"),
    ):
        condition = study.condition(task=task, b=b, duration=SECONDS)
        made.add(record(study.bound_trial(), condition, _SEED), label, trail=TRAIL)
    return made
