"""The study's film: the same start with and without the safety search, side by side."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from experiments.safe_navigation.trial import trial
from mjmr.film import Film
from mjmr.film_options import FilmOptions
from mjmr.loop import TickedSimulation
from mjmr.recording import Recording
from mjmr.study import Study

_SECONDS = 12.0
_SEED = 0


def film(study: Study, path: Path, options: FilmOptions) -> None:
    """Four robots on real bodies cross between boxes, search off and on."""
    picture = Film("Safe navigation: four robots, contact physics, goals mirrored", options)
    for search in (False, True):
        condition = study.condition(
            mode="physical", scene="cross4", search=search, margin_mm=1.0, duration=_SECONDS
        )
        picture.add(_record(condition), f"safety search {'on' if search else 'off'}")
    picture.write(path)


def _record(condition: Any) -> Recording:
    kept: list[Recording] = []

    def record(simulation: TickedSimulation, caption: Callable[[], str]) -> Recording:
        recording = Recording(simulation, caption)
        kept.append(recording)
        return recording

    trial(condition, _SEED, record)
    return kept[0]
