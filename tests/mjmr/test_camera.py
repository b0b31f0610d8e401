"""Cameras: geometry against projection, schedule, errors, and what is never rendered."""

import gc
import hashlib
import os
import subprocess
import sys

import cv2
import mujoco
import numpy as np
import pytest

from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.sensors.camera import Camera
from mjmr.sensors.studio import Studio
from mjmr.simulation import Simulation
from mjmr.world import World
from tests.mjmr.worlds import BOTH, soccer

TOP = SoccerBot.pattern.height
POSES = np.array([[-2.0, 1.5, 0.3], [0.4, -0.2, 2.0], [2.3, -1.8, -1.0]])


def overhead(world, at=(0.0, 0.0, 4.0), to=(0.0, 0.0, 0.0), **options):
    options = {"width": 640, "height": 480, "fovy": np.radians(61.0)} | options
    return world.add_camera(Camera(**options), position=at, look_at=to)


def start(world, kind=Simulation, **options):
    """A simulation whose sensors have taken their first sample."""
    simulation = kind(world, **options)
    for _ in simulation.ticks(simulation.control_period):
        break
    return simulation


def digest(image):
    return hashlib.sha256(image.tobytes()).hexdigest()


def approaching(kind=Simulation, seed=3, **options):
    """Two robots on the move under a camera; the world is seen by (camera, simulation, robots)."""
    world, robots = soccer([[-1.0, 0.5, 0.0], [1.0, -0.5, 2.0]])
    camera = overhead(world, width=160, height=120, **options)
    return camera, kind(world, seed=seed), robots


def frames(camera, simulation, robots, read=lambda k: True, seconds=1.0):
    """Images read, by the instant they were taken."""
    seen = {}
    for k, _ in enumerate(simulation.ticks(seconds)):
        robots.drive(np.tile([0.8, 0.3, 1.0], (robots.n, 1)))
        if read(k):
            image = camera.read()
            seen[camera.sampled_at] = image.copy()
    return seen


def spots(image):
    """Middles (k, 2) of the magenta spots that OpenCV finds in an RGB picture [px]."""
    hsv = cv2.cvtColor(image, cv2.COLOR_RGB2HSV)
    mask = cv2.inRange(hsv, (145, 150, 40), (155, 255, 255))
    _, _, stats, middles = cv2.connectedComponentsWithStats(mask)
    assert (stats[1:, cv2.CC_STAT_AREA] > 20).all()
    return middles[1:] + 0.5


def depth_by_rays(simulation, camera, width, height):
    """Depths (height, width) that mj_ray finds along each pixel, and where they are smooth.

    Smooth: neither the pixel nor its neighbours look past an edge, where a picture's triangles and
    true round shapes differ.
    """
    model, data = simulation.model, simulation.data
    mujoco.mj_forward(model, data)
    at = data.camera(camera)
    fovy = np.radians(model.camera(camera).fovy[0])
    focal = height / 2 / np.tan(fovy / 2)
    u, v = np.meshgrid(np.arange(width) + 0.5 - width / 2, np.arange(height) + 0.5 - height / 2)
    rays = np.stack([u / focal, -v / focal, -np.ones_like(u)], axis=-1) @ at.xmat.reshape(3, 3).T
    seen, geom = np.array([1, 1, 0, 0, 0, 0], dtype=np.uint8), np.zeros(1, dtype=np.int32)
    depth = np.empty((height, width))
    for i, j in np.ndindex(height, width):
        found = mujoco.mj_ray(model, data, at.xpos, rays[i, j], seen, 1, -1, geom)
        # rays are 1 m deep, and mj_ray counts in lengths of the ray
        depth[i, j] = found if found >= 0 else np.inf
    # of a plane the inverse depth is linear in the picture
    near, bend = 1.0 / depth, np.full((height, width), np.inf)
    down, right = np.diff(near, 2, axis=0)[:, 1:-1], np.diff(near, 2, axis=1)[1:-1]
    bend[1:-1, 1:-1] = np.maximum(np.abs(down), np.abs(right))
    with np.errstate(invalid="ignore"):
        return depth, np.isfinite(depth) & (bend * depth**2 < 0.003)


@pytest.mark.parametrize(("at", "to"), [((0, 0, 4), (0, 0, 0)), ((1.5, -3.5, 3.0), (0.2, 0, 0))])
def test_dots_are_seen_where_they_are_projected(at, to):
    world, _ = soccer(POSES)
    camera = overhead(world, at, to, width=1280, height=960)
    start(world)
    hsv = cv2.cvtColor(camera.read(), cv2.COLOR_RGB2HSV)
    yellow = cv2.inRange(hsv, (20, 150, 60), (32, 255, 255))
    _, spots = cv2.connectedComponents(yellow)
    for x, y, _ in POSES:
        u, v = camera.calibration.project([x, y, TOP])
        rows, columns = np.nonzero(spots == spots[int(v), int(u)])
        assert len(rows) > 10
        assert abs(columns.mean() + 0.5 - u) < 0.5
        assert abs(rows.mean() + 0.5 - v) < 0.5


def test_dots_have_the_height_of_the_pattern():
    world, _ = soccer(POSES[:1])
    camera = overhead(world, (POSES[0, 0], POSES[0, 1], 1.0), (*POSES[0, :2], 0), modality="depth")
    start(world)
    assert camera.read()[240, 320] == pytest.approx(1.0 - TOP, abs=2e-4)


@pytest.mark.parametrize("kind", BOTH)
def test_depth_is_the_distance_along_the_axis(kind):
    world, _ = soccer(POSES)
    world.add_box(-1.0, -1.0, 0.6, 0.4, height=0.3)
    camera = overhead(world, modality="depth")
    start(world, kind)
    depth, view = camera.read(), camera.calibration
    assert depth.dtype == np.float32
    for x, y, z in ((-1.0, -1.0, 0.3), (1.6, 1.0, 0.0), (-2.0, 0.0, 0.0), (2.77, 0.0, 0.1)):
        u, v = view.project([x, y, z])
        assert depth[int(v), int(u)] == pytest.approx(4.0 - z, abs=2e-3)


@pytest.mark.parametrize("at", [(0.1, 0.0, 0.1), (0.05, -0.1, 0.4)])
def test_depth_is_that_of_rays(at):
    """Of a camera on a robot that looks at another one, a box, a ball, the floor and the wall."""
    world, robots = soccer([[-0.6, 0.1, 0.2], [0.4, 0.3, 2.0]])
    world.add_box(0.9, -0.3, 0.3, 0.5, yaw=0.4, height=0.25)
    world.add_golf_ball(-0.1, 0.1)
    place = {"position": at, "look_at": (1.0, 0.0, 0.05)}
    robots.mount(Camera(modality="depth", width=160, height=120, **place))
    simulation = start(world)
    for i, depth in enumerate(robots.camera.read()):
        wanted, smooth = depth_by_rays(simulation, f"soccer_bot{i}/camera", 160, 120)
        assert smooth.sum() > 5000
        np.testing.assert_allclose(depth[smooth], wanted[smooth], atol=0.01)


def test_points_are_found_where_a_robots_camera_projects_them():
    """Spheres of 10 mm around robots that have moved, by OpenCV: within a pixel."""
    points = np.array([[0.6, 0.1, 0.12], [1.0, -0.3, 0.3], [0.9, 0.35, 0.05]])
    world, robots = soccer([[-1.0, 0.3, 0.4], [0.7, -0.9, 2.6]])

    def add(spec):
        for name in robots.names:
            for point in points:
                spec.body(f"{name}/base").add_geom(
                    type=mujoco.mjtGeom.mjGEOM_SPHERE, pos=point, size=[0.01, 0, 0],
                    rgba=[1, 0, 1, 1], contype=0, conaffinity=0, group=1, mass=0,
                )  # fmt: skip

    world.edit(add)
    robots.mount(Camera(position=(0.1, 0.02, 0.2), look_at=(1.0, 0.0, 0.15), rate=60.0))
    simulation = Simulation(world)
    for _ in simulation.ticks(0.5):
        robots.drive([[0.5, 0.2, 1.0]] * 2)
    wanted = robots.camera.calibration.project(points)
    for image in robots.camera.read():
        found = spots(image)
        apart = np.linalg.norm(found[:, None] - wanted[None], axis=2)
        assert apart.shape == (3, 3)
        assert apart.min(axis=0).max() < 1.0


def test_there_is_nothing_in_the_sky():
    world, _ = soccer(POSES)
    place = {"position": (0, 0, 1), "look_at": (1, 0, 1.5)}
    depth = world.add_camera(Camera(modality="depth"), name="depth", **place)
    labels = world.add_camera(Camera(modality="segmentation"), name="labels", **place)
    start(world)
    assert np.isinf(depth.read()[0]).all()
    assert (labels.read()[0] == -1).all()


@pytest.mark.parametrize("kind", BOTH)
def test_segmentation_names_what_is_seen(kind):
    world, _ = soccer(POSES)
    world.add_box(-1.0, -1.0, 0.6, 0.4)
    world.add_golf_ball(1.0, 1.0)
    camera = overhead(world, modality="segmentation")
    start(world, kind)
    labels, view = camera.read(), camera.calibration
    assert labels.dtype == np.int32
    expected = {
        "soccer_bot0": (*POSES[0, :2], TOP),
        "soccer_bot2": (*POSES[2, :2], TOP),
        "box0": (-1.0, -1.0, 0.3),
        "ball1": (1.0, 1.0, 0.03),
        "floor": (-1.5, 0.4, 0.0),
        "wall": (2.77, 0.0, 0.1),
    }
    for name, point in expected.items():
        u, v = view.project(point)
        assert camera.label_names[labels[int(v), int(u)]] == name
    assert camera.label_names[:3] == ("soccer_bot0", "soccer_bot1", "soccer_bot2")
    # a field line is part of the floor
    u, v = view.project([0.0, -0.7, 0.001])
    assert camera.label_names[labels[int(v), int(u)]] == "floor"


@pytest.mark.parametrize("kind", BOTH)
def test_robots_see_each_other(kind):
    """0 and 1 face each other, 2 looks at the wall: each image has who it should, and where."""
    world, robots = soccer([[-0.5, 0.0, 0.0], [0.5, 0.0, np.pi], [0.0, 1.0, np.pi / 2]])
    eyes = Camera(
        modality="segmentation",
        width=80,
        height=60,
        position=(0.1, 0.0, 0.1),
        look_at=(1.0, 0.0, 0.1),
    )
    robots.mount(eyes, "eyes")
    start(world, kind)
    images = eyes.read()
    assert images.shape == (3, 60, 80)
    seen = [set(np.unique(image)) & {0, 1, 2} for image in images]
    assert seen == [{1}, {0}, set()]
    # 0.8 m ahead of the lens, 0.18 m wide: this many columns, in the middle
    columns = np.flatnonzero((images[0] == 1).any(axis=0))
    width = 2 * eyes.calibration.focal * np.tan(np.arcsin(0.09 / 0.9))
    assert len(columns) == pytest.approx(width, abs=2)
    assert columns.mean() == pytest.approx(39.5, abs=0.6)


class Eyed(SoccerBot):
    name = "eyed"

    def model(self, number, team):
        spec = super().model(number, team)
        spec.body("base").add_camera(name="eye", pos=[0.1, 0, 0.1], xyaxes=[0, -1, 0, 0, 0, 1])
        return spec


def test_a_camera_of_the_model_is_used_by_name(monkeypatch):
    monkeypatch.setattr("mjmr.robots.soccer_bot.model_path", _soccer_path)
    world = World.rectangle(4.9, 3.8, border=0.3)
    robots = world.add_group(Eyed, [[-0.5, 0.0, 0.0], [0.5, 0.0, np.pi]])
    eye = robots.mount(Camera(at="eye", modality="segmentation", width=80, height=60))
    same = Camera(
        modality="segmentation", width=80, height=60, fovy=np.radians(45.0),
        position=(0.1, 0, 0.1), look_at=(1, 0, 0.1),
    )  # fmt: skip
    robots.mount(same, "same")
    start(world)
    np.testing.assert_array_equal(eye.read(), same.read())
    np.testing.assert_allclose(eye.calibration.rotation, same.calibration.rotation, atol=1e-12)
    assert eye.calibration.focal == pytest.approx(same.calibration.focal)
    robots.mount(Camera(at="nose"), "nose")
    with pytest.raises(UnknownNameError, match="'nose'; valid: same, eye"):
        Simulation(world)


def _soccer_path(*_: str):
    from mjmr.assets import model_path

    return model_path("soccer_bot")


@pytest.mark.parametrize("kind", BOTH)
def test_a_late_image_shows_the_past(kind):
    """30 Hz, 0.1 s late, read at every tick: what a punctual camera saw at the same instant."""
    punctual = frames(*approaching(kind, rate=30.0))
    camera, simulation, robots = approaching(kind, rate=30.0, latency=0.1)
    late = frames(camera, simulation, robots)
    assert np.isnan(min(late))
    late = {t: image for t, image in late.items() if not np.isnan(t)}
    assert len(late) == 27
    assert simulation.time - max(late) > 0.1
    for t, image in late.items():
        np.testing.assert_array_equal(image, punctual[t])
    assert len({digest(image) for image in late.values()}) == len(late), "it shows motion"


def test_images_nobody_reads_are_not_rendered(monkeypatch):
    count = []
    render = Studio.picture
    monkeypatch.setattr(Studio, "picture", lambda *a: count.append(1) or render(*a))
    camera, simulation, robots = approaching(rate=60.0)
    frames(camera, simulation, robots, read=lambda k: False)
    assert simulation._studio is None
    camera.read()
    camera.read()
    assert len(count) == 1


def test_a_forgotten_simulation_does_not_spoil_the_pictures_of_another():
    """The collector frees the context of one while that of another is current."""
    camera, simulation, robots = approaching(rate=60.0)
    alone = frames(camera, simulation, robots, seconds=4 / 60)
    camera, simulation, robots = approaching(rate=60.0)
    gc.collect()
    again = {}
    for _ in range(4):
        other = approaching(rate=60.0)
        frames(*other, seconds=1 / 60)
        again |= frames(camera, simulation, robots, seconds=1 / 60)
        del other
        gc.collect()
    assert {t: digest(i) for t, i in again.items()} == {t: digest(i) for t, i in alone.items()}


def test_cameras_of_one_size_share_a_context():
    world, _ = soccer(POSES)
    cameras = [
        world.add_camera(
            Camera(width=64, height=48, modality=m), name=m, position=(0, 0, 4), look_at=(0, 0, 0)
        )
        for m in ("rgb", "depth", "segmentation")
    ]
    simulation = start(world)
    before = [digest(c.read()) for c in cameras]
    assert len(simulation.studio._renderers) == 1
    simulation.close()
    assert not simulation.studio._renderers
    for _ in simulation.ticks(0.1):
        pass
    assert [digest(c.read()) for c in cameras][1:] == before[1:], "it opens again after close"


@pytest.mark.parametrize("kind", BOTH)
def test_noise_depends_on_the_sample_number_alone(kind):
    options = {"rate": 30.0, "noise": 5.0, "loss": 0.2}
    every = frames(*approaching(kind, **options))
    some = frames(*approaching(kind, **options), read=lambda k: k % 7 == 3)
    assert len(some) > 5
    for t, image in some.items():
        np.testing.assert_array_equal(image, every[t])


def test_pixel_noise_is_white_and_has_its_size():
    world, _ = soccer(POSES)
    clean = overhead(world)
    noisy = Camera(width=640, height=480, fovy=np.radians(61.0), noise=5.0)
    world.add_camera(noisy, position=(0, 0, 4), look_at=(0, 0, 0), name="noisy")
    simulation = Simulation(world, seed=1)
    errors = []
    for _ in simulation.ticks(0.1):
        # on the box-free carpet every channel is above 20 and below 110: nothing saturates
        errors.append((noisy.read().astype(float) - clean.read())[150:220, 180:300])
    errors = np.array(errors[::2])
    assert errors.std() == pytest.approx(5.0, rel=0.01)
    assert abs(errors.mean()) < 0.06
    flat = errors.reshape(len(errors), -1)
    across = np.corrcoef(flat)[np.triu_indices(len(flat), 1)]
    assert np.abs(across).max() < 0.03, "images are independent"
    assert abs((errors[..., 0] * errors[..., 1]).mean()) / 25 < 0.02, "channels are independent"
    assert abs((errors[:, :, 1:] * errors[:, :, :-1]).mean()) / 25 < 0.02, "pixels are independent"


def test_lost_images_are_blank_and_say_so():
    camera, simulation, robots = approaching(rate=60.0, loss=0.3)
    fresh, blank = [], []
    for _ in simulation.ticks(5.0):
        fresh.append(camera.fresh)
        blank.append(not camera.read().any())
    assert np.array_equal(fresh, ~np.array(blank))
    assert np.mean(blank) == pytest.approx(0.3, abs=0.08)


def test_lost_images_of_robots_are_blank_one_by_one():
    world, robots = soccer(POSES)
    place = {"position": (0.1, 0, 0.1), "look_at": (1, 0, 0.1)}
    robots.mount(Camera(width=40, height=30, loss=0.5, noise=5.0, rate=60.0, **place))
    simulation = Simulation(world, seed=4)
    partly = 0
    for _ in simulation.ticks(0.5):
        seen = robots.camera.read().any(axis=(1, 2, 3))
        np.testing.assert_array_equal(robots.camera.fresh, seen)
        partly += 0 < seen.sum() < 3
    assert partly > 5


def test_gain_darkens_corners_and_one_side():
    world, _ = soccer(POSES)
    clean = overhead(world)
    spoilt = Camera(width=640, height=480, fovy=np.radians(61.0), vignetting=0.4, unevenness=0.2)
    world.add_camera(spoilt, position=(0, 0, 4), look_at=(0, 0, 0), name="spoilt")
    start(world)
    ratio = spoilt.read()[..., 1] / clean.read()[..., 1].astype(float).clip(1)
    x = (np.array([20, 320, 619]) + 0.5) / 640 * 2 - 1
    y = (np.array([20, 240, 459]) + 0.5) / 480 * 2 - 1
    squared = (x**2 * 640**2 + y[:, None] ** 2 * 480**2) / (640**2 + 480**2)
    gain = (1 - 0.4 * squared) * (1 - 0.2 * (x + 1) / 2)
    seen = np.array([[ratio[r, c] for c in (20, 320, 619)] for r in (20, 240, 459)])
    # relative: the field is scaled so that its brightest pixel keeps its light
    np.testing.assert_allclose(seen / seen[1, 1], gain / gain[1, 1], atol=0.03)


def test_uneven_light_is_twice_as_bright_on_one_side():
    ratios = {}
    for lighting in ("even", "uneven"):
        world = World.rectangle(4.9, 3.8, border=0.3, lighting=lighting)
        world.add_group(SoccerBot, POSES)
        camera = overhead(world)
        start(world)
        image, view = camera.read(), camera.calibration
        # the side lines of the field are white: their brightest pixel near the middle of each
        bright = []
        for x in (-2.45, 2.45):
            u, v = view.project([x, 0.0, 0.0016]).astype(int)
            bright.append(float(image[v - 1 : v + 2, u - 2 : u + 3].max()))
        ratios[lighting] = bright[0] / bright[1]
    assert ratios["even"] == pytest.approx(1.0, abs=0.02)
    assert 1.7 < ratios["uneven"] < 2.5
    with pytest.raises(UnknownNameError, match="uneven"):
        World.rectangle(1.0, 1.0, lighting="dim")


@pytest.mark.parametrize("kind", BOTH)
def test_a_snapshot_brings_images_back(kind):
    camera, simulation, robots = approaching(kind, rate=30.0, noise=3.0, latency=0.05)
    frames(camera, simulation, robots, seconds=0.5)
    snapshot, before = simulation.snapshot(), digest(camera.read())
    later = frames(camera, simulation, robots, seconds=0.5)
    simulation.restore(snapshot)
    assert digest(camera.read()) == before
    again = frames(camera, simulation, robots, seconds=0.5)
    assert {t: digest(i) for t, i in later.items()} == {t: digest(i) for t, i in again.items()}


SCRIPT = """
from tests.mjmr.test_camera import approaching, digest, frames
seen = frames(*approaching(noise=4.0, rate=30.0, loss=0.1), seconds=0.3)
print(*(digest(seen[t]) for t in sorted(seen)))
"""


def test_same_seed_same_bits_also_in_another_process():
    def run(seed):
        seen = frames(*approaching(seed=seed, noise=4.0, rate=30.0, loss=0.1), seconds=0.3)
        return [digest(seen[t]) for t in sorted(seen)]

    here = run(3)
    assert here == run(3)
    assert here != run(4)
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT],
        env=os.environ | {"MUJOCO_GL": "egl"},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == here
    assert "Error" not in done.stderr, "contexts are closed before the process ends"


def test_pictures_do_not_disturb_the_physics():
    ends = []
    for read in (lambda k: True, lambda k: False):
        camera, simulation, robots = approaching(rate=60.0)
        frames(camera, simulation, robots, read=read)
        ends.append(simulation.data.qpos.tobytes())
    assert ends[0] == ends[1]


def test_images_are_read_only_and_need_a_simulation():
    world, _ = soccer(POSES)
    camera = overhead(world)
    with pytest.raises(InvalidInputError, match="simulation"):
        camera.read()
    start(world)
    with pytest.raises(ValueError, match="read-only"):
        camera.read()[0, 0] = 1
    assert isinstance(world.spec().compile(), mujoco.MjModel)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"modality": "infrared"}, "valid: "),
        ({"width": 0}, "at least 1 x 1"),
        ({"height": 10.5}, "at least 1 x 1"),
        ({"fovy": 61.0}, "rad"),
        ({"noise": -1.0}, "deviation"),
        ({"noise": np.nan}, "deviation"),
        ({"loss": 1.2}, "share"),
        ({"vignetting": -0.1}, "share"),
        ({"modality": "depth", "noise": 1.0}, "rgb"),
        ({"at": "eye", "fovy": 1.0}, "alone"),
        ({"position": (0, 0, 1)}, "either"),
        ({"position": (0, 0, 1), "look_at": (0, 0, 1)}, "where it is"),
        ({"position": (0, 0), "look_at": (0, 0, 1)}, "three"),
        ({"position": (0, 0, 1), "quaternion": (0, 0, 0, 0)}, "zero"),
        ({"position": (0, 0, np.inf), "look_at": (0, 0, 1)}, "finite"),
    ],
)
def test_bad_cameras_are_refused(options, message):
    with pytest.raises(InvalidInputError, match=message):
        Camera(**options)


def test_a_camera_has_one_place():
    world, robots = soccer(POSES)
    camera = overhead(world)
    with pytest.raises(InvalidInputError, match="named 'camera'"):
        overhead(world)
    with pytest.raises(InvalidInputError, match="place already"):
        world.add_camera(camera, position=(0, 0, 1), look_at=(0, 0, 0), name="second")
    robots.mount(camera)
    with pytest.raises(InvalidInputError, match="stands in the world"):
        Simulation(world)
    world, robots = soccer(POSES)
    robots.mount(Camera())
    with pytest.raises(InvalidInputError, match="no place"):
        Simulation(world)
    world, robots = soccer(POSES)
    robots.mount(Camera(body="head", position=(0, 0, 0.2), look_at=(1, 0, 0)))
    with pytest.raises(UnknownNameError, match="valid: base"):
        Simulation(world)
