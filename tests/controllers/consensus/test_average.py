"""The mean of a number a robot, over links that come, go and lose messages."""

import numpy as np
import pytest

from controllers.consensus import AverageConsensus, RatioConsensus, of_this_round
from mjmr.errors import InvalidInputError

VALUES = np.array([1.0, 4.0, -2.0, 7.0, 0.5])
RING = np.roll(np.eye(5, dtype=bool), 1, axis=1) | np.roll(np.eye(5, dtype=bool), -1, axis=1)


def talk(service, rounds, loss=0.0, seed=0, links=lambda k: RING):
    rng, n = np.random.default_rng(seed), len(VALUES)
    for k in range(rounds):
        told = service.message()
        heard = links(k) & (rng.uniform(size=(n, n)) >= loss)
        service.hear(np.where(heard[..., None], told[None], np.nan))
    return service


def pairs(k):
    """One link at a time, round and round."""
    links = np.zeros((5, 5), dtype=bool)
    i, j = (k // 4) % 5, (k // 4 + 1) % 5
    links[i, j] = links[j, i] = True
    return links


@pytest.mark.parametrize("kind", [AverageConsensus, RatioConsensus])
def test_without_loss_all_end_with_the_mean(kind):
    found = talk(kind(VALUES), 120).estimate
    assert found == pytest.approx(np.full(5, VALUES.mean()), abs=1e-6)


@pytest.mark.parametrize("links", [lambda k: RING, pairs])
def test_metropolis_keeps_the_sum_in_every_round_while_who_hears_is_heard(links):
    service = AverageConsensus(VALUES)
    for k in range(60):
        talk(service, 1, links=lambda _, k=k: links(k))
        assert service.estimate.sum() == pytest.approx(VALUES.sum(), abs=1e-9)
    assert np.ptp(service.estimate) < 0.6 * np.ptp(VALUES)
    assert service.crowded == 0


def test_lost_messages_move_the_sum_of_metropolis_weights_and_not_that_of_ratios():
    biases = []
    for seed in range(20):
        lossy = talk(AverageConsensus(VALUES), 300, loss=0.5, seed=seed)
        assert np.ptp(lossy.estimate) < 1e-6  # they agree
        biases.append(lossy.estimate.mean() - VALUES.mean())
        ratio = talk(RatioConsensus(VALUES), 300, loss=0.5, seed=seed)
        assert ratio.estimate == pytest.approx(np.full(5, VALUES.mean()), abs=1e-4)
    assert np.sqrt(np.mean(np.square(biases))) > 0.2


def test_a_ratio_takes_what_it_missed_when_a_link_comes_back():
    def links(k):
        return RING if k < 10 or k > 60 else np.zeros((5, 5), dtype=bool)

    service = talk(RatioConsensus(VALUES), 10)
    apart = talk(service, 40, links=lambda k: np.zeros((5, 5), dtype=bool)).estimate
    assert np.ptp(apart) > 1e-3
    assert talk(RatioConsensus(VALUES), 200, 0.3, links=links).estimate == pytest.approx(
        np.full(5, VALUES.mean()), abs=1e-4
    )


def carried(service):
    """Value and weight of all: in robots, on their way, and still to be taken from them."""
    way = service._given - service._taken.swapaxes(0, 1)
    return (service._mass + service._owed).sum(axis=0) + way.sum(axis=(0, 1))


def disorderly(service, rounds, seed, each=lambda: None):
    """Messages are lost, late by up to four rounds, heard again, and out of order."""
    rng, n, told = np.random.default_rng(seed), len(VALUES), []
    for _ in range(rounds):
        told.append(service.message())
        age = np.minimum(rng.integers(0, 5, (n, n)), len(told) - 1)
        words = np.array(told)[len(told) - 1 - age, np.arange(n)]
        heard = RING & (rng.uniform(size=(n, n)) >= 0.3)
        service.hear(np.where(heard[..., None], words, np.nan))
        each()
    return service


@pytest.mark.parametrize("seed", range(5))
def test_a_ratio_keeps_value_and_weight_when_messages_come_late_twice_and_out_of_order(seed):
    service = RatioConsensus(VALUES)

    def look():
        assert carried(service) == pytest.approx([VALUES.sum(), 5.0], abs=1e-9)
        # what is a mean of the readings with weights that are not negative stays among them
        assert VALUES.min() - 1e-9 <= service.estimate.min()
        assert service.estimate.max() <= VALUES.max() + 1e-9

    disorderly(service, 300, seed, look)
    assert service.estimate == pytest.approx(np.full(5, VALUES.mean()), abs=1e-6)


def test_weights_that_shrink_leave_no_robot_without_an_estimate():
    service = talk(RatioConsensus(VALUES, [0.0, 8.0, 0.0, 1.0, 0.0]), 100)
    service.replace(VALUES, [1.0, 0.0, 0.0, 1.0, 0.0])

    def look():
        assert np.isfinite(service.estimate).all()
        assert (service._mass[:, 1] > 0).all()
        assert carried(service) == pytest.approx([VALUES[0] + VALUES[3], 2.0], abs=1e-9)

    look()
    disorderly(service, 600, 3, look)
    mean = (VALUES[0] + VALUES[3]) / 2
    assert service.estimate == pytest.approx(np.full(5, mean), abs=1e-6)


def test_weights_count_and_numbers_may_change():
    weights = np.array([0.0, 2.0, 0.0, 1.0, 0.0])
    service = RatioConsensus(VALUES, weights)
    assert np.isnan(service.estimate).tolist() == [True, False, True, False, True]
    mean = (2 * VALUES[1] + VALUES[3]) / 3
    assert talk(service, 300, loss=0.5).estimate == pytest.approx(np.full(5, mean), abs=1e-4)
    service.replace(VALUES + 1.0, [0.0, 0.0, 1.0, 1.0, 0.0])
    mean = (VALUES[2] + VALUES[3]) / 2 + 1.0
    assert talk(service, 300, loss=0.5, seed=1).estimate == pytest.approx(
        np.full(5, mean), abs=1e-4
    )
    for bad in ([1.0, 2.0], [1.0, -1.0, 0.0, 0.0, 0.0], [np.nan] * 5):
        with pytest.raises(InvalidInputError, match="5 finite numbers each, weights 0 or more"):
            service.replace(VALUES, bad)


def test_nobody_is_heard_and_nothing_changes():
    nobody = np.zeros((5, 5), dtype=bool)
    for kind in (AverageConsensus, RatioConsensus):
        assert talk(kind(VALUES), 5, links=lambda k: nobody).estimate == pytest.approx(VALUES)


def test_only_what_was_sent_in_this_round_is_of_it():
    values, sent = np.ones((2, 2, 3)), np.array([[np.nan, 1.0], [0.9, np.nan]])
    found = of_this_round(values, sent, 1.0)
    assert np.isfinite(found[0, 1]).all()
    assert np.isnan(found[[0, 1, 1], [0, 0, 1]]).all()


@pytest.mark.parametrize("kind", [AverageConsensus, RatioConsensus])
def test_bad_input_is_told(kind):
    for bad in ([], [1.0, np.nan], ["a"], [[1.0], [1.0, 2.0]], 3.0):
        with pytest.raises(InvalidInputError, match="finite number"):
            kind(bad)
    with pytest.raises(InvalidInputError, match=r"messages have shape \(5, 5, \d+\); got shape"):
        kind(VALUES).hear(np.zeros((4, 4, 2)))


def test_vectors_are_for_links_and_not_for_messages():
    service = AverageConsensus(np.zeros((3, 2)))
    service.step(np.eye(3))
    with pytest.raises(InvalidInputError, match=r"one number each; got .* \(3, 2\)"):
        service.message()
    with pytest.raises(InvalidInputError, match="one finite number a robot"):
        RatioConsensus(np.zeros((3, 2)))
