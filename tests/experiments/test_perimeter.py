"""The study: worlds, short trials, and what its claims stand on."""

from types import SimpleNamespace

import numpy as np
import pytest

from controllers.perimeter import ACQUIRE, MOVING, SEARCHING, TRACKING
from experiments.perimeter import study
from experiments.perimeter.claims import claims
from experiments.perimeter.evidence import flags, share, share_interval, untouched
from experiments.perimeter.measures import Log
from experiments.perimeter.plots import plots
from experiments.perimeter.sensing import INSIDE
from experiments.perimeter.trial import trial
from experiments.perimeter.worlds import build
from mjmr.bus import Change
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


def test_the_radio_graph_is_what_was_heard_and_not_who_is_in_range():
    found = run(task="stay", start="bunch", duration=5.0)
    assert found["graph"]
    assert len(found["heard"].split()) == len(found["graph"].split()) == 10
    # nothing is heard before the first broadcast
    assert all(":1-" in entry for entry in found["heard"].split())
    silent = run(task="join", failure="radio", d_com=150.0, duration=5.0)
    assert silent["graph"]
    assert not silent["heard"]


def test_odometry_drifts_and_nobody_steers_by_it():
    found = run(task="join", duration=40.0)
    assert 0.0 < found["drift_m"] < 1.0
    still = run(task="join", duration=40.0, mode="unicycle")
    # wheels that cannot slip are read as whole counts
    assert 0.0 < still["drift_m"] < found["drift_m"]


def _rows(**metrics):
    condition = study.condition(task="join")
    values = zip(*metrics.values(), strict=True)
    told = [dict(zip(metrics, row, strict=True)) for row in values]
    return Table(
        [Row(condition=condition, seed=k, status="ok", metrics=m) for k, m in enumerate(told)],
        study.parameters,
    )


def test_shares_have_wilson_s_interval_where_asked():
    table = _rows(all_track=[True] * 19 + [False])
    plain, wide = (f(flags("all_track"))(table) for f in (share, share_interval))
    assert plain.measured == wide.measured == pytest.approx(95.0)
    assert plain.interval is None
    assert wide.interval == pytest.approx((76.4, 99.1), abs=0.1)


def test_any_contact_counts_and_bodies_without_contact_are_refused():
    table = _rows(contacts=[0, 1, 0], obstacle_contact_s=[0.0, 0.0, 0.1])
    assert untouched(table).tolist() == [True, False, False]
    with pytest.raises(InvalidInputError, match="without contact"):
        untouched(_rows(contacts=[-1], obstacle_contact_s=[-1.0]))


@pytest.mark.parametrize(
    ("after", "gave_up"), [(SEARCHING, True), (ACQUIRE, False), (TRACKING, False)]
)
def test_a_location_is_given_up_by_searching_again_alone(after, gave_up):
    states = np.array([[SEARCHING]] * 5 + [[MOVING]] * 10 + [[after]] * 5)
    log = SimpleNamespace(_failure=SimpleNamespace(kind="lie", robot=0))
    found = Log._failing(log, 0.1 * np.arange(20), np.zeros((20, 1, 3)), states)  # pyright: ignore
    assert found["gave_up_s"] == pytest.approx(1.0 if gave_up else -1.0)


def test_reports_are_those_of_the_camera():
    changes = [
        Change(1.0, 0, "pose", "removed"), Change(2.5, 0, INSIDE, "removed"),
        Change(3.0, 1, INSIDE, "removed"),
    ]  # fmt: skip
    log = SimpleNamespace(
        _failure=SimpleNamespace(kind="camera", robot=0, at=2.0),
        _senses=SimpleNamespace(bus=SimpleNamespace(changes=changes)),
    )
    found = Log._failing(log, 0.1 * np.arange(50), np.zeros((50, 2, 3)), np.zeros((50, 2)))  # pyright: ignore
    assert found["reported_s"] == pytest.approx(0.5)
