import numpy as np
import pytest

from controllers.motion.clearance import (
    check_bounds,
    prepare_boxes,
    segment_free,
    segment_rectangle,
)
from mjmr.errors import InvalidInputError
from tests.controllers.motion.scenes import box_distance

NO_BOXES, NO_DISCS = prepare_boxes(None), np.zeros((0, 3))
WIDE = np.array([-50.0, -50.0, 50.0, 50.0])


def least_along(distance, a, b):
    """Least distance along segments a-b (m, 2): ternary search, as distance is convex there."""
    low, high = np.zeros(len(a)), np.ones(len(a))
    for _ in range(60):
        s, t = low + (high - low) / 3, high - (high - low) / 3
        left = distance(a + s[:, None] * (b - a)) < distance(a + t[:, None] * (b - a))
        low, high = np.where(left, low, s), np.where(left, t, high)
    inner = distance(a + low[:, None] * (b - a))
    return np.minimum(inner, np.minimum(distance(a), distance(b)))


def segments(count, rng, length):
    a = rng.uniform(-1.5, 1.5, (count, 2))
    return a, a + rng.uniform(-length, length, (count, 2))


@pytest.mark.parametrize("length", [0.05, 0.6, 3.0])
def test_segment_to_box_distance_is_exact(length):
    rng = np.random.default_rng(5)
    a, b = segments(1500, rng, length)
    box = np.array([0.0, 0.0, 0.0, 0.5, 0.2])
    want = least_along(lambda x: box_distance(x, box), a, b)
    got = [segment_rectangle(*p, *q, 0.5, 0.2) for p, q in zip(a, b, strict=True)]
    np.testing.assert_allclose(got, want, atol=1e-9)
    assert (want == 0).any()
    assert (want > 0.1).any()


@pytest.mark.parametrize("length", [0.09, 0.6, 3.0])
def test_free_agrees_with_brute_force_where_the_start_is_clear(length):
    rng = np.random.default_rng(6)
    seen = np.zeros(2, dtype=int)
    for _ in range(40):
        boxes = np.column_stack(
            [
                rng.uniform(-1, 1, (3, 2)),
                rng.uniform(-np.pi, np.pi, 3),
                rng.uniform(0.05, 0.6, (3, 2)),
            ]
        )
        discs = np.column_stack([rng.uniform(-1, 1, (3, 2)), rng.uniform(0.05, 0.2, 3)])
        box_gap, disc_gap = rng.uniform(0.01, 0.2, 2)
        a, b = segments(150, rng, length)

        spare = [lambda x, o=o, gap=box_gap: box_distance(x, o) - gap for o in boxes]
        spare += [
            lambda x, o=o, gap=disc_gap: np.linalg.norm(x - o[:2], axis=-1) - o[2] - gap
            for o in discs
        ]
        least = np.min([least_along(f, a, b) for f in spare], axis=0)
        clear_start = np.min([f(a) for f in spare], axis=0) > 0
        prepared = prepare_boxes(boxes)
        for i in np.flatnonzero(clear_start & (np.abs(least) > 1e-9)):
            got = segment_free(*a[i], *b[i], -1, WIDE, 0.09, prepared, box_gap, discs, disc_gap)
            assert got == (least[i] > 0)
            seen[int(got)] += 1
    assert seen.min() > 50


def test_a_robot_s_own_disc_is_skipped():
    discs = np.array([[0.0, 0.0, 0.09], [1.0, 0.0, 0.09]])
    args = (WIDE, 0.09, NO_BOXES, 0.1, discs, 0.1)
    assert segment_free(0.0, 0.0, 0.5, 0.0, 0, *args)
    assert not segment_free(0.0, 0.0, 1.5, 0.0, 0, *args)


def test_from_a_start_too_near_it_may_leave_but_not_come_nearer():
    box = prepare_boxes([[0.0, 0.0, 0.0, 0.5, 0.5]])
    args = (-1, WIDE, 0.09, box, 0.105, NO_DISCS, 0.1)
    assert segment_free(0.55, 0.0, 0.9, 0.0, *args)
    assert segment_free(0.55, 0.0, 0.55, 0.3, *args)
    assert not segment_free(0.55, 0.0, 0.54, 0.3, *args)
    assert not segment_free(0.55, 0.0, -0.9, 0.0, *args)
    disc = np.array([[0.0, 0.0, 0.09]])
    args = (-1, WIDE, 0.09, NO_BOXES, 0.1, disc, 0.12)
    assert segment_free(0.15, 0.0, 1.0, 0.2, *args)
    assert not segment_free(0.15, 0.0, -1.0, 0.0, *args)
    args = (-1, np.array([-1.0, -1.0, 1.0, 1.0]), 0.09, NO_BOXES, 0.1, NO_DISCS, 0.1)
    assert segment_free(0.95, 0.0, 0.5, 0.0, *args)
    assert not segment_free(0.95, 0.0, 0.96, 0.0, *args)


def test_the_body_stays_within_the_bounds():
    args = (-1, np.array([-1.0, -1.0, 1.0, 1.0]), 0.09, NO_BOXES, 0.1, NO_DISCS, 0.1)
    assert segment_free(0.0, 0.0, 0.91, -0.91, *args)
    for end in ([0.9101, 0.0], [-0.9101, 0.0], [0.0, 0.9101], [0.0, -0.9101]):
        assert not segment_free(0.0, 0.0, *end, *args)


@pytest.mark.parametrize(
    ("boxes", "match"),
    [
        ([[0, 0, 0, 1]], r"\(k, 5\)"),
        ([[0, 0, 0, 1, 1], [0, 0, 0, 0, 1]], "box 1"),
        ([[0, np.nan, 0, 1, 1]], "box 0"),
    ],
)
def test_bad_boxes_are_named(boxes, match):
    with pytest.raises(InvalidInputError, match=match):
        prepare_boxes(boxes)


@pytest.mark.parametrize("bounds", [[0, 0, 1], [0, 0, 1, np.inf], [0, 0, 0.1, 1], [1, 1, 0, 0]])
def test_bad_bounds_are_refused(bounds):
    with pytest.raises(InvalidInputError, match="bounds"):
        check_bounds(bounds, 0.09)
