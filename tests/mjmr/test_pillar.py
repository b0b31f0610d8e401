"""Pillars: contact, rays and pictures follow a radius that is a function of time."""

import mujoco
import numpy as np
import pytest

from mjmr import Camera, Simulation, Spot, TamiyaTXT1, VisualArc, World
from mjmr.errors import InvalidInputError
from mjmr.kinematics import KinematicSimulation
from mjmr.pillar import Pillar, radii_at
from mjmr.sensors.visual_arc import PILLAR


def hall(distance=3.0, radius=1.0, yaw=0.0, **options):
    world = World.rectangle(40.0, 40.0, wall_height=0.6)
    world.add_pillar(distance + radius, 0.0, radius, **options)
    return world, world.add_group(TamiyaTXT1, [[0.0, 0.0, yaw]])


@pytest.mark.parametrize("kind", [Simulation, KinematicSimulation])
def test_rays_meet_the_radius_of_the_instant_they_were_sent_at(kind):
    world, trucks = hall(growth=0.1, limit=2.0)
    arc = trucks.mount(
        VisualArc(site="lidar", height=0.2, columns=3, field_of_view=0.2, max_range=9.0, rate=1.0)
    )
    simulation = kind(world, control_period=0.1, dt_max=0.01)
    late = []
    for t in simulation.ticks(14.0):
        look = arc.read()[0, 1]
        late.append((arc.sampled_at, look[0], t))
        assert look[1] == PILLAR
    for sampled, met, t in late:
        surface = 3.0 - min(0.1 * sampled, 1.0)
        assert met == pytest.approx(surface - 0.24, abs=0.01), t


def test_growing_into_a_truck_pushes_it_away():
    world, trucks = hall(distance=0.6, radius=1.0, growth=0.05, limit=1.5)
    simulation = Simulation(world, control_period=0.1, dt_max=0.01)
    for _ in simulation.ticks(10.0):
        pass
    front = simulation.truth.poses(trucks)[0, 0] + 0.40
    # the wall has come 0.5 m nearer, from 0.2 m before the bumper; brakes roll back a little
    assert simulation.truth.poses(trucks)[0, 0] < -0.2
    assert front < 0.6 - 0.5 + 0.06


def test_a_still_pillar_stops_a_truck():
    world, trucks = hall(distance=1.5)
    simulation = Simulation(world, control_period=0.1, dt_max=0.01)
    for _ in simulation.ticks(6.0):
        trucks.drive([[0.5, 0.0]])
    assert 0.9 < simulation.truth.poses(trucks)[0, 0] < 1.3


def test_restoring_a_snapshot_restores_the_radius():
    world, trucks = hall(growth=0.1, limit=2.0)
    simulation = Simulation(world, control_period=0.1, dt_max=0.01)
    geom = simulation.model.geom("pillar0").id
    for _ in simulation.ticks(2.0):
        pass
    kept, size = simulation.snapshot(), simulation.model.geom_size[geom, 0]
    for _ in simulation.ticks(3.0):
        pass
    simulation.restore(kept)
    # at once, before anything moves: the radius of the next period is that of its beginning
    assert simulation.model.geom_size[geom, 0] == pytest.approx(1.2, abs=1e-9)
    for _ in simulation.ticks(0.1):
        pass
    assert simulation.model.geom_size[geom, 0] == pytest.approx(size + 0.01, abs=1e-9)


def test_contacts_right_after_restoring_are_those_of_the_radius_of_that_instant():
    world, _ = hall(distance=1.0, radius=1.0, growth=0.2, limit=4.0)
    simulation = Simulation(world, control_period=0.1, dt_max=0.01)
    model, data = simulation.model, simulation.data
    geom = model.geom("pillar0").id

    def touched():
        return bool((data.contact.geom == geom).any())

    kept = simulation.snapshot()
    for _ in simulation.ticks(5.0):
        pass
    grown = model.geom_size[geom, 0]
    simulation.restore(kept)
    assert not touched()
    # the truck where it was before, in the pillar that came later
    model.geom_size[geom, 0] = grown
    mujoco.mj_forward(model, data)
    assert touched()


def test_what_stops_growing_or_shrinking_stops_at_its_limit():
    first, rate, limit = [1.0, 1.0, 1.0], [0.1, -0.1, 0.0], [1.5, 0.8, 9.0]
    for time, expected in ((-1.0, [1.0, 1.0, 1.0]), (1.0, [1.1, 0.9, 1.0]), (9.0, [1.5, 0.8, 1.0])):
        assert radii_at(first, rate, limit, time) == pytest.approx(expected)


def test_pictures_show_the_same_edge_as_rays():
    world, trucks = hall(distance=1.6, radius=3.0, yaw=-np.pi / 2, growth=0.1, limit=3.7)
    eye = trucks.mount(
        Camera(width=160, height=120, rate=2.0, position=(0.1, 0.1, 0.42), look_at=(0.1, 1.2, 0.0)),
        "eye",
    )
    spot = trucks.mount(Spot(position=(0.1, 0.1, 0.42), target=(0.1, 1.2, 0.0), rate=2.0))
    simulation = Simulation(world, control_period=0.1, dt_max=0.01)
    seen = []
    for _ in simulation.ticks(8.0):
        if eye.sampled_at == spot.sampled_at:
            middle = eye.read()[0, 58:62, 78:82].reshape(-1, 3).astype(float).mean(axis=0)
            seen.append((spot.read()[0] > 0.5, middle[0] > 2.0 * middle[1]))
    simulation.close()
    rays, pictures = np.array(seen[3:]).T
    assert rays.any()
    assert not rays.all()
    assert np.count_nonzero(rays != pictures) <= 5  # one image around the crossing


def test_wrong_readings_are_as_many_as_asked_for():
    world, trucks = hall(distance=8.0)
    spot = trucks.mount(Spot(position=(0.1, 0, 0.42), target=(1, 0, 0), rate=10.0, wrong=0.2))
    simulation = KinematicSimulation(world, control_period=0.1)
    told = [float(spot.read()[0]) for _ in simulation.ticks(100.0)]
    assert 0.15 < np.mean(told) < 0.25


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"radius": -1.0}, "radius"),
        ({"radius": 1.0, "growth": 0.1}, "limit"),
        ({"radius": 1.0, "growth": 0.1, "limit": 0.5}, "away from"),
        ({"radius": 1.0, "growth": np.nan}, "growth"),
    ],
)
def test_impossible_pillars_are_refused(options, words):
    with pytest.raises(InvalidInputError, match=words):
        Pillar(x=0.0, y=0.0, **options)


def test_a_pillar_larger_than_the_hall_is_refused_in_one_sentence():
    world = World.rectangle(20.0, 20.0)
    with pytest.raises(InvalidInputError, match="does not fit between the walls"):
        world.add_pillar(0.0, 0.0, 5.0, growth=0.1, limit=11.0)
