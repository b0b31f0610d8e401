"""PatternFinder on images drawn with OpenCV: no simulator."""

import cv2
import numpy as np
import pytest

from controllers.perception import PatternFinder
from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.geometry import Pinhole, look_at, rotate, wrap_angle
from mjmr.robots.soccer_bot import SoccerBot

LAYOUT = SoccerBot.pattern
TEAMS = tuple(LAYOUT.team_colours)
ALL = [(team, number) for team in TEAMS for number in range(16)]
CARPET = (26, 92, 41)
DOWN = Pinhole(np.array([0.0, 0.0, 4.0]), look_at((0, 0, 4), (0, 0, 0)), 815.0, 1280, 960)
TEN = [("yellow", k) for k in range(10)]


def draw(robots, poses, camera=DOWN, light=None, noise=0.0, hidden=()):
    """Image of robots at poses; ``hidden`` are (robot, dot) that something covers."""
    size = (camera.height, camera.width, 3)
    image = np.empty(size, np.uint8)
    image[:] = CARPET
    cv2.rectangle(image, (300, 100), (1000, 104), (240, 240, 240), -1)
    for k, ((team, number), pose) in enumerate(zip(robots, poses, strict=True)):
        disc(image, camera, pose, (0.0, 0.0), 0.0897, (0.05, 0.05, 0.06))
        disc(image, camera, pose, (0.0, 0.0), LAYOUT.centre_radius, LAYOUT.team_colours[team])
        for dot, (at, colour) in enumerate(zip(LAYOUT.dots, LAYOUT.colours(number), strict=True)):
            if (k, dot) not in hidden:
                disc(image, camera, pose, at, LAYOUT.dot_radius, colour[:3])
    seen = image.astype(float)
    if light is not None:
        seen *= np.linspace(*light, camera.width)[:, None]
    if noise:
        seen += np.random.default_rng(0).normal(0, noise, size)
    return np.clip(np.round(seen), 0, 255).astype(np.uint8)


def disc(image, camera, pose, at, radius, colour):
    """A disc on the plane of the dots; pixels whose middle lies inside."""
    angles = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    rim = np.array(at) + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    points = np.asarray(pose[:2]) + rotate(rim, pose[2])
    pixels = camera.on_floor(points, z=LAYOUT.height)
    low = np.maximum(np.floor(pixels.min(axis=0)).astype(int), 0)
    high = np.ceil(pixels.max(axis=0)).astype(int) + 1
    v, u = np.mgrid[low[1] : high[1], low[0] : high[0]] + 0.5
    ground = camera.on_plane(np.stack([u, v], axis=-1), LAYOUT.height)
    centre = np.asarray(pose[:2]) + rotate(np.array(at), pose[2])
    inside = ((ground - centre) ** 2).sum(axis=-1) < radius**2
    patch = image[low[1] : high[1], low[0] : high[0]]
    patch[inside[: patch.shape[0], : patch.shape[1]]] = np.round(255 * np.array(colour))


def check(found, poses, position=0.0015, heading=1.0):
    error = found - poses
    assert np.isfinite(found).all()
    assert np.hypot(error[:, 0], error[:, 1]).max() < position
    assert np.degrees(np.abs(wrap_angle(error[:, 2])).max()) < heading


def grid(n):
    """n poses that touch nothing, all over the image."""
    draw = np.random.default_rng(n)
    x, y = np.meshgrid(np.linspace(-2.6, 2.6, 10), np.linspace(-2.0, 2.0, 8))
    spots = np.column_stack([x.ravel(), y.ravel()])[:n] + draw.uniform(-0.05, 0.05, (n, 2))
    return np.column_stack([spots, draw.uniform(-np.pi, np.pi, n)])


@pytest.mark.parametrize("turn", [0.0, 1.3, 2.9, -2.1])
def test_every_number_of_every_team_is_told_from_the_others(turn):
    poses = grid(64)
    poses[:, 2] = wrap_angle(poses[:, 2] + turn)
    check(PatternFinder(DOWN, LAYOUT, ALL).find(draw(ALL, poses)), poses)


def test_uneven_light_and_noise_change_little():
    poses = grid(64)
    image = draw(ALL, poses, light=(1.0, 0.35), noise=5.0)
    check(PatternFinder(DOWN, LAYOUT, ALL).find(image), poses, 0.003, 2.5)


def test_a_tilted_camera_sees_the_same_poses():
    eye = (0.5, -3.0, 3.5)
    camera = Pinhole(np.array(eye), look_at(eye, (0, 0, 0)), 900.0, 1280, 960)
    poses = np.array([[-1.0, 0.5, 0.3], [0.8, 1.0, 2.0], [0.0, -0.8, -1.0]])
    robots = [("blue", 3), ("yellow", 5), ("red", 14)]
    check(PatternFinder(camera, LAYOUT, robots).find(draw(robots, poses, camera)), poses, 0.004, 3)


def test_robots_that_touch_keep_their_dots():
    """Seven in a honeycomb, whatever their headings."""
    rng = np.random.default_rng(4)
    ring = np.arange(6) * np.pi / 3
    spots = np.vstack([np.zeros(2), 0.1801 * np.column_stack([np.cos(ring), np.sin(ring)])])
    finder = PatternFinder(DOWN, LAYOUT, TEN)
    for shift in ((0.0, 0.0), (2.3, 1.7), (-2.2, 1.1)):
        for _ in range(5):
            poses = np.column_stack([spots + shift, rng.uniform(-np.pi, np.pi, 7)])
            order = rng.permutation(10)[:7]
            found = finder.find(draw([TEN[k] for k in order], poses))
            check(found[order], poses)
            assert np.isnan(np.delete(found, order, axis=0)).all()


@pytest.mark.parametrize("dot", range(4))
def test_a_robot_with_a_dot_missing_is_found_if_only_one_fits(dot):
    """Number 1 (code 1111) without one dot might be the number that has a 0 there."""
    single = {0: 14, 1: 15, 2: 13, 3: 12}
    codes = LAYOUT.codes
    twin = next(n for n in range(16) if codes[n] == 0b1111 & ~(1 << dot))
    assert twin in single.values()
    pose = np.array([[0.4, -0.3, 0.8]])
    image = draw([("blue", 1)], pose, hidden={(0, dot)})
    alone = PatternFinder(DOWN, LAYOUT, [("blue", 1), ("blue", 0), ("yellow", twin)])
    check(alone.find(image)[:1], pose)
    torn = PatternFinder(DOWN, LAYOUT, [("blue", 1), ("blue", twin)])
    assert np.isnan(torn.find(image)).all(), "either could it be"
    both = np.vstack([pose, [-1.0, 0.5, 2.0]])
    image = draw([("blue", 1), ("blue", twin)], both, hidden={(0, dot)})
    check(torn.find(image), both)


def test_a_half_hidden_dot_does_not_pull_the_pose():
    pose = np.array([[0.4, -0.3, 0.8]])
    image = draw([("blue", 3)], pose)
    middle = DOWN.on_floor(pose[:, :2] + rotate(LAYOUT.dots[1], 0.8), z=LAYOUT.height)[0]
    u, v = middle.astype(int)
    cv2.rectangle(image, (u + 1, v - 10), (u + 10, v + 10), (140, 107, 77), -1)
    check(PatternFinder(DOWN, LAYOUT, [("blue", 3)]).find(image), pose)


def test_slivers_of_dots_still_tell_the_number():
    """A box hides all but 6 mm of two dots: their colours count, their middles do not."""
    pose = np.array([[0.4, -0.3, 0.0]])
    numbers = [n for n in range(16) if LAYOUT.codes[n] >> 3 == 0]
    for number in numbers:
        image = draw([("blue", number)], pose)
        u = int(DOWN.on_floor(pose[:, :2] + [-0.0548 - 0.014, 0.0], z=LAYOUT.height)[0, 0])
        cv2.rectangle(image, (u - 100, 400), (u, 700), (140, 107, 77), -1)
        whole = draw([("blue", number)], pose)
        assert (whole != image).any()
        found = PatternFinder(DOWN, LAYOUT, [("blue", n) for n in range(16)]).find(image)
        assert np.flatnonzero(np.isfinite(found[:, 0])).tolist() == [number]
        check(found[[number]], pose, 0.002, 1.5)


def test_nothing_is_seen_where_nothing_is():
    finder = PatternFinder(DOWN, LAYOUT, TEN)
    for image in (
        np.zeros((960, 1280, 3), np.uint8),
        np.full((960, 1280, 3), 255, np.uint8),
        np.random.default_rng(0).integers(0, 256, (960, 1280, 3)).astype(np.uint8),
    ):
        found = finder.find(image)
        assert found.shape == (10, 3)
        assert np.isnan(found).all()


def test_clutter_and_strangers_are_not_taken_for_robots():
    """Loose dots, balls, boxes, and robots of numbers and teams nobody asked for."""
    robots = [("yellow", 12), ("red", 3), ("yellow", 4)]
    poses = np.array([[-1.0, 0.5, 0.3], [0.8, 1.0, 2.0], [0.0, -0.8, -1.0]])
    image = draw(robots, poses)
    cv2.circle(image, (900, 700), 5, (242, 102, 13), -1)
    cv2.rectangle(image, (1000, 600), (1150, 800), (140, 107, 77), -1)
    for k, colour in enumerate(((255, 64, 191), (26, 242, 242), (250, 217, 26))):
        cv2.circle(image, (200 + 20 * k, 800), 4, colour, -1)
    found = PatternFinder(DOWN, LAYOUT, TEN).find(image)
    check(found[4:5], poses[2:])
    assert np.isnan(np.delete(found, 4, axis=0)).all()


def test_robots_at_the_edge_of_the_image_are_found_whole_or_not_at_all():
    finder = PatternFinder(DOWN, LAYOUT, [("green", 7)])
    edge = DOWN.on_plane(np.array([1280.0, 480.0]), LAYOUT.height)[0]
    for beyond in np.linspace(-0.12, 0.12, 13):
        pose = np.array([[edge + beyond, 0.0, 0.4]])
        found = finder.find(draw([("green", 7)], pose))
        if beyond < -0.09:
            check(found, pose)
        elif np.isfinite(found).all():
            check(found, pose, 0.004, 4.0)


def test_the_same_image_gives_the_same_bits_whatever_came_before():
    image = draw(TEN, grid(10), noise=5.0)
    finder = PatternFinder(DOWN, LAYOUT, TEN)
    first = finder.find(image)
    finder.find(np.zeros_like(image))
    assert finder.find(image).tobytes() == first.tobytes()
    assert PatternFinder(DOWN, LAYOUT, TEN).find(image).tobytes() == first.tobytes()


def test_codes_are_all_different():
    assert sorted(LAYOUT.codes) == list(range(16))


@pytest.mark.parametrize(
    "image",
    [
        np.zeros((960, 1280), np.uint8),
        np.zeros((1280, 960, 3), np.uint8),
        np.zeros((960, 1280, 4), np.uint8),
        np.zeros((960, 1280, 3), np.float32),
    ],
)
def test_other_images_are_refused(image):
    with pytest.raises(InvalidInputError, match=r"\(960, 1280, 3\) uint8; got"):
        PatternFinder(DOWN, LAYOUT, TEN).find(image)


def test_unknown_robots_are_refused():
    with pytest.raises(UnknownNameError, match="valid:"):
        PatternFinder(DOWN, LAYOUT, [("pink", 0)])
    with pytest.raises(InvalidInputError, match="0 to 15"):
        PatternFinder(DOWN, LAYOUT, [("blue", 16)])
    with pytest.raises(InvalidInputError, match="twice"):
        PatternFinder(DOWN, LAYOUT, [("blue", 1), ("blue", 1)])
