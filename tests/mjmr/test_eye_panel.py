"""Films through a robot's camera, of an area, with pillars; and what pictures leave out."""

import copy

import mujoco
import numpy as np
import pytest

from mjmr import Camera, Film, FilmOptions, Recording, Simulation, TamiyaTXT1, World
from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.render import Renderer

OPTIONS = FilmOptions(width=640, height=484)


@pytest.fixture(scope="module")
def recording():
    world = World.rectangle(40.0, 40.0, wall_height=0.6, floor="concrete")
    world.add_pillar(8.0, 0.0, 4.0, growth=0.5, limit=6.0)
    trucks = world.add_group(TamiyaTXT1, [[0.0, 0.0, 0.0], [0.0, 3.0, 1.0], [-3.0, 0.0, 0.2]])
    trucks.mount(Camera(position=(0.1, 0.1, 0.42), look_at=(4.0, 0.0, 0.0)), "eye")
    simulation = Simulation(world, control_period=0.1, dt_max=0.01)
    recorded = Recording(simulation)
    for _ in simulation.ticks(3.0):
        pass
    return recorded


def red(picture):
    return (picture[..., 0] > 100) & (picture[..., 1] < 60)


def test_a_pillar_grows_in_the_film(recording):
    film = Film("t", OPTIONS)
    film.add(recording)
    early, late = (np.count_nonzero(red(film.still(t))) for t in (0.0, 2.9))
    assert late / early == pytest.approx((5.45 / 4.0) ** 2, rel=0.06)


def test_an_area_is_shown_larger(recording):
    whole, part = Film("t", OPTIONS), Film("t", OPTIONS)
    whole.add(recording)
    part.add(recording, area=(-2.0, -10.0, 18.0, 10.0))
    counts = [np.count_nonzero(red(film.still(0.0))) for film in (whole, part)]
    assert counts[1] > 3 * counts[0]


def test_an_eye_shows_the_robot_s_view_and_what_is_made_of_it(recording):
    film = Film("t", OPTIONS)
    name = "tamiya_txt10/eye"
    film.add_eye(recording, name, paint=lambda p: np.full_like(p, (0, 255, 0)))
    picture = film.still(1.0)[44:]
    upper, lower = picture[:220], picture[220:]
    assert np.count_nonzero(red(upper)) > 2000
    green = (lower == (0, 255, 0)).all(axis=2)
    assert green[60:160, 250:390].all()
    assert not np.count_nonzero(red(lower))


@pytest.mark.parametrize("sides", [20, 90])
def test_what_pictures_leave_out_is_not_in_them(recording, sides, monkeypatch):
    footage = recording.footage()
    data = mujoco.MjData(footage.model)
    data.qpos[:] = footage.positions[-1]
    mujoco.mj_kinematics(footage.model, data)
    mujoco.mj_camlight(footage.model, data)
    with Renderer(footage.model, 160, 120, sides=sides) as renderer:
        groups = renderer.model.geom_group.copy()
        for k in range(3):
            eye = f"tamiya_txt1{k}/eye"
            few = renderer.picture(data, eye)
            # the model is everybody's: another camera, or a film, is to see all of it
            assert np.array_equal(renderer.model.geom_group, groups)
            counted = renderer._renderer.scene.ngeom
            with monkeypatch.context() as all_of_it:
                all_of_it.setattr(renderer, "leaves_out", False)
                every = renderer.picture(data, eye)
            assert counted < renderer._renderer.scene.ngeom - 50
            assert np.array_equal(few, every)


def test_a_camera_without_perspective_leaves_out_nothing(recording):
    footage = recording.footage()
    data = mujoco.MjData(footage.model)
    data.qpos[:] = footage.positions[-1]
    mujoco.mj_kinematics(footage.model, data)
    mujoco.mj_camlight(footage.model, data)
    model = copy.copy(footage.model)
    eye = "tamiya_txt10/eye"
    model.cam_projection[model.camera(eye).id] = mujoco.mjtProjection.mjPROJ_ORTHOGRAPHIC
    model.cam_fovy[model.camera(eye).id] = 20.0  # m, of such a camera
    with Renderer(model, 160, 120) as renderer:
        few = renderer.picture(data, eye)
        renderer.leaves_out = False
        assert np.array_equal(few, renderer.picture(data, eye))


def test_an_unknown_camera_is_told_from_those_there_are(recording):
    film = Film("t", OPTIONS)
    with pytest.raises(UnknownNameError, match="tamiya_txt10/eye"):
        film.add_eye(recording, "tamiya_txt10/ear")


@pytest.mark.parametrize(
    "area", [(0.0, 1.0, 2.0), (2.0, 0.0, 1.0, 1.0), (0.0, 0.0, np.nan, 1.0), "wide"]
)
def test_an_area_is_four_numbers_in_order(recording, area):
    with pytest.raises(InvalidInputError, match=r"xmin, ymin, xmax, ymax"):
        Film("t", OPTIONS).add(recording, area=area)
