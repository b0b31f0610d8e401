"""The head's closed forms, against the compiled model's camera."""

import mujoco
import numpy as np
import pytest

from controllers.legged.head import ERS7_HEAD, HeadScan
from mjmr.assets import model_path
from mjmr.errors import InvalidInputError
from mjmr.robots.aibo_ers7 import JOINTS, AiboERS7

HEAD = slice(12, 15)


def compiled_camera(angles):
    """Position and rotation (image's right, down, forward) of the model's camera, body frame."""
    model = mujoco.MjModel.from_xml_path(str(model_path("aibo_ers7")))
    data = mujoco.MjData(model)
    base = model.body("base").id
    for name, angle in zip(("tilt1", "pan", "tilt2"), angles, strict=True):
        data.joint(name).qpos[0] = angle
    data.qpos[3:7] = [0.8, 0.1, -0.5, 0.3]
    mujoco.mj_forward(model, data)
    R_world_body = data.xmat[base].reshape(3, 3)
    camera = model.camera("camera").id
    position = R_world_body.T @ (data.cam_xpos[camera] - data.xpos[base])
    right, up, back = (R_world_body.T @ data.cam_xmat[camera].reshape(3, 3)).T
    return position, np.column_stack([right, -up, -back])


def test_limits_are_the_platforms():
    np.testing.assert_allclose(ERS7_HEAD.limits, AiboERS7.joint_limits[HEAD])
    assert [j.name for j in JOINTS[HEAD]] == ["tilt1", "pan", "tilt2"]


def test_the_camera_is_where_the_compiled_model_has_it():
    rng = np.random.default_rng(0)
    angles = rng.uniform(*ERS7_HEAD.limits.T, (20, 3))
    position, rotation = ERS7_HEAD.camera_pose(angles)
    for k, row in enumerate(angles):
        expected = compiled_camera(row)
        np.testing.assert_allclose(position[k], expected[0], atol=1e-9)
        np.testing.assert_allclose(rotation[k], expected[1], atol=1e-7)


@pytest.mark.parametrize("tilt1", [0.0, -0.35, -1.2])
def test_what_is_looked_at_is_in_the_middle_of_the_models_image(tilt1):
    rng = np.random.default_rng(1)
    points = rng.uniform([0.15, -0.6, -0.12], [1.5, 0.6, 0.3], (300, 3))
    angles, seen = ERS7_HEAD.look_at(points, tilt1)
    assert seen.mean() > 0.8
    assert (angles >= ERS7_HEAD.limits[:, 0]).all()
    assert (angles <= ERS7_HEAD.limits[:, 1]).all()
    for point, angle in list(zip(points[seen], angles[seen], strict=True))[:40]:
        position, rotation = compiled_camera(angle)
        right, down, forward = rotation.T @ (point - position)
        assert forward > 0
        np.testing.assert_allclose([right, down], 0.0, atol=1e-6)


def test_the_neck_tilts_as_preferred_until_the_nod_is_at_its_limit():
    far, near = ERS7_HEAD.look_at([[1.0, 0.2, 0.0], [0.2, 0.05, -0.08]], -0.2)[0]
    assert far[0] == pytest.approx(-0.2)
    assert near[0] < -0.3
    assert near[2] == pytest.approx(ERS7_HEAD.limits[2, 0])


def test_what_is_behind_is_not_seen_and_angles_stay_within_limits():
    angles, seen = ERS7_HEAD.look_at([-1.0, 0.1, 0.0])
    assert not seen
    assert angles[1] == pytest.approx(ERS7_HEAD.limits[1, 1])


def test_points_must_be_finite_threes():
    with pytest.raises(InvalidInputError, match="shape"):
        ERS7_HEAD.look_at([1.0, 2.0])
    with pytest.raises(InvalidInputError, match="finite"):
        ERS7_HEAD.look_at([1.0, np.nan, 0.0])


def test_a_scan_sweeps_both_ways_within_the_servos_rates():
    frame = 0.008
    angles = HeadScan().angles(np.arange(0.0, 4.8, frame))
    assert angles[:, 1].max() == pytest.approx(1.3, abs=1e-3)
    assert angles[:, 1].min() == pytest.approx(-1.3, abs=1e-3)
    assert (np.abs(np.diff(angles, axis=0)) < AiboERS7.joint_rates[HEAD] * frame).all()
    limits = AiboERS7.joint_limits[HEAD]
    assert ((angles >= limits[:, 0]) & (angles <= limits[:, 1])).all()
    leftwards = np.gradient(angles[:, 1]) > 0.9 * np.gradient(angles[:, 1]).max()
    assert (angles[leftwards][:, 0] == -0.35).all()
