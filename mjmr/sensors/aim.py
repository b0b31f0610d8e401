"""Angles that units which turn cameras are aimed at."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError

if TYPE_CHECKING:
    from mjmr.group import Group

Array = NDArray[np.float64]


def aimed_angles(group: "Group", **angles: ArrayLike) -> Array:
    """Angles by name as columns (n, k) [rad]; a new array.

    Args:
        group: Whose units are aimed.
        angles: Each of shape (n,), or one for all.

    Raises:
        InvalidInputError: Another shape, NaN or infinity (names the robots).
    """
    told = " and ".join(angles)
    try:
        columns = [
            np.broadcast_to(np.asarray(a, dtype=np.float64), group.n) for a in angles.values()
        ]
    except ValueError:
        shapes = " and ".join(str(np.shape(a)) for a in angles.values())
        raise InvalidInputError(
            f"{group.name}: {told} must be one angle a robot, shape ({group.n},), or one for all; "
            f"got {shapes}"
        ) from None
    aimed = np.column_stack(columns)
    bad = np.flatnonzero(~np.isfinite(aimed).all(axis=1))
    if len(bad):
        names = ", ".join(group.names[i] for i in bad)
        are = "they are" if len(angles) > 1 else "it is"
        raise InvalidInputError(f"{told} must be finite; {are} not for {names}")
    return aimed
