"""The study's tests refuse to measure robots that do nothing."""

import numpy as np
import pytest

from experiments.proving_ground import aibo_trials, course, noise, study
from experiments.proving_ground.trial import trial
from mjmr.claims import Bound
from mjmr.conditions import Grid
from mjmr.group import Group
from mjmr.table import Row, Table


def run(**given):
    return trial(study.condition(**given), 0)


@pytest.mark.parametrize(
    "given",
    [
        {"platform": "koala", "test": "straight"},
        {"platform": "koala", "test": "turn", "turn": 2.0},
        {"platform": "koala", "test": "odometry", "turn": 2.0},
        {"platform": "koala", "test": "square", "variant": "left", "speed": 0.4},
        {"platform": "tamiya_txt1", "test": "unicycle-open", "variant": "changing"},
    ],
    ids=lambda g: g["test"],
)
def test_a_robot_that_does_not_move_is_no_robot_without_error(given, monkeypatch):
    obeyed = run(**given)
    assert all(np.isfinite(v) for v in obeyed.values())
    monkeypatch.setattr(Group, "drive", lambda self, command: None)
    with pytest.raises(course.NothingMeasuredError, match=r"nothing was measured: (way|turn)"):
        run(**given)


def test_what_is_not_a_number_is_nothing():
    with pytest.raises(course.NothingMeasuredError, match="pixels came to nan"):
        course.demand("pixels", float("nan"), 1)
    course.demand("pixels", 1, 1)


def test_a_base_that_errs_either_way_is_not_the_same_at_every_timestep():
    (claim,) = [c for c in study.load_claims() if c.id == "pioneer-straight-timestep"]
    conditions = Grid(test="straight", dt_ms=(2.0, 5.0)).conditions(study.parameters)
    errors = (0.2, -0.2)
    rows = [
        Row(c, 0, "ok", {"error_pct": abs(e), "over_pct": e})
        for c, e in zip(conditions, errors, strict=True)
    ]
    found = claim.evaluate(Table(rows, study.parameters)).measured
    assert found == pytest.approx(0.4)
    assert claim.bound == Bound("<=", 0.1)


def test_noise_reaches_both_cables_from_many_places_and_a_winch_only_as_far_as_it_pulls(
    monkeypatch,
):
    built = []

    class Kept(noise.Simulation):
        def __init__(self, world, **options):
            super().__init__(world, **options)
            built.append((world.groups[0], self.model))

    monkeypatch.setattr(noise, "Simulation", Kept)
    condition = study.condition(platform="nims", test="noise")
    for seed in range(6):
        trial(condition, seed)
    assert {group.platform.cable_model for group, _ in built} == {"curve", "tendon"}
    assert len({float(group.start[0, 0]) for group, _ in built}) == 6
    model = built[0][1]
    winch = model.actuator("nims0/winch").id
    low, high = noise._ranges(model)
    # the set point gets ahead by what saturates the motor in 50 ms
    most = -model.actuator_forcerange[winch, 0] / model.actuator_gainprm[winch, 0]
    assert (low[winch], high[winch]) == pytest.approx((-most / 0.05, most / 0.05))


def test_noise_that_moves_nothing_is_refused(monkeypatch):
    monkeypatch.setattr(noise, "_ranges", lambda model: (np.zeros(model.nu), np.zeros(model.nu)))
    with pytest.raises(course.NothingMeasuredError, match="fastest speed"):
        run(platform="koala", test="noise")


def test_the_truck_rolls_over_at_a_speed_it_drove_not_only_one_it_was_asked_for():
    found = run(platform="tamiya_txt1", test="roll-over-steps")
    # inner wheels spin: it never drives what it is asked for
    assert 2.0 < found["rolls_driven"] < found["rolls_at"] - 0.05
    assert found["held_driven"] < found["rolls_driven"]


def test_a_floor_is_as_it_is_unless_a_friction_is_named():
    def sliding(friction):
        return float(aibo_trials.world_with(friction).spec().geom("floor").friction[0])

    assert sliding(0.0) == float(course.hall(4.0).spec().geom("floor").friction[0]) > 0.5
    assert sliding(0.6) == 0.6
