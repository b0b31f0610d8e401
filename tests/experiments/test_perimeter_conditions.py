"""What the study refuses, what it just allows, and its leader's paths."""

import numpy as np
import pytest

from experiments.perimeter import study
from experiments.perimeter.checks import check
from experiments.perimeter.formation import (
    HALF_LONG,
    HALF_WIDE,
    SEPARATION,
    _turn,
    start_of,
)
from experiments.perimeter.trial import trial
from experiments.perimeter.worlds import build
from mjmr.cli import main
from mjmr.robots.tamiya_txt1 import TamiyaTXT1

BAD = [
    ("radius=60", "the largest has 34 m"),
    ("radius=35 growth=0.01", "the largest has 34 m"),
    ("robots=100", "at most 42 do"),
    ("failure=added robots=1", "needs 2 robots or more"),
    ("failure=removed robots=1", "needs 2 robots or more"),
    ("failure=added start=even radius=18", "at most 17 m"),
    ("task=formation duration=20", "must be more than 30 s"),
    ("duration=0.4", "duration"),
    ("edge=lobes start=bunch", "give edge=disc"),
    ("start=bunch robots=15", "at most 14 do"),
    ("start=even robots=19", "at most 18 do"),
    ("task=envelope duration=30", "does not read duration"),
    ("task=formation failure=radio", "does not read failure"),
    ("task=formation heard=nothing d_com=10", "have no radio"),
    ("path=circle", "does not read path"),
    ("sensing=camera wrong=0.2", "wrong is of readings of the ray"),
]


@pytest.fixture(autouse=True)
def _named(monkeypatch):
    monkeypatch.setenv("MJMR_STUDIES", "perimeter=experiments.perimeter:study")


@pytest.mark.parametrize(("given", "words"), BAD)
def test_what_cannot_be_run_is_refused_in_one_sentence(given, words, capsys):
    assert main(["trial", "perimeter", *given.split()]) == 2
    told = capsys.readouterr().err.strip()
    assert words in " ".join(told.split())
    assert told.count("mjmr:") == 1
    assert "Traceback" not in told


def test_a_run_of_a_spill_larger_than_the_hall_is_refused(capsys, tmp_path):
    assert main(["run", "perimeter", "--only", "radius=60", "--out", str(tmp_path / "r")]) == 2
    assert "no condition with radius=60" in " ".join(capsys.readouterr().err.split())


@pytest.mark.parametrize(
    "most",
    [
        {"robots": 42},
        {"robots": 14, "start": "bunch"},
        {"robots": 18, "start": "even"},
        {"radius": 34.0},
        {"radius": 17.0, "start": "even", "failure": "added"},
        {"edge": "lobes", "radius": 20.0, "growth": 0.01},
    ],
)
def test_what_is_just_allowed_has_room(most):
    for seed in range(1000, 1004):
        scene = build(study.condition(**most), seed)
        way = scene.start[:, None, :2] - scene.start[None, :, :2]
        apart = np.hypot(way[..., 0], way[..., 1]) + 99.0 * np.eye(len(way))
        assert apart.min() > 3.0
        assert np.abs(scene.start[:, :2]).max() < 49.0


def test_every_planned_condition_is_allowed():
    for size in study.sizes:
        for grid in size.grids:
            for condition in grid.conditions(study.parameters):
                check(condition)


def test_who_hears_plainly_and_who_moves_it_on_are_two_laws():
    errors = [
        trial(study.condition(task="formation", path="circle", heard=heard, duration=35.0), 1000)
        for heard in ("extrapolated", "plain")
    ]
    assert errors[0]["place_rms_m"] < errors[1]["place_rms_m"] < 0.3


def test_who_hears_nothing_follows_what_its_camera_sees():
    condition = study.condition(task="formation", path="circle", heard="nothing", duration=33.0)
    assert trial(condition, 1000)["place_rms_m"] < 0.1


def test_the_eight_changes_sides_at_once_and_the_smooth_one_does_not():
    times = np.arange(0.0, 160.0, 0.1)
    sharp, smooth, circle = (
        np.array([_turn(path, t) for t in times]) for path in ("eight", "eight-smooth", "circle")
    )
    assert set(np.round(np.unique(sharp), 9)) == {-0.08, 0.0, 0.08}
    assert np.abs(np.diff(smooth)).max() < 0.003
    assert np.abs(smooth).max() == pytest.approx(0.08)
    assert set(np.unique(circle)) == {0.0, 0.08}


@pytest.mark.parametrize(
    ("name", "fits"),
    [("circle", True), ("eight", False), ("eight-middle", True), ("eight-smooth-middle", True)],
)
def test_paths_in_the_middle_keep_leader_and_followers_off_the_walls(name, fits):
    path, (x, y, yaw) = start_of(name)
    track = []
    for now in np.arange(0.0, 160.0, 0.1):
        yaw += 0.1 * _turn(path, now)
        x, y = x + 0.08 * np.cos(yaw), y + 0.08 * np.sin(yaw)
        track.append((x, y))
    room = np.array([HALF_LONG, HALF_WIDE]) - np.abs(track).max(axis=0)
    assert (room.min() > SEPARATION + TamiyaTXT1.radius) == fits
