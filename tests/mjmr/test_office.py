import copy
import json

import numpy as np
import pytest
from shapely.geometry import Point

from mjmr.errors import InvalidInputError
from mjmr.office import load_office
from tests.controllers.helping.offices import FOLDER

ROOM = {
    "name": "two rooms",
    "size": [10, 6],
    "walls": [[0, 0, 10, 0], [10, 0, 10, 6], [10, 6, 0, 6], [0, 6, 0, 0], [5, 0, 5, 2.5],
              [5, 3.5, 5, 6]],
    "doors": [{"x": 5, "y": 3, "dir": "v", "width": 1.0}],
    "rooms": [{"rect": [0, 0, 5, 6], "goal": [1, 1, 3, 5]},
              {"rect": [5, 0, 10, 6], "goal": [6, 1, 9, 5]}],
    "routes": [[[2, 3], [8, 3]]],
}  # fmt: skip


def _load(tmp_path, change=lambda given: None, clearance=0.22):
    given = copy.deepcopy(ROOM)
    change(given)
    path = tmp_path / "office.json"
    path.write_text(json.dumps(given, indent=1))
    return load_office(path, clearance)


@pytest.mark.parametrize("name", ["world1", "world2", "trap"])
def test_the_studys_offices_are_sound(name):
    office = load_office(FOLDER / f"{name}.json")
    edges, links = office.edges(0.22)
    free = office.free_space(0.22)
    np.testing.assert_array_equal(edges[:, 2:], edges[links[:, 0], :2])
    np.testing.assert_array_equal(edges[:, :2], edges[links[:, 1], 2:])
    middle = (edges[:, :2] + edges[:, 2:]) / 2
    along = edges[:, 2:] - edges[:, :2]
    left = np.column_stack([-along[:, 1], along[:, 0]]) / np.hypot(*along.T)[:, None]
    assert all(free.contains(Point(p)) for p in middle + 1e-3 * left)
    rng = np.random.default_rng(0)
    for room in range(len(office.goals)):
        assert free.contains(Point(office.goal(room, rng, free)))


def test_a_sound_file_is_read(tmp_path):
    office = _load(tmp_path)
    assert office.walls.shape == (6, 4)
    assert office.doors.tolist() == [[5, 3, 1, 0]]
    assert len(office.edges(0.22)[0]) == 12


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda g: g["walls"].pop(1), r"size \(line 3\) does not close.*east side from"),
        (lambda g: g["walls"][4].__setitem__(3, 2.0),
         r"room 0 \(line \d+\) does not close.*east.*\(5, 2\).*\(5, 2.5\).*wall 4 \(line 32\)"),
        (lambda g: g["doors"].pop(), "room 0 .*does not close.*neither wall nor door"),
        (lambda g: g["rooms"][1].__setitem__("goal", [4.5, 1, 9, 2]), "room 1 .*in wall 4"),
        (lambda g: g["rooms"][1].__setitem__("goal", [9, 1, 11, 2]), "room 1 .*outside"),
        (lambda g: g["rooms"][0].__setitem__("goal", [0.0, 1, 0.2, 5]), "room 0 .*cannot get"),
        (lambda g: g["routes"].append([[2, 1], [8, 1]]), "route 1 .*crosses a wall.*wall 4"),
        (lambda g: g["routes"].append([[2, 1]]), "route 1 .*two waypoints"),
        (lambda g: g["routes"].append(7), r"route 1 \(line \d+\) needs two waypoints.*not 7"),
        (lambda g: g["routes"].append("far"), r"route 1 \(line \d+\) needs two waypoints"),
        (lambda g: g["routes"][0].append([5]), r"waypoint 2 \(line \d+\).*2 numbers, not \[5\]"),
        (lambda g: g["walls"].append([1, 1, 1, 1]), "wall 6 .*no length"),
        (lambda g: g["walls"].append([1, 1, 11, 1]), "wall 6 .*leaves"),
        (lambda g: g["walls"].append([1, 1, "x", 1]), "wall 6 .*4 numbers"),
        (lambda g: g["doors"][0].__setitem__("dir", "d"), "door 0 .*dir h or v"),
        (lambda g: g["doors"][0].__setitem__("width", 0.0), "door 0 .*above 0"),
        (lambda g: g["rooms"][0].__setitem__("rect", [5, 0, 0, 6]), "room 0 .*rect that is empty"),
        (lambda g: g.pop("rooms"), "rooms must not be empty"),
        (lambda g: g.pop("size"), "size must be 2 numbers"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named(tmp_path, change, words):
    with pytest.raises(InvalidInputError, match=words):
        _load(tmp_path, change)


def test_the_line_named_is_the_entrys(tmp_path):
    path = tmp_path / "office.json"
    text = json.dumps(ROOM, indent=1).replace("8,\n    3", "8,\n    5.95")
    path.write_text(text)
    with pytest.raises(InvalidInputError, match=r"route 0 \(line (\d+)\)") as e:
        load_office(path)
    line = int(str(e.value).partition("(line ")[2].partition(")")[0])
    assert text.splitlines()[line - 1].strip() == "["
    assert '"routes"' in text.splitlines()[line - 2]


def test_the_line_of_a_waypoint_is_named(tmp_path):
    path = tmp_path / "office.json"
    text = json.dumps(ROOM, indent=1).replace("8,\n    3", '8,\n    "x"')
    path.write_text(text)
    with pytest.raises(InvalidInputError, match=r"waypoint 1 \(line \d+\), which must be") as e:
        load_office(path)
    line = int(str(e.value).rpartition("(line ")[2].partition(")")[0])
    lines = [row.strip() for row in text.splitlines()]
    assert lines[line - 1 : line + 2] == ["[", "8,", '"x"']


def test_not_an_office(tmp_path):
    path = tmp_path / "office.json"
    path.write_text("[1, 2")
    with pytest.raises(InvalidInputError, match="cannot read office"):
        load_office(path)
    path.write_text("[1, 2]")
    with pytest.raises(InvalidInputError, match="expected an object"):
        load_office(path)


def test_a_door_too_narrow_for_the_robot(tmp_path):
    with pytest.raises(InvalidInputError, match=r"cannot get|crosses a wall"):
        _load(tmp_path, clearance=0.55)
