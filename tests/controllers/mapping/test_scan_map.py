"""Maps and sight from scans, against the geometry the scans were made of."""

import numpy as np
import pytest
import shapely

from controllers.helping import visbug
from controllers.helping.visibility import inside
from controllers.mapping import ScanMap, free_ranges, way_is_clear
from mjmr.errors import InvalidInputError

ANGLES = np.radians(np.arange(-180.0, 180.0))
BEAMS = np.cos(ANGLES), np.sin(ANGLES)


def scan(x: float, y: float, yaw: float, walls: list) -> np.ndarray:
    """Ranges (360,) [m] from a pose to walls, segments; by shapely."""
    lines = shapely.union_all([shapely.LineString(w) for w in walls])
    here, ranges = shapely.Point(x, y), np.full(len(ANGLES), np.inf)
    for k, angle in enumerate(ANGLES + yaw):
        end = (x + 20 * np.cos(angle), y + 20 * np.sin(angle))
        hit = shapely.LineString([(x, y), end]).intersection(lines)
        if not hit.is_empty:
            ranges[k] = here.distance(hit)
    return ranges


ROOM = [[(-2, -2), (2, -2)], [(2, -2), (2, 2)], [(2, 2), (-2, 2)], [(-2, 2), (-2, -2)]]


def test_a_room_is_a_ring_with_free_space_on_the_left():
    walls = ScanMap(radius=0.3, reach=8.0)
    for pose in ([0, 0, 0], [0.5, 0.3, 1.0]):
        walls.add(pose, scan(*pose, ROOM), ANGLES)
    edges, after, before = walls.edges()
    np.testing.assert_array_equal(before[after], np.arange(len(edges)))
    np.testing.assert_allclose(edges[after][:, :2], edges[:, 2:])
    area = 0.5 * (edges[:, 0] * edges[:, 3] - edges[:, 2] * edges[:, 1])
    rims = {tuple(sorted(_loop(after, k))) for k in range(len(edges))}
    signed = sorted(float(area[list(rim)].sum()) for rim in rims)
    # free space inside runs anticlockwise, the outside of the ring clockwise
    assert signed[0] == pytest.approx(-(4.6**2), rel=0.06)
    assert signed[-1] == pytest.approx(3.4**2, rel=0.06)
    inner = edges[list(max(rims, key=lambda rim: area[list(rim)].sum()))]
    # 1.7 m to each side are free, give or take a cell
    for x, y in ((1.6, 0), (-1.6, 0), (0, 1.6), (0, -1.6)):
        assert inside(x, y, inner)
        assert not inside(1.12 * x, 1.12 * y, inner)


def _loop(after: np.ndarray, k: int) -> list[int]:
    loop = [k]
    while after[loop[-1]] != k:
        loop.append(int(after[loop[-1]]))
    return loop


def test_bug2_goes_round_a_wall_it_mapped():
    wall = [[(2, -1), (2, 1)]]
    walls = ScanMap(radius=0.3, reach=8.0)
    for pose in ([0, 0, 0], [1, 1.8, 0], [1, -1.8, 0], [3.5, 0, 3.0]):
        walls.add(pose, scan(*pose, wall), ANGLES)
    bug = visbug.bug()
    visbug.plan(bug, 0.0, 0.0, 4.0, 0.0, *walls.edges(), True)
    path = shapely.LineString(bug.path[: bug.at[0]])
    assert bug.at[2] == 0
    assert path.distance(shapely.LineString(wall[0])) > 0.22
    # with the wall on the left it passes on the right, where y is negative
    assert path.bounds[1] == pytest.approx(-1.3, abs=0.1)
    assert path.bounds[3] < 0.2


def test_nothing_new_is_no_new_version():
    walls = ScanMap(radius=0.3, reach=8.0)
    ranges = scan(0, 0, 0, ROOM)
    walls.add([0, 0, 0], ranges, ANGLES)
    version = walls.version
    walls.add([0, 0, 0], ranges, ANGLES)
    assert walls.version == version
    walls.add([0, 0, 0.1], scan(0, 0, 0.1, [*ROOM, [(1, 0), (1, 0.5)]]), ANGLES)
    assert walls.version > version


def test_sight_is_sight_of_a_disc():
    """Agrees with shapely's buffer, away from the very edge."""
    rng = np.random.default_rng(0)
    walls = [*ROOM, [(0.8, -2), (0.8, 0.4)]]
    solid, seen = shapely.union_all([shapely.LineString(w) for w in walls]), 0
    ranges = scan(0, -1, 0.5, walls)
    for _ in range(300):
        point = rng.uniform(-1.6, 1.6, 2)
        gap = shapely.LineString([(0, -1), point]).distance(solid)
        if abs(gap - 0.3) < 0.04:
            continue
        c, s = np.cos(0.5), np.sin(0.5)
        x, y = point - [0, -1]
        found = way_is_clear(ranges, *BEAMS, c * x + s * y, -s * x + c * y, 0.3, 8.0)
        assert found == (gap > 0.3)
        seen += found
    assert 50 < seen < 250


def test_ways_end_at_the_radius_from_a_wall():
    ranges = scan(0, 0, 0, ROOM)
    ways = free_ranges(ranges, *BEAMS, np.array([0.0, np.pi / 2, np.pi / 4]), 0.3, 5.0)
    np.testing.assert_allclose(ways[:2], 1.7, atol=0.01)
    assert ways[2] == pytest.approx(np.sqrt(2) * 1.7, abs=0.02)


def test_refuses_what_cannot_be():
    with pytest.raises(InvalidInputError, match="radius must be positive"):
        ScanMap(radius=0.0, reach=3.0)
