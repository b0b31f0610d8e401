"""What is known to be in a cone, and what echo is left over."""

import numpy as np
import pytest

from controllers.perimeter.echoes import kind_in_cones, nearest_unexplained, wall_ranges

BOUNDS = (-50.0, -50.0, 50.0, 50.0)
WIDTH = np.radians(15.0)
AHEAD = np.array([[0.4, 0.0, 0.0]])
PAIR = np.array([[0.4, 0.1, 0.13], [0.4, -0.1, -0.13]])
AT = np.array([0.24, 0.0])
RED = 4


def walls(pose, mounts=AHEAD):
    return wall_ranges(np.array([pose], dtype=float), mounts, WIDTH, BOUNDS)[0]


def somebody(ranges, known, mounts=AHEAD, reach=2.75):
    found = nearest_unexplained(
        np.array([ranges]), np.array([known]), mounts, margin=0.5, at=AT, reach=reach
    )
    return found[0]


def test_a_wall_ahead_is_as_far_as_it_is_from_the_cone_s_tip():
    assert walls([47.0, 0.0, 0.0]) == pytest.approx(2.6)
    assert walls([0.0, -47.0, -np.pi / 2]) == pytest.approx(2.6)
    # half a beam nearer to the normal
    assert walls([47.0, 0.0, 0.5])[0] == pytest.approx(
        (3.0 - 0.4 * np.cos(0.5)) / np.cos(0.5 - WIDTH / 2)
    )


def test_the_nearest_ray_of_a_cone_is_the_bound_that_brute_force_finds():
    rng = np.random.default_rng(0)
    for _ in range(50):
        pose = np.array([*rng.uniform(-49, 49, 2), rng.uniform(-np.pi, np.pi)])
        tip = pose[:2] + 0.4 * np.array([np.cos(pose[2]), np.sin(pose[2])])
        way = pose[2] + np.linspace(-WIDTH / 2, WIDTH / 2, 2001)
        with np.errstate(divide="ignore"):
            x = (np.where(np.cos(way) > 0, 50.0, -50.0) - tip[0]) / np.cos(way)
            y = (np.where(np.sin(way) > 0, 50.0, -50.0) - tip[1]) / np.sin(way)
        if np.abs(tip).max() < 50.0:
            # never longer than the true range, and shorter only where the wall ends before the ray
            assert walls(pose)[0] <= np.minimum(x, y).min() + 1e-6


def test_who_does_not_know_where_it_is_knows_no_walls():
    assert np.isinf(walls([np.nan, 0.0, 0.0])).all()


def test_red_counts_in_the_cones_that_look_at_it():
    angles = np.radians([-20.0, 7.0, 60.0])
    looks = np.array([[[2.0, RED], [2.5, RED], [1.0, RED]]])
    at = np.array([0.24, 0.0, 0.0])
    left, right = kind_in_cones(looks, angles, RED, at, PAIR, WIDTH, 3.0)[0]
    assert left == pytest.approx(
        np.hypot(2.5 * np.cos(angles[1]) - 0.16, 2.5 * np.sin(angles[1]) - 0.1)
    )
    assert np.isinf(right)
    looks[..., 1] = 2  # a truck
    assert np.isinf(kind_in_cones(looks, angles, RED, at, PAIR, WIDTH, 3.0)).all()
    looks[..., 1] = RED
    assert np.isinf(kind_in_cones(looks, angles, RED, at, PAIR, WIDTH, 2.4)[0, 0])


def test_an_echo_that_is_explained_is_nobody_and_a_nearer_one_is_somebody():
    assert np.isnan(somebody([2.5], [2.6])).all()
    assert np.isnan(somebody([2.2], [2.6])).all()  # within the margin
    assert somebody([2.0], [2.6]) == pytest.approx([2.4, 0.0])
    assert somebody([2.0], [np.inf]) == pytest.approx([2.4, 0.0])
    assert np.isnan(somebody([2.7], [np.inf])).all()  # the camera does not know what is there
    assert np.isnan(somebody([np.inf], [np.inf])).all()
    assert np.isnan(somebody([np.nan], [np.inf])).all()


def test_what_is_too_near_to_be_measured_is_somebody_at_once():
    assert somebody([-np.inf], [2.6]) == pytest.approx([0.4, 0.0])
    assert np.isnan(somebody([-np.inf], [0.3])).all()  # the wall itself


def test_the_nearest_of_several_counts_on_the_axis_of_its_cone():
    found = somebody([2.0, 1.5], [np.inf, np.inf], PAIR)
    assert found == pytest.approx([0.4 + 1.5 * np.cos(0.13), -0.1 - 1.5 * np.sin(0.13)])
    assert somebody([2.0, 1.5], [np.inf, 1.6], PAIR)[1] > 0.0
