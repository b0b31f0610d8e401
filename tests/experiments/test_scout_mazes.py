"""Mazes of the scouts and workers: the study's own, and files that cannot be."""

import json

import numpy as np
import pytest
import shapely

from experiments.scout_workers.mazes import GAP, ROBOT, load, maze
from mjmr.errors import InvalidInputError, UnknownNameError

GOOD = {"nest": [0.3, 0.3], "goal": [2.0, 2.0], "blocks": [[0.9, 0.9, 1.4, 1.4]]}


def loaded(tmp_path, size=2.5, **changed):
    """The maze ``m9`` of a file that has ``GOOD`` with these changes."""
    path = tmp_path / "mazes.json"
    kept = {key: value for key, value in (GOOD | changed).items() if value is not None}
    path.write_text(json.dumps({"size": size, "mazes": {"m9": kept}}))
    return load(path)["m9"]


def test_the_four_mazes_are_what_the_card_asks_for():
    mazes = load()
    assert list(mazes)[:4] == ["m1", "m2", "m3", "m4"]
    for found in list(mazes.values())[:4]:
        assert found.size == 2.5
        np.testing.assert_array_equal(found.nest, [0.3, 0.3])
        assert 1.5 <= np.hypot(*(found.goal - found.nest)) <= 3.0
        sides = found.blocks[:, 2:] - found.blocks[:, :2]
        assert sides.min() >= 0.3 - 1e-9
        assert sides.max() <= 0.6 + 1e-9
        assert found.free_space().geom_type == "Polygon"
        # from every block a robot's way leads round, but for the lip of m2 at the south wall
        for k, block in enumerate(found.blocks):
            rest = [shapely.box(*b) for i, b in enumerate(found.blocks) if i != k]
            nearest = min([shapely.distance(shapely.box(*block), s) for s in rest], default=np.inf)
            assert nearest >= GAP - 1e-9
    for found in mazes.values():  # those drawn since, too
        assert 1.5 <= np.hypot(*(found.goal - found.nest)) <= 3.0
        assert found.free_space().geom_type == "Polygon"
    assert maze("m1") is maze("m1"), "read and checked once"
    with pytest.raises(ValueError, match="read-only"):
        maze("m1").blocks[0] = 0.0
    with pytest.raises(UnknownNameError, match="unknown maze 'm5'; valid: m1, m2, m3, m4"):
        maze("m5")


def test_free_space_is_where_the_middle_of_a_robot_can_be(tmp_path):
    found = loaded(tmp_path)
    free = found.free_space()
    edge = 0.9 - ROBOT
    for x, y, fits in ((edge - 0.001, 1.1, True), (edge + 0.001, 1.1, False), (0.089, 1.0, False),
                       (0.091, 1.0, True), (0.83, 0.83, True), (0.84, 0.84, False)):  # fmt: skip
        assert free.contains(shapely.Point(x, y)) == fits, (x, y)


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"blocks": [[1.0, 1.0, 1.4, 1.4], [2.0, 1.0, 2.6, 1.5]]},
         r"maze m9: block 1 \(2, 1, 2.6, 1.5\) is out of the arena, 0 to 2.5 m"),
        ({"blocks": [[1.4, 1.0, 1.0, 1.4]]}, "maze m9: block 0 must have x0 < x1"),
        ({"goal": [1.1, 1.0]}, r"m9: the goal \(1.1, 1\) lies in block 0 \(0.9, 0.9, 1.4, 1.4\)"),
        ({"nest": [1.4, 1.4]}, r"maze m9: the nest \(1.4, 1.4\) lies in block 0"),
        ({"nest": [2.6, 1.4]}, r"maze m9: the nest \(2.6, 1.4\) is out of the arena"),
        ({"goal": [1.45, 1.0]}, r"does not fit on the goal \(1.45, 1\): block 0 is 0.05 m away"),
        ({"goal": [2.45, 1.0]}, r"does not fit on the goal .*: a wall is 0.05 m away"),
        ({"blocks": [[0.9, 0.9, 1.2, 1.2], [1.5, 0.9, 1.9, 1.2]]},
         "m9: block 0 and block 1 leave a gap of 0.3 m; a gap is 0.45 m or more, or below 0.18"),
        ({"blocks": [[0.9, 0.3, 1.2, 0.7]]}, "block 0 and the south wall leave a gap of 0.3 m"),
        ({"blocks": [[1.9, 1.0, 2.2, 1.3]]}, "block 0 and the east wall leave a gap of 0.3 m"),
        ({"blocks": [[0.0, 1.0, 2.5, 1.3]]},
         r"maze m9: no way of 0.18 m leads from the nest \(0.3, 0.3\) to the goal \(2, 2\)"),
        ({"blocks": [[0.0, 1.0, 1.2, 1.3], [1.3, 1.0, 2.5, 1.3]]}, "no way of 0.18 m leads"),
        ({"nest": None}, "maze m9: it has no nest"),
        ({"blocks": {}}, "maze m9: blocks is a list; got {}"),
        ({"blocks": [[1, 2, 3]]}, r"maze m9: block 0 must be 4 finite numbers; got \[1, 2, 3\]"),
        ({"goal": [1.0, "x"]}, r"maze m9: goal must be 2 finite numbers; got \[1.0, 'x'\]"),
        ({"goal": [1.0, float("nan")]}, "maze m9: goal must be 2 finite numbers"),
        ({"size": -1}, "size must be positive; got -1 m"),
        ({"size": "large"}, "size must be a finite number; got 'large'"),
    ],
)  # fmt: skip
def test_a_maze_that_cannot_be_is_refused_by_name(tmp_path, changed, words):
    with pytest.raises(InvalidInputError, match=words):
        loaded(tmp_path, **changed)


def test_a_gap_no_robot_fits_in_is_a_wall_and_may_be(tmp_path):
    assert len(loaded(tmp_path, blocks=[[0.8, 0.1, 1.2, 0.55]]).blocks) == 1
    assert len(loaded(tmp_path, blocks=[]).blocks) == 0


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('{"size": 2.5,\n "mazes": }', "mazes.json, line 2: no JSON"),
        ("[]", "a file of mazes has size and mazes, by name"),
        ('{"size": 2.5, "mazes": {"a": 3}}', "maze a: it has nest, goal and blocks; got 3"),
    ],
)
def test_a_file_that_is_none_is_refused(tmp_path, text, words):
    path = tmp_path / "mazes.json"
    path.write_text(text)
    with pytest.raises(InvalidInputError, match=words):
        load(path)
    with pytest.raises(InvalidInputError, match="cannot read mazes from"):
        load(tmp_path / "none.json")
