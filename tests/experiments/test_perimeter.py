"""The study: worlds, short trials, and what its claims stand on."""

import numpy as np
import pytest

from experiments.perimeter import study
from experiments.perimeter.claims import claims
from experiments.perimeter.plots import plots
from experiments.perimeter.trial import trial
from experiments.perimeter.worlds import build
from mjmr.errors import InvalidInputError
from mjmr.table import Row, Table


def run(seed=1000, **values):
    return trial(study.condition(**values), seed)


def test_a_spill_larger_than_the_hall_is_refused_in_one_sentence():
    with pytest.raises(InvalidInputError, match="a spill of 60 m radius does not fit"):
        build(study.condition(radius=60.0), 0)


@pytest.mark.parametrize("start", ["scattered", "bunch", "even"])
def test_trucks_start_clear_of_each_other_and_of_the_spill(start):
    scene = build(study.condition(start=start), 1003)
    way = scene.start[:, None, :2] - scene.start[None, :, :2]
    apart = np.hypot(way[..., 0], way[..., 1]) + 99.0 * np.eye(5)
    assert apart.min() > 3.0
    assert scene.depth(scene.start[:, :2], 0.0).max() < -0.5


def test_trucks_track_a_growing_spill_without_touching_it():
    found = run(task="stay", start="bunch", growth=0.0125, duration=50.0)
    assert found["all_track"]
    assert 0.0 <= found["rms_m"] < 0.15
    assert found["contacts"] == 0
    assert found["obstacle_contact_s"] == 0.0
    assert found["anticlockwise_rad"] > 0.0
    assert found["top_turn"] <= 0.305


def test_both_kinds_of_bodies_do_the_same_on_a_disc():
    bodies = [
        run(task="stay", start="bunch", duration=40.0, mode=mode)
        for mode in ("physical", "unicycle")
    ]
    assert abs(bodies[0]["anticlockwise_rad"] - bodies[1]["anticlockwise_rad"]) < 0.1
    assert max(b["rms_m"] for b in bodies) < 0.05


def test_the_same_seed_gives_the_same_numbers():
    first, second = (run(duration=20.0, task="stay", mode="unicycle") for _ in range(2))
    assert first == second


def test_an_unplugged_camera_is_reported_and_its_truck_stops():
    found = run(task="stay", start="bunch", mode="unicycle", failure="camera", duration=40.0)
    assert 0.0 < found["reported_s"] <= 1.0
    assert found["stop_way_m"] < 0.01
    assert found["again"]


def test_claims_have_names_of_their_own_and_conditions_that_exist():
    told = claims()
    assert len({c.id for c in told}) == len(told)
    names = {p.name for p in study.parameters}
    planned = [c for grid in _grids("standard") for c in grid.conditions(study.parameters)]
    for claim in told:
        assert set(claim.needs) <= names
        met = [
            c for c in planned
            if all(c[k] in (v if isinstance(v, tuple | list) else (v,))
                   for k, v in claim.needs.items())
        ]  # fmt: skip
        assert met, claim.id


def _grids(name):
    return next(size.grids for size in study.sizes if size.name == name)


def test_plots_are_drawn_of_a_trial(tmp_path):
    condition = study.condition(task="stay", start="bunch", mode="physical", duration=3.0)
    row = Row(condition=condition, seed=0, status="ok", metrics=trial(condition, 0))
    written = plots(Table([row], study.parameters), tmp_path)
    assert {p.name for p in written} == {"states-stay.svg", "graph-stay.svg"}
    assert all(p.read_text().count("path") > 5 for p in written)
