"""What mjmr raises: one base class, so that a caller can catch all of it at once."""

import difflib
from collections.abc import Iterable
from typing import Any


class MjmrError(Exception):
    """Base of every error mjmr raises on purpose.

    The message is one sentence that says what was given and what is allowed.
    """


class InvalidInputError(MjmrError, ValueError):
    """A value, name or shape given by the caller is not acceptable."""


class UnknownNameError(InvalidInputError):
    """A name was looked up and is not there; the message lists the valid ones, nearest first."""

    def __init__(self, kind: str, name: object, valid: Iterable[object]):
        """Build the message.

        Args:
            kind: What the name stands for, for example ``"study"``.
            name: What was given.
            valid: Every name that would have been accepted.
        """
        ordered = nearest_first(str(name), [str(v) for v in valid])
        super().__init__(f"unknown {kind} {str(name)!r}; valid: {', '.join(ordered) or 'none'}")


class UnknownSensorError(UnknownNameError, AttributeError):
    """A group has no sensor mounted under this name, nor any attribute called so."""


class PartError(MjmrError):
    """What takes a role in a study cannot be loaded, or does not do what the role demands."""


class TruthError(MjmrError):
    """Truth was read while a controller is to act."""


class LiftError(MjmrError):
    """A controller tried to move a robot by hand."""


class SimulationDivergedError(MjmrError):
    """The physics left the finite or plausible range; the message says where and when.

    Attributes:
        snapshots: States of about the last second before it, oldest first.
    """

    snapshots: tuple[Any, ...] = ()


GL_ADVICE = (
    "no off-screen OpenGL: install libegl1 (Debian: apt install libegl1 libgl1-mesa-dri) and set "
    "MUJOCO_GL=egl, or import mjmr before mujoco"
)


class MissingGLError(MjmrError):
    """No off-screen OpenGL is available; everything without cameras still runs."""


def nearest_first(name: str, valid: list[str]) -> list[str]:
    """Order ``valid`` by likeness to ``name``, most alike first, ties as given."""
    low = name.lower()
    return sorted(valid, key=lambda v: -difflib.SequenceMatcher(None, low, v.lower()).ratio())


def one_line(error: BaseException) -> str:
    """Type and message of an error on one line."""
    return " ".join(f"{type(error).__name__}: {error}".split())
