"""Sonars and dead reckoning: what trucks make of them, in scenes set up by hand."""

import dataclasses

import numpy as np
import pytest

from controllers.perimeter import PerimeterTeam
from experiments.perimeter import study
from experiments.perimeter.claims import claims
from experiments.perimeter.claims_all import everywhere
from experiments.perimeter.claims_senses import SENSES, senses
from experiments.perimeter.reckoning import Reckoning
from experiments.perimeter.sensing import BEAM, COMPASS, IDENTIFIERS, ODOMETER, SONAR, Senses, mount
from experiments.perimeter.trial import configuration, trial
from experiments.perimeter.worlds import HALF, SPILL_HEIGHT, WALL, Scene
from mjmr.kinematics import KinematicSimulation
from mjmr.robots.tamiya_txt1 import TamiyaTXT1
from mjmr.world import World

FAR = (30.0, 30.0, 5.0)  # a spill nobody is near


def set_up(poses, spill=FAR, start=None, **values):
    """A hall with trucks at poses (n, 3), and their senses."""
    condition = study.condition(robots=len(poses), mode="unicycle", **values)
    hall = World.rectangle(2 * HALF, 2 * HALF, wall_height=WALL, floor="concrete")
    hall.add_pillar(*spill, height=SPILL_HEIGHT)
    trucks = hall.add_group(TamiyaTXT1, poses)
    scene = Scene(
        world=hall, trucks=trucks, lobes=np.array([spill]), growth=0.0, limit=spill[2],
        start=np.array(poses if start is None else start, dtype=float),
    )  # fmt: skip
    mount(scene, condition)
    simulation = KinematicSimulation(hall, seed=0, control_period=0.1)
    return simulation, scene, Senses(simulation, scene, condition)


def stand(simulation, scene, bus, seconds=1.0):
    """What they know after having stood for a while."""
    n, known = scene.trucks.n, None
    for now in simulation.ticks(seconds):
        known = bus.look(now, np.ones(n, dtype=bool))
        scene.trucks.drive(np.zeros((n, 2)))
    assert known is not None
    return known


@pytest.mark.parametrize(
    ("poses", "spill", "seen"),
    [
        # the hull's front is 0.4 m ahead; what is met at more than 25 degrees returns nothing
        ([[HALF - 3.0, 0, 0]], FAR, {2: 2.7, 3: 2.61, 4: 2.61, 5: 2.7}),
        ([[0, 0, 0], [3.0, 0, 0]], FAR, {3: 2.5, 4: 2.5}),
        ([[0, 0, 0]], (13.0, 0.0, 10.0), {2: 2.73, 3: 2.61, 4: 2.61, 5: 2.73}),
        ([[0, 0, 0]], FAR, {}),
    ],
)
def test_what_eight_cones_return_of_wall_truck_and_spill(poses, spill, seen):
    simulation, scene, bus = set_up(poses, spill, obstacles="sonars")
    stand(simulation, scene, bus)
    ranges = scene.trucks.sonar.read()[0]
    assert ranges.shape == (8,)
    assert set(np.flatnonzero(np.isfinite(ranges))) == set(seen)
    for k, distance in seen.items():
        assert ranges[k] == pytest.approx(distance, abs=0.15)


def test_the_cones_cover_sixty_degrees_to_each_side():
    simulation, scene, bus = set_up([[0, 0, 0]], obstacles="sonars")
    stand(simulation, scene, bus)
    yaws = np.degrees(scene.trucks.sonar.mounts[:, 2])
    assert yaws == pytest.approx(np.arange(52.5, -60.0, -15.0), abs=0.1)
    assert scene.trucks.sonar.beam_width == pytest.approx(BEAM)


@pytest.mark.parametrize("yaw", np.linspace(-np.pi, np.pi, 9))
def test_walls_and_spill_are_nobody(yaw):
    for pose, spill in (
        ([HALF - 2.0, 0.0, yaw], FAR),
        ([HALF - 2.0, HALF - 2.5, yaw], (-30.0, 0.0, 5.0)),
        ([0.0, 0.0, yaw], (12.0, 0.0, 10.0)),
    ):
        simulation, scene, bus = set_up([pose], spill, obstacles="sonars")
        assert np.isnan(stand(simulation, scene, bus).body).all()


@pytest.mark.parametrize("bearing", [-0.8, -0.3, 0.0, 0.5])
def test_a_truck_is_somebody_within_half_a_beam(bearing):
    way = 2.2 * np.array([np.cos(bearing), np.sin(bearing)])
    poses = [[0.0, 0.0, 0.0], [*way, bearing + np.pi]]
    simulation, scene, bus = set_up(poses, obstacles="sonars")
    body = stand(simulation, scene, bus).body[0]
    # the origin is below the rear axle, what is met 0.4 m before it
    assert np.hypot(*body) == pytest.approx(1.8, abs=0.15)
    assert np.arctan2(body[1], body[0]) == pytest.approx(bearing, abs=0.2)


def test_a_truck_before_the_spill_is_told_from_it():
    poses = [[0.0, 0.0, 0.0], [2.0, 0.0, np.pi / 2]]
    simulation, scene, bus = set_up(poses, (13.2, 0.0, 10.0), obstacles="sonars")
    body = stand(simulation, scene, bus).body[0]
    assert body[0] == pytest.approx(1.8, abs=0.15)


def test_a_wall_that_is_nearer_than_the_robot_believes_is_something():
    pose, believed = [[HALF - 2.5, 0.0, 0.0]], [[HALF - 4.5, 0.0, 0.0]]
    simulation, scene, bus = set_up(
        pose, start=believed, obstacles="sonars", localization="odometry"
    )
    known = stand(simulation, scene, bus)
    assert known.pose[0] == pytest.approx(believed[0])
    assert known.body[0] == pytest.approx([2.5, 0.0], abs=0.35)


def drive_at_one_who_stands(unplug):
    """Least distance of a truck that heads for one that is off, without radio."""
    poses = [[0.0, 0.0, 0.0], [8.0, 0.1, np.pi / 2]]
    values = {"obstacles": "sonars", "d_com": 0.0}
    simulation, scene, bus = set_up(poses, **values)
    config = configuration(study.condition(robots=2, **values))
    straight = dataclasses.replace(config, spiral_turn=1e-9)
    team = PerimeterTeam(2, straight, np.random.default_rng(0))
    if unplug:
        bus.bus.unplug(SONAR, [0])
    on, nearest = np.array([True, False]), np.inf
    apart: list[float] = []
    simulation.observe(
        lambda: apart.append(
            float(np.hypot(*np.subtract(*simulation.truth.poses(scene.trucks)[:, :2])))
        )
    )
    for now in simulation.ticks(15.0):
        known = bus.look(now, on)
        if known is not None:
            command = team.step(known)
            command[1] = 0.0
            scene.trucks.drive(command)
    nearest = min(apart)
    reported = [c.device for c in bus.bus.changes if c.kind == "removed"]
    return nearest, reported


def test_a_stranger_ahead_stops_a_truck_with_sonars_and_not_one_whose_are_unplugged():
    nearest, reported = drive_at_one_who_stands(False)
    assert nearest > 1.2
    assert reported == []
    nearest, reported = drive_at_one_who_stands(True)
    assert nearest < 0.5
    assert reported == [SONAR]


def test_devices_have_identifiers_of_their_own():
    assert len(set(IDENTIFIERS.values())) == len(IDENTIFIERS)


def test_who_loses_its_odometer_does_not_know_where_it_is_until_it_has_it_again():
    simulation, scene, bus = set_up([[0.0, 0.0, 0.0], [0.0, 9.0, 0.0]], localization="odometry")
    told, on = [], np.ones(2, dtype=bool)
    for now in simulation.ticks(6.0):
        known = bus.look(now, on)
        scene.trucks.drive(np.full((2, 2), [0.5, 0.0]))
        told.append(np.full((2, 3), np.nan) if known is None else known.pose)
        if round(now, 6) == 2.0:
            bus.bus.unplug(ODOMETER, [0])
        if round(now, 6) == 4.0:
            bus.bus.plug(ODOMETER, [0])
    told = np.array(told)
    assert np.isnan(told[30:38, 0]).all()
    assert np.isfinite(told[5:, 1]).all()
    assert not (told[30:38, 0] == told[30:38, 1]).any()
    # counts go on while nobody reads them
    assert told[-1, 0, 0] == pytest.approx(told[-1, 1, 0], abs=0.01)


def test_without_its_compass_a_truck_does_not_know_where_it_is():
    simulation, scene, bus = set_up([[0.0, 0.0, 0.0]], localization="odometry-compass")
    bus.bus.unplug(COMPASS, [0])
    assert bus.look(simulation.time, np.ones(1, dtype=bool)) is None
    simulation, scene, bus = set_up([[0.0, 0.0, 0.0]], localization="odometry-compass")
    assert stand(simulation, scene, bus).pose[0] == pytest.approx([0.0, 0.0, 0.0], abs=0.1)
    bus.bus.unplug(COMPASS, [0])
    assert np.isnan(stand(simulation, scene, bus, 2.0).pose).all()


def test_headings_of_a_compass_turn_the_way_that_was_counted():
    _, scene, _ = set_up([[0.0, 0.0, 0.0]], localization="odometry")
    counts = np.array([[1000.0, 1000.0]])
    plain, turned = Reckoning(scene), Reckoning(scene)
    first = plain.step(counts)[0]
    assert first[0] == pytest.approx(1000.0 / 1024.0 * 2 * np.pi * TamiyaTXT1.rolling_radius)
    turned.step(0 * counts, np.array([np.pi / 2]))
    assert turned.step(counts, np.array([np.pi / 2]))[0] == pytest.approx(
        [0.0, first[0], np.pi / 2]
    )
    assert plain.step(np.full((1, 2), np.nan))[0] == pytest.approx(first)


@pytest.mark.parametrize("name", ["suite", "compass"])
def test_teams_with_other_senses_track(name):
    given = SENSES[name][0]
    found = trial(study.condition(task="stay", start="bunch", duration=35.0, **given), 1000)
    assert found["all_track"]
    assert 0.0 < found["rms_m"] < 0.05
    assert found["contacts"] == 0
    assert found["obstacle_contact_s"] == 0.0
    assert 0.0 < found["drift_worst_m"] < 0.5


def test_a_team_by_odometry_errs_as_odometry_does():
    """The pose is the odometers' alone: two noises of the localizer change nothing."""
    values = {"task": "stay", "start": "bunch", "duration": 20.0, "mode": "unicycle"}
    found = trial(study.condition(localization="odometry", **values), 1000)
    assert found["drift_worst_m"] < 0.02  # wheels that cannot slip
    assert found["drift_worst_deg"] < 1.0
    known = trial(study.condition(localization="odometry-compass", **values), 1000)
    assert known["drift_worst_deg"] > found["drift_worst_deg"]


def test_claims_of_these_senses_and_the_others_have_conditions_of_their_own():
    told = senses()
    assert len({c.id for c in told}) == len(told) == 28
    for claim in told:
        assert (claim.needs["obstacles"], claim.needs["localization"]) != ("fan", "localizer")
    ids = {c.id for c in (*told, *everywhere())}
    for claim in claims():
        if claim.id not in ids and claim.needs["task"] in ("join", "stay"):
            assert (claim.needs["obstacles"], claim.needs["localization"]) == ("fan", "localizer")
