"""The study's film: figures 9 and 10 in MuJoCo, the trap without and with state-sharing.

Both panels have the same robots, patrols and seed. On the left R1 shares goals alone and stays in
the dead end; on the right it goes to teammates while it is in trouble, and one lures it out.
"""

import dataclasses
import math
from pathlib import Path

from experiments.helping_navigation.journey import Journey
from experiments.helping_navigation.scenes import trap
from mjmr.film import Film
from mjmr.film_options import FilmOptions
from mjmr.recording import Recording
from mjmr.study import Study

_SEED, _SECONDS = 1000, 300.0  # not a seed that decides claims; s at most
_SPEED = 6.0  # times real time, unless asked otherwise


def film(study: Study, path: Path, options: FilmOptions) -> None:
    """A robot lured out of a trap by a teammate."""
    trap_film(study, options).write(path)


def trap_film(study: Study, options: FilmOptions, seed: int = _SEED) -> Film:
    """The film, recorded and not yet written."""
    options = dataclasses.replace(options, speed=options.speed or _SPEED)
    picture = Film("Helping navigation: a robot in a trap, two Pioneers in MuJoCo", options)
    freed = _record(study, True, seed, _SECONDS)
    seconds = float(freed.times[-1])
    stuck = _record(study, False, seed, seconds)
    picture.add(stuck, "goals shared: stays in the dead end", trail=math.inf)
    picture.add(freed, "goals and states shared: a teammate leads it out", trail=math.inf)
    return picture


def _record(study: Study, shares_state: bool, seed: int, seconds: float) -> Recording:
    condition = study.condition(
        mode="physical", scene="trap", world="trap", planner="potential-field", robots=2,
        reading="literal", shares_state=shares_state, targets=1,
    )  # fmt: skip
    journey = Journey(trap(condition, seed, seconds), seed)
    recording = Recording(journey.crew.simulation)
    journey.run()
    return recording
