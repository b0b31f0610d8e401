import numpy as np
import pytest
from shapely.geometry import LineString, Point

from controllers.helping.visibility import RAYS, cast, clear, move, sees
from tests.controllers.helping.offices import KEPT, RADIUS, inside, place, walls


@pytest.mark.parametrize("name", ["world1", "world2", "trap"])
def test_sight_is_shapelys(name):
    office, edges = place(name), walls(name).sight
    free, rng = office.free_space(RADIUS), np.random.default_rng(1)
    points = inside(office, rng, 60)
    seen = 0
    for p in points[:30]:
        for q in points[30:]:
            expected = free.covers(LineString([p, q]))
            assert clear(*p, *q, edges) == expected
            assert sees(*p, *q, 4.0, edges) == (expected and np.hypot(*(p - q)) <= 4.0)
            seen += expected
    assert 20 < seen < 800  # both answers occur


def test_rays_are_shapelys():
    office, edges = place("world2"), walls("world2").motion
    boundary = office.free_space(KEPT).boundary
    ranges = np.zeros(len(RAYS))
    for p in inside(office, np.random.default_rng(2), 20):
        cast(*p, RAYS, 3.0, edges, ranges)
        for angle, found in zip(RAYS, ranges, strict=True):
            end = p + 3.0 * np.array([np.cos(angle), np.sin(angle)])
            hits = LineString([p, end]).intersection(boundary)
            expected = 3.0 if hits.is_empty else Point(p).distance(hits)
            assert found == pytest.approx(expected, abs=1e-9)


def test_nobody_leaves_the_free_space():
    office, edges = place("world2"), walls("world2").motion
    free, rng = office.free_space(KEPT - 1e-5), np.random.default_rng(3)
    for x, y in inside(office, rng, 20):
        for _ in range(200):
            angle = rng.uniform(-np.pi, np.pi)
            way = rng.uniform(0.0, 3.0)
            nx, ny = move(x, y, np.cos(angle), np.sin(angle), way, edges, rng.random() < 0.5)
            assert free.contains(Point(nx, ny))
            assert np.hypot(nx - x, ny - y) <= way + 1e-9
            x, y = nx, ny


def test_what_is_seen_is_reached_straight():
    # sight lines that brush past a corner clip motion's polygon; the robot goes round
    office, w = place("world2"), walls("world2")
    points = inside(office, np.random.default_rng(4), 200)
    pairs = 0
    for p, q in zip(points[:100], points[100:], strict=True):
        for goal in points[100:130]:
            if not sees(*p, *goal, 8.0, w.sight):
                continue
            pairs += 1
            x, y = p
            for _ in range(70):
                far = np.hypot(goal[0] - x, goal[1] - y)
                if far < 1e-3:
                    break
                way = min(far, 0.15)
                x, y = move(x, y, (goal[0] - x) / far, (goal[1] - y) / far, way, w.motion, True)
            assert far < 1e-3, (p, goal)
        del q
    assert pairs > 100
