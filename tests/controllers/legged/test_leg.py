"""Legs in closed form: against the compiled model, and forwards against backwards."""

import re

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from controllers.legged.leg import ERS7, LEGS, UnreachableError
from mjmr.assets import model_path
from mjmr.errors import InvalidInputError

LOW, HIGH = ERS7.limits[..., 0], ERS7.limits[..., 1]
# below these a knee is bent the other way, or an elevator tips over
BENT = np.radians([11.9, 11.9, 19.0, 19.0])
RISEN = np.radians(82.5)


def test_feet_are_where_the_compiled_model_has_them():
    model = mujoco.MjModel.from_xml_path(str(model_path("aibo_ers7")))
    data = mujoco.MjData(model)
    rng = np.random.default_rng(0)
    names = [f"{leg}_{joint}" for leg in LEGS for joint in ("rotator", "elevator", "knee")]
    hinges = [model.joint(name) for name in names]
    np.testing.assert_allclose([j.range for j in hinges], ERS7.limits.reshape(12, 2), atol=1e-8)
    angles = rng.uniform(LOW, HIGH, (300, 4, 3))
    address = [j.qposadr[0] for j in hinges]
    for angle, feet in zip(angles, ERS7.feet(angles), strict=True):
        data.qpos[:] = 0.0
        data.qpos[3] = 1.0
        data.qpos[address] = angle.ravel()
        mujoco.mj_kinematics(model, data)
        found = [data.geom(f"paw{i}").xpos for i in range(4)]
        np.testing.assert_allclose(found, feet, atol=1e-9)


def test_angles_come_back_from_feet():
    rng = np.random.default_rng(1)
    low, high = LOW.copy(), HIGH.copy()
    low[:, 2], high[:, 1] = BENT, RISEN
    angles = rng.uniform(low, high, (5000, 4, 3))
    np.testing.assert_allclose(ERS7.angles(ERS7.feet(angles)), angles, atol=1e-8)


def test_over_the_whole_range_what_is_called_reached_is_reached():
    angles = np.random.default_rng(2).uniform(LOW, HIGH, (5000, 4, 3))
    feet = ERS7.feet(angles)
    found, reached = ERS7.solve(feet)
    assert np.abs(ERS7.feet(found) - feet)[reached].max() < 1e-12
    # the other branch is what some of the box needs; it lies near straight legs
    assert 0.9 < reached.mean() < 0.98
    assert (found >= LOW).all()
    assert (found <= HIGH).all()


@given(
    st.integers(0, 3),
    st.tuples(*[st.floats(-0.3, 0.3)] * 3),
)
def test_no_point_is_called_reached_that_is_not(leg, offset):
    feet = ERS7.feet(np.radians([[0, 5, 60]] * 4))
    feet[leg] = ERS7.hips[leg] + offset
    found, reached = ERS7.solve(feet)
    assert reached[np.arange(4) != leg].all()
    miss = np.linalg.norm(ERS7.feet(found)[leg] - feet[leg])
    if reached[leg]:
        assert miss < 1e-7
        np.testing.assert_allclose(ERS7.angles(feet), found)
    else:
        with pytest.raises(UnreachableError, match=f"foot {LEGS[leg]} "):
            ERS7.angles(feet)


def test_fore_and_hind_left_and_right_mirror_each_other():
    feet = ERS7.feet(np.radians([[20, 10, 50]] * 4)) - ERS7.hips
    np.testing.assert_allclose(feet[0] * [1, -1, 1], feet[1])
    np.testing.assert_allclose(feet[2] * [1, -1, 1], feet[3])
    assert feet[0, 0] > 0.05 > -0.05 > feet[2, 0]
    assert feet[0, 1] > 0.01


def test_unreachable_points_are_named():
    feet = np.stack([ERS7.feet(np.radians([[0, 5, 60]] * 4))] * 3)
    feet[1, 2] += [0.0, 0.0, -0.08]
    feet[2, 3] += [0.0, 0.3, 0.0]
    _, reached = ERS7.solve(feet)
    np.testing.assert_array_equal(np.argwhere(~reached), [[1, 2], [2, 3]])
    x, y, z = np.round(1e3 * feet[1, 2])
    words = re.escape(f"foot hl of row (1,) cannot reach ({x:.0f}, {y:.0f}, {z:.0f}) mm")
    with pytest.raises(UnreachableError, match=f"{words}.*nor 1 others"):
        ERS7.angles(feet)
    with pytest.raises(InvalidInputError, match=r"\(\.\.\., 4, 3\); got \(3, 4\)"):
        ERS7.solve(np.zeros((3, 4)))
    feet[0, 0, 0] = np.nan
    with pytest.raises(InvalidInputError, match="finite"):
        ERS7.solve(feet)
