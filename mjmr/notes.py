"""What a controller can ask films and traces to show, and the shapes it has."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError, UnknownNameError

Array = NDArray[np.float64]
NOTES = ("goals", "waypoints", "stops", "links", "points")
"""Rings (n, 2), ways there (n, 2), planned stops (n, 2), who is linked to whom (n, n), any marks
(k, 2)."""


def check_note(name: str, value: ArrayLike, n: int) -> Array:
    """A note as it is kept: a new array of floats.

    Args:
        name: One of ``NOTES``.
        value: What is to be shown; positions [m], world frame, NaN rows are not drawn. Links are
            numbers, those above 0 drawn from robot row to robot column.
        n: Robots of the team.

    Raises:
        UnknownNameError: Another name.
        InvalidInputError: Another shape.
    """
    if name not in NOTES:
        raise UnknownNameError("note", name, NOTES)
    array = np.array(value, dtype=np.float64)
    shape: tuple[int, ...] = nothing(name, n).shape
    if name == "points" and array.ndim == 2:
        shape = (len(array), 2)
    if array.shape != shape:
        wanted = "(k, 2)" if name == "points" else shape
        raise InvalidInputError(f"{name} must have shape {wanted}; got {array.shape}")
    return array


def nothing(name: str, n: int) -> Array:
    """What stands for a note that was not made: nothing is drawn."""
    rows, columns = {"links": (n, n), "points": (0, 2)}.get(name, (n, 2))
    return np.full((rows, columns), np.nan)


def stack_notes(name: str, notes: "list[dict[str, Array]]", n: int) -> Array:
    """Notes of one name over time (k, ...), NaN where there were none or fewer."""
    found = [note.get(name, nothing(name, n)) for note in notes]
    rows = max(len(array) for array in found)
    table = np.full((len(found), rows, nothing(name, n).shape[1]), np.nan)
    for k, array in enumerate(found):
        table[k, : len(array)] = array
    return table
