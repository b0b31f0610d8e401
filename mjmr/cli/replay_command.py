"""``mjmr replay``."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from tyro.conf import Positional

from mjmr.cli.parsing import option, parse
from mjmr.errors import GL_ADVICE, InvalidInputError, MissingGLError

_MORE = """
EXAMPLES
  mjmr replay renders/safe-navigation/quick/failures/0123456789ab-seed3.npz
  mjmr replay trial.npz --camera chase --speed 0.5 --out slow.mp4

EXIT CODES
  0  the film was written
  1  there is no off-screen OpenGL
  2  bad input; a file that is not there, damaged, or of another version
"""


@dataclass(frozen=True)
class Replay:
    """Make a film of a trace, or of the last second of a trial that failed.

    A failure is shown at a quarter of its speed unless --speed says otherwise. An existing film is
    replaced.
    """

    file: Annotated[
        Positional[Path], option("FILE", "A .npz trace, or a file from a run's failures folder.")
    ]
    out: Annotated[
        Path | None, option("FILM.mp4", "File to write.", "beside FILE, ending in .mp4")
    ] = None
    camera: Annotated[str, option("CAMERA", "overview or chase.", "overview")] = "overview"
    follow: Annotated[str, option("ROBOT", "The robot chase follows, by index.", "0")] = "0"
    look: Annotated[str, option("LOOK", "draft (fast) or fine.", "draft")] = "draft"
    speed: Annotated[
        str | None,
        option("X", "Simulated seconds a second.", "1; 0.25 of a failure"),
    ] = None


def main(arguments: Sequence[str]) -> int:
    """Make a film from a file."""
    a = parse(Replay, "replay", arguments, _MORE)
    from mjmr.cli.parsing import check_file, whole_number
    from mjmr.film_options import FilmOptions

    follow = whole_number("--follow", a.follow, least=0) or 0
    options = FilmOptions(camera=a.camera, follow=follow, look=a.look, speed=_speed(a.speed))
    out = a.out or a.file.with_suffix(".mp4")
    check_file(out)
    from rich.console import Console

    from mjmr.progress import doing
    from mjmr.replay import load, write_film

    replay = load(a.file)
    try:
        with doing(Console(stderr=True), "making the film ..."):
            speed = write_film(replay, out, options)
    except MissingGLError:
        print(f"mjmr: {GL_ADVICE}", file=sys.stderr)
        return 1
    times = replay.footage.times
    told = f"{out}: t = {times[0]:.2f} to {times[-1]:.2f} s at {speed:g} x"
    print(told + (f"; the trial failed: {replay.error}" if replay.error else ""))
    return 0


def _speed(text: str | None) -> float | None:
    if text is None:
        return None
    try:
        return float(text)
    except ValueError:
        raise InvalidInputError(f"--speed must be a positive number, not {text!r}") from None
