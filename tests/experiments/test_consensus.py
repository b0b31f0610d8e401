"""Study consensus: its graphs, its linear model, and short runs of bodies."""

import subprocess
import sys
from typing import Any

import numpy as np
import pytest

from controllers.consensus import CanonicalModel, NeighbourGains, check_structure, rooted
from experiments.consensus import quotes, study
from experiments.consensus.claims import claims
from experiments.consensus.graphs import random_admissible, team_graph, three
from experiments.consensus.linear import START, Runner, degrees_of, reference
from experiments.consensus.linear import run as follow
from experiments.consensus.physical import Team
from experiments.consensus.plots import series
from experiments.consensus.refusals import READS, refuse
from experiments.consensus.trial import trial, world
from mjmr.claims import judge
from mjmr.errors import InvalidInputError, TruthError
from mjmr.table import Row, Table

RULE = NeighbourGains(3)
SHORT = {"mode": "physical", "duration": 4.0}


def run(seed=1000, **given) -> Any:
    return trial(study.condition(**given), seed)


def test_claims_are_told_apart_and_name_parameters_there_are():
    every = claims()
    assert len({c.id for c in every}) == len(every)
    names = {p.name for p in study.parameters}
    assert all(set(c.needs) <= names for c in every)


def test_texts_are_quotes_or_say_that_they_are_not():
    quoted = {v for k, v in vars(quotes).items() if k.isupper()}
    for claim in claims():
        assert claim.text in quoted or claim.text.startswith((quotes.ABSENT, "beyond the paper: "))


@pytest.mark.parametrize(
    ("name", "given", "good", "bad"),
    [
        ("body-spread", {}, {"spread_m": 0.01}, {"spread_m": 0.03}),
        ("body-spread", {}, {"spread_m": 0.01}, {"spread_m": None}),
        ("body-error", {}, {"error_m": 0.01}, {"error_m": 0.06}),
        ("body-contacts-all", {"loss": 0.5}, {"contacts": 0}, {"contacts": 1}),
        ("body-distance-all", {"schedule": "case-i"}, {"least_distance_m": 2.0},
         {"least_distance_m": 0.9}),
        ("literal-meets", {"side": 0.0, "virtual": True}, {"spread_m": 0.01}, {"spread_m": 0.2}),
        ("crowd-agrees", {"experiment": "graph", "robots": 100}, {"agree_s": 31.0},
         {"agree_s": None}),
        ("stochastic-rows-robots", {"mode": "linear"}, {"row_error": 1e-15}, {"row_error": 1e-8}),
        ("stochastic-entries-robots", {"mode": "linear"}, {"least": 0.0}, {"least": -1e-8}),
    ],
)  # fmt: skip
def test_one_bad_run_fails_a_claim(name, given, good, bad):
    claim = next(c for c in claims() if c.id == name)
    condition = study.condition(**{"mode": "physical", **given})

    def verdict(*metrics: dict[str, Any]) -> str:
        rows = [Row(condition, seed, "ok", m) for seed, m in enumerate(metrics)]
        return judge(claim, Table(rows, study.parameters), "standard").verdict

    assert verdict(good, good, good) == "holds"
    assert verdict(good, bad, good) == "fails"


@pytest.mark.parametrize("size", ["quick", "standard", "full"])
def test_every_size_has_what_its_claims_need(size):
    conditions = [c for c, _ in study.trials(size)]
    for claim in claims():
        if size not in claim.sizes:
            continue
        wanted = {k: v if isinstance(v, tuple) else (v,) for k, v in claim.needs.items()}
        assert any(all(c[k] in v for k, v in wanted.items()) for c in conditions), claim.id


def test_schedules_that_meet_the_condition_are_told_from_those_that_never_do():
    rng = np.random.default_rng(0)
    names = ("alternate", "case-i", "star", "joint", "isolated", "decaying")
    holds = {name: three(name, 2.0, 60.0, 0.2, rng, RULE).structure().holds for name in names}
    assert holds == {"alternate": True, "case-i": True, "star": True, "joint": False,
                     "isolated": False, "decaying": False}  # fmt: skip


@pytest.mark.parametrize("mode", ["linear", "physical"])
@pytest.mark.parametrize("schedule", ["isolated", "decaying", "joint"])
def test_hopeless_graphs_are_refused_before_running_and_run_if_asked(mode, schedule):
    given = {"mode": mode, "schedule": schedule, "dwell": 0.5, "duration": 10.0}
    with pytest.raises(InvalidInputError, match="never meet Assumption 4.2.*anyway=true"):
        run(**given)
    if mode == "linear":
        assert run(**given, anyway=True)["spread_m"] > 0.5


def test_degrees_below_one_or_of_the_wrong_number_are_refused():
    assert degrees_of("3 1 2", 3) == [3, 1, 2]
    with pytest.raises(InvalidInputError, match="system 1 has 0"):
        run(degrees="1 0 2")
    with pytest.raises(InvalidInputError, match="there are 3 robots; got 2 degrees"):
        run(degrees="1 2")
    with pytest.raises(InvalidInputError, match="whole numbers separated by spaces"):
        run(degrees="two")
    with pytest.raises(InvalidInputError, match="experiment lemmas is of mode linear"):
        run(mode="physical", experiment="lemmas")


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"experiment": "graph", "sight": "camera", "robots": 4}, "has its graph given.*camera"),
        ({"experiment": "graph", "sight": "rays"}, "has its graph given.*rays"),
        ({"degrees": "1 2 3"}, "degrees and weight_y are of mode=linear; got degrees='1 2 3'"),
        ({"weight_y": 0.5}, "weight_y=0.5"),
        ({"sight": "rays", "loss": 0.5, "delay": 0.1}, "loss, delay are of what.*sight=rays"),
        ({"experiment": "agreement", "noise": 0.05}, "agreement does not read noise: leave it at"),
        ({"side": 0.0}, "side=0 needs virtual=true"),
        ({"sight": "rays", "scan": True, "avoid": "barrier"}, "scan=true.*avoid=none is allowed"),
    ],
)
def test_what_does_not_go_together_is_refused_in_a_sentence(given, told):
    with pytest.raises(InvalidInputError, match=told):
        run(mode="physical", **given)


def test_no_size_runs_what_is_refused():
    for size in ("quick", "standard", "full"):
        for condition, _ in study.trials(size):
            refuse(condition)


@pytest.mark.parametrize(("experiment", "mode"), READS)
def test_parameters_an_experiment_does_not_read_are_refused_by_name(experiment, mode):
    """Each but those of which a sentence of its own is told."""
    fit = {"experiment": experiment, "mode": mode}
    fit |= {"schedule": "case-i", "duration": 70.0} if experiment == "moving" else {}
    refuse(study.condition(**fit))
    for parameter in study.parameters:
        if parameter.name in {*READS[experiment, mode], *fit, "sight", "degrees", "weight_y"}:
            continue
        usual = parameter.default
        if parameter.values:
            other = next(c for c in parameter.values if c != usual)
        else:
            other = not usual if isinstance(usual, bool) else usual + 1
            other = 0.5 if parameter.most == 1.0 else other
        told = f"experiment={experiment}.* does not read {parameter.name}: leave it at .*; got"
        with pytest.raises(InvalidInputError, match=told):
            refuse(study.condition(**fit, **{parameter.name: other}))


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"sight": "rays", "schedule": "star"}, "sight=rays does not read schedule"),
        ({"scan": True}, "sight=given does not read scan: leave it at false; got scan=true"),
        ({"experiment": "moving", "schedule": "star", "path": "scale", "speed": 0.3},
         r"path=scale does not read speed: leave it at 0\.2; got speed=0\.3"),
        ({"mode": "linear", "degrees": "3", "experiment": "graph"},
         "experiment=graph with mode=linear does not read degrees: leave it at 2; got degrees=3"),
    ],
)  # fmt: skip
def test_what_another_parameter_makes_idle_is_refused(given, told):
    with pytest.raises(InvalidInputError, match=told):
        run(**{"mode": "physical", **given})


@pytest.mark.parametrize("seed", range(5))
def test_random_sequences_are_admissible_and_the_others_between_are_not_all(seed):
    rng = np.random.default_rng(seed)
    q = int(rng.integers(5, 13))
    graphs, gains = random_admissible(q, 24, rng)
    assert check_structure(graphs, gains, epsilon=0.01).holds
    alone = [
        check_structure([g], [w], epsilon=0.01).holds for g, w in zip(graphs, gains, strict=True)
    ]
    assert all(alone[::3])
    assert not all(alone)
    np.testing.assert_allclose(np.sum(gains, axis=2), 1.0)


@pytest.mark.parametrize("name", ["ring", "path", "star", "complete", "geometric"])
def test_graphs_of_many_are_connected_both_ways(name):
    graph = team_graph(name, 12, np.random.default_rng(3))
    assert (graph == graph.T).all()
    assert rooted(graph)
    links = graph.sum() - 12
    assert links == {"ring": 24, "path": 22, "star": 22, "complete": 132}.get(name, links)


def test_the_table_of_dwells_and_a_leader_with_a_velocity():
    found = run(dwell=5.0)
    assert (found["x_m"], found["y_m"]) == pytest.approx((4.511, 3.744), abs=1e-3)
    schedule = three("case-i", 5.0, 300.0, 0.2, np.random.default_rng(0), RULE)
    velocity = np.array([[0.4, -0.2], [0.0, 0.0], [0.0, 0.0]])
    ends = follow(Runner([2, 2, 2]), START, schedule, 300.0, velocity=velocity)
    # a leader that starts with velocity w ends at p + w / 2
    assert (ends["x_m"], ends["y_m"]) == pytest.approx((6.2, 2.9), abs=1e-6)


@pytest.mark.parametrize("dwell", [0.7, 0.1])
def test_gains_change_at_the_instants_of_a_schedule_that_no_look_falls_on(dwell):
    schedule = three("alternate", dwell, 8 * dwell, 0.2, np.random.default_rng(0), RULE)
    model = CanonicalModel([2, 2, 2])
    state = model.start(START)
    for gains in schedule.gains:
        state = model.transition(gains, dwell) @ state
    middle = state[model.outputs].mean(axis=0)
    found = follow(Runner([2, 2, 2]), START, schedule, 8 * dwell)
    assert (found["x_m"], found["y_m"]) == pytest.approx(tuple(middle), abs=1e-12)
    np.testing.assert_allclose(reference(schedule, 8 * dwell), middle, atol=1e-12)


def test_a_linear_trial_loads_no_simulator_no_vision_and_no_solver():
    code = (
        "import sys\n"
        "from experiments.consensus import study\n"
        "from experiments.consensus.trial import trial\n"
        "trial(study.condition(duration=1.0), 1000)\n"
        "print([m for m in ('mujoco', 'cv2', 'osqp') if m in sys.modules])\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_bodies_close_in_and_the_same_seed_gives_the_same_bits():
    one, two = run(**SHORT), run(**SHORT)
    assert one == two
    assert run(seed=1001, **SHORT)["x_m"] != one["x_m"]
    outputs, heard = series(one)
    assert outputs.shape == (5, 3, 2)
    assert heard.shape == (5, 3, 3)
    assert one["spread_m"] < 4.0 < np.linalg.norm(outputs[0, 0] - outputs[0, 1])
    assert one["contacts"] == 0


def test_a_controller_reads_no_truth():
    team = Team(study.condition(**SHORT, sight="rays", scan=True), 1000)
    for time in team.simulation.ticks(0.2):
        team.tick(time)
        with pytest.raises(TruthError):
            team.simulation.truth.poses(team.robots)


def test_who_sees_nobody_stands_unless_it_scans():
    alone = {**SHORT, "sight": "rays", "cone_deg": 10.0}
    assert run(seed=1002, **alone)["peak_turn"] < 0.05
    assert run(seed=1002, **alone, scan=True)["peak_turn"] > 0.4


def test_a_dead_robot_stands_and_a_hundredfold_team_is_built_without_overlap():
    team = Team(study.condition(**SHORT, fault="follower-dies"), 1000)
    team.run(12.0)
    before = team.log.output[2].copy()
    team.run(1.0)
    np.testing.assert_allclose(team.log.output[2], before, atol=1e-3)
    crowd = Team(study.condition(**SHORT, experiment="graph", robots=30, graph="complete"), 1000)
    apart = crowd.log.spread_now
    crowd.run(2.0)
    assert crowd.log.meter.episodes == 0
    assert crowd.log.spread_now < 0.6 * apart


def test_virtual_robots_pass_through_each_other_and_are_carried_by_the_floor():
    """Robots 1 and 2 have to pass each other: bodies jam, virtual ones do not."""
    given = {"mode": "physical", "side": 1.2, "places": "crossed", "duration": 40.0}
    bodies, virtual = run(**given), run(**given, virtual=True)
    assert bodies["contacts"] > 0
    assert virtual["contacts"] == 0
    assert virtual["least_distance_m"] < 0.4 < bodies["least_distance_m"]
    assert virtual["spread_m"] < 0.2 < bodies["spread_m"]
    team = Team(study.condition(mode="physical", side=0.0, virtual=True), 1000)
    team.run(1.0)
    base = team.simulation.data.body("rover0/base")
    assert abs(base.xpos[2]) < 0.01


def test_the_world_can_be_written_as_mjcf():
    assert "rover2/" in world(study.condition(mode="physical")).to_xml()


@pytest.mark.slow
def test_cameras_and_rays_tell_the_same():
    found = run(mode="physical", experiment="agreement", scan=True, duration=8.0)
    assert found["inside_same"] > 0.98
    assert found["bearing_rms_deg"] < 1.0
    assert found["seen"] > 50


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ({"schedule": "isolated"}, "never meet Assumption 4.2"),
        ({"degrees": "0"}, "1 or more"),
        ({"experiment": "lemmas", "mode": "physical"}, "of mode linear"),
        ({"experiment": "average", "mode": "physical", "noise": 0.1}, "does not read noise"),
        ({"path": "circle"}, "experiment=three with mode=linear does not read path: leave it at"),
    ],
)
def test_what_cannot_be_run_is_bad_input_and_not_a_failed_trial(given, why, capsys):
    from mjmr.cli import main

    words = [f"{name}={value}" for name, value in given.items()]
    assert main(["trial", "consensus", *words]) == 2
    assert why in capsys.readouterr().err
