"""``mjmr film``."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from mjmr.cli.parsing import SizeName, StudyName, check_file, option, parse
from mjmr.errors import GL_ADVICE, MissingGLError, MjmrError

_MORE = """
EXAMPLES
  mjmr film safe-navigation
  mjmr film safe-navigation --camera chase --look fine --out chase.mp4

EXIT CODES
  0  the film was written
  1  there is no off-screen OpenGL
  2  bad input, a study without a film, or making it failed
"""


@dataclass(frozen=True)
class Film:
    """Make a study's film: H.264, at most 60 s, with a clock and a stated speed.

    An existing file is replaced once the new one is complete.
    """

    study: StudyName
    out: Annotated[Path | None, option("FILE", "File to write.", "renders/STUDY/SIZE/film.mp4")] = (
        None
    )
    size: SizeName = "quick"
    camera: Annotated[str, option("CAMERA", "overview or chase.", "overview")] = "overview"
    look: Annotated[str, option("LOOK", "draft (fast) or fine.", "draft")] = "draft"


def main(arguments: Sequence[str]) -> int:
    """Make a film."""
    a = parse(Film, "film", arguments, _MORE)
    from rich.console import Console

    from mjmr.film_options import FilmOptions
    from mjmr.progress import doing
    from mjmr.registry import load_study
    from mjmr.runner import default_folder
    from mjmr.store import is_of
    from mjmr.study_calls import call_study, make_film

    study = load_study(a.study)
    study.size(a.size)
    options = FilmOptions(camera=a.camera, look=a.look)
    path = a.out or default_folder(study, a.size) / "film.mp4"
    if a.out is None and not is_of(path.parent, study.digest(a.size)):
        raise MjmrError(
            f"{path.parent} holds results of another configuration or source, or damaged ones; a "
            "film of this one goes elsewhere with --out FILE"
        )
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as e:
        raise MjmrError(f"cannot write to {path.parent}: {e.strerror}") from e
    check_file(path)
    prepare = study.resolve("prepare")
    messages = Console(stderr=True)
    try:
        if prepare is not None:
            with doing(messages, "preparing (compiles on the first run) ..."):
                call_study("prepare", prepare)
        with doing(messages, "making the film ..."):
            make_film(study, path, options)
    except MissingGLError:
        print(f"mjmr: {GL_ADVICE}", file=sys.stderr)
        return 1
    print(path)
    return 0
