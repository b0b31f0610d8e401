import mujoco
import numpy as np
import pytest

from mjmr import World
from mjmr.errors import InvalidInputError
from mjmr.notes import stack_notes


def test_marks_are_painted_and_felt_by_nothing():
    world = World.rectangle(4.0, 4.0)
    world.add_mark(1.0, 0.5, radius=0.3)
    world.add_mark(-1.0, 0.0, length=1.0, width=0.4, yaw=np.pi / 2, rgba=(0, 0, 1, 1))
    plain, painted = World.rectangle(4.0, 4.0).spec().compile(), world.spec().compile()
    assert painted.ngeom == plain.ngeom + 2
    disc, rectangle = painted.ngeom - 2, painted.ngeom - 1
    assert (painted.geom_contype[disc:] == 0).all()
    assert (painted.geom_conaffinity[disc:] == 0).all()
    assert painted.geom_type[disc] == mujoco.mjtGeom.mjGEOM_CYLINDER
    assert painted.geom_size[disc, 0] == 0.3
    assert painted.geom_size[rectangle, :2].tolist() == [0.5, 0.2]
    assert painted.geom_rgba[rectangle].tolist() == [0, 0, 1, 1]


@pytest.mark.parametrize(
    "sides",
    [{}, {"radius": -1.0}, {"radius": np.nan}, {"radius": np.inf}, {"length": np.inf, "width": 1.0},
     {"length": 1.0}, {"radius": 1.0, "length": 1.0, "width": 1.0}],
)  # fmt: skip
def test_a_mark_without_extent_is_refused(sides):
    with pytest.raises(InvalidInputError, match="a mark has a positive radius, or"):
        World.rectangle(4.0, 4.0).add_mark(0.0, 0.0, **sides)


def test_a_mark_that_is_nowhere_is_refused():
    world = World.rectangle(4.0, 4.0)
    with pytest.raises(InvalidInputError, match="place, yaw and colour must be finite"):
        world.add_mark(np.nan, 0.0, radius=0.1)
    with pytest.raises(InvalidInputError, match="place, yaw and colour must be finite"):
        world.add_mark(0.0, 0.0, length=1.0, width=1.0, yaw=np.nan)
    with pytest.raises(InvalidInputError, match=r"within the walls, x -2 to 2 .* got \(2.5, 0\)"):
        world.add_mark(2.5, 0.0, radius=0.1)
    assert not world.marks


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"start": (1.0, 2.0, 3.0)}, r"a wall's start must be two finite numbers \(x, y\); got"),
        ({"start": 1.0}, "a wall's start must be"),
        ({"end": (np.nan, 1.0)}, r"a wall's end must be two finite numbers .* got \(nan, 1.0\)"),
        ({"end": ((1.0, 2.0), (3.0,))}, "a wall's end must be"),
        ({"thickness": np.nan}, "thickness must be positive and finite; got nan m"),
        ({"thickness": 0.0}, "thickness must be positive and finite; got 0.0 m"),
    ],
)
def test_a_wall_that_cannot_be_is_refused(given, words):
    world = World.rectangle(10.0, 10.0)
    with pytest.raises(InvalidInputError, match=words):
        world.add_wall(**({"start": (0.0, 0.0), "end": (1.0, 0.0)} | given))
    assert not world.props


def test_a_wall_stands_along_its_line():
    world = World.rectangle(10.0, 10.0)
    wall = world.add_wall((1.0, 1.0), (1.0, 3.0), thickness=0.2, height=0.5)
    assert (wall.x, wall.y, wall.length, wall.width, wall.height) == (1.0, 2.0, 2.0, 0.2, 0.5)
    assert wall.yaw == pytest.approx(np.pi / 2)
    assert world.boxes[0] == pytest.approx([1.0, 2.0, np.pi / 2, 1.0, 0.1])
    with pytest.raises(InvalidInputError, match="positive length"):
        world.add_wall((1.0, 1.0), (1.0, 1.0))


def test_notes_of_changing_length_become_one_table():
    notes = [{}, {"points": np.ones((1, 2))}, {"points": np.zeros((3, 2))}]
    table = stack_notes("points", notes, n=2)
    assert table.shape == (3, 3, 2)
    assert np.isnan(table[0]).all()
    assert np.isnan(table[1, 1:]).all()
    assert (table[2] == 0).all()
    assert stack_notes("links", [{}, {"links": np.eye(2)}], n=2).shape == (2, 2, 2)
