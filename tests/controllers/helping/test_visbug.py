import numpy as np
import pytest
from shapely.geometry import LineString, Point

from controllers.helping import visbug
from controllers.helping.visibility import move
from mjmr.office import free_space
from tests.controllers.helping.offices import KEPT, inside, place, walls


def _edges(polygon):
    """Edges and links of a shapely polygon, oriented."""
    edges, links, first = [], [], 0
    for ring in (polygon.exterior, *polygon.interiors):
        points = np.asarray(ring.coords)
        k, index = len(points) - 1, np.arange(len(points) - 1)
        edges.append(np.hstack([points[:-1], points[1:]]))
        links.append(np.column_stack([(index + 1) % k, (index - 1) % k]) + first)
        first += k
    after, before = np.ascontiguousarray(np.vstack(links).T)
    return np.vstack(edges), after, before


@pytest.mark.parametrize("left", [True, False])
def test_bug2_round_one_wall_is_exact(left):
    polygon = free_space([10, 10], [[0, 0, 10, 0], [10, 0, 10, 10], [10, 10, 0, 10],
                                    [0, 10, 0, 0], [5, 3, 5, 8]], 0.5)  # fmt: skip
    bug = visbug.bug()
    visbug.plan(bug, 2.0, 5.0, 8.0, 5.0, *_edges(polygon), left)
    path = bug.path[1 : bug.at[0]]
    # the wall on the left: to the right of the way, that is round its lower end
    y = 2.5 if left else 8.5
    expected = [[2, 5], [4.5, 5], [4.5, y], [5.5, y], [5.5, 5], [8, 5]]
    np.testing.assert_allclose(path, expected, atol=1e-9)
    assert bug.at[2] == 0


def test_bug2_leaves_where_it_is_nearer_and_may_go_on():
    # a wall shaped like a C round the start: the M-line meets it again farther from the goal
    polygon = free_space([12, 12], [[0, 0, 12, 0], [12, 0, 12, 12], [12, 12, 0, 12], [0, 12, 0, 0],
                                    [3, 4, 7, 4], [3, 8, 7, 8], [7, 4, 7, 8]], 0.3)  # fmt: skip
    bug = visbug.bug()
    visbug.plan(bug, 5.0, 6.0, 10.0, 6.0, *_edges(polygon), True)
    path = LineString(bug.path[: bug.at[0]])
    assert bug.at[2] == 0
    np.testing.assert_allclose(path.coords[-1], [10, 6])
    # it goes round the lower arm: out of its mouth, on the outer side, to the M-line behind
    assert Point(7.3, 6.0).distance(path) < 1e-9
    assert path.bounds[1] == pytest.approx(3.7)


def test_a_goal_behind_walls_is_found_out_of_reach():
    polygon = free_space([10, 10], [[0, 0, 10, 0], [10, 0, 10, 10], [10, 10, 0, 10], [0, 10, 0, 0],
                                    [6, 0, 6, 10]], 0.2)  # fmt: skip
    bug = visbug.bug()
    visbug.plan(bug, 2.0, 5.0, 8.0, 5.0, *_edges(polygon), True)
    assert bug.at[2] == 1


@pytest.mark.parametrize("name", ["world1", "world2"])
def test_paths_stay_free_and_arrive(name):
    office, w = place(name), walls(name)
    free, rng = office.free_space(KEPT - 1e-6), np.random.default_rng(5)
    points = inside(office, rng, 80)
    for p, q in zip(points[::2], points[1::2], strict=True):
        bug = visbug.bug()
        visbug.plan(bug, *p, *q, w.path, w.after, w.before, True)
        assert bug.at[2] == 0
        path = bug.path[: bug.at[0]]
        np.testing.assert_allclose(path[-1], q)
        assert free.covers(LineString(path))
        # a robot that follows it with a shortcut arrives, and by no longer a way
        (x, y), gone = p, 0.0
        for _ in range(3000):
            tx, ty = visbug.target(bug, x, y, 3.0, w.sight)
            far = np.hypot(tx - x, ty - y)
            if far < 1e-6:
                break
            way = min(far, 0.15)
            x, y = move(x, y, (tx - x) / far, (ty - y) / far, way, w.motion, True)
            gone += way
        assert np.hypot(q[0] - x, q[1] - y) < 1e-3
        assert gone <= LineString(path).length + 0.5
