"""How far a disc gets, against shapely."""

import math

import numpy as np
import pytest
from shapely.geometry import LineString, Point

from controllers.motion.free_way import SKIN, free_past


def test_a_disc_goes_until_the_point_is_as_near_as_it_may_be():
    rng = np.random.default_rng(3)
    for _ in range(200):
        x, y = rng.uniform(-2, 2, 2)
        keep, angle = rng.uniform(0.1, 0.9), rng.uniform(-math.pi, math.pi)
        if math.hypot(x, y) < keep:
            continue
        c, s = math.cos(angle), math.sin(angle)
        lane = LineString([(0, 0), (9 * c, 9 * s)])
        met = lane.intersection(Point(x, y).buffer(keep, quad_segs=512))
        expected = math.inf if met.is_empty else met.distance(Point(0, 0))
        found = free_past(c, s, x, y, math.hypot(x, y), keep)
        assert found == pytest.approx(expected, abs=1e-4)


def test_what_is_inside_stops_a_disc_that_would_come_nearer_only():
    assert free_past(1.0, 0.0, 0.2, 0.0, 0.2, 0.3) == pytest.approx(SKIN)
    assert free_past(0.0, 1.0, 0.2, 0.0, 0.2, 0.3) == math.inf
    assert free_past(-1.0, 0.0, 0.2, 0.0, 0.2, 0.3) == math.inf
