"""Work W: what the benchmark measures is what it says."""

import numpy as np
import pytest

from mjmr.bench_crowd import _advance, bare, build, crowd, crowds
from mjmr.errors import UnknownNameError
from mjmr.world_spec import leave_out_drawn


def test_bare_steps_are_the_physics_of_the_blind_variant():
    """Every coordinate is that of the loop, bit for bit, after two seconds."""
    run, data = bare(3, 0.005, 2)
    assert run() > 0
    assert run() > 0
    simulation, robots = build(3, 0.005, False)
    advance = _advance(simulation, robots)
    advance()
    advance()
    assert data.qpos.tobytes() == simulation.data.qpos.tobytes()
    assert np.hypot(*(robots.start - simulation.truth.poses(robots)).T[:2]).min() > 0.2


def test_leaving_out_what_is_drawn_changes_no_bit_of_the_physics():
    found = []
    for edit in (None, leave_out_drawn):
        simulation, robots = build(3, 0.01, True)
        if edit:
            world = simulation.world
            world.edit(edit)
            simulation = type(simulation)(world, control_period=0.1, dt_max=0.01)
            assert simulation.model.ngeom < 100
        _advance(simulation, robots)()
        found.append((simulation.data.qpos.tobytes(), robots.lidar.read().tobytes()))
    assert found[0] == found[1]


def test_robots_with_lidars_turn_away():
    """Blind ones run into something within 8 s, the others seldom come as near."""
    closest = []
    for sees in (False, True):
        simulation, robots = build(6, 0.01, sees)
        advance, touches = _advance(simulation, robots), []
        hulls = [simulation.model.geom(f"{name}/hull").id for name in robots.names]

        def count(data=simulation.data, hulls=hulls, touches=touches):
            pairs = data.contact.geom[: data.ncon]
            touches.append(np.isin(pairs, hulls).any(axis=1).sum())

        simulation.watch_steps(count)
        for _ in range(8):
            advance()
        closest.append(np.sum(touches))
    assert closest[1] < 0.5 * closest[0]


def test_it_says_what_it_measured_and_refuses_unknown_sizes():
    text = crowd(1, (2,))
    assert text.count("N =   2") == 5
    assert "ratio 1 [1, 1]" in text
    with pytest.raises(UnknownNameError, match="valid: quick, "):
        crowds("quik")
