"""The study's film: the same start with and without the safety search, side by side."""

from pathlib import Path

from experiments.safe_navigation.sizes import OMNI
from mjmr.film import Film
from mjmr.film_options import FilmOptions
from mjmr.recording import record
from mjmr.study import Study

_SECONDS = 12.0
_SEED = 0


def film(study: Study, path: Path, options: FilmOptions) -> None:
    """Four robots on omni-wheels cross the field, search off and on."""
    title = f"Safe navigation: four robots on omni-wheels, goals mirrored{study.swapped}"
    picture = Film(title, options)
    for search in (False, True):
        condition = study.condition(
            mode="physical", scene="cross4", search=search, **OMNI, duration=_SECONDS
        )
        recording = record(study.bound_trial(), condition, _SEED)
        picture.add(recording, f"safety search {'on' if search else 'off'}")
    picture.write(path)
