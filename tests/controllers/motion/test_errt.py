import numpy as np
import pytest

from controllers.motion import ErrtConfig, Planner
from mjmr.errors import InvalidInputError
from tests.controllers.motion.scenes import BOUNDS, RADIUS, box_distance

STAGGERED = np.array([[-0.7, 0.35, 0.0, 0.3, 0.75], [0.7, -0.2, 0.0, 0.3, 0.9]])
START, GOAL = np.array([-2.0, 0.0]), np.array([2.0, 0.2])


def planner(seed=0, boxes=STAGGERED, **settings):
    config = ErrtConfig(**settings)
    return Planner(BOUNDS, boxes, RADIUS, config, np.random.default_rng(seed))


def clear(a, b, boxes, gap):
    path = a + np.linspace(0, 1, 400)[:, None] * (b - a)
    return min(box_distance(path, box).min() for box in boxes) >= gap - 1e-12


def follow(p, step=0.03):
    """Drive 30 mm a cycle towards the waypoint; cycles until within 45 mm, mean iterations."""
    x, iterations = START.copy(), []
    for cycle in range(1000):
        plan = p.plan(x, GOAL)
        iterations.append(plan.iterations)
        assert clear(x, plan.waypoint, STAGGERED, RADIUS + 0.015)
        d = plan.waypoint - x
        x = x + d * min(1.0, step / np.linalg.norm(d))
        if np.linalg.norm(x - GOAL) < 0.045:
            return cycle, np.mean(iterations)
    raise AssertionError(f"not there after 1000 cycles, at {x}")


def test_repeated_plans_all_succeed_with_2000_nodes():
    p = planner()
    plans = [p.plan(START, GOAL) for _ in range(40)]
    assert all(plan.success for plan in plans)
    for plan in plans:
        assert plan.nodes > 0
        assert clear(START, plan.waypoint, STAGGERED, RADIUS + 0.015)


def test_the_cache_makes_success_likelier_and_trees_smaller():
    boxes = np.array([[-0.5, 0.5, 0.0, 0.3, 0.75], [0.5, -0.5, 0.0, 0.3, 0.9]])

    def forty_plans(q, nodes):
        for seed in range(10):
            p = planner(seed, boxes, waypoint_probability=q, max_nodes=nodes)
            yield from (p.plan(START, GOAL) for _ in range(40))

    success = {q: np.mean([p.success for p in forty_plans(q, 500)]) for q in (0.0, 0.6)}
    assert success[0.6] > success[0.0]
    iterations = {q: np.median([p.iterations for p in forty_plans(q, 2000)]) for q in (0.0, 0.6)}
    assert iterations[0.6] < iterations[0.0]


def test_followed_waypoints_lead_past_the_boxes_and_the_cache_saves_iterations():
    work = {}
    for q in (0.0, 0.6):
        runs = [follow(planner(seed, waypoint_probability=q)) for seed in range(4)]
        assert max(cycles for cycles, _ in runs) < 400
        work[q] = np.mean([iterations for _, iterations in runs])
    assert work[0.6] < work[0.0]


def test_a_free_straight_line_is_taken_at_once():
    plan = planner(boxes=None).plan(START, GOAL)
    np.testing.assert_array_equal(plan.waypoint, GOAL)
    assert (plan.success, plan.nodes, plan.iterations) == (True, 0, 0)


def test_discs_are_gone_around():
    disc = [[0.0, 0.1, 0.09]]
    plan = planner(boxes=None).plan(START, GOAL, disc)
    assert plan.success
    assert plan.nodes > 0
    path = START + np.linspace(0, 1, 500)[:, None] * (plan.waypoint - START)
    gap = np.linalg.norm(path - [0.0, 0.1], axis=1).min()
    assert gap >= 2 * RADIUS + 0.03 - 1e-12


def test_starts_inside_obstacles_do_not_stop_it():
    touching = planner().plan([-0.7 - 0.3 - 0.08, 0.35], GOAL)
    assert touching.success
    inside = planner(boxes=None).plan([0.0, 0.0], GOAL, [[0.05, 0.0, 0.09], [-0.1, 0.05, 0.09]])
    assert np.isfinite(inside.waypoint).all()
    outside = planner().plan([-3.0, 0.0], GOAL)
    assert outside.success


def test_an_unreachable_goal_is_approached():
    walls = [[0.0, 0.0, 0.0, 0.05, 3.0]]
    plan = planner(boxes=walls, max_nodes=800).plan(START, GOAL)
    assert not plan.success
    assert plan.iterations == 800
    assert plan.waypoint[0] < -0.05 - RADIUS
    assert np.linalg.norm(plan.waypoint - GOAL) < np.linalg.norm(START - GOAL)


def test_plans_depend_on_their_generator_alone():
    def plans():
        p = planner(seed=7)
        out = []
        for _ in range(10):
            np.random.random()  # noqa: NPY002 - stirs the global state on purpose
            out.append(p.plan(START, GOAL).waypoint)
        return np.array(out)

    np.testing.assert_array_equal(plans(), plans())
    assert (plans() != np.array([planner(8).plan(START, GOAL).waypoint] * 10)).any()


@pytest.mark.parametrize(
    ("settings", "name"),
    [
        ({"goal_probability": -0.1}, "goal_probability"),
        ({"goal_probability": 0.5, "waypoint_probability": 0.6}, "waypoint_probability"),
        ({"cache_size": 0}, "cache_size"),
        ({"max_nodes": 0}, "max_nodes"),
        ({"box_clearance": -0.1}, "box_clearance"),
        ({"disc_clearance": np.nan}, "disc_clearance"),
    ],
)
def test_config_errors_name_the_field(settings, name):
    with pytest.raises(InvalidInputError, match=name):
        ErrtConfig(**settings)


def test_plan_errors_name_the_argument():
    for name, args in {
        "start": ([0.0], GOAL),
        "goal": (START, [np.nan, 0.0]),
        "discs": (START, GOAL, [[0.0, 0.0]]),
    }.items():
        with pytest.raises(InvalidInputError, match=name):
            planner().plan(*args)
    with pytest.raises(InvalidInputError, match="radius"):
        Planner(BOUNDS, None, 0.0, ErrtConfig(), np.random.default_rng(0))
