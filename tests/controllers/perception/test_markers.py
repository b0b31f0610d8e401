"""MarkerFinder on cylinders drawn column by column: no simulator."""

import numpy as np
import pytest

from controllers.perception.markers import Marker, MarkerFinder
from mjmr.geometry import Pinhole, look_at

MARKER = Marker(length=0.4, radius=0.07, colours=((0.9, 0.05, 0.05), (0.05, 0.75, 0.1)))
# 45 degrees to either side
CAMERA = Pinhole(np.zeros(3), look_at((0, 0, 0), (1, 0, 0)), 240.0, 480, 120)


def draw(bearing, distance):
    """Picture of a red cylinder whose axis is at a bearing [deg], left positive, and distance."""
    image = np.full((CAMERA.height, CAMERA.width, 3), 120, dtype=np.uint8)
    column = np.arange(CAMERA.width) + 0.5
    angle = np.arctan((column - CAMERA.centre[0]) / CAMERA.focal)
    off = angle + np.radians(bearing)
    miss = distance * np.sin(off)
    hit = np.abs(miss) < MARKER.radius
    near = distance * np.cos(off) - np.sqrt(np.maximum(MARKER.radius**2 - miss**2, 0.0))
    half = CAMERA.focal * MARKER.length / 2 / (near * np.cos(angle))
    row = np.abs(np.arange(CAMERA.height) + 0.5 - CAMERA.centre[1])
    image[(row[:, None] < half) & hit] = (230, 13, 13)
    return image


def found(bearing, distance, **more):
    """Distance [m] and bearing [deg] that are told of it."""
    seen = MarkerFinder(MARKER, [CAMERA], **more).find([draw(bearing, distance)])
    assert np.isnan(seen[1]).all()
    return seen[0, 0], np.degrees(seen[0, 1])


@pytest.mark.parametrize("distance", [1.2, 2.1, 4.0])
@pytest.mark.parametrize("bearing", [-45.4, -45.0, -44.0, -20.0, 0.0, 30.0, 44.0, 45.0, 45.4])
def test_a_marker_is_placed_also_if_its_pictures_side_cuts_it(bearing, distance):
    away, told = found(bearing, distance, complete=True)
    assert away == pytest.approx(distance, rel=0.03)
    assert told == pytest.approx(bearing, abs=0.4)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_without_completion_the_bearing_is_that_of_the_part_seen(side):
    _, told = found(side * 46.0, 2.1)
    assert 0.8 < 46.0 - side * told < 2.0


def test_completion_changes_nothing_of_a_whole_marker():
    assert found(10.0, 2.0) == found(10.0, 2.0, complete=True)
