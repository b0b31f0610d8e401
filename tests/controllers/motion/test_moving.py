"""Boxes that move, and robots that take no part."""

import numpy as np
import pytest

from controllers.motion import Navigator, NavigatorConfig
from controllers.motion.clearance import prepare_boxes
from controllers.motion.moving import drifting_gap
from controllers.motion.prediction import PIECES, fill_prediction
from mjmr.errors import InvalidInputError
from tests.controllers.motion.scenes import BOUNDS, PERIOD, RADIUS, box_distance

B, HORIZON = 6.0, 0.7


def places(rows, times):
    """Positions (k, 2) of a prediction, sampled."""
    found = []
    for t in times:
        row = rows[np.searchsorted(rows[:, 0], t, side="right") - 1]
        s = t - row[0]
        found.append(row[1:3] + row[3:5] * s + 0.5 * row[5:7] * s * s)
    return np.array(found)


def test_gap_is_that_of_dense_sampling_and_never_more():
    rng = np.random.default_rng(5)
    rows, hits = np.empty((PIECES, 7)), 0
    for _ in range(300):
        p, v = rng.uniform(-0.8, 0.8, 2), rng.uniform(-2, 2, 2)
        c, u = v + rng.uniform(-0.1, 0.1, 2), rng.uniform(-0.4, 0.4, 2)
        fill_prediction(*p, *v, *c, B, PERIOD, rows)
        box = np.array([0.1, 0.0, rng.uniform(-3, 3), 0.25, 0.15])
        got = drifting_gap(rows, HORIZON, prepare_boxes([box]), 0, *u)
        times = np.linspace(0.0, max(HORIZON, rows[3, 0]), 2000)
        gaps = [
            box_distance(x[None], np.concatenate([box[:2] + u * t, box[2:]]))[0]
            for t, x in zip(times, places(rows, times), strict=True)
        ]
        assert got <= min(gaps) + 1e-12
        # conservative by the sag of the braking parabola in the box's frame, at most
        assert got >= min(gaps) - 0.5 * np.hypot(*u) * (rows[3, 0] - rows[1, 0]) - 1e-3
        hits += 0.0 < min(gaps) < 0.2
    assert hits > 30


def navigator(n, boxes=None, **settings):
    config = NavigatorConfig(planner="straight", foresight=HORIZON, **settings)
    return Navigator(BOUNDS, boxes, n, config, np.random.default_rng(0))


def test_a_robot_at_rest_gets_out_of_the_way_of_a_box():
    """Its goal is where it stands, the box comes at 0.3 m/s; without word of it, it is run over."""

    def nearest(told):
        box, u = np.array([[-1.0, 0.02, 0.0, 0.25, 0.15]]), np.array([[0.3, 0.0]])
        robot = navigator(1, box)
        p, v = np.zeros((1, 2)), np.zeros((1, 2))
        gaps = []
        for _ in range(420):
            robot.see_boxes(box, u if told else np.zeros((1, 2)))
            c = robot.step(p, v, np.zeros((1, 2)))
            p, v = p + 0.5 * (v + c) * PERIOD, c
            box[:, :2] += u * PERIOD
            gaps.append(box_distance(p, box[0])[0])
        return min(gaps)

    assert nearest(told=True) >= RADIUS - 1e-9
    assert nearest(told=False) < RADIUS - 0.01


def test_robots_give_way_to_a_foreseen_stranger():
    """One crosses the way of another that minds nobody; told of it, it stays clear."""

    def nearest(strangers):
        robots = navigator(2, strangers=strangers)
        p, v = np.array([[-1.5, 0.0], [0.0, -0.9]]), np.zeros((2, 2))
        goals = np.array([[1.5, 0.0], [0.0, 1.5]])
        gaps = []
        for _ in range(180):
            c = robots.step(p, v, goals)
            c[1] = [0.0, min(1.0, v[1, 1] + 0.05)]
            p, v = p + 0.5 * (v + c) * PERIOD, c
            gaps.append(np.hypot(*(p[0] - p[1])))
        return min(gaps)

    assert nearest((1,)) >= 2 * RADIUS - 1e-9
    assert nearest(()) < 2 * RADIUS


def test_bad_words_of_boxes_and_strangers_are_refused():
    robot = navigator(1, [[0.0, 0.0, 0.0, 0.1, 0.1]])
    with pytest.raises(InvalidInputError, match="made with 1"):
        robot.see_boxes(np.ones((2, 5)), np.zeros((2, 2)))
    with pytest.raises(InvalidInputError, match="velocity"):
        robot.see_boxes(np.ones((1, 5)), np.full((1, 2), np.nan))
    with pytest.raises(InvalidInputError, match="stranger"):
        navigator(2, strangers=(2,))
