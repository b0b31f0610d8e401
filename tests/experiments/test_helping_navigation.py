"""The study of teammates that lend their eyes, point robots."""

import numpy as np
import pytest
from shapely.geometry import LineString

from controllers.helping import AvoidPast, PotentialField, VisBug
from experiments.helping_navigation import point, study
from experiments.helping_navigation.allowed import check
from experiments.helping_navigation.published import PUBLISHED
from experiments.helping_navigation.shortest import VisibilityGraph, office_graph
from mjmr.conditions import Grid
from mjmr.errors import InvalidInputError
from mjmr.office import free_space
from mjmr.parts import PartChoice
from mjmr.table import Row, Table

TRAP = {"scene": "trap", "world": "trap", "planner": "potential-field", "robots": 2, "targets": 1}
_NAMES = {"avoid-past": AvoidPast, "visbug": VisBug, "potential-field": PotentialField}


def _run(seed=1000, **given):
    return study.bound_trial()(study.condition(**given), seed)


@pytest.mark.parametrize("planner", list(_NAMES))
def test_same_seed_same_bits(planner):
    given = {
        "planner": planner, "robots": 4, "reading": "chain", "targets": 8, "noise": True,
        "err_max": 0.3, "fault": "radio", "shares_state": planner == "potential-field",
    }  # fmt: skip
    first = _run(**given)
    np.random.seed(7)  # noqa: NPY002 - nothing may depend on the global state
    assert _run(**given) == first
    assert _run(seed=1001, **given) != first


@pytest.mark.parametrize("planner", list(_NAMES))
def test_a_planner_in_python_takes_the_compiled_ones_place_bit_for_bit(planner):
    reference = f"controllers.helping:{_NAMES[planner].__name__}"
    swapped = study.choose([PartChoice("planner", reference)]).bound_trial()
    condition = study.condition(planner=planner, robots=3, reading="literal", targets=6)
    assert swapped(condition, 1000) == study.bound_trial()(condition, 1000)


def test_a_planner_that_returns_nonsense_is_named():
    choice = PartChoice("planner", "bad.py:Bad", source=(
        "class Bad:\n"
        "    def __init__(self, settings, walls, size): pass\n"
        "    def begin(self): pass\n"
        "    def pause(self, position): pass\n"
        "    def step(self, position, target, ranges): return [float('nan'), 0.0]\n"
    ))  # fmt: skip
    with pytest.raises(Exception, match="Bad"):
        study.choose([choice]).bound_trial()(study.condition(targets=1), 1000)


def test_the_trap_holds_goal_sharing_and_lets_go_of_state_sharing():
    stuck = _run(**TRAP, reading="literal")
    assert not stuck["reached"]
    assert stuck["offers"] > 0  # helped, but to no avail
    freed = _run(**TRAP, reading="literal", shares_state=True, level=5)
    assert freed["reached"]
    assert 2 <= freed["follows"] <= 10
    assert freed["longest_follow"] > freed["first_follow"]
    assert _run(**TRAP, reading="chain")["reached"]


def test_standing_mirrors_need_no_planner_and_a_dead_one_does():
    chain = {"scene": "chain", "robots": 4, "planner": "visbug", "targets": 5}
    for reading in ("literal", "chain"):
        found = _run(**chain, reading=reading)
        assert (found["calls"], found["reached"]) == (0, 5)
        assert found["steps"] < found["along"] * 1.02
    dead = _run(**chain, reading="literal", fault="dead")
    assert dead["calls"] > 0
    assert dead["reached"] == 5


def test_supporters_frames_do_not_matter_but_are_there():
    given = {"world": "world2", "planner": "visbug", "robots": 4, "reading": "chain", "targets": 10}
    points = point.targets("world2", 10, 1000)
    places, ghosts = [], []
    for fault in ("none", "lost"):
        condition = study.condition(**given, fault=fault)
        crew = point.patrolling(condition, points[0], 1000)
        point.drive(condition, crew, points[1:], point.CAP, 1000)
        places.append(crew.place[0])
        ghosts.append(crew.known.path[1, 0, 0])
    np.testing.assert_allclose(places[0], places[1], atol=1e-6)
    assert np.hypot(*(ghosts[0] - ghosts[1])) > 1.0


def test_a_chain_is_never_in_vain_without_noise():
    for planner in ("avoid-past", "visbug"):
        found = _run(planner=planner, robots=4, reading="chain", targets=30)
        assert found["offers"] > 10
        assert found["vain"] == 0


_FOUR = {"robots": 4, "reading": "chain"}


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"robots": 2}, "one robot has none, several have literal or chain"),
        ({"reading": "chain"}, "one robot has none, several have literal or chain"),
        ({"scene": "markers", **_FOUR}, "scene=markers .* allowed with mode=physical"),
        ({"scene": "markers", "mode": "physical"}, "scene=markers .* allowed with robots=4"),
        ({"scene": "markers", "mode": "physical", **_FOUR, "noise": True}, "with noise=false"),
        ({"world": "trap"}, "scene=tour .* world=trap; allowed with world=world1 or world2"),
        ({**TRAP, "reading": "chain", "world": "world1"}, "scene=trap .* with world=trap"),
        ({"scene": "chain", **_FOUR, "world": "world2"}, "scene=chain .* with world=world1"),
        ({"scene": "chain", "robots": 2, "reading": "chain"}, "scene=chain .* with robots=4"),
        ({"planner": "shortest-path", "scene": "trap", "world": "trap"}, "with scene=tour: it kno"),
        ({"planner": "shortest-path", **_FOUR}, "shortest-path .* allowed with robots=1"),
        ({"planner": "shortest-path", "mode": "physical"}, "with mode=point: it knows the map"),
        ({"fault": "dead"}, "fault=dead is of supporters, .* allowed with robots=2, 3 or 4"),
        ({"noise": True}, "noise is of supporters"),
        ({**_FOUR, "err_max": 0.2}, "err_max=0.2 .* allowed with noise=true"),
        ({"mode": "physical", **_FOUR, "fault": "dead", "world": "world2"}, "with world=world1"),
        ({**TRAP, "mode": "physical", "reading": "literal", "fault": "dead"}, "nobody to follow"),
    ],
)  # fmt: skip
def test_conditions_that_mean_nothing_are_refused(given, words):
    with pytest.raises(InvalidInputError, match=words):
        _run(**given)


def test_an_error_of_a_distance_is_a_share():
    with pytest.raises(InvalidInputError, match=r"err_max must be at most 0.99; got 1.5"):
        study.condition(err_max=1.5)


def test_targets_and_smaller_teams_are_shared():
    condition = study.condition(robots=4, reading="chain")
    fewer = study.condition(robots=2, reading="chain")
    start = point.targets("world1", 3, 5)[0]
    large, small = (point.patrolling(c, start, 5) for c in (condition, fewer))
    np.testing.assert_array_equal(large.place[:2], small.place)
    np.testing.assert_array_equal(point.targets("world1", 60, 5)[:4], point.targets("world1", 3, 5))


def test_shortest_ways():
    outline = [[0, 0, 10, 0], [10, 0, 10, 10], [10, 10, 0, 10], [0, 10, 0, 0]]
    polygon = free_space([10, 10], [*outline, [5, 0, 5, 6]], 0.5)
    points = np.asarray(polygon.exterior.coords)
    graph = VisibilityGraph(np.hstack([points[:-1], points[1:]]))
    # over both corners of the wall's end
    expected = np.hypot(2.5, 4.5) + 1.0 + np.hypot(2.5, 4.5)
    assert graph.length([2, 2], [8, 2]) == pytest.approx(expected, abs=1e-3)
    assert graph.length([2, 8], [8, 8]) == pytest.approx(6.0)
    assert graph.length([2, 2], [8, 2]) == pytest.approx(expected, abs=1e-3)  # nothing is left over


def test_no_robot_is_faster_than_a_map():
    points = point.targets("world2", 12, 1000)
    best = office_graph("world2", point.KEPT).tour(points) / 0.15
    condition = study.condition(world="world2", planner="visbug", robots=4, reading="chain")
    crew = point.patrolling(condition, points[0], 1000)
    steps, reached, _ = point.drive(condition, crew, points[1:], point.CAP, 1000)
    assert reached.all()
    # both ends of a leg may be 0.3 m short
    assert (steps >= best - 2 * 0.3 / 0.15 - 1).all()
    free = point.office("world2").free_space(point.KEPT)
    straight = [free.covers(LineString([a, b])) for a, b in zip(points, points[1:], strict=False)]
    for ok, way, a, b in zip(straight, best, points, points[1:], strict=False):
        if ok:
            assert way == pytest.approx(np.hypot(*(a - b)) / 0.15)


def test_the_papers_numbers():
    assert PUBLISHED["world1"]["visbug"][1] == (840.6, 7.6)
    assert PUBLISHED["world2"]["potential-field"][4] == (913.6, 4.7)
    assert 1 not in PUBLISHED["world1"]["potential-field"]


def test_sizes_are_declared_and_claims_load():
    for size in ("quick", "standard", "full"):
        for condition, _ in study.trials(size):
            check(condition)
    assert len(study.load_claims()) > 50


@pytest.mark.slow
def test_claims_and_plots_read_a_small_table(tmp_path):
    from experiments.helping_navigation.plots import plots, table_text
    from mjmr.claims import judge_all

    trial, rows = study.bound_trial(), []
    for grid in (
        Grid(planner=("avoid-past", "visbug"), targets=20),
        Grid(planner=("avoid-past", "visbug"), robots=4, reading=("literal", "chain"), targets=20),
    ):
        for condition in grid.conditions(study.parameters):
            rows += [Row(condition, s, "ok", trial(condition, s)) for s in (1000, 1001)]
    table = Table(rows, study.parameters)
    verdicts = {v.claim.id: v for v in judge_all(study.load_claims(), table, "quick")}
    assert not [v for v in verdicts.values() if v.error]
    assert verdicts["chain-four-against-one-visbug"].measured < 1.0
    written = plots(table, tmp_path)
    assert {p.name for p in written} >= {"table-world1.svg", "path-chain.svg"}
    assert all(p.stat().st_size > 5000 for p in written)
    assert "841 (7.6)" in table_text(table, "world1")
