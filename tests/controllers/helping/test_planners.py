import numpy as np
import pytest

from controllers.helping import RAYS, AvoidPast, HelpingTeam, PotentialField, Settings, VisBug
from controllers.helping.patrol import advance, length, place
from mjmr.errors import InvalidInputError, UnknownNameError


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
    for k in range(12):  # up and down the positive x axis
        planner.pause(np.array([0.4 * abs((k % 6) - 3) + 0.2, 0.2]))
    vector = planner.step(np.array([0.2, 0.2]), [5.0, 0.2], free)
    assert vector[0] < 0.9


def test_avoid_past_does_not_circle_in_a_cell():
    # a heading is held for the way of a cell, and every choice counts
    planner = AvoidPast(Settings())
    planner.begin()
    at, cells = np.array([5.0, 5.0]), set()
    for _ in range(600):
        at = np.clip(at + 0.15 * planner.step(at, [9.0, 5.0], np.full(32, 3.0)), 0, 10)
        cells.add(tuple((at // 0.4).astype(int)))
    assert len(cells) > 60


def test_visbug_wants_walls():
    with pytest.raises(InvalidInputError, match="walls"):
        VisBug(Settings())


def test_unknown_reading_and_no_robots_are_refused():
    with pytest.raises(UnknownNameError, match="chain"):
        HelpingTeam(2, "letter", PotentialField(Settings()))
    with pytest.raises(InvalidInputError, match="at least one"):
        HelpingTeam(0, "chain", PotentialField(Settings()))


def test_a_patrol_goes_its_route_at_one_pace():
    route = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]])
    assert length(route) == pytest.approx(12.0)
    assert place(route, 5.0) == (4.0, 1.0, 2)
    x, y, following = place(route, 0.0)
    for _ in range(80):
        x, y, following = advance(x, y, following, route, 0.15)
    np.testing.assert_allclose([x, y], [0, 0], atol=1e-9)  # 80 steps of 0.15 m: once round
