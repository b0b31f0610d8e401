"""Arrays of finite numbers or None."""

import numpy as np
import pytest

from mjmr.finite import finite, numbers


@pytest.mark.parametrize(
    ("given", "shape"),
    [
        ([1.0, np.nan], (2,)),
        ([1.0, np.inf], (2,)),
        ([1.0], (2,)),
        ([[1.0, 2.0], [3.0]], (2, 2)),
        ([1.0, "x"], (2,)),
        (None, (2,)),
        ({"x": 1.0}, (2,)),
    ],
)
def test_what_is_no_array_of_finite_numbers_is_none(given, shape):
    assert finite(given, shape) is None


def test_arrays_are_their_own():
    given = np.array([1.0, 2.0])
    for found in (finite(given, (2,)), numbers(given)):
        assert found is not None
        found[0] = 5.0
    assert given[0] == 1.0
    flags = numbers([[1, 0], [0, 1]], bool)
    assert flags is not None
    assert flags.dtype == bool
    assert numbers([[1, 0], [1]], bool) is None
    assert finite([1, 2], (2,)).tolist() == [1.0, 2.0]  # pyright: ignore
