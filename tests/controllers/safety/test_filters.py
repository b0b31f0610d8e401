import itertools

import numpy as np
import pytest
from shapely import affinity
from shapely.geometry import LinearRing, Point, box

from controllers.motion import Limits, Navigator, NavigatorConfig
from controllers.motion.safety import reachable_box
from controllers.safety import (
    Barrier,
    BarrierNavigator,
    NearestPoints,
    SafetyConfig,
    Unfiltered,
    VelocitySearch,
    reachable,
)
from mjmr.errors import InvalidInputError

FIELD = np.array([-2.75, -2.2, 2.75, 2.2])
BOXES = np.array([[0.0, 0.5, 0.4, 0.4, 0.2], [1.0, -1.0, 0.0, 0.3, 0.3]])


def test_nearest_points_are_shapelys():
    rng = np.random.default_rng(0)
    position = rng.uniform(-2, 2, (60, 2))
    found = NearestPoints(FIELD, BOXES).of(position)
    xmin, ymin, xmax, ymax = FIELD
    walls = [
        LinearRing([a, b, a])
        for a, b in itertools.pairwise(
            [(xmin, ymax), (xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax)]
        )
    ]
    shapes = [
        affinity.translate(affinity.rotate(box(-a, -b, a, b), yaw, (0, 0), use_radians=True), x, y)
        for x, y, yaw, a, b in BOXES
    ]
    for p, points in zip(position, found, strict=True):
        for shape, q in zip(walls + shapes, points, strict=True):
            assert np.hypot(*(p - q)) == pytest.approx(shape.distance(Point(p)), abs=1e-9)
            assert shape.distance(Point(q)) < 1e-9


def test_reachable_is_the_searchs_set():
    rng = np.random.default_rng(1)
    limits, T = Limits(max_speed=2.0, acceleration=3.0, deceleration=6.0), 0.02
    velocity = rng.uniform(-1, 1, (500, 2)) * rng.choice([0.0, 0.05, 1.0], (500, 1))
    wish = velocity + rng.uniform(-0.2, 0.2, (500, 2))
    found = reachable(velocity, wish, limits, T)
    inside = 0
    for v, w, f in zip(velocity, wish, found, strict=True):
        speed = float(np.hypot(*v))
        e = v / speed if speed else np.array([1.0, 0.0])
        n = np.array([-e[1], e[0]])
        least, most, side = reachable_box(speed, 3.0, 6.0, T)
        asked, given = ((x - v) @ np.column_stack([e, n]) for x in (w, f))
        assert given[0] == pytest.approx(min(max(asked[0], least), most), abs=1e-12)
        assert given[1] == pytest.approx(min(max(asked[1], -side), side), abs=1e-12)
        inside += np.allclose(f, w)
    assert 5 < inside < 495


def crossing(make, cycles=240, config=None, boxes=None):
    """Positions (cycles, 6, 2) of discs that swap sides and execute their commands exactly."""
    config = config or SafetyConfig(radius=0.09, margin=0.0, rate=3.0)
    y = np.linspace(-1.0, 1.0, 6)
    x, v = np.column_stack([np.full(6, -2.0), y]), np.zeros((6, 2))
    x[::2, 0] = 2.0
    goal = -x
    part = make(FIELD, boxes, 6, config, np.random.default_rng(3))
    seen = []
    for _ in range(cycles):
        away = goal - x
        length = np.hypot(*away.T)[:, None]
        wish = away * np.minimum(1.0, 2.0 / np.maximum(length, 1e-9))
        command = part.step(x, v, wish)
        x = x + 0.5 * (v + command) * config.period
        v = command
        seen.append(x)
    return np.array(seen), part


def least(seen):
    i, j = np.triu_indices(seen.shape[1], 1)
    return np.hypot(*(seen[:, i] - seen[:, j]).transpose(2, 0, 1)).min()


@pytest.mark.parametrize(("make", "floor"), [(Barrier, 0.18), (VelocitySearch, 0.18 - 1e-9)])
def test_filters_keep_discs_apart_that_would_meet(make, floor):
    free, _ = crossing(Unfiltered)
    assert least(free) < 0.1
    margin = 0.015 if make is Barrier else 0.0
    seen, part = crossing(make, config=SafetyConfig(radius=0.09, margin=margin, rate=3.0))
    assert least(seen) >= floor
    assert part.infeasible == 0


def test_the_barrier_keeps_off_boxes_and_walls():
    wall = np.array([[0.0, 0.0, 0.3, 0.2, 1.0]])
    seen, _ = crossing(Barrier, boxes=wall)
    free, _ = crossing(Unfiltered)
    points = NearestPoints(FIELD, wall)
    near = [np.hypot(*(points.of(p) - p[:, None]).transpose(2, 0, 1)).min() for p in seen]
    assert min(near) > 0.09 - 0.01
    assert min(np.hypot(*(points.of(p) - p[:, None]).transpose(2, 0, 1)).min() for p in free) == 0


def test_the_search_as_a_filter_is_the_navigators_bit_for_bit():
    n, period = 8, 1 / 60
    rng = np.random.default_rng(5)
    x = np.column_stack([rng.choice([-1.5, 1.5], n), np.linspace(-1.5, 1.5, n)])
    goals, v = -x, np.zeros((n, 2))
    common = {"planner": "straight", "samples": 30, "margin": 0.002}
    whole = Navigator(FIELD, BOXES, n, NavigatorConfig(**common), np.random.default_rng(7))
    off = NavigatorConfig(**common, search=False)
    wisher = Navigator(FIELD, BOXES, n, off, np.random.default_rng(8))
    part = VelocitySearch(
        FIELD, BOXES, n, SafetyConfig(radius=0.09, margin=0.002, samples=30),
        np.random.default_rng(7), within_reach=True,
    )  # fmt: skip
    overruled = 0
    for _ in range(150):
        expected = whole.step(x, v, goals)
        assert (part.step(x, v, wisher.step(x, v, goals)) == expected).all()
        overruled += int(part.overruled.sum())
        x, v = x + 0.5 * (v + expected) * period, expected
    assert overruled > 50


def test_who_does_not_obey_is_told_to_brake():
    x, v = np.array([[0.0, 0.0], [1.5, 0.0]]), np.array([[1.0, 0.0], [0.0, 0.5]])
    config, active = SafetyConfig(radius=0.09), np.array([False, True])
    for make in (Barrier, VelocitySearch):
        part = make(FIELD, None, 2, config, np.random.default_rng(0))
        found = part.step(x, v, np.array([[2.0, 0.0], [0.0, 0.5]]), active)
        assert found[0] == pytest.approx([0.9, 0.0])
        assert found[1] == pytest.approx([0.0, 0.5], abs=2e-3)


def test_a_tick_without_a_solution_brakes_is_counted_and_the_run_goes_on():
    """Two discs deep inside each other, one of them pinned in a corner by boxes all around."""
    pins = [[0.0, 0.16, 0.0, 1.0, 0.1], [0.0, -0.16, 0.0, 1.0, 0.1]]
    config = SafetyConfig(radius=0.09, margin=0.0, rate=20.0, limits=Limits(max_speed=0.2))
    part = Barrier(FIELD, np.array(pins), 3, config, np.random.default_rng(0))
    v = np.array([[0.1, 0.0], [0.1, 0.0], [0.1, 0.0]])
    jam = np.array([[0.0, 0.0], [0.01, 0.0], [0.02, 0.0]])
    found = part.step(jam, v, np.ones((3, 2)))
    assert part.infeasible == 1
    assert found == pytest.approx(np.zeros((3, 2)), abs=1e-12)  # 6 m/s^2 stop 0.1 m/s at once
    free = np.array([[-2.0, 1.5], [0.0, 1.5], [2.0, 1.5]])
    wish = np.full((3, 2), 0.1)
    assert part.step(free, wish, wish) == pytest.approx(wish, abs=2e-3)
    assert part.infeasible == 1


def test_the_barrier_navigator_reaches_goals_past_each_other():
    x, v = np.array([[-1.5, 0.02], [1.5, -0.02]]), np.zeros((2, 2))
    goals = -x
    navigator = BarrierNavigator(FIELD, None, 2, NavigatorConfig(), np.random.default_rng(0))
    closest, active = 9.0, np.array([True, True])
    for _ in range(400):
        command = navigator.step(x, v, goals, active)
        x, v = x + 0.5 * (v + command) / 60, command
        closest = min(closest, float(np.hypot(*(x[0] - x[1]))))
    assert 0.18 <= closest < 0.4
    assert np.abs(x - goals).max() < 0.05


@pytest.mark.parametrize(
    ("given", "told"),
    [({"radius": 0.0}, "radius"), ({"margin": -0.1}, "margin"), ({"rate": np.inf}, "rate")],
)
def test_numbers_that_make_no_sense_are_refused(given, told):
    with pytest.raises(InvalidInputError, match=told):
        SafetyConfig(**{"radius": 0.1, **given})
