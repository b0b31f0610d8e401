"""Study consensus: formations that move, and averages by radio."""

from typing import Any

import numpy as np
import pytest

from experiments.consensus import study, teams
from experiments.consensus.average import Patrol
from experiments.consensus.claims import claims
from experiments.consensus.moving import PATHS, MovingTeam, Path, measure
from experiments.consensus.plots import plots
from experiments.consensus.trial import trial, world
from mjmr.claims import judge
from mjmr.errors import InvalidInputError, TruthError
from mjmr.table import Row, Table

CORNERS = np.array([[2.0, 0.0], [-1.0, 1.5], [-1.0, -1.5]])
MOVING = {
    "mode": "physical", "experiment": "moving", "schedule": "case-i", "side": 4.0, "weight": 0.8,
    "turn_rate": 0.4, "duration": 30.0,
}  # fmt: skip
AVERAGE = {"mode": "physical", "experiment": "average", "robots": 5, "duration": 12.0}


def run(given: dict[str, Any], seed=1000, **more) -> Any:
    return trial(study.condition(**{**given, **more}), seed)


@pytest.mark.parametrize("kind", PATHS)
def test_velocities_and_accelerations_of_paths_are_those_of_their_places(kind):
    path = Path(kind, np.array([1.0, 2.0]), 0.2, 0.3, CORNERS)
    h = 1e-4
    for at in (path.point, path.offsets):
        before, now, after = at(3.0 - h), at(3.0), at(3.0 + h)
        np.testing.assert_allclose(now[1], (after[0] - before[0]) / (2 * h), atol=1e-6)
        np.testing.assert_allclose(now[2], (after[0] - 2 * now[0] + before[0]) / h**2, atol=1e-5)
    np.testing.assert_allclose(path.point(0.0)[0], [1.0, 2.0])
    np.testing.assert_allclose(path.offsets(0.0)[0], CORNERS)


def test_patrols_give_the_velocities_of_their_places():
    patrol, h = Patrol(6, True, np.random.default_rng(0)), 1e-4
    before, now, after = patrol.at(2.0 - h), patrol.at(2.0), patrol.at(2.0 + h)
    np.testing.assert_allclose(now[1], (after[0] - before[0]) / (2 * h), atol=1e-6)
    np.testing.assert_allclose(now[2], (after[0] - 2 * now[0] + before[0]) / h**2, atol=1e-5)
    assert np.hypot(*now[1].T).max() <= 0.41


def test_the_papers_law_lags_as_the_loop_says_and_what_is_told_closes_the_gap():
    alone = run(MOVING)
    assert alone["theory_2_m"] == pytest.approx(0.504)
    assert alone["theory_3_m"] == pytest.approx(1.008)
    assert alone["lag_off"] < 0.02
    told = run(MOVING, feedforward="told")
    assert told["formation_rms_m"] < 0.05 * alone["formation_rms_m"]
    assert alone["contacts"] == told["contacts"] == 0
    assert run(MOVING) == alone


@pytest.mark.parametrize("path", ["circle", "rotate", "scale"])
def test_what_turns_and_swings_is_followed_as_the_loop_says(path):
    found = run(MOVING, path=path, schedule="star", turn_rate=0.3)
    assert found["lag_off"] < 0.05
    assert found["leader_rms_m"] < 0.01


def test_the_controller_of_a_moving_formation_reads_no_truth():
    team = MovingTeam(study.condition(**MOVING, feedforward="told"), 1000)
    for time in team.simulation.ticks(0.2):
        team.tick(time)
        with pytest.raises(TruthError):
            team.simulation.truth.poses(team.robots)


def test_robots_agree_on_the_mean_unless_messages_get_lost():
    kept = run(AVERAGE, patrol=False)
    assert kept["average_error"] < 0.05 < kept["reading_error"]
    assert abs(kept["average_bias"]) < 1e-12
    assert kept["connected"] == 1.0
    lost = run(AVERAGE, patrol=False, loss=0.5)
    assert abs(lost["average_bias"]) > 1e-3
    ratio = run(AVERAGE, patrol=False, loss=0.5, rule="ratio", duration=40.0)
    assert ratio["average_error"] < 0.01
    assert run(AVERAGE, patrol=False) == kept


def test_robots_that_patrol_meet_others_and_touch_nobody():
    found = run(AVERAGE, duration=20.0)
    assert found["contacts"] == 0
    assert found["connected"] < 1.0
    assert abs(found["average_bias"]) < 1e-12
    assert found["average_error"] < 0.9 * found["reading_error"]


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({**MOVING, "schedule": "alternate"}, "schedule=case-i, case-ii, star are allowed; got"),
        ({**MOVING, "sight": "rays"}, "led by one robot.*got sight=rays"),
        ({**MOVING, "duration": 15.0}, r"last turn, 15\.71 s at turn_rate=0\.4; got duration=15"),
        ({**MOVING, "speed": 0.9}, r"speed is at most 0\.8 m/s; got 0\.9"),
        ({**AVERAGE, "delay": 0.2}, r"within a round of 0\.1 s; got delay=0\.2"),
        ({**AVERAGE, "mode": "linear"}, "experiment average is of mode physical; got linear"),
    ],
)
def test_what_does_not_go_together_is_refused_in_a_sentence(given, told):
    with pytest.raises(InvalidInputError, match=told):
        run(given)


@pytest.mark.parametrize("path", PATHS)
def test_who_hears_no_leader_is_told_before_anything_moves(path):
    given = {**MOVING, "weight": 0.0, "anyway": True, "path": path, "duration": 1e6}
    with pytest.raises(InvalidInputError, match="robot 1 does not hear robot 0"):
        world(study.condition(**given))


@pytest.mark.parametrize(
    ("given", "size"),
    [
        ({"experiment": "three"}, (12.0, 11.5)),
        ({"experiment": "graph", "robots": 5}, (9.6, 9.6)),
        ({**MOVING, "speed": 0.7, "path": "circle"}, None),
        ({**AVERAGE, "patrol": False}, (10.0, 11.2)),
    ],
    ids=lambda v: v.get("experiment") if isinstance(v, dict) else None,
)
def test_the_world_that_is_shown_is_the_one_that_is_run(given, size, monkeypatch):
    condition, ran = study.condition(**{"mode": "physical", "duration": 0.1, **given}), []
    monkeypatch.setattr(teams, "measure", lambda team: ran.append(team) or {})
    trial(condition, 0)
    shown, (team,) = world(condition), ran
    assert shown.to_xml() == team.simulation.world.to_xml()
    low_x, low_y, high_x, high_y = shown.bounds
    if size is None:  # the leader's circle of 3.5 m fits in
        assert high_y - low_y > 7.0
    else:
        assert (high_x - low_x, high_y - low_y) == pytest.approx(size)
    count = condition["robots"] if given["experiment"] in ("graph", "average") else 3
    assert f"rover{count - 1}/" in shown.to_xml()
    assert f"rover{count}/" not in shown.to_xml()


def test_walls_that_are_touched_count_in_formations_that_move():
    class Tight(MovingTeam):
        def _places(self, condition, streams):
            start, offsets, (x0, y0, _, y1) = super()._places(condition, streams)
            return start, offsets, (x0, y0, (start + offsets)[:, 0].max() + 0.6, y1)

    short = {**MOVING, "turn_rate": 0.9, "duration": 7.0, "speed": 0.7}
    assert run(short)["wall_contact_seconds"] == 0.0
    assert measure(Tight(study.condition(**short), 1000))["wall_contact_seconds"] > 1.0


@pytest.mark.parametrize(
    ("name", "given", "good", "bad"),
    [
        ("moving-line-lag", {**MOVING}, {"lag_off": 0.01}, {"lag_off": 0.2}),
        ("moving-line-lag", {**MOVING}, {"lag_off": 0.01}, {"lag_off": None}),
        ("moving-told", {**MOVING, "feedforward": "told"}, {"formation_rms_m": 0.01},
         {"formation_rms_m": 0.1}),
        ("average-kept", AVERAGE, {"average_bias": -1e-15}, {"average_bias": -1e-3}),
        ("average-ratio", {**AVERAGE, "rule": "ratio", "loss": 0.5, "patrol": False},
         {"average_error": 1e-4}, {"average_error": 0.1}),
    ],
)  # fmt: skip
def test_one_bad_run_fails_a_claim(name, given, good, bad):
    claim = next(c for c in claims() if c.id == name)

    def verdict(*metrics: dict[str, Any]) -> str:
        rows = [Row(study.condition(**given), seed, "ok", m) for seed, m in enumerate(metrics)]
        return judge(claim, Table(rows, study.parameters), "standard").verdict

    assert verdict(good, good, good) == "holds"
    assert verdict(good, bad, good) == "fails"


def test_followers_are_drawn_from_where_their_own_leader_goes(tmp_path, monkeypatch):
    """Outputs that stand on the path of robot 2, who leads, are nowhere away from it."""
    condition = study.condition(**{**MOVING, "schedule": "case-ii", "weight": 0.2})
    at = [[2.0 + 0.2 * t, 5.0] for t in range(4)]
    words = " ".join(f"{v:.3f}" for v in np.repeat(at, 3, axis=0).ravel())
    metrics = {"outputs": words, **{f"theory_{i}_m": 1.0 for i in (1, 2, 3)}}
    drawn = []
    monkeypatch.setattr(
        "matplotlib.axes.Axes.plot", lambda axes, y, *a, **k: drawn.append((y, k["label"]))
    )
    plots(Table([Row(condition, 0, "ok", metrics)], study.parameters), tmp_path)
    assert [np.max(y) for y, _ in drawn] == [1e-3, 1e-3]
    assert [label for _, label in drawn] == ["line, law alone", None]


def test_plots_show_what_ran(tmp_path):
    rows = []
    for given in ({**MOVING, "weight": 0.2}, {**AVERAGE, "duration": 3.0}):
        condition = study.condition(**given)
        rows.append(Row(condition, 0, "ok", trial(condition, 1000)))
    made = plots(Table(rows, study.parameters), tmp_path)
    assert [path.name for path in made] == ["moving.svg", "average-bias.svg"]
    assert "line, law alone" in made[0].read_text()
    assert plots(Table([], study.parameters), tmp_path) == []


def test_a_bias_that_is_large_in_the_mean_decides():
    claim = next(c for c in claims() if c.id == "average-loss-biased")
    condition = study.condition(**{**AVERAGE, "loss": 0.5, "patrol": False})

    def verdict(biases: Any) -> str:
        rows = [Row(condition, k, "ok", {"average_bias": b}) for k, b in enumerate(biases)]
        return judge(claim, Table(rows, study.parameters), "standard").verdict

    assert verdict([0.1, -0.2, 0.15, -0.1, 0.12]) == "holds"
    assert verdict([1e-3, -2e-3, 1e-3, 0.0, 1e-3]) == "fails"
    assert verdict([0.1, 0.0, 0.0, 0.0, 0.0]) == "inconclusive"
