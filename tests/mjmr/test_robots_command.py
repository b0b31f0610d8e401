"""``mjmr robots``: what is told of the platforms, and their contact sheets."""

import dataclasses
import json
import os
import subprocess
import sys

import cv2
import mujoco
import numpy as np
import pytest

from mjmr.cli import main
from mjmr.robots import PLATFORMS, Pioneer2DX, SoccerBot, platform_class
from mjmr.robots.facts import _reach, collapse, facts, number_tables, stage
from tests import toy_study


@pytest.fixture(autouse=True)
def elsewhere(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")


def figures(monkeypatch, path):
    """Let the proving ground be a toy study with these committed figures."""
    study = dataclasses.replace(toy_study.study, name="proving-ground", figures=path)
    monkeypatch.setattr(toy_study, "ground", study, raising=False)
    found = {"proving-ground": "tests.toy_study:ground"}
    monkeypatch.setattr("mjmr.registry.study_references", lambda: found)


@pytest.mark.parametrize(
    ("platform", "size", "mass"),
    [
        (Pioneer2DX(), (0.44, 0.38, 0.22), 9.0),
        (SoccerBot(), (0.18, 0.18, 0.15), 2.5),
        (SoccerBot("omni"), (0.18, 0.18, 0.15), 2.5),
    ],
)
def test_size_and_mass_of_the_models_are_those_of_the_data_sheets(platform, size, mass):
    f = facts(stage(platform))
    np.testing.assert_allclose(f.size, size, atol=3e-4)
    assert f.mass == pytest.approx(mass, abs=1e-9)


def test_mounts_are_the_models_sites_without_those_that_are_painted():
    f = facts(stage(Pioneer2DX()))
    assert f.sites == (*(f"sonar{k}" for k in range(16)), "lidar", "camera")
    assert f.cameras == ()
    assert collapse(f.sites) == "sonar0-15, lidar, camera"
    assert collapse(["eye1", "ear", "eye2", "leg7"]) == "eye1-2, ear, leg7"
    assert collapse([]) == ""


@pytest.mark.parametrize("robot", PLATFORMS)
def test_every_robot_has_its_numbers_with_sources_and_bounds(robot):
    tables = number_tables(robot)
    assert tables
    for _, (header, *rows) in tables:
        assert header[0] == "number"
        assert header[-2:] == ["source", "grade"]
        assert rows
        assert all(len(row) == len(header) and row[-1][0] in "ABC-" for row in rows)
    platform = platform_class(robot)()
    low, high = platform.command_bounds
    assert low.shape == high.shape == (len(platform.command_names),)
    assert (low < high).all()


@pytest.mark.parametrize(
    ("kind", "size"),
    [
        ("box", [0.3, 0.1, 0.2]),
        ("sphere", [0.2, 0, 0]),
        ("capsule", [0.1, 0.3, 0]),
        ("cylinder", [0.2, 0.3, 0]),
        ("ellipsoid", [0.3, 0.1, 0.2]),
    ],
)
def test_extents_of_a_turned_shape_are_where_its_surface_ends(kind, size):
    """Against where rays along each axis of the world first meet the shape, over a grid."""
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body(quat=[0.8, 0.3, -0.4, 0.33])
    body.add_geom(type=getattr(mujoco.mjtGeom, f"mjGEOM_{kind.upper()}"), size=size)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    found = _reach(model, data, 0)
    grid, hit = np.linspace(-0.5, 0.5, 101), np.zeros(1, dtype=np.int32)
    for axis in range(3):
        way, start = -np.eye(3)[axis], np.empty(3)
        reach = -1.0
        for a in grid:
            for b in grid:
                start[axis], start[axis - 1], start[axis - 2] = 1.0, a, b
                distance = mujoco.mj_ray(model, data, start, way, None, 1, -1, hit)
                if distance >= 0:
                    reach = max(reach, 1.0 - distance)
        # the grid misses a corner by a little
        assert reach <= found[axis] + 1e-9
        assert reach == pytest.approx(found[axis], abs=0.02)


def test_the_table_has_every_robot(capsys):
    assert main(["robots"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    for name in PLATFORMS:
        assert name in out
    row = next(line for line in out.splitlines() if "pioneer2dx" in line)
    for words in ("0.44 x 0.38 x 0.22", " 9 ", "1.6 m/s, 300 deg/s", "forward, turn", "(10 Hz)"):
        assert words in row
    assert "sonar0-15" in row


def test_one_robot_is_told_with_the_sources_of_its_numbers(capsys):
    assert main(["robots", "soccer_bot"]) == 0
    out = capsys.readouterr().out
    for words in (
        "forward -3 to 3, left -3 to 3, turn -12 to 12",
        "speeds up by 3 and slows down by 6 m/s^2",
        "localizer (60 Hz)",
        "Bruce and Veloso 2005, section 5",
        "The omni drive",
        "50 W flat brushless motor",
    ):
        assert words in out


def test_figures_come_from_the_proving_ground(capsys, monkeypatch, tmp_path):
    path = tmp_path / "figures.json"
    path.write_text(json.dumps({"pioneer2dx": {"5 m straight": "0.1 %", "top speed": 1.6}}))
    figures(monkeypatch, path)
    assert main(["robots"]) == 0
    out = capsys.readouterr().out
    assert "measured (proving-ground)" in out
    assert "5 m straight: 0.1 %" in out
    assert main(["robots", "pioneer2dx"]) == 0
    assert "Measured (proving-ground)" in capsys.readouterr().out
    path.write_text("[1]")
    assert main(["robots", "pioneer2dx"]) == 0
    out, err = capsys.readouterr()
    assert "cannot read committed figures" in err
    assert "9 kg" in out
    figures(monkeypatch, tmp_path / "not-yet.json")
    assert main(["robots"]) == 0
    assert "measured" not in capsys.readouterr().out


def test_a_broken_robot_does_not_hide_the_others(capsys, monkeypatch):
    monkeypatch.setattr(Pioneer2DX, "name", "pioneer3")
    assert main(["robots"]) == 1
    out, err = capsys.readouterr()
    assert "soccer_bot" in out
    assert err.startswith("mjmr: pioneer2dx: unknown robot model 'pioneer3'")


@pytest.mark.slow
def test_a_contact_sheet_shows_the_robot_from_all_sides_and_what_it_sees(tmp_path, capsys):
    assert main(["robots", "pioneer2dx", "--view"]) == 0
    assert capsys.readouterr().out == "contact sheet: renders/robots/pioneer2dx.png\n"
    sheet = cv2.imread(str(tmp_path / "renders/robots/pioneer2dx.png"))[..., ::-1].astype(int)
    height, width = sheet.shape[:2]
    assert (width, height) == (1298, 1018)
    half = (height - 46) // 2
    panels = [sheet[y : y + half, x : x + width // 2] for y in (46, 46 + half) for x in (0, 649)]

    def share(panel, rgb):
        """Of the pixels with this hue: channels in the same proportions, within a tenth."""
        bright = panel.max(axis=2) > 60
        scaled = panel / np.maximum(panel.max(axis=2, keepdims=True), 1)
        near = np.abs(scaled - np.array(rgb) / max(rgb)).max(axis=2) < 0.1
        return (near & bright).mean()

    red, yellow, orange = (0.78, 0.07, 0.06), (0.95, 0.85, 0.1), (0.95, 0.4, 0.05)
    front, side, top, own = panels
    assert share(front, red) > 0.05
    assert share(side, red) > 0.05
    assert share(top, yellow) > 0.01
    assert share(own, orange) > 0.005
    assert share(own, red) < 0.001  # it does not see itself
    for panel in panels:  # filled: no sky, no void
        assert (panel.max(axis=2) < 5).mean() < 0.001


def test_without_gl_a_view_is_one_sentence_and_exit_1(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "mjmr.cli", "robots", "soccer_bot", "--view", "--out", "a.png"],
        env=os.environ | {"MUJOCO_GL": "disable"},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 1
    assert done.stderr.startswith("mjmr: no off-screen OpenGL: install libegl1")
    assert done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []
