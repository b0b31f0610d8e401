"""The bus: priority, bandwidth, hot plug, what the manager reports and when."""

import numpy as np
import pytest

from mjmr.bus import Bus, frame_bits
from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.kinematics import KinematicSimulation
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.world import World


class Source:
    """A device that samples at every tick, its reading the time."""

    def __init__(self, simulation, n=2):
        self.simulation, self.n = simulation, n

    def read(self):
        return np.full((self.n, 1), self.simulation.time)

    def sampled_at(self):
        return self.simulation.time


def setting(**options):
    world = World.rectangle(4.0, 4.0)
    world.add_group(SoccerBot, [[0, 0, 0], [1, 0, 0]])
    simulation = KinematicSimulation(world, control_period=0.1)
    return simulation, Bus(simulation, 2, **options), Source(simulation)


def run(simulation, bus, seconds, act=lambda t: None):
    for t in simulation.ticks(seconds):
        act(t)
        bus.step()


def attach(bus, source, name, identifier, size=8):
    bus.attach(name, identifier, source.read, source.sampled_at, size=size)


def test_frames_count_as_can_does():
    assert frame_bits(8) == 135  # an 11-bit identifier, 8 bytes, stuffed as badly as can be
    assert frame_bits(12) == 135 + 47 + 32 + (34 + 32 - 1) // 4
    assert frame_bits(0) == 47 + 33 // 4


def test_messages_arrive_and_have_an_age():
    simulation, bus, source = setting()
    attach(bus, source, "eye", 0x100)
    assert np.isinf(bus.age("eye")).all()
    with pytest.raises(InvalidInputError, match="nothing has come"):
        bus.read("eye")
    run(simulation, bus, 1.0)
    # what was sampled at the last tick has not had any time on the bus yet
    assert bus.read("eye")[0, 0] == pytest.approx(0.8)
    assert bus.age("eye") == pytest.approx([0.1, 0.1])


def test_nothing_is_sent_by_the_bandwidth_of_a_time_before_it_was_sampled():
    simulation, bus, source = setting()
    attach(bus, source, "eye", 0x100)
    for t in simulation.ticks(1.0):
        bus.step()
        age = bus.age("eye")
        assert age == pytest.approx([np.inf, np.inf] if t < 0.05 else [0.1, 0.1])


def test_the_lowest_identifier_goes_first_and_the_rest_starve():
    # polls take two short frames a device every 0.25 s; one message of 8 bytes fits beside them
    simulation, bus, source = setting(bit_rate=2600.0)
    for name, identifier in (("low", 0x300), ("high", 0x100), ("middle", 0x200)):
        attach(bus, source, name, identifier)
    run(simulation, bus, 10.0)
    ages = [bus.age(name)[0] for name in ("high", "middle", "low")]
    lost = dict(zip(("low", "high", "middle"), bus.lost[0], strict=True))
    assert ages[0] <= 0.2
    assert ages[0] <= ages[1] <= ages[2]
    assert lost["high"] < lost["middle"] < lost["low"]


def test_unplugged_devices_are_reported_within_a_second_and_only_there():
    simulation, bus, source = setting()
    attach(bus, source, "eye", 0x100)

    def act(t):
        if abs(t - 2.05) < 0.05:
            bus.unplug("eye", [1])
        if abs(t - 5.05) < 0.05:
            bus.plug("eye", [1])

    run(simulation, bus, 4.0, act)
    assert [(c.robot, c.device, c.kind) for c in bus.changes] == [(1, "eye", "removed")]
    assert 0.0 < bus.changes[0].time - 2.0 <= 1.0
    assert bus.present("eye").tolist() == [True, False]
    assert bus.age("eye")[0] == pytest.approx(0.1)
    assert bus.age("eye")[1] > 1.5
    run(simulation, bus, 3.0, act)
    assert [c.kind for c in bus.changes] == ["removed", "added"]
    assert 0.0 <= bus.changes[1].time - 5.0 <= 1.0
    assert bus.age("eye") == pytest.approx([0.1, 0.1])


def test_unhealthy_devices_are_told_from_absent_ones():
    simulation, bus, source = setting()
    attach(bus, source, "eye", 0x100)
    run(simulation, bus, 1.0)
    bus.fail("eye", [0])
    run(simulation, bus, 1.0)
    assert [(c.robot, c.kind) for c in bus.changes] == [(0, "unhealthy")]
    assert bus.age("eye")[0] > 0.5
    bus.mend("eye", [0])
    run(simulation, bus, 1.0)
    assert [c.kind for c in bus.changes] == ["unhealthy", "healthy"]


def test_snapshots_have_the_bus():
    simulation, bus, source = setting()
    attach(bus, source, "eye", 0x100)
    run(simulation, bus, 2.0)
    kept = simulation.snapshot()
    bus.unplug("eye", [0])
    run(simulation, bus, 2.0)
    assert bus.changes
    simulation.restore(kept)
    assert not bus.changes
    run(simulation, bus, 2.0)
    assert not bus.changes
    assert bus.read("eye")[:, 0] == pytest.approx([3.8, 3.8])


def test_wrong_devices_are_refused():
    _, bus, source = setting()
    attach(bus, source, "eye", 0x100)
    with pytest.raises(InvalidInputError, match="unique"):
        attach(bus, source, "ear", 0x100)
    with pytest.raises(InvalidInputError, match="identifier"):
        attach(bus, source, "ear", 0x10)
    with pytest.raises(InvalidInputError, match="already"):
        attach(bus, source, "eye", 0x101)
    with pytest.raises(UnknownNameError, match="eye"):
        bus.unplug("nose", [0])
