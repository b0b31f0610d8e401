"""The automaton and the relay, on what robots are told by hand."""

import numpy as np
import pytest

from controllers.perimeter import (
    ACQUIRE,
    MOVING,
    SEARCHING,
    TRACKING,
    Percepts,
    PerimeterConfig,
    PerimeterTeam,
)
from controllers.perimeter.percepts import NEWS_AT, SPOKEN
from controllers.perimeter.relay import Relay
from mjmr.errors import InvalidInputError

CONFIG = PerimeterConfig(bounds=(-50.0, -50.0, 50.0, 50.0), desired=10.0)
N = 3
FAR = np.array([[-30.0, 0.0, 0.0], [0.0, 0.0, 0.0], [30.0, 0.0, 0.0]])


def team(config=CONFIG, n=N):
    return PerimeterTeam(n, config, np.random.default_rng(0))


def percepts(time, pose=FAR, heard=None, sent=None, **known):
    n = len(pose)
    nothing = {
        "edge": np.full((n, 2), np.nan),
        "inside": np.zeros(n),
        "room": np.full(n, np.inf),
        "body": np.full((n, 2), np.nan),
    }
    heard = np.full((n, n, len(SPOKEN)), np.nan) if heard is None else heard
    sent = np.full((n, n), np.nan) if sent is None else sent
    return Percepts(time=time, pose=pose, heard=heard, sent=sent, **(nothing | known))


def hears(robots, spoken, links, time):
    """Arrays of what is heard if robot i hears j where links[i, j]."""
    heard = np.where(links[..., None], np.tile(spoken, (robots, 1, 1)), np.nan)
    return {"heard": heard, "sent": np.where(links, time, np.nan)}


def edge(left):
    """Robot 0 alone senses an edge so far to its left."""
    found = np.full((N, 2), np.nan)
    found[0] = [0.0, left]
    return found


def test_states_in_order_of_a_robot_that_finds_it_alone():
    group = team()
    group.step(percepts(0.0))
    assert group.state.tolist() == [SEARCHING] * N
    group.step(percepts(0.1, edge=edge(2.5)))
    assert group.state[0] == ACQUIRE
    group.step(percepts(0.2, edge=edge(0.65)))
    assert group.state[0] == TRACKING
    assert not group.told[0]
    assert group.joined[0] == pytest.approx(0.2)
    command = group.step(percepts(0.3, edge=edge(0.6)))
    assert command[0] == pytest.approx([0.4, 0.1])
    command = group.step(percepts(0.4, edge=edge(0.6), inside=np.array([1.0, 0.0, 0.0])))
    assert command[0] == pytest.approx([0.4, -0.1])
    for t in range(5, 80):
        group.step(percepts(0.1 * t))
    assert group.state[0] == MOVING  # lost: back to where it last sensed it
    assert group.state[1:].tolist() == [SEARCHING] * 2


def test_who_tracks_makes_room_for_one_who_acquires_behind_it():
    group = team()
    pose = np.array([[0.0, 0.0, 0.0], [-2.0, -1.0, 0.5], [30.0, 0.0, 0.0]])
    far = np.array([[0.0, 0.0, 0.0], [9.95, 0.0, 0.0], [30.0, 0.0, 0.0]])
    links, none = ~np.eye(N, dtype=bool), np.zeros(N)
    speeds = []
    for k in range(60):
        spoken = group.speak(percepts(0.1 * k, pose=pose))
        spoken[1, 3] = ACQUIRE if k >= 20 else SEARCHING
        spoken[2, 3] = TRACKING
        spoken[2, :2] = far[1, :2]  # ahead, as far as it is desired to be
        told = hears(N, spoken, links, 0.1 * k)
        now = percepts(0.1 * k, pose=pose, edge=edge(0.6), inside=none + (k // 2) % 2, **told)
        speeds.append(group.step(now)[0, 0])
    assert group.state[0] == TRACKING
    assert speeds[19] == 0.0
    assert speeds[-1] == pytest.approx(0.4)


def test_news_hop_from_radio_to_radio():
    group = team()
    chain = np.array([[0, 1, 0], [1, 0, 1], [0, 1, 0]], dtype=bool)  # 0 and 2 do not hear
    group.step(percepts(0.0, edge=edge(2.5)))
    for k in range(1, 4):
        now = percepts(0.1 * k, edge=edge(2.0))
        told = hears(N, group.speak(now), chain, 0.1 * k)
        group.step(percepts(0.1 * k, edge=edge(2.0), **told))
    assert group.state.tolist() == [ACQUIRE, MOVING, MOVING]
    assert group.relay.hops.tolist() == [0, 1, 2]
    assert group.relay.place[2] == pytest.approx([-30.0, 2.0], abs=0.6)
    assert group.told.tolist() == [False, True, True]


def test_false_news_is_given_up_and_not_believed_again():
    group = team()
    group.tell(np.array([True, False, False]), np.array([-25.0, 0.0]), 0.0)
    seen = []
    for t in range(0, 900):
        group.step(percepts(0.1 * t))
        seen.append(group.state[0])
    first = seen.index(MOVING)
    back = next(k for k in range(first, 900) if seen[k] == SEARCHING)
    assert 0.1 * (back - first) == pytest.approx(5.0 + 60.0, abs=0.3)
    assert set(seen[back:]) == {SEARCHING}


def test_an_operator_s_newer_news_is_believed():
    relay = Relay(2)
    who = np.array([True, False])
    relay.tell(who, np.array([1.0, 2.0]), 5.0)
    relay.disbelieve(who)
    assert np.isnan(relay.place).all()
    relay.tell(who, np.array([3.0, 4.0]), 6.0)
    assert relay.place[0].tolist() == [3.0, 4.0]
    assert relay.told_at[0] == 6.0


def test_without_its_camera_a_robot_that_tracks_stands_and_goes_on_after():
    group = team()
    group.step(percepts(0.0, edge=edge(0.62)))
    group.step(percepts(0.1, edge=edge(0.62)))
    assert group.state[0] == TRACKING
    blind = np.array([np.nan, 0.0, 0.0])
    assert group.step(percepts(0.2, edge=edge(0.62), inside=blind))[0].tolist() == [0.0, 0.0]
    assert group.step(percepts(0.3, edge=edge(0.62)))[0, 0] == 0.4


def test_who_has_no_room_to_turn_before_the_next_of_a_bay_turns_at_once():
    group, near = team(), np.full(N, 0.1)
    group.step(percepts(0.0, edge=edge(0.62)))
    group.step(percepts(0.1, edge=edge(0.62)))
    assert group.state[0] == TRACKING
    command = group.step(percepts(0.2, edge=edge(0.62), room=near))
    assert command[0].tolist() == [0.2, -0.3]
    assert command[1, 0] > 0.1  # who searches heeds it not
    assert group.step(percepts(0.3, edge=edge(0.62), room=near + 0.1))[0, 1] == 0.1


def test_who_does_not_know_where_it_is_stands():
    pose = FAR.copy()
    pose[1] = np.nan
    command = team().step(percepts(5.0, pose=pose))
    assert command[1].tolist() == [0.0, 0.0]
    assert command[0, 0] > 0.9


def test_rows_do_not_mix():
    """What a robot does depends on its own row alone, and on what it hears."""
    rng = np.random.default_rng(1)
    together, alone = team(), team()
    for t in range(50):
        found = edge(2.5 - 0.03 * t)
        a = together.step(percepts(0.1 * t, edge=found))
        other = found.copy()
        other[2] = rng.uniform(-2, 2, 2)
        b = alone.step(percepts(0.1 * t, edge=other))
        assert a[:2] == pytest.approx(b[:2])


def test_estimated_distance_follows_who_tracks():
    config = PerimeterConfig(bounds=CONFIG.bounds)
    group = team(config, 2)
    angle = 0.0
    for t in range(600):
        time, angle = 0.1 * t, angle + 0.04 / 10.6
        turn = np.array([angle, angle + 2.0])
        pose = np.column_stack([10.6 * np.cos(turn), 10.6 * np.sin(turn), turn + np.pi / 2])
        found = np.tile([0.0, 0.6], (2, 1))
        now = percepts(time, pose=pose, edge=found)
        links = ~np.eye(2, dtype=bool)
        told = hears(2, group.speak(now), links, time)
        group.step(percepts(time, pose=pose, edge=found, **told))
    # two on a circle: f = .95, chord = the diameter
    assert group.desired == pytest.approx(0.95 * 21.2, rel=0.01)


def test_wrong_shapes_are_refused():
    with pytest.raises(InvalidInputError, match="inside"):
        percepts(0.0, inside=np.zeros(2))
    assert SPOKEN[NEWS_AT] == "news_at"
