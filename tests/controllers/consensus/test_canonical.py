"""Against numbers computed from the restored system, in the specification of system 04."""

import networkx as nx
import numpy as np
import pytest

from controllers.consensus import (
    AverageConsensus,
    CanonicalModel,
    acceleration,
    check_gains,
    check_structure,
    condense,
    delta,
    equal_gains,
    metropolis_gains,
    neighbour_gains,
    offset_relative,
    overlap_coefficient,
    reducible,
    rooted,
    spread,
)
from mjmr.errors import InvalidInputError

START = np.array([[6.0, 3.0], [2.0, 5.0], [4.0, 2.0]])
LEADER_1 = np.array([[1.0, 0, 0], [0.2, 0.8, 0], [0, 0.2, 0.8]])
LEADER_2 = np.array([[0.8, 0.2, 0], [0, 1, 0], [0.2, 0, 0.8]])
EXAMPLE = np.array([[1, 1, 0, 1], [0, 1, 0, 0], [1, 0, 1, 0], [0, 0, 1, 1]], dtype=bool)


def run(dwell, seconds, sequence=(LEADER_1, LEADER_2)):
    model = CanonicalModel([2, 2, 2])
    state, k = model.start(START), 0
    while k * dwell < seconds - 1e-9:
        state = model.advance(state, sequence[k % len(sequence)], dwell)
        k += 1
    return state[model.outputs]


@pytest.mark.parametrize(
    ("dwell", "x", "y"),
    [
        (0.5, 4.050, 3.975),
        (1, 4.101, 3.949),
        (2, 4.205, 3.898),
        (5, 4.511, 3.744),
        (10, 4.964, 3.518),
        (20, 5.567, 3.217),
    ],
)
def test_three_robots_agree_where_the_reference_table_says(dwell, x, y):
    end = run(dwell, 400.0)
    assert spread(end) < 1e-6
    assert end[0] == pytest.approx([x, y], abs=6e-4)
    assert end[0] @ [1, 2] == pytest.approx(12.0, abs=1e-6)


def test_without_switching_the_leader_s_start_decides():
    assert run(5.0, 800.0, (LEADER_1,))[2] == pytest.approx([6, 3], abs=1e-6)
    assert run(5.0, 800.0, (LEADER_2,))[2] == pytest.approx([2, 5], abs=1e-6)


def test_a_robot_that_hears_nobody_stays_away():
    deaf_1, deaf_2 = LEADER_1.copy(), LEADER_2.copy()
    deaf_1[2] = deaf_2[2] = [0, 0, 1]
    end = run(2.0, 400.0, (deaf_1, deaf_2))
    assert end[0] == pytest.approx([4.205, 3.898], abs=6e-4)
    assert spread(end) == pytest.approx(1.91, abs=0.005)


def test_channels_with_gains_of_their_own_agree_off_the_segment():
    def gains(weight):
        heard_1, heard_2 = LEADER_1 > 0, LEADER_2 > 0
        return neighbour_gains(heard_1, weight), neighbour_gains(heard_2, weight)

    x, y = gains(0.2), gains(0.5)
    sequence = [np.stack([x[k], y[k]]) for k in range(2)]
    assert (x[0] == LEADER_1).all()
    assert run(5.0, 400.0, sequence)[0] == pytest.approx([4.511, 3.387], abs=6e-4)


def test_gains_that_decay_too_fast_leave_robots_apart():
    model = CanonicalModel([2, 2, 2])
    state = model.start(START)
    for k in range(200):
        heard = (LEADER_1, LEADER_2)[k % 2] > 0
        state = model.advance(state, neighbour_gains(heard, 0.2 * 0.5**k), 2.0)
    assert spread(state[model.outputs]) == pytest.approx(2.96, abs=0.005)


def test_a_moving_leader_ends_half_a_second_further():
    """A leader that starts with hand velocity w ends at p + w / 2."""
    model = CanonicalModel([2, 2, 2])
    velocity = np.array([[0.4, -0.2], [0, 0], [0, 0]])
    state = model.advance(model.start(START, velocity), LEADER_1, 500.0)
    assert state[model.outputs][1] == pytest.approx(START[0] + velocity[0] / 2, abs=1e-6)


@pytest.mark.parametrize(("degree", "slow"), [(1, -0.1123), (2, -0.0578), (3, -0.0389)])
def test_the_example_of_four_agrees_at_robot_two_for_every_degree(degree, slow):
    model = CanonicalModel([degree] * 4)
    gains = equal_gains(EXAMPLE)
    table = model.expanded(gains)
    values = np.linalg.eigvals(table - np.eye(len(table)))
    nonzero = values[np.abs(values) > 1e-9]
    assert nonzero.real.max() == pytest.approx(slow, abs=5e-4)
    start = np.array([[1.0, 4], [7, -2], [3, 3], [-5, 0]])
    end = model.advance(model.start(start), gains, 600.0)
    assert end[model.outputs] == pytest.approx(np.tile(start[1], (4, 1)), abs=1e-6)


def test_transitions_are_row_stochastic_with_positive_diagonal():
    rng = np.random.default_rng(0)
    for _ in range(50):
        q = int(rng.integers(2, 9))
        model = CanonicalModel(rng.integers(1, 4, q))
        gains = equal_gains(rng.random((q, q)) < 0.4)
        p = model.transition(gains, float(rng.uniform(0.1, 5)))
        assert p.sum(axis=1) == pytest.approx(np.ones(len(p)), abs=1e-9)
        assert p.min() >= -1e-12
        assert np.diag(p).min() > 0


def test_the_expanded_matrix_is_irreducible_when_the_gains_are():
    """Lemma 2.1, with relative degrees mixed."""
    rng = np.random.default_rng(1)
    seen = {True: 0, False: 0}
    for _ in range(400):
        q = int(rng.integers(2, 6))
        gains = equal_gains(rng.random((q, q)) < 0.5)
        np.fill_diagonal(gains, 0.0)
        sums = gains.sum(axis=1)
        if (sums == 0).any():
            continue
        gains /= sums[:, None]
        table = CanonicalModel(rng.integers(1, 4, q)).expanded(gains)
        connected = [
            nx.is_strongly_connected(nx.from_numpy_array(m > 0, create_using=nx.DiGraph))
            for m in (gains, table)
        ]
        assert connected[0] == connected[1]
        seen[connected[0]] += 1
    assert min(seen.values()) > 20


def test_measures_of_a_matrix_that_is_one_row():
    alike = np.tile([0.2, 0.5, 0.3], (3, 1))
    assert delta(alike) == 0.0
    assert overlap_coefficient(alike) == pytest.approx(0.0)
    assert overlap_coefficient(np.eye(3)) == 1.0
    assert delta(np.eye(3)) == 1.0


def test_the_relative_form_is_the_canonical_control():
    rng = np.random.default_rng(2)
    position, velocity = rng.normal(size=(3, 2)), rng.normal(size=(3, 2))
    model = CanonicalModel([2, 2, 2])
    state = model.start(position, velocity)
    u = model.input_of(state, LEADER_1)
    second = state[model.outputs + 1]
    relative = position[None] - position[:, None]
    expected = -2 * second + position + u  # v = -2 x_2 + x_1 + u
    assert acceleration(velocity, relative, LEADER_1) == pytest.approx(expected)


def test_who_is_not_seen_has_no_weight_and_offsets_shift_places():
    relative = np.full((2, 2, 2), np.nan)
    assert (acceleration(np.zeros((2, 2)), relative, np.full((2, 2), 0.5)) == 0).all()
    offsets = np.array([[0.0, 0], [1, 0]])
    in_place = offsets[None] - offsets[:, None]
    assert (offset_relative(in_place, offsets) == 0).all()


def test_the_order_of_the_example_begins_with_robot_two():
    condensation = condense(EXAMPLE)
    assert condensation.groups == ((1,), (0, 2, 3))
    order = condensation.order
    assert EXAMPLE[np.ix_(order, order)].astype(int).tolist() == [
        [1, 0, 0, 0], [1, 1, 0, 1], [0, 1, 1, 0], [0, 0, 1, 1]
    ]  # fmt: skip
    assert reducible(EXAMPLE)
    assert rooted(EXAMPLE)
    assert not rooted(np.eye(2))
    assert not reducible(np.ones((3, 3)))


def test_sequences_that_meet_the_condition_say_when():
    graphs = [LEADER_1 > 0, LEADER_2 > 0] * 2
    report = check_structure(graphs, [LEADER_1, LEADER_2] * 2)
    assert report.holds
    assert report.instants == (0, 2)
    assert report.order == (0, 1, 2)
    assert report.longest_gap == 2


def test_sequences_that_do_not_say_why():
    half_1, half_2 = np.eye(3, dtype=bool), np.eye(3, dtype=bool)
    half_1[1, 0] = half_2[2, 1] = True
    report = check_structure([half_1, half_2], [equal_gains(half_1), equal_gains(half_2)])
    assert not report.holds
    assert "instant 0: the group of 2 weights nobody of an earlier group" in report.why
    ring = np.array([[1, 0, 1], [1, 1, 0], [0, 1, 1]], dtype=bool)
    weak = np.array([[0.5, 0, 0.5], [0.5, 0.5, 0], [0, 0, 1.0]])
    report = check_structure([ring], [weak])
    assert "system 2 hears 1 of its own group but weights it 0" in report.why
    faint = neighbour_gains(LEADER_1 > 0, 1e-5)
    assert not check_structure([LEADER_1 > 0], [faint]).holds
    assert check_structure([LEADER_1 > 0], [faint], epsilon=1e-6).holds


def test_random_sequences_that_meet_the_condition_agree():
    rng = np.random.default_rng(5)
    met = 0
    while met < 20:
        q = int(rng.integers(3, 8))
        graphs = [rng.random((q, q)) < 0.35 for _ in range(4)]
        gains = [equal_gains(g) for g in graphs]
        report = check_structure(graphs, gains)
        model = CanonicalModel(rng.integers(1, 4, q))
        if not report.holds:
            continue
        met += 1
        period = np.linalg.multi_dot([model.transition(g, 1.0) for g in gains[::-1]])
        state = np.linalg.matrix_power(period, 400) @ model.start(rng.normal(size=(q, 2)))
        assert spread(state[model.outputs]) < 1e-3


@pytest.mark.parametrize(
    ("gains", "said"),
    [
        (np.ones((2, 3)) / 3, r"shape \(q, q\); got \(2, 3\)"),
        ([[1.2, -0.2], [0, 1]], "row 0 gives 1 -0.2"),
        ([[1.0, 0.0], [0.5, 0.4]], "row 1 sums to 0.9"),
    ],
)
def test_gains_that_cannot_be_are_refused_with_the_row(gains, said):
    with pytest.raises(InvalidInputError, match=said):
        check_gains(gains)


def test_weights_of_those_not_heard_are_refused():
    with pytest.raises(InvalidInputError, match="row 1 weights 0, whom it does not hear"):
        check_gains([[1, 0], [0.5, 0.5]], heard=np.eye(2))


@pytest.mark.parametrize("degrees", [[1, 0, 2], [1.5], []])
def test_degrees_below_one_are_refused(degrees):
    with pytest.raises(InvalidInputError):
        CanonicalModel(degrees)


def test_average_consensus_keeps_the_sum_and_ends_at_the_mean():
    rng = np.random.default_rng(3)
    service = AverageConsensus(rng.normal(size=8))
    mean = service.estimate.mean()
    for _ in range(400):
        links = rng.random((8, 8)) < 0.15
        service.step(links | links.T)
        assert service.estimate.mean() == pytest.approx(mean)
    assert np.ptp(service.estimate) < 1e-6
    with pytest.raises(InvalidInputError, match="0 hears 1, who does not hear it"):
        metropolis_gains(np.triu(np.ones((2, 2))))


def test_a_state_is_advanced_the_same_the_second_time_and_transitions_are_not_written_to():
    model = CanonicalModel([2, 1, 3])
    gains = equal_gains(np.ones((3, 3)))
    state = np.random.default_rng(5).normal(size=(6, 2))
    first = model.advance(state, gains, 0.7)
    assert (model.advance(state, gains, 0.7) == first).all()
    assert not np.allclose(model.advance(state, gains, 0.8), first)
    assert not np.allclose(model.advance(state, neighbour_gains(gains > 0, 0.1), 0.7), first)
    with pytest.raises(ValueError, match="read-only"):
        model.transition(gains, 0.7)[0, 0] = 1.0


@pytest.mark.parametrize("method", ["advance", "input_of"])
@pytest.mark.parametrize(
    ("state", "gains", "said"),
    [
        (np.zeros((5, 2)), LEADER_1, r"a stacked state has shape \(6, m\); got \(5, 2\)"),
        (np.zeros(6), LEADER_1, "a stacked state has shape"),
        (np.zeros((6, 2)), np.eye(2), r"have shape \(3, 3\) or \(2, 3, 3\); got \(2, 2\)"),
        (np.zeros((6, 2)), [LEADER_1] * 3, "gains of 2 channels"),
        (np.zeros((6, 2)), LEADER_1 * 2, "sum"),
        (np.zeros((6, 2)), [LEADER_1, LEADER_1 * 2], "sum"),
        (np.zeros((6, 2)), [[1, 0, 0], [1]], "gains are numbers in rows of one length"),
    ],
)
def test_states_and_gains_that_cannot_be_say_so(method, state, gains, said):
    more = (1.0,) if method == "advance" else ()
    with pytest.raises(InvalidInputError, match=said):
        getattr(CanonicalModel([2, 2, 2]), method)(state, gains, *more)


def test_the_relative_form_checks_its_gains():
    with pytest.raises(InvalidInputError, match="sum"):
        acceleration(np.zeros((3, 2)), np.zeros((3, 3, 2)), LEADER_1 * 2)


def test_ragged_graphs_and_graphs_of_different_sizes_are_refused():
    with pytest.raises(InvalidInputError, match="rows of one length"):
        rooted([[1, 0], [1]])
    with pytest.raises(InvalidInputError, match="got graphs of 2 and 3"):
        check_structure([np.eye(2), np.eye(3)], [np.eye(2), np.eye(3)])


def test_average_consensus_hands_out_copies():
    consensus = AverageConsensus([1.0, 3.0])
    found = consensus.step(np.ones((2, 2)))
    found[:] = 99.0
    assert consensus.step(np.ones((2, 2))) == pytest.approx([2.0, 2.0])
