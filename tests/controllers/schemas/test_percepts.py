import numpy as np
import pytest

from controllers.schemas import Things
from mjmr.errors import InvalidInputError


def test_gap_is_to_the_surface_and_infinite_where_nothing_is():
    things = Things.of(np.array([[[3.0, 4.0], [np.nan, np.nan]]]), np.array([[0.5, 0.5]]))
    assert things.gap.tolist() == [[4.5, np.inf]]
    assert things.nearest().offset.tolist() == [[[3.0, 4.0]]]


def test_nearest_of_nothing_at_all_is_nothing():
    nearest = Things.of(np.empty((2, 0, 2))).nearest()
    assert nearest.valid.tolist() == [[False], [False]]


def test_a_scan_becomes_the_nearest_point_of_each_sector():
    angles = np.linspace(-np.pi / 2, np.pi / 2, 9)
    ranges = np.array([[5, 4, 3, np.inf, np.inf, np.inf, np.nan, 2.0, 1.5]], dtype=float)
    things = Things.from_scan(ranges, angles, np.array([np.pi / 2]), sectors=3)
    assert things.valid.tolist() == [[True, False, True]]
    bearing = angles[2] + np.pi / 2
    assert things.offset[0, 0] == pytest.approx(3 * np.array([np.cos(bearing), np.sin(bearing)]))
    assert things.offset[0, 2] == pytest.approx([-1.5, 0.0], abs=1e-12)


@pytest.mark.parametrize("sectors", [0, 10])
def test_sectors_must_fit(sectors):
    with pytest.raises(InvalidInputError, match="in 1 to as many sectors"):
        Things.from_scan(np.ones((1, 9)), np.zeros(9), np.zeros(1), sectors=sectors)


@pytest.mark.parametrize("shape", [(3,), (2, 3, 3)])
def test_offsets_of_another_shape_are_refused(shape):
    with pytest.raises(InvalidInputError, match=r"\(n, k, 2\)"):
        Things.of(np.zeros(shape))


def test_negative_radii_are_refused():
    with pytest.raises(InvalidInputError, match="radii"):
        Things.of(np.zeros((1, 2)), -0.1)
