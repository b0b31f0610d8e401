"""Without off-screen OpenGL everything but pictures still runs, and says so in one sentence."""

import os
import subprocess
import sys

import pytest

SCRIPT = """
from mjmr import MjmrError
from mjmr.errors import MissingGLError
from mjmr.render import Renderer
from mjmr.sensors.camera import Camera
from mjmr.simulation import Simulation
from tests.mjmr.worlds import soccer

world, robots = soccer([[0.0, 0.0, 0.0]])
camera = world.add_camera(Camera(width=64, height=64), position=(0, 0, 4), look_at=(0, 0, 0))
simulation = Simulation(world)
for _ in simulation.ticks(0.1):
    robots.drive([[0.1, 0.0, 0.0]])
for picture in (lambda: Renderer(simulation.model, 64, 64), camera.read):
    try:
        picture()
    except MissingGLError as error:
        assert isinstance(error, MjmrError)
        print(error)
"""


def test_physics_runs_without_gl_and_a_picture_is_a_clear_error():
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT],
        env=os.environ | {"MUJOCO_GL": "disable"},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("no off-screen OpenGL: install libegl1") == 2


@pytest.mark.slow
def test_a_run_without_gl_skips_the_film_with_one_line(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "mjmr.cli", "run", "safe-navigation", "--out", str(tmp_path / "r"),
         "--only", "scene=overlap"],
        env=os.environ | {"MUJOCO_GL": "disable"},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    lines = [line for line in done.stderr.splitlines() if "OpenGL" in line]
    assert len(lines) == 1
    assert "film skipped" in lines[0]
    assert not (tmp_path / "r" / "film.mp4").exists()
    assert (tmp_path / "r" / "claims.json").exists()
