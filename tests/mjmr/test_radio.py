"""The radio: who hears what and when, exactly, whoever asks first."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.faults import Fault
from mjmr.kinematics import KinematicSimulation
from mjmr.radio import Radio
from mjmr.robots.pioneer2dx import Pioneer2DX
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.simulation import Simulation
from mjmr.statistics import proportion
from mjmr.trace import Trace
from mjmr.world import World
from tests.mjmr.worlds import BOTH

PERIOD = 0.1
FACTS = {"study": "s", "condition": {}, "seed": 0, "error": ""}


def row(n, apart=1.0, kind=KinematicSimulation, seed=0, **options):
    """n robots along x, two groups; returns (simulation, radio, groups)."""
    world = World(bounds=[-1, -2, apart * n + 1, 2])
    x = apart * np.arange(n)
    poses = np.column_stack([x, np.zeros(n), np.zeros(n)])
    half = max(1, n // 2)
    groups = [world.add_group(SoccerBot, poses[:half])]
    if n > half:
        groups.append(world.add_group(Pioneer2DX, poses[half:]))
    simulation = kind(world, seed=seed, control_period=PERIOD)
    return simulation, Radio(simulation, **options), groups


def heard(radio, simulation, agents):
    """(receiver, sender, payload) of everything read now."""
    return [(a, m.sender, m.payload) for a in agents for m in radio.receive(a)]


@pytest.mark.parametrize("kind", BOTH)
def test_a_message_goes_to_those_it_is_for(kind):
    simulation, radio, _ = row(4, kind=kind)
    for k, t in enumerate(simulation.ticks(0.3)):
        if k == 0:
            radio.send(0, b"one", 2)
            radio.send("pioneer2dx1", b"two", ["soccer_bot1", 0])
            radio.broadcast(1, b"three")
            assert not heard(radio, simulation, range(4)), "nothing is heard in the same tick"
        elif k == 1:
            found = heard(radio, simulation, range(4))
            assert found == [
                (0, 3, b"two"), (0, 1, b"three"), (1, 3, b"two"),
                (2, 0, b"one"), (2, 1, b"three"), (3, 1, b"three"),
            ]  # fmt: skip
        else:
            assert not heard(radio, simulation, range(4)), "nothing comes twice"
        assert t == simulation.time


@pytest.mark.parametrize("kind", BOTH)
@pytest.mark.parametrize(("latency", "steps"), [(0.0, 1), (0.03, 6), (0.031, 7), (0.25, 50)])
def test_latency_is_exact_in_physics_steps(kind, latency, steps):
    """At 5 ms: the first tick at or after the step it is due."""
    simulation, radio, _ = row(2, kind=kind, latency=latency)
    assert simulation.timestep == pytest.approx(0.005)
    arrivals = {}
    for t in simulation.ticks(2.0):
        for message in radio.receive(1):
            arrivals[message.number] = (t, message)
        radio.send(0, b"", 1)
    assert len(arrivals) == 20 - np.ceil(steps * 0.005 / PERIOD - 1e-9)
    for number, (t, message) in arrivals.items():
        assert message.sent == pytest.approx(number * PERIOD)
        assert message.delivered == pytest.approx(message.sent + steps * 0.005)
        assert 0 <= t - message.delivered + 1e-9 < PERIOD


def test_a_radio_reaches_exactly_as_far_as_it_says():
    """Robots 1 m apart: at a range of 2 m those two away hear, at a hair less they do not."""
    for reach, count in ((2.0, 2), (2.0 - 1e-9, 1), (0.0, 0), (np.inf, 4)):
        simulation, radio, _ = row(5, range=reach)
        for _ in simulation.ticks(PERIOD):
            radio.broadcast(0, b"x")
        assert sum(len(radio.receive(a)) for a in range(5)) == count
        assert radio.messages_received.tolist() == [0] + [1] * count + [0] * (4 - count)


@pytest.mark.parametrize("kind", BOTH)
def test_range_is_measured_when_a_message_is_sent(kind):
    """The first robot drives away from the second; what was sent in reach arrives all the same."""
    simulation, radio, groups = row(2, kind=kind, range=1.5, latency=0.3)
    positions, got = [], []
    simulation.observe(lambda: positions.append(simulation.truth.poses(groups[0])[0, 0]))
    for _ in simulation.ticks(2.0):
        groups[0].drive([[-0.5, 0.0, 0.0]])
        radio.send(1, b"", 0)
        got.extend(m.number for m in radio.receive(0))
    inside = [k for k in range(17) if 1.0 - positions[k] <= 1.5]
    assert got == inside
    assert 8 < len(inside) < 17


def test_sight_is_asked_for_once_an_instant_with_the_sender_first():
    calls = []

    def visible():
        calls.append(1)
        return np.triu(np.ones((3, 3), dtype=bool))

    simulation, radio, _ = row(3, visible=visible)
    for _ in simulation.ticks(2 * PERIOD):
        for agent in range(3):
            radio.broadcast(agent, b"x")
    assert len(calls) == 2
    for receiver, senders in ((0, []), (1, [0]), (2, [0, 1])):
        assert [m.sender for m in radio.receive(receiver)] == senders * 2
    simulation, radio, _ = row(3, visible=lambda: np.ones((3, 2), dtype=bool))
    with pytest.raises(InvalidInputError, match=r"flags of shape \(3, 3\)"):
        radio.broadcast(0, b"x")


@pytest.mark.parametrize("loss", [0.0, 0.03, 0.5, 1.0])
def test_the_share_lost_is_the_one_stated(loss):
    simulation, radio, _ = row(20, loss=loss)
    for _ in simulation.ticks(10.0):
        for agent in range(20):
            radio.broadcast(agent, b"x")
    for _ in simulation.ticks(PERIOD):
        pass
    kept, sent = int(radio.messages_received.sum()), 20 * 19 * 100
    found = proportion(kept, sent, confidence=0.999)
    assert found.low <= 1.0 - loss <= found.high
    assert radio.messages_sent.tolist() == [100] * 20


def test_losses_are_independent_of_each_other():
    simulation, radio, _ = row(6, loss=0.4)
    got = []
    for _ in simulation.ticks(200.0):
        radio.broadcast_arrays(np.zeros((6, 1)))
        got.append(radio.latest()[1])
    got = np.array(got)
    fresh = np.diff(got, axis=0, prepend=np.nan) > 0
    fresh |= np.isnan(np.roll(got, 1, axis=0)) & ~np.isnan(got)
    pairs = ~np.eye(6, dtype=bool)
    flags = fresh[2:, pairs].astype(float)
    assert flags.mean() == pytest.approx(0.6, abs=0.01)
    across = np.corrcoef(flags.T) - np.eye(30)
    assert np.abs(across).max() < 5 / np.sqrt(len(flags))
    again = ((flags[1:] - 0.6) * (flags[:-1] - 0.6)).mean() / 0.24
    assert abs(again) < 0.02


def conversation(simulation, radio, seconds, order=1, stir=False, start=0):
    """Everybody broadcasts and reads, in one order or the other; what each one heard."""
    team = list(range(simulation.team.n))[::order]
    got = []
    for k, _ in enumerate(simulation.ticks(seconds)):
        if stir:
            np.random.seed(k)  # noqa: NPY002
            radio.messages_received  # noqa: B018
        for agent in team:
            if order > 0:
                got += [(a, m.sender, m.number, m.sent, m.delivered, m.payload)
                        for a in [agent] for m in radio.receive(a)]  # fmt: skip
            radio.broadcast(agent, bytes([agent, (k + start) % 256]))
        radio.broadcast_arrays(np.full((len(team), 2), 0.1 * (k + start)))
        if order < 0:
            got += [(a, m.sender, m.number, m.sent, m.delivered, m.payload)
                    for a in team for m in radio.receive(a)]  # fmt: skip
        got.append(radio.latest()[0].tobytes())
    return got


@pytest.mark.parametrize("kind", BOTH)
def test_order_of_reading_and_sending_and_the_global_generator_change_nothing(kind):
    options = {"kind": kind, "loss": 0.3, "latency": 0.02, "range": 3.5, "seed": 3}
    one = conversation(*row(6, **options)[:2], 3.0)
    other = conversation(*row(6, **options)[:2], 3.0, order=-1, stir=True)

    def told(items):
        return sorted(i for i in items if isinstance(i, tuple))

    assert told(one) == told(other)
    assert [i for i in one if isinstance(i, bytes)] == [i for i in other if isinstance(i, bytes)]
    assert one != conversation(*row(6, **options | {"seed": 4})[:2], 3.0)
    assert 0 < len(told(one)) < 6 * 5 * 30


def test_losses_do_not_depend_on_what_others_send_or_how_many_follow():
    def numbers(n, chatter):
        simulation, radio, _ = row(n, loss=0.5)
        got = []
        for _ in simulation.ticks(4.0):
            radio.send(0, b"x", 1)
            if chatter:
                radio.broadcast(1, b"y")
            got += [m.number for m in radio.receive(1)]
        return got

    assert numbers(2, False) == numbers(2, True) == numbers(8, True)


@pytest.mark.parametrize("kind", BOTH)
def test_a_snapshot_taken_in_mid_flight_goes_on(kind):
    options = {"kind": kind, "loss": 0.3, "latency": 0.25, "seed": 3, "inbox": 7}
    simulation, radio, _ = row(4, **options)
    for _ in simulation.ticks(0.5):
        radio.broadcast(0, b"unread")
    conversation(simulation, radio, 0.5)
    for _ in simulation.ticks(0.4):
        radio.broadcast(2, b"unread")
    snapshot = simulation.snapshot()
    assert radio._flights, "there is something on its way"

    def counts(radio):
        names = ("messages_sent", "bytes_sent", "messages_received", "bytes_received", "overflowed")
        return [getattr(radio, name).tolist() for name in names]

    before, rest = counts(radio), conversation(simulation, radio, 1.0, start=9)
    after = counts(radio)
    simulation.restore(snapshot)
    assert counts(radio) == before
    assert conversation(simulation, radio, 1.0, start=9) == rest
    fresh, other, _ = row(4, **options)
    fresh.restore(snapshot)
    assert conversation(fresh, other, 1.0, start=9) == rest
    assert counts(other) == after


def test_after_a_restore_positions_are_looked_at_afresh():
    simulation, radio, groups = row(2, range=1.5)
    snapshot = simulation.snapshot()

    def speak_after(speed):
        for k, _ in enumerate(simulation.ticks(1.2)):
            groups[0].drive([[speed, 0.0, 0.0]])
            if k == 10:
                radio.broadcast(0, b"x")
        return len(radio.receive(1))

    assert speak_after(-1.0) == 0
    simulation.restore(snapshot)
    assert speak_after(0.0) == 1


@pytest.mark.parametrize("kind", BOTH)
def test_after_a_lift_positions_are_looked_at_afresh(kind):
    """Within one physics step: an observer sends, lifts and sends again."""
    simulation, radio, groups = row(2, apart=1.5, kind=kind, range=2.0)

    def move():
        if simulation.step == 0:
            radio.send(0, b"near", 1)
            simulation.lift(groups[1], [0], [[0.0, 1.5, 0.0]])
            radio.send(0, b"still near", 1)
            simulation.lift(groups[1], [0], [[2.3, 0.0, 0.0]])
            radio.send(0, b"far", 1)

    simulation.observe(move)
    for _ in simulation.ticks(0.2):
        pass
    assert [m.payload for m in radio.receive(1)] == [b"near", b"still near"]


def test_a_snapshot_needs_the_same_radios():
    simulation, _, _ = row(2)
    snapshot = simulation.snapshot()
    Radio(simulation, name="second")
    with pytest.raises(InvalidInputError, match="radios"):
        simulation.restore(snapshot)


def test_bytes_are_counted_by_payload():
    simulation, radio, _ = row(3, range=1.0, latency=0.15)
    for k, _ in enumerate(simulation.ticks(0.4)):
        if k == 0:
            radio.broadcast(1, b"12345")
            radio.send(0, np.zeros(3), [1, 2])  # 2 is out of reach
            radio.send(2, np.zeros((2, 2), dtype=np.float32), 1)
            radio.broadcast(0, bytearray(10))
            radio.broadcast_arrays(np.zeros((3, 4), dtype=np.float32))
            radio.broadcast_arrays(np.zeros((3, 4)), senders=np.array([True, False, False]))
        sent = radio.bytes_sent.tolist(), radio.messages_sent.tolist()
        assert sent == ([24 + 10 + 16 + 32, 5 + 16, 16 + 16], [4, 2, 2])
        if k < 2:
            assert not radio.bytes_received.any(), "nothing has arrived after 0.1 s"
    assert radio.bytes_received.tolist() == [5 + 16, 24 + 16 + 10 + 32 + 32, 5 + 16]
    assert radio.messages_received.tolist() == [2, 6, 2]


def test_what_is_sent_is_a_copy_that_nobody_can_change():
    simulation, radio, _ = row(2)
    sent = np.arange(3)
    for _ in simulation.ticks(PERIOD):
        radio.send(0, sent, 1)
        sent[:] = 9
    (message,) = radio.receive(1)
    np.testing.assert_array_equal(message.payload, [0, 1, 2])
    assert message.size == 24
    with pytest.raises(ValueError, match="read-only"):
        message.payload[0] = 1


def test_a_full_inbox_drops_the_oldest_and_says_so():
    simulation, radio, _ = row(2, inbox=3)
    for k, _ in enumerate(simulation.ticks(0.5)):
        radio.send(0, bytes([k]), 1)
    assert radio.overflowed.tolist() == [0, 2]
    assert [m.payload for m in radio.receive(1)] == [b"\2", b"\3", b"\4"]
    assert radio.messages_received.tolist() == [0, 5]


def test_arrays_keep_the_newest_row_heard_of_each_sender():
    simulation, radio, _ = row(4, range=1.0, latency=0.1)
    for k, t in enumerate(simulation.ticks(0.6)):
        senders = np.array([True, k < 2, True, True])
        radio.broadcast_arrays(np.arange(8.0).reshape(4, 2) + 10 * k, senders)
        values, sent = radio.latest()
        assert np.isnan(values[np.eye(4, dtype=bool)]).all()
        for i in range(4):
            for j in range(4):
                if abs(i - j) != 1 or k == 0:
                    assert np.isnan(sent[i, j])
                    continue
                last = min(k - 1, 1) if j == 1 else k - 1
                np.testing.assert_allclose(values[i, j], [2 * j + 10 * last, 2 * j + 1 + 10 * last])
                assert sent[i, j] == pytest.approx(last * PERIOD)
        values[:] = 5.0
        assert t == pytest.approx(k * PERIOD)


@pytest.mark.parametrize("vectorised", [False, True])
@pytest.mark.parametrize(
    ("kind", "sends", "hears"),
    [("dead", False, False), ("commands-lost", True, False), ("stopped", True, True),
     ("reports-lost", True, True)],
)  # fmt: skip
def test_a_dead_robot_neither_sends_nor_hears(kind, sends, hears, vectorised):
    """Robot 2 of 4 fails from 0.5 to 1 s; messages are 0.1 s late."""
    simulation, radio, groups = row(4, latency=0.1)
    groups[1].faults.add(Fault(kind=kind, robot=0, start=0.5, end=1.0))
    from_it, to_it, sent, counts = set(), set(), {}, []
    for t in simulation.ticks(1.6):
        if vectorised:
            radio.broadcast_arrays(np.full((4, 1), t))
            values = radio.latest()[0][..., 0]
            from_it.add(values[1, 2])
            to_it.add(values[2, 1])
        else:
            for agent in range(4):
                radio.broadcast(agent, np.array([t]))
            from_it |= {m.payload[0] for m in radio.receive(1) if m.sender == 2}
            to_it |= {m.payload[0] for m in radio.receive(2) if m.sender == 1}
        counts.append(radio.messages_sent[2])
        sent[t] = t
    times = np.array(sorted(sent))[:-1]
    down = (times > 0.5 - 1e-6) & (times < 1.0 - 1e-6)
    late = (times > 0.4 - 1e-6) & (times < 0.9 - 1e-6)
    expected = times if sends else times[~down]
    assert sorted(x for x in from_it if x == x) == expected.tolist()
    assert sorted(x for x in to_it if x == x) == (times if hears else times[~late]).tolist()
    assert counts[-1] == (16 if sends else 11)


def test_a_trace_has_every_message(tmp_path):
    world = World(bounds=[-1, -2, 4, 2])
    robots = world.add_group(SoccerBot, [[0.0, 0, 0], [1.0, 0, 0], [2.0, 0, 0]])
    robots.faults.add(Fault(kind="dead", robot=1, start=0.35))
    simulation = Simulation(world, control_period=PERIOD)
    trace = Trace(simulation)
    radio = Radio(simulation, range=1.2, latency=0.02)
    for k, _ in enumerate(simulation.ticks(0.5)):
        if k == 1:
            radio.broadcast(0, b"four")
            radio.send(0, b"seventy", [1, 2])
        if k == 2:
            radio.broadcast_arrays(np.zeros((3, 1)), senders=np.array([False, False, True]))
        if k == 4:
            radio.broadcast(2, b"to the dead")
            radio.broadcast(1, b"silent")
            robots.drive([[-1.0, 0, 0], [0, 0, 0], [0, 0, 0]])
    lonely = Radio(simulation, range=0.1, name="lonely")
    lonely.broadcast(0, b"?")
    found = trace.arrays(trace.recording.footage())
    columns = [found[f"message_{c}"] for c in ("sent", "delivered", "sender", "receiver", "bytes")]
    table = np.column_stack(columns)
    nan = np.nan
    np.testing.assert_allclose(
        table,
        [
            [0.1, 0.12, 0, 1, 4],
            [0.1, 0.12, 0, 1, 7],
            [0.1, nan, 0, 2, 7],
            [0.2, 0.22, 2, 1, 8],
            [0.4, nan, 2, 1, 11],
            [0.5, nan, 0, -1, 1],
        ],
        atol=1e-9,
    )
    assert found["message_sender"].dtype == found["message_bytes"].dtype == np.int64
    parquet = pytest.importorskip("pyarrow.parquet")
    trace.save(tmp_path / "t.parquet", FACTS)
    rows = [r for r in parquet.read_table(tmp_path / "t.parquet").to_pylist()
            if r["kind"] == "message"]  # fmt: skip
    assert [r["source"] for r in rows] == [f"soccer_bot{i}" for i in (0, 0, 0, 2, 2, 0)]
    assert [r["robot"] for r in rows] == [*(f"soccer_bot{i}" for i in (1, 1, 2, 1, 1)), None]
    assert [r["value"] for r in rows] == table[:, 4].tolist()
    np.testing.assert_allclose([r["delivered"] for r in rows], table[:, 1])
    assert {r["field"] for r in rows} == {"bytes"}


PLANS = st.lists(
    st.tuples(
        st.integers(0, 3),  # tick
        st.integers(0, 3),  # sender
        st.one_of(st.none(), st.sets(st.integers(0, 3), min_size=1)),  # to
    ),
    max_size=12,
)


@settings(max_examples=60, deadline=None)
@given(
    plan=PLANS,
    latency=st.floats(0.0, 0.5),
    loss=st.sampled_from([0.0, 0.5]),
    reads=st.lists(st.sets(st.integers(0, 3)), min_size=12, max_size=12),
)
def test_nothing_is_delivered_twice_or_to_its_sender_or_to_others(plan, latency, loss, reads):
    simulation, radio, _ = row(4, latency=latency, loss=loss)
    wanted, got = {}, []
    for k, t in enumerate(simulation.ticks(1.2)):
        for number, (tick, sender, to) in enumerate(plan):
            if tick != k or (to is not None and not to - {sender}):
                continue
            others = set(range(4)) - {sender} if to is None else to - {sender}
            wanted[number] = (sender, others, t)
            if to is None:
                radio.broadcast(sender, bytes([number]))
            else:
                radio.send(sender, bytes([number]), others)
        for agent in reads[k] if k < 11 else range(4):
            for message in radio.receive(agent):
                got.append((agent, message.payload[0]))
                sender, others, sent = wanted[message.payload[0]]
                assert message.sender == sender
                assert agent in others
                assert message.sent == sent
                assert sent + max(latency, 1e-9) <= message.delivered + 1e-9 <= t + 2e-9
    assert len(set(got)) == len(got)
    if loss == 0.0:
        assert set(got) == {(a, n) for n, (_, others, _) in wanted.items() for a in others}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"range": -1.0}, "range is 0 or more"),
        ({"range": np.nan}, "range is 0 or more"),
        ({"latency": -0.1}, "latency is 0 or more"),
        ({"latency": np.inf}, "latency is 0 or more"),
        ({"loss": 1.1}, "loss is a probability"),
        ({"loss": -0.1}, "loss is a probability"),
        ({"loss": np.nan}, "loss is a probability"),
        ({"inbox": 0}, "room for 1"),
        ({"name": "radio"}, "radio named 'radio' already"),
    ],
)
def test_bad_radios_are_refused(options, message):
    simulation, _, _ = row(2)
    with pytest.raises(InvalidInputError, match=message):
        Radio(simulation, **{"name": "other", **options})


def test_bad_messages_are_refused():
    simulation, radio, _ = row(3)
    for call, error, message in (
        (lambda: radio.send(0, b"", 3), UnknownNameError, "unknown robot '3'; valid: .*0 to 2"),
        (lambda: radio.send(-1, b"", 1), UnknownNameError, "unknown robot '-1'"),
        (lambda: radio.send("pioneer", b"", 1), UnknownNameError, "'pioneer'; valid: pioneer2dx0"),
        (lambda: radio.receive("nobody"), UnknownNameError, "unknown robot 'nobody'"),
        (lambda: radio.send(0, "text", 1), InvalidInputError, "bytes or an array.*got str"),
        (lambda: radio.send(0, {"a": 1}, 1), InvalidInputError, "got dict"),
        (lambda: radio.send(0, np.array([None]), 1), InvalidInputError, "numbers.*got object"),
        (lambda: radio.send(0, b"", 0), InvalidInputError, "soccer_bot0 cannot send to itself"),
        (lambda: radio.send(0, b"", [1, 0]), InvalidInputError, "cannot send to itself"),
        (lambda: radio.latest(), InvalidInputError, "before the first"),
        (lambda: radio.broadcast_arrays(np.zeros((2, 3))), InvalidInputError, r"shape \(3, c\)"),
        (lambda: radio.broadcast_arrays(np.zeros(3)), InvalidInputError, r"shape \(3, c\)"),
        (lambda: radio.broadcast_arrays([["a"]] * 3), InvalidInputError, "numbers"),
    ):
        with pytest.raises(error, match=message):
            call()
    radio.broadcast_arrays(np.zeros((3, 2)))
    with pytest.raises(InvalidInputError, match="2 columns"):
        radio.broadcast_arrays(np.zeros((3, 3)))
    with pytest.raises(InvalidInputError, match="3 flags"):
        radio.broadcast_arrays(np.zeros((3, 2)), senders=[0, 1])
    assert radio.messages_sent.tolist() == [1, 1, 1], "what was refused does not count"
