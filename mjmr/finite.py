"""Arrays of finite numbers, or None: what is refused is said by who asks."""

from typing import Any

import numpy as np
from numpy.typing import NDArray


def numbers(values: Any, dtype: type = np.float64) -> NDArray[Any] | None:
    """An array of its own; None of rows of unequal length and of what are no numbers."""
    try:
        return np.array(values, dtype=dtype)
    except (TypeError, ValueError):
        return None


def finite(values: Any, shape: tuple[int, ...]) -> NDArray[np.float64] | None:
    """An array of its own of that shape; None of another, and of what are no finite numbers."""
    found = numbers(values)
    return None if found is None or found.shape != shape or not np.isfinite(found).all() else found
