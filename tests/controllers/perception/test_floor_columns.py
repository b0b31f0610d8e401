"""Columns of drawn pictures, against where their feet were drawn."""

import numpy as np
import pytest

from controllers.perception.floor_columns import FloorColumns, Paint
from mjmr.geometry import Pinhole, look_at

WIDTH, HEIGHT = 160, 120
ORANGE, BLUE = (0.95, 0.45, 0.05), (0.10, 0.35, 0.95)
CAMERA = Pinhole(
    np.array([0.0, 0.0, 0.2]), look_at((0.0, 0.0, 0.2), (1.0, 0.0, 0.2)), 80.0, WIDTH, HEIGHT
)


def picture(things, noise=0.0):
    """Upright plates (x, y, half width, foot, height, colour) on a grey floor, furthest first."""
    image = np.full((HEIGHT, WIDTH, 3), 120, dtype=np.uint8)
    v, u = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    for x, y, half, foot, height, colour in things:
        (left, top), (right, low) = CAMERA.project([(x, y + half, height), (x, y - half, foot)])
        image[(u > left) & (u < right) & (v > top) & (v < low)] = [int(255 * c) for c in colour]
    drawn = image + noise * np.random.default_rng(0).standard_normal(image.shape)
    return np.clip(drawn, 0, 255).astype(np.uint8)


@pytest.fixture
def columns():
    return FloorColumns(
        CAMERA, (Paint(kind=3, colour=ORANGE), Paint(kind=2, colour=BLUE, foot=0.04))
    )


@pytest.mark.parametrize("x", [0.5, 1.0, 1.8])
def test_a_foot_on_the_floor_tells_the_range(columns, x):
    bearings, ranges, kinds = columns.look(picture([(x, 0.1, 0.15, 0.0, 0.17, ORANGE)])[None])
    seen = kinds[0] == 3
    assert set(kinds[0]) == {0, 3}
    places = ranges[0, seen] * np.array([np.cos(bearings[0, seen]), np.sin(bearings[0, seen])])
    pixel = x * x * columns.resolution
    assert places[0] == pytest.approx(x, abs=1.5 * pixel)
    assert places[1].mean() == pytest.approx(0.1, abs=0.03)
    assert np.diff(bearings[0]).min() > 0


def test_a_foot_above_the_floor_counts_from_its_height(columns):
    _, ranges, kinds = columns.look(picture([(1.0, 0.0, 0.2, 0.04, 0.26, BLUE)])[None])
    assert np.median(ranges[0, kinds[0] == 2]) == pytest.approx(1.0, abs=0.12)


def test_the_nearest_thing_of_a_column_counts(columns):
    behind, before = (2.0, 0.0, 0.4, 0.04, 0.26, BLUE), (1.0, 0.0, 0.1, 0.0, 0.17, ORANGE)
    _, _, kinds = columns.look(picture([behind, before])[None])
    assert kinds[0, WIDTH // 2] == 3
    assert (kinds[0] == 2).any()


def test_noise_and_grey_things_are_nothing(columns):
    grey = (1.0, 0.0, 0.3, 0.0, 0.3, (0.82, 0.83, 0.85))
    _, ranges, kinds = columns.look(picture([grey], noise=4.0)[None])
    assert (kinds == 0).all()
    assert (ranges == np.inf).all()


def test_every_picture_is_looked_at_by_itself(columns):
    one = picture([(1.0, 0.0, 0.2, 0.0, 0.17, ORANGE)])
    _, _, kinds = columns.look(np.stack([one, np.zeros_like(one)]))
    assert (kinds[0] == 3).any()
    assert (kinds[1] == 0).all()
