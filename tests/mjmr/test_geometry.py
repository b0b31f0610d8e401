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
