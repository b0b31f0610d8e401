"""Objects in arcs, against circles whose visible edges are worked out by hand."""

import numpy as np
import pytest

from controllers.perception.arc_objects import FIXED, MOVER, NOTHING, ROBOT, ArcObjects
from mjmr.errors import InvalidInputError

ANGLES = np.linspace(-np.pi / 4, np.pi / 4, 128)


def arc(circles, angles=ANGLES):
    """Exact columns (1, c) of circles (x, y, radius, kind): ranges and kinds."""
    ranges, kinds = np.full(len(angles), np.inf), np.zeros(len(angles))
    for x, y, radius, kind in circles:
        along = x * np.cos(angles) + y * np.sin(angles)
        across = x * np.sin(angles) - y * np.cos(angles)
        hit = (np.abs(across) < radius) & (along > 0)
        near = along - np.sqrt(np.maximum(radius**2 - across**2, 0.0))
        nearer = hit & (near < ranges)
        ranges[nearer], kinds[nearer] = near[nearer], kind
    return ranges[None], kinds[None]


def finder(mover=0.1, **options):
    return ArcObjects(robot_radius=0.24, mover_radius=mover, max_range=3.0, **options)


def find(circles, mover=0.1, noise=0.0, **options):
    ranges, kinds = arc(circles)
    ranges = ranges + noise * np.random.default_rng(0).standard_normal(ranges.shape)
    return finder(mover, **options).find(ANGLES, ranges, kinds)


def centres(found, kind):
    return found.centre[0, found.kind[0] == kind]


def test_whole_things_are_where_they_are_nearest_first():
    found = find([(2.0, 0.5, 0.1, MOVER), (1.0, -0.4, 0.1, MOVER), (1.6, -0.1, 0.24, ROBOT)])
    assert found.kind[0, :4].tolist() == [MOVER, ROBOT, MOVER, NOTHING]
    assert centres(found, MOVER) == pytest.approx(np.array([[1.0, -0.4], [2.0, 0.5]]), abs=0.015)
    assert centres(found, ROBOT) == pytest.approx(np.array([[1.6, -0.1]]), abs=0.015)
    assert found.gap[0, 0] == pytest.approx(np.hypot(1.0, 0.4) - 0.1, abs=0.01)
    assert found.gap[0, 3] == np.inf
    assert found.whole[0, :3].all()


@pytest.mark.parametrize("side", [1, -1])
def test_of_a_thing_half_hidden_the_other_edge_tells_where_it_is(side):
    """A robot hides a good half of the disc behind it."""
    found = find([(1.5, 0.0, 0.3, MOVER), (0.8, side * 0.24, 0.24, ROBOT)], mover=0.3)
    ((x, y),) = centres(found, MOVER)
    assert (x, y) == pytest.approx((1.5, 0.0), abs=0.04)
    assert not found.whole[0, found.kind[0] == MOVER].any()


def test_a_large_disc_that_fills_the_field_is_where_it_is():
    found = find([(1.25, 0.15, 1.0, MOVER)], mover=1.0, noise=0.01)
    ((x, y),) = centres(found, MOVER)
    assert (x, y) == pytest.approx((1.25, 0.15), abs=0.04)
    assert found.gap[0, 0] == pytest.approx(np.hypot(1.25, 0.15) - 1.0, abs=0.03)


def test_two_pieces_of_one_thing_are_one_thing():
    found = find([(2.2, 0.0, 0.4, MOVER), (0.9, 0.0, 0.1, ROBOT)], mover=0.4)
    assert len(centres(found, MOVER)) == 1


@pytest.mark.parametrize("distance", [0.6, 1.0, 1.8])
def test_things_that_touch_are_two(distance):
    circles = [(distance, 0.1, 0.1, MOVER), (distance, -0.1, 0.1, MOVER)]
    found = find(circles, noise=0.005)
    places = centres(found, MOVER)
    assert len(places) == 2
    assert sorted(places[:, 1]) == pytest.approx([-0.1, 0.1], abs=0.03)


def test_things_one_behind_the_other_are_two():
    found = find([(1.0, 0.0, 0.1, MOVER), (1.6, 0.2, 0.1, MOVER)], noise=0.005)
    assert len(centres(found, MOVER)) == 2


def test_one_thing_stays_one_in_noise_at_any_distance():
    for distance in np.arange(0.5, 2.8, 0.1):
        ranges, kinds = arc([(distance, 0.0, 0.1, MOVER)])
        noise = 0.02 * distance * np.random.default_rng(3).standard_normal(ranges.shape)
        found = finder(resolution=0.02).find(ANGLES, ranges + noise, kinds)
        assert (found.kind == MOVER).sum() == 1


def test_walls_are_their_nearest_points():
    ranges = 1.2 / np.cos(ANGLES)[None]
    found = finder().find(ANGLES, ranges, np.full(ranges.shape, FIXED))
    assert found.kind[0].tolist()[:2] == [FIXED, NOTHING]
    assert found.centre[0, 0] == pytest.approx((1.2, 0.0), abs=0.01)


def test_specks_and_what_is_too_far_are_left_out():
    ranges, kinds = arc([(1.0, 0.0, 0.1, MOVER)])
    kinds[0, 10], ranges[0, 10] = MOVER, 2.0
    assert (finder().find(ANGLES, ranges, kinds).kind == MOVER).sum() == 1
    assert (find([(3.2, 0.0, 0.1, MOVER)]).kind == NOTHING).all()


def test_no_more_than_asked_are_kept_and_they_are_the_nearest():
    found = find([(2.0, 0.6, 0.1, MOVER), (1.0, 0.0, 0.1, MOVER)], most=1)
    assert found.centre.shape == (1, 1, 2)
    assert found.centre[0, 0] == pytest.approx((1.0, 0.0), abs=0.02)


def test_radii_that_cannot_be_are_refused():
    with pytest.raises(InvalidInputError):
        finder(mover=0.0)
