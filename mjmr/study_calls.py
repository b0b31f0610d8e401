"""Calling what a study declares, so that whatever it raises becomes one sentence."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from mjmr.errors import InvalidInputError, MissingGLError, MjmrError, one_line
from mjmr.files import temporary_folder
from mjmr.film_options import FilmOptions
from mjmr.study import Study
from mjmr.table import NoTrialsError


def make_film(study: Study, path: Path, options: FilmOptions) -> None:
    """Make a study's film at ``path``: whole, or not at all.

    Raises:
        MissingGLError: No off-screen OpenGL.
        MjmrError: The study has no film, or making it failed.
    """
    function = study.resolve("film")
    if function is None:
        raise MjmrError(f"study {study.name} has no film")
    try:
        with temporary_folder(path.parent, "film") as folder:
            call_study("film", function, study, folder / path.name, options)
            if not (folder / path.name).is_file():
                raise MjmrError(f"film of {study.name}: nothing was written")
            os.replace(folder / path.name, path)
    except OSError as e:
        raise MjmrError(f"cannot write to {path.parent}: {e.strerror}") from e


def debugging() -> bool:
    """Whether tracebacks are wanted: ``MJMR_DEBUG=1``."""
    return os.environ.get("MJMR_DEBUG", "") not in ("", "0")


def call_study(role: str, function: Callable[..., Any], *arguments: Any) -> Any:
    """Call a study's function; what it raises becomes one sentence that names its role.

    Raises:
        MissingGLError: As the function raised it.
        NoTrialsError: As the function raised it.
        InvalidInputError: As the function raised it.
        MjmrError: For anything else the function raised, unless ``MJMR_DEBUG=1``.
    """
    try:
        return function(*arguments)
    except (MissingGLError, NoTrialsError, InvalidInputError):
        raise
    except Exception as e:
        if debugging():
            raise
        raise MjmrError(f"{role} failed: {one_line(e)} (MJMR_DEBUG=1 shows where)") from e
