import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mjmr import geometry as g

angles = st.floats(-50, 50)
poses = st.tuples(st.floats(-10, 10), st.floats(-10, 10), angles).map(np.array)


@given(angles)
def test_wrapped_angle_is_in_range_and_the_same_direction(a):
    w = float(g.wrap_angle(a))
    assert -np.pi < w <= np.pi
    assert abs(complex(np.cos(w), np.sin(w)) - complex(np.cos(a), np.sin(a))) < 1e-12


@pytest.mark.parametrize(
    ("angle", "wrapped"), [(np.pi, np.pi), (-np.pi, np.pi), (3 * np.pi, np.pi), (0.0, 0.0)]
)
def test_the_half_turn_is_positive(angle, wrapped):
    assert float(g.wrap_angle(angle)) == pytest.approx(wrapped)


@given(poses, poses)
def test_compose_agrees_with_homogeneous_matrices(a, b):
    def matrix(p):
        c, s = np.cos(p[2]), np.sin(p[2])
        return np.array([[c, -s, p[0]], [s, c, p[1]], [0, 0, 1]])

    np.testing.assert_allclose(matrix(g.compose(a, b)), matrix(a) @ matrix(b), atol=1e-12)
    np.testing.assert_allclose(matrix(g.invert(a)), np.linalg.inv(matrix(a)), atol=1e-10)


@given(poses, st.tuples(st.floats(-5, 5), st.floats(-5, 5)))
def test_transforming_there_and_back_is_nothing(a, point):
    there = g.transform_points(a, np.array([point]))
    np.testing.assert_allclose(g.transform_points(g.invert(a), there), [point], atol=1e-10)


@given(angles)
def test_yaw_of_a_quaternion_about_z(a):
    q = [np.cos(a / 2), 0, 0, np.sin(a / 2)]
    assert abs(float(g.angle_difference(g.quaternion_yaw(q), a))) < 1e-9


def test_pixels_go_to_the_plane_and_back():
    camera = g.Pinhole(
        np.array([0.5, -3.0, 3.5]), g.look_at((0.5, -3, 3.5), (0, 0, 0)), 900, 800, 600
    )
    pixels = np.random.default_rng(0).uniform((0, 0), (800, 600), (50, 2))
    ground = camera.on_plane(pixels, 0.15)
    np.testing.assert_allclose(camera.on_floor(ground, z=0.15), pixels, atol=1e-9)
    np.testing.assert_allclose(camera.project([0, 0, 0]), camera.centre, atol=1e-9)
    # 1 m to the right and 2 m up in front of the camera, in its own frame
    ahead = camera.T_world_camera @ [1.0, -2.0, 10.0, 1.0]
    np.testing.assert_allclose(camera.project(ahead[:3]), camera.centre + [90, -180], atol=1e-9)
    behind = camera.position - camera.rotation[:, 2]
    assert np.isnan(camera.project(behind)).all()
    level = g.Pinhole(np.array([0.0, 0.0, 1.0]), g.look_at((0, 0, 1), (1, 0, 1)), 100.0, 100, 100)
    assert np.isnan(level.on_plane([50.0, 20.0], 0.0)).all(), "the sky never meets the floor"


def test_look_at_keeps_up_up():
    np.testing.assert_allclose(
        g.look_at((0, 0, 4), (0, 0, 0)), np.diag([1.0, -1.0, -1.0]), atol=1e-15
    )
    right, down, forward = g.look_at((0, 0, 1), (5, 0, 1)).T
    np.testing.assert_allclose(
        [right, down, forward], [[0, -1, 0], [0, 0, -1], [1, 0, 0]], atol=1e-15
    )


@given(st.lists(st.floats(-1, 1), min_size=4, max_size=4).filter(lambda q: np.linalg.norm(q) > 0.1))
def test_rotation_of_a_quaternion_is_scipys(q):
    from scipy.spatial.transform import Rotation

    expected = Rotation.from_quat([*q[1:], q[0]]).as_matrix()
    np.testing.assert_allclose(g.rotation_matrix(q), expected, atol=1e-12)
