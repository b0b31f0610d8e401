import numpy as np
import pytest

from controllers.helping import RAYS, AvoidPast, PotentialField, Settings, VisBug
from controllers.helping.patrol import advance, length, place
from controllers.schemas import AvoidPast as AvoidPastSchema
from controllers.schemas.visits import past, visit
from mjmr.errors import InvalidInputError


def test_the_potential_field_is_unit_and_pushed_off_walls():
    field, free = PotentialField(Settings()), np.full(32, 3.0)
    np.testing.assert_allclose(field.step(np.zeros(2), [3.0, 4.0], free), [0.6, 0.8])
    near = free.copy()
    near[np.cos(RAYS - np.pi / 2) > 0.5] = 0.3  # a wall to the left
    pushed = field.step(np.zeros(2), [3.0, 0.0], near)
    assert pushed[1] < -0.2
    assert np.hypot(*pushed) == pytest.approx(1.0)


def test_avoid_past_goes_where_it_has_not_been():
    planner, free = AvoidPast(Settings(bias=0.0)), np.full(32, 3.0)
    planner.begin()
    middle = planner._past.low + 5.5 * 0.4  # of a cell
    for k in range(12):  # up and down a row of cells
        planner.pause(middle + [0.4 * abs((k % 6) - 3), 0.0])
    vector = planner.step(middle, middle + [5.0, 0.0], free)
    assert vector[0] < 0.9


def _to_the_rim(at, size=10.0):
    """Free way (32,) [m] from a place to the walls of a square room, up to 3 m."""
    ways = np.stack([np.cos(RAYS), np.sin(RAYS)], axis=1)
    with np.errstate(divide="ignore"):
        return np.where(ways > 0, (size - at) / ways, -at / ways).clip(0.0, 3.0).min(axis=1)


def test_avoid_past_does_not_circle_in_a_cell():
    # a heading is held for the way of a cell, and every choice counts
    planner = AvoidPast(Settings())
    planner.begin()
    at, cells = np.array([5.0, 5.0]), set()
    for _ in range(600):
        at = at + 0.15 * planner.step(at, [9.0, 5.0], _to_the_rim(at))
        cells.add(tuple((at // 0.4).astype(int)))
    assert len(cells) > 60


def test_the_last_bits_of_a_place_do_not_decide_its_cell():
    # routes, doors and waypoints are at multiples of 5 cm; frames turned and back err by 1e-14 m
    round_numbers = np.arange(0.0, 26.0, 0.05).round(2)
    places = np.column_stack([round_numbers, round_numbers[::-1]])
    been = past(np.zeros(2), np.full(2, 26.0), 0.4)
    schema = AvoidPastSchema("place", walls="walls").start(1, np.random.default_rng(0))
    for grid in (been, schema):
        lower, upper = (np.floor((places + e - grid.low) / 0.4) for e in (-1e-9, 1e-9))
        np.testing.assert_array_equal(lower, upper)
    for point in places:
        for error in (-1e-9, 1e-9):
            visit(been, *(point + error), 0.4)
    assert been.visits.sum() == len(np.unique(np.floor((places - been.low) / 0.4), axis=0))


def test_visbug_wants_walls():
    with pytest.raises(InvalidInputError, match="walls"):
        VisBug(Settings())


def test_a_patrol_goes_its_route_at_one_pace():
    route = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]])
    assert length(route) == pytest.approx(12.0)
    assert place(route, 5.0) == (4.0, 1.0, 2)
    x, y, following = place(route, 0.0)
    for _ in range(80):
        x, y, following = advance(x, y, following, route, 0.15)
    np.testing.assert_allclose([x, y], [0, 0], atol=1e-9)  # 80 steps of 0.15 m: once round
