"""The study's own tests: outcomes on seeds that decide no claim, never coordinates."""

import re
from pathlib import Path

import numpy as np
import pytest

from controllers.perception.arc_objects import MOVER, ROBOT
from controllers.pushing import Parameters, pusher_machine
from experiments.versatile_pushing import study
from experiments.versatile_pushing.claims import claims
from experiments.versatile_pushing.sight import LENS, SKIRT, CameraSight, sight
from experiments.versatile_pushing.tasks import largest_gap
from experiments.versatile_pushing.worlds import (
    DISC_HEIGHT,
    HALF,
    HOME,
    LARGE_AT,
    NEST,
    RING_HEIGHT,
    SMALL,
    TASKS,
    around,
    at_home,
    build,
    places,
)
from mjmr.claims import Row, Table, judge
from mjmr.robots.round_pusher import RoundPusher
from mjmr.simulation import Simulation

trial = study.bound_trial()
TRANSPORT = {"task": "transport", "c": 1.0, "weight": 1, "robots": 2, "p": 2.0, "duration": 60.0}


def run(seed=1000, **values):
    return trial(study.condition(**{"map": 1000} | values), seed)


def test_two_robots_bring_weight_1_home_and_one_does_not():
    assert run(**TRANSPORT)["success"]
    alone = run(**TRANSPORT | {"robots": 1, "duration": 30.0})
    assert not alone["success"]
    assert alone["travel_m"] < 0.3


def test_exact_positions_are_never_taken_by_two():
    metrics = run(**TRANSPORT | {"p": 0.0, "duration": 30.0})
    assert not metrics["success"]
    assert run(**TRANSPORT | {"p": 0.0, "recovery": True})["success"]


def test_foraging_brings_discs_home():
    metrics = run(task="foraging", duration=60.0)
    assert metrics["share"] >= 0.3
    assert metrics["push"] > 0.1


def test_construction_brings_discs_out():
    start = TASKS["construction"].done(places("construction", 1000)).mean()
    metrics = run(task="construction", b=True, duration=40.0)
    assert metrics["share"] > start + 0.3


def test_without_the_build_flag_the_nest_is_not_built():
    metrics = run(task="construction", b=False, duration=20.0)
    assert metrics["share"] == 0.0


def test_robots_wander_while_cameras_are_dark_and_finish_afterwards():
    metrics = run(**TRANSPORT, failure="camera")
    assert metrics["dark_wander"] == 1.0
    assert metrics["success"]


def test_a_stopped_robot_is_missed_only_if_there_is_no_spare_one():
    assert run(**TRANSPORT | {"robots": 3}, failure="stopped")["success"]
    assert not run(**TRANSPORT | {"duration": 30.0}, failure="stopped")["success"]


@pytest.mark.slow
def test_the_camera_does_what_rays_do():
    pytest.importorskip("mujoco")
    assert run(**TRANSPORT, vision="camera")["success"]
    metrics = run(task="vision", duration=9.0)
    assert metrics["both_share"] > 0.85
    assert metrics["objects"] > 50


def test_same_seed_same_bits_while_global_randomness_is_stirred():
    values = {"task": "construction", "b": True, "duration": 6.0}
    first = run(**values)
    np.random.seed(1)  # noqa: NPY002
    assert run(**values) == first
    other = run(1001, **values)
    assert other["switches"] != first["switches"] or other["travel_m"] != first["travel_m"]


def test_maps_depend_on_their_number_alone_and_keep_the_papers_rules():
    for number in range(1000, 1020):
        foraging, nest = places("foraging", number), places("construction", number)
        assert np.array_equal(foraging, places("foraging", number))
        assert (len(foraging), len(nest)) == (10, 30)
        assert np.abs(foraging).max() <= HALF - 0.5
        assert np.abs(foraging).max(axis=1).min() >= HOME
        distance = np.hypot(*nest.T)
        assert 1.0 <= distance.min() <= distance.max() <= NEST
        for found in (foraging, nest):
            apart = np.hypot(*(found[:, None] - found[None]).transpose(2, 0, 1))
            assert apart[~np.eye(len(found), dtype=bool)].min() > 2 * SMALL
    assert not np.array_equal(places("foraging", 1000), places("foraging", 1001))


def test_the_largest_gap_of_a_ring_is_found_across_the_seam_too():
    angles = np.radians([170.0, -175.0, -90.0, 0.0, 60.0])
    places = np.column_stack([np.cos(angles), np.sin(angles)])
    assert largest_gap(places) == pytest.approx(110.0)
    turned = np.column_stack([np.cos(angles + 1.3), np.sin(angles + 1.3)])
    assert largest_gap(turned) == pytest.approx(110.0)


def test_robots_start_where_the_paper_says():
    assert np.abs(at_home(4)[:, :2]).max(axis=1) == pytest.approx(HOME)
    poses = around(LARGE_AT, 4, np.random.default_rng(0))
    away = np.array(LARGE_AT) - poses[:, :2]
    # all face the disc
    assert np.arctan2(away[:, 1], away[:, 0]) == pytest.approx(
        (poses[:, 2] + np.pi) % (2 * np.pi) - np.pi, abs=1e-6
    )


def test_what_sensors_are_told_of_the_model_is_so():
    world, _ = build("foraging", robots=1)
    model = Simulation(world).model
    camera = model.camera("pusher0/camera").id
    body = model.cam_bodyid[camera]
    assert model.body_pos[body, 2] + model.cam_pos[camera, 2] == pytest.approx(LENS)
    # the ring looks over discs and meets the hulls of robots and walls
    hull = model.geom("pusher0/hull")
    top = hull.pos[2] + hull.size[1]
    assert DISC_HEIGHT < RING_HEIGHT < top
    assert DISC_HEIGHT < LENS
    paint = [
        model.geom(g)
        for g in range(model.ngeom)
        if model.geom_bodyid[g] == model.body("pusher0/base").id
    ]
    skirts = [g.pos[2] + g.size[1] for g in paint if g.size[0] > RoundPusher.radius and
              g.pos[2] < 0.1 and g.type == 5]  # fmt: skip
    assert skirts == pytest.approx([SKIRT])


@pytest.mark.slow
def test_the_camera_tells_where_things_are():
    """One robot, one disc ahead and one robot aside: against where they were put."""
    world, robots = build("transport", robots=2, weight=0, vision="both")
    world.start_at({"pusher": [[-2.0, 0.6, np.pi / 2], [-2.9, 1.5, -0.8]]})
    simulation = Simulation(world, seed=0, control_period=0.1, dt_max=0.01)
    eyes = [sight("arcs", robots, 1.0), CameraSight(robots, 1.0)]
    looks = []
    for _ in simulation.ticks(0.1):
        looks = [eye.look() for eye in eyes]
    simulation.close()
    for look in looks:
        disc = look.centre[0, look.kind[0] == MOVER]
        assert disc == pytest.approx(np.array([[1.9, 0.0]]), abs=0.15)
        mate = look.centre[0, look.kind[0] == ROBOT]
        assert mate == pytest.approx(np.array([[0.9, 0.9]]), abs=0.2)


def test_the_page_shows_the_diagram_of_the_machine_that_runs():
    page = (Path(__file__).parents[2] / "docs/versatile-pushing.md").read_text()
    shown = re.findall(r"```mermaid\n(.*?)```", page, re.S)
    machine = pusher_machine(Parameters(c=0.0, p=1.0, b=True))
    assert shown == [machine.mermaid()]


@pytest.mark.parametrize("size", ["quick", "standard", "full"])
def test_every_claim_that_a_size_decides_has_its_trials(size):
    """A table in which every trial succeeded leaves no claim without a measurement."""
    metrics = {
        "success": True, "share": 1.0, "on_wall": 0, "travel_m": 0.1, "dark_wander": 1.0,
        "both_share": 1.0, "bearing_rms_deg": 1.0, "range_median_pct": 1.0,
        "near_range_rms_m": 0.01, "error_pct": 0.0, "creep_mm": 0.0, "arrival_mm": 0.0,
        "ring_gap_deg": 40.0, "push_share": 1.0, "way": 1.0, "aside": 0.0,
    }  # fmt: skip
    rows = [
        Row(condition, seed, "ok", {**metrics, "time_s": 100.0 + 10 * float(condition["c"]) + seed})
        for condition, seed in study.trials(size)
    ]
    table = Table(rows, study.parameters)
    for claim in claims():
        verdict = judge(claim, table, size)
        assert not verdict.error, verdict.error
        if size in claim.sizes:
            assert verdict.measured is not None, (claim.id, verdict.why)
