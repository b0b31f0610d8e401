"""The compiled point robots: what they sense, and where their last steps end."""

import numpy as np
import pytest

from controllers.helping import GOAL, LITERAL, OFFER, Settings, patrol, point_team
from controllers.helping.visibility import Walls, sees
from mjmr.office import Office
from tests.controllers.helping.offices import inside, place, walls


def _start(n):
    office = place()
    route, rng = office.routes[0], np.random.default_rng(6)
    points = inside(office, rng, 4)
    at, following = [points[0]], [-1]
    for k in range(n - 1):
        x, y, waypoint = patrol.place(route, (0.2 + k / 3) % 1 * patrol.length(route))
        at.append(np.array([x, y]))
        following.append(waypoint)
    frames = np.zeros((n, 3))
    frames[1:] = rng.uniform([-9, -9, -3], [9, 9, 3], (n - 1, 3))
    return office, points[1:], np.array(at), np.array(following), frames


def test_a_ghost_whose_goal_a_corner_hides_from_half_a_millimetre_is_reached():
    # a wall from the south rim: the line from ghost to goal clears its end, as sight has it, by
    # less than 0.1 mm, and R1's last full step ends 0.5 mm short of the ghost, behind the corner
    rim = [[0, 0, 10, 0], [10, 0, 10, 6], [10, 6, 0, 6], [0, 6, 0, 0]]
    size, none = np.array([10.0, 6.0]), np.empty((0, 4))
    office = Office("corner", size, np.array([*rim, [5, 0, 5, 3.0]]), none, none, none, ())
    path, links = office.edges(0.236)
    after, before = np.ascontiguousarray(links.T)
    w = Walls(*(office.edges(c)[0] for c in (0.22, 0.19, 0.235)), path, after, before)
    ghost, goal = np.array([4.0, 2.4401]), np.array([6.0, 4.4401])
    start = ghost - [0.0, 0.1505]
    settings, rng = Settings(), np.random.default_rng(0)
    assert sees(*ghost, *goal, settings.sight, w.sight)
    assert not sees(*ghost - [0.0, 0.0005], *goal, settings.sight, w.sight)

    crew = point_team.team(start[None], np.zeros((1, 3)), [-1], LITERAL, size, settings)
    point_team.begin(crew, *goal)
    crew.offered.active[0], crew.offered.length[0], crew.offered.taken[0] = True, 1, 1
    crew.offered.points[0, 0] = ghost
    route, modes = np.empty((0, 2)), []
    for _ in range(4):
        mode, x, y = point_team.before(crew, w, settings, point_team.Options(), rng)
        point_team.after(crew, mode, *point_team.towards(crew, x, y, settings), w, settings, route)
        modes.append(mode)
    assert modes == [OFFER, OFFER, GOAL, GOAL]
    assert crew.offered.vain[0] == 0


@pytest.mark.parametrize("err_max", [0.0, 0.4])
def test_mates_are_misperceived_as_section_6_1_says(err_max):
    _, goals, at, following, frames = _start(2)
    at = np.array([[4.0, 6.0], [7.0, 6.0]])  # 3 m apart in the corridor
    crew = point_team.team(at, frames * 0, following * 0 - 1, LITERAL, [16, 12], Settings())
    point_team.begin(crew, *goals[0])
    options = point_team.Options(noisy=True, err_max=err_max, robot_size=0.44)
    rng, found = np.random.default_rng(1), []
    for _ in range(4000):
        point_team.before(crew, walls(), Settings(), options, rng)
        found.append([crew.distance[0, 1], crew.distance[1, 0], crew.bearing[0, 1]])
    mine, its, bearing = np.array(found).T
    most = np.arctan(0.44 / 6.0)
    for values, limit in ((mine / 3 - 1, err_max), (its / 3 - 1, err_max), (bearing, most)):
        assert np.abs(values).max() <= limit + 1e-12
        assert np.std(values) == pytest.approx(limit / np.sqrt(3), rel=0.05)
    if err_max:
        assert abs(np.corrcoef(mine, its)[0, 1]) < 0.1  # each errs by itself


def test_lost_messages_and_dead_robots_are_not_heard():
    _, goals, _, following, frames = _start(2)
    at = np.array([[4.0, 6.0], [7.0, 6.0]])
    crew = point_team.team(at, frames * 0, following * 0 - 1, LITERAL, [16, 12], Settings())
    point_team.begin(crew, *goals[0])
    rng, heard = np.random.default_rng(1), []
    for _ in range(4000):
        point_team.before(crew, walls(), Settings(), point_team.Options(drop=0.2), rng)
        heard.append(crew.heard[0, 1])
    assert np.mean(heard) == pytest.approx(0.8, abs=0.03)
    crew.dead[1] = True
    point_team.before(crew, walls(), Settings(), point_team.Options(), rng)
    assert not crew.heard.any()
