"""The team for callers that sense by themselves, against the compiled point robots."""

import numpy as np
import pytest

from controllers.helping import (
    CHAIN,
    GOAL,
    LITERAL,
    OFFER,
    PLAN,
    PLANNERS,
    RAYS,
    AvoidPast,
    HelpingTeam,
    PotentialField,
    Settings,
    VisBug,
    patrol,
    point_team,
)
from controllers.helping.visibility import Walls, cast, move, sees
from mjmr.office import Office
from tests.controllers.helping.offices import inside, place, walls

_CLASSES = {"avoid-past": AvoidPast, "visbug": VisBug, "potential-field": PotentialField}


def _into(frame, point):
    c, s = np.cos(frame[2]), np.sin(frame[2])
    dx, dy = point[0] - frame[0], point[1] - frame[1]
    return np.array([c * dx + s * dy, -s * dx + c * dy])


def _out_of(frame, point):
    c, s = np.cos(frame[2]), np.sin(frame[2])
    return frame[:2] + [c * point[0] - s * point[1], s * point[0] + c * point[1]]


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


@pytest.mark.parametrize("reading", ["literal", "chain"])
@pytest.mark.parametrize("planner", list(PLANNERS))
def test_the_class_does_what_the_compiled_loop_does(planner, reading):
    n, settings, w = 3, Settings(), walls()
    office, goals, at, following, frames = _start(n)
    state = planner == "potential-field"
    crew = point_team.team(
        at, frames, following, LITERAL if reading == "literal" else CHAIN, office.size, settings
    )
    steps, reached = np.zeros(3, dtype=np.int64), np.zeros(3, dtype=bool)
    trace = np.zeros((3000, n + 1, 2))
    options = point_team.Options(shares_state=state)
    rng, route = np.random.default_rng(0), office.routes[0]
    point_team.run(
        crew,
        PLANNERS[planner],
        goals,
        1000,
        w,
        settings,
        options,
        route,
        rng,
        steps,
        reached,
        trace,
    )

    team = HelpingTeam(
        n, reading, _CLASSES[planner](settings, w, office.size), settings, shares_state=state
    )
    now, ranges, visited = 0, np.zeros(32), set()
    for goal, count in zip(goals, steps, strict=True):
        team.new_goal(goal)
        mode = PLAN
        for _ in range(count):
            own = np.array([_into(f, p) for f, p in zip(frames, at, strict=True)])
            heard = np.array([[i != j and sees(*at[i], *at[j], 8.0, w.sight) for j in range(n)]
                              for i in range(n)])  # fmt: skip
            away = at[None] - at[:, None]
            bearing = np.arctan2(away[..., 1], away[..., 0]) - frames[:, None, 2]
            team.share(own, heard, np.hypot(away[..., 0], away[..., 1]), bearing)

            def looks(i, point, edges):
                if np.isnan(point[0]):
                    return False
                return sees(*at[i], *_out_of(frames[i], point), 8.0, edges)

            ask = team.points()
            team.reflect(
                [looks(i, ask.goal[i], w.sight) for i in range(n)],
                [looks(i, ask.ghost[i], w.sight) for i in range(n)],
            )
            sees_goal = looks(0, goal, w.kept if mode == GOAL else w.sight)
            mode, target = team.decide(sees_goal, looks(0, team.points().next, w.sight))
            np.testing.assert_allclose(at[0], trace[now, 0], atol=1e-6)
            assert mode == trace[now, n, 0]
            cast(*at[0], RAYS, 3.0, w.motion, ranges)
            vx, vy = team.steer(mode, target, ranges)
            size = max(np.hypot(vx, vy), 1e-12)  # it may wait
            at[0] = move(*at[0], vx / size, vy / size, min(size, 1.0) * 0.15, w.motion,
                         mode != PLAN or planner == "visbug")  # fmt: skip
            for i in range(1, n):
                x, y, following[i] = patrol.advance(*at[i], following[i], route, 0.15)
                at[i] = x, y
            now += 1
            visited.add(mode)
    assert {PLAN, GOAL} <= visited
    assert reached.any()


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
