"""Films and their overlays, looked at with OpenCV and PyAV."""

import av
import cv2
import mujoco
import numpy as np
import pytest

from mjmr.bench import films
from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.film import Film, corner_camera, overview_camera
from mjmr.film_options import FilmOptions
from mjmr.geometry import Pinhole
from mjmr.kinematics import KinematicSimulation
from mjmr.overlay import draw_ring
from mjmr.recording import Recording
from mjmr.render import Renderer
from mjmr.simulation import Simulation
from mjmr.video import VideoWriter
from tests.mjmr.worlds import soccer


def record(kind=Simulation, seconds=1.0):
    world, robots = soccer([[-1.0, 0.8, 0.0], [1.0, -0.8, 0.0]])
    world.add_golf_ball(0.0, 0.0)
    simulation = kind(world)
    recording = Recording(simulation, lambda: f"t {simulation.time:.1f}")
    for _ in simulation.ticks(seconds):
        robots.drive(np.tile([0.5, 0.0, 0.0], (2, 1)))
        recording.note(goals=[[1.0, 0.8], [2.0, -0.8]])
    return recording


def test_a_film_plays_in_browsers_and_has_the_right_length(tmp_path):
    film = Film("title", FilmOptions(width=320, height=240))
    film.add(record(seconds=2.0))
    path = film.write(tmp_path / "film.mp4")
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        assert stream.codec_context.name == "h264"
        assert stream.codec_context.pix_fmt == "yuv420p"
        assert (stream.width, stream.height) == (320, 240)
        assert sum(1 for _ in container.decode(stream)) == 60
    content = path.read_bytes()
    assert content.index(b"moov") < content.index(b"mdat"), "the index must come first"
    assert list(tmp_path.iterdir()) == [path], "no partial file is left"


def test_a_film_never_exceeds_a_minute():
    film = Film("t", FilmOptions(width=320, height=240))
    recording = record(KinematicSimulation, seconds=90.0)
    film.add(recording)
    assert film.speed == pytest.approx(1.5)
    assert len(film._frame_times()) <= 60 * 30


def test_projection_puts_overlays_where_things_are_drawn():
    """The dot on top of a robot, found by colour, is where the camera model projects it."""
    world, _ = soccer([[-1.0, 0.8, 0.0], [1.3, -1.1, 0.0]])
    simulation = Simulation(world)
    camera = overview_camera(world.bounds, 640 / 480, simulation.model)
    with Renderer(simulation.model, 640, 480) as renderer:
        picture = renderer.picture(simulation.data, camera)
        view = renderer.view()
    yellow = cv2.inRange(cv2.cvtColor(picture, cv2.COLOR_RGB2HSV), (22, 150, 120), (32, 255, 255))
    for x, y in ((-1.0, 0.8), (1.3, -1.1)):
        u, v = view.project(np.array([x, y, 0.1538]))
        # the dot is 50 mm wide, about 5 px here; the ring around the hull starts 8 px away
        left, top = round(u) - 6, round(v) - 6
        rows, columns = np.nonzero(yellow[top : top + 13, left : left + 13])
        assert len(rows) > 5
        assert abs(columns.mean() + left + 0.5 - u) < 1.0
        assert abs(rows.mean() + top + 0.5 - v) < 1.0


@pytest.mark.parametrize("whole", [overview_camera, corner_camera])
def test_everything_of_the_world_is_in_the_picture(whole):
    world, _ = soccer([[0.0, 0.0, 0.0]])
    model = world.spec().compile()
    for width, height in ((640, 676), (1280, 676), (300, 900)):
        with Renderer(model, width, height) as renderer:
            simulation = Simulation(world)
            renderer.picture(simulation.data, whole(world.bounds, width / height, model))
            view = renderer.view()
        x0, y0, x1, y1 = world.bounds
        corners = view.on_floor(np.array([[x0, y0], [x0, y1], [x1, y0], [x1, y1]]))
        assert (corners > 0).all()
        assert (corners < [width, height]).all()


def test_goals_are_drawn_into_the_picture_and_missing_ones_are_not():
    film = Film("t", FilmOptions(width=640, height=480))
    film.add(record())
    with_goals = film.still(1.0)
    before = film.still(0.0)
    assert (with_goals != before).any()
    blank = np.zeros((50, 50, 3), np.uint8)
    view = Pinhole(np.array([0, 0, 2.0]), np.diag([1.0, -1.0, -1.0]), 50.0, 50, 50)
    draw_ring(blank, view, np.array([np.nan, 0.0]), 0.1, (255, 255, 255))
    assert not blank.any()
    draw_ring(blank, view, np.array([0.0, 0.0]), 0.1, (255, 255, 255))
    assert blank.any()


def test_a_moving_robot_moves_in_the_film():
    film = Film("t", FilmOptions(width=640, height=480))
    film.add(record(seconds=2.0))
    difference = cv2.absdiff(film.still(0.1), film.still(1.9)).max(axis=2)
    assert (difference > 60).sum() > 100


def test_chase_follows_the_robot():
    film = Film("t", FilmOptions(width=320, height=240, camera="chase", follow=1))
    film.add(record())
    assert film.still(0.5).std() > 5.0


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"camera": "chaise"}, "valid: chase"),
        ({"look": "finer"}, "valid: fine"),
        ({"width": 321}, "even"),
        ({"fps": 0}, "at least 1"),
        ({"speed": 0.0}, "positive"),
    ],
)
def test_bad_film_options_are_refused(options, message):
    with pytest.raises((InvalidInputError, UnknownNameError), match=message):
        FilmOptions(**options)


def test_notes_are_checked():
    recording = record(seconds=0.1)
    with pytest.raises(UnknownNameError, match="goals"):
        recording.note(goal=[[0, 0], [0, 0]])
    with pytest.raises(InvalidInputError, match=r"\(2, 2\)"):
        recording.note(goals=[[0, 0]])
    with pytest.raises(InvalidInputError, match="at least one"):
        Film("t").still(0.0)


def test_drafts_draw_the_floor_as_a_box_and_nobody_can_tell(monkeypatch):
    footage = record().footage()
    stills = []
    for camera in ("overview", "chase"):
        for plain in (False, True):
            with monkeypatch.context() as patch:
                if plain:
                    patch.setattr("mjmr.film._boxes_for_planes", lambda model: None)
                film = Film("t", FilmOptions(width=640, height=480, camera=camera))
                film.add(footage)
                stills.append(film.still(0.5))
    assert (stills[0] != stills[2]).any()
    np.testing.assert_array_equal(stills[0], stills[1])
    assert (cv2.absdiff(stills[2], stills[3]).max(axis=2) > 8).mean() < 1e-3
    planes = footage.model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE
    assert planes.sum() == 1, "the model that was simulated keeps its plane"


def test_colours_survive_the_file(tmp_path):
    colours = [(230, 30, 30), (30, 230, 30), (30, 30, 230), (240, 240, 240), (20, 90, 40)]
    picture = np.zeros((240, 320, 3), np.uint8)
    for k, colour in enumerate(colours):
        picture[:, 64 * k : 64 * (k + 1)] = colour
    with VideoWriter(tmp_path / "c.mp4", 320, 240) as video:
        for _ in range(3):
            video.write(picture)
    with av.open(str(tmp_path / "c.mp4")) as container:
        seen = next(container.decode(video=0)).to_ndarray(format="rgb24")
    for k, colour in enumerate(colours):
        np.testing.assert_allclose(seen[120, 64 * k + 32], colour, atol=4)


def test_the_benchmark_of_films_says_what_it_measured():
    title, one, two = films(seconds=0.2, rounds=1)
    assert "1280 x 720, draft, 6 frames" in title
    assert "1 panel(s)" in one
    assert float(two.split(": ")[1].split(" [")[0]) > 0.5


def test_a_renderer_leaves_the_model_as_it_is():
    model = soccer([[0.0, 0.0, 0.0]])[0].spec().compile()
    quality = model.vis.quality
    before = (quality.shadowsize, quality.numslices, quality.numquads, quality.offsamples)
    size = model.vis.global_.offwidth, model.vis.global_.offheight
    with Renderer(model, 160, 120):
        pass
    assert (quality.shadowsize, quality.numslices, quality.numquads, quality.offsamples) == before
    assert (model.vis.global_.offwidth, model.vis.global_.offheight) == size


def test_trails_go_back_as_far_as_they_are_asked_to():
    recording = record(seconds=3.0)
    lengths = []
    for trail in (0.0, 1.0, float("inf")):
        film = Film("t", FilmOptions(width=640, height=480, trail=trail))
        film.add(recording)
        pictures = [panel_track(film, index) for index in (60, 180)]
        lengths.append([float(np.ptp(track[:, 0, 0])) for track in pictures])
    x = recording.poses[:, 0, 0]
    assert lengths[0] == [0.0, 0.0]
    assert lengths[1] == pytest.approx([x[60] - x[0], x[180] - x[120]], abs=0.03)
    assert lengths[2] == pytest.approx([x[60] - x[0], x[180] - x[0]], abs=0.03)
    with pytest.raises(InvalidInputError, match="a trail lasts 0 s or more"):
        FilmOptions(trail=-1.0)


def panel_track(film, index):
    from mjmr.film import _Panel

    _, footage, label, options = film._panels[0]
    panel = _Panel(footage, label, 64, 64, options)
    try:
        return footage.poses[panel._trail_rows(index), :, :2]
    finally:
        panel.close()


def test_links_and_points_are_drawn_and_kept_in_traces():
    recording = record(seconds=0.1)
    plain = Film("t", FilmOptions(width=640, height=480))
    plain.add(recording.footage())
    before = plain.still(0.1)
    recording.note(links=[[0, 1], [0, 0]], points=[[0.5, 0.5], [np.nan, np.nan]])
    for _ in recording._simulation.ticks(0.1):
        pass
    film = Film("t", FilmOptions(width=640, height=480))
    film.add(recording)
    after = film.still(0.2)
    colour = np.array([255, 240, 150])
    shown = [(np.abs(p.astype(int) - colour).max(axis=2) < 40).sum() for p in (before, after)]
    assert shown[1] > shown[0] + 60
    with pytest.raises(InvalidInputError, match=r"links must have shape \(2, 2\)"):
        recording.note(links=[[1, 0]])
    with pytest.raises(InvalidInputError, match=r"points must have shape \(k, 2\)"):
        recording.note(points=[1.0, 2.0])
