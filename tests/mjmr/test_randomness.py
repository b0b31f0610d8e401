import numpy as np

from mjmr.randomness import SampleNoise, Streams


def test_streams_depend_on_seed_and_name_alone():
    first = Streams(7).generator("a").random(4)
    other = Streams(7)
    other.generator("b").random(100)
    np.testing.assert_array_equal(other.generator("a").random(4), first)
    assert not np.array_equal(Streams(7).generator("b").random(4), first)
    assert not np.array_equal(Streams(8).generator("a").random(4), first)


def test_a_sample_does_not_depend_on_which_were_read_before():
    sequence = Streams(1).sequence("noise")
    straight = SampleNoise(sequence, (3, 2), "normal")
    in_order = [straight.sample(k).copy() for k in range(200)]
    jumping = SampleNoise(sequence, (3, 2), "normal")
    for k in (150, 3, 199, 3, 64):
        np.testing.assert_array_equal(jumping.sample(k), in_order[k])


def test_a_row_does_not_depend_on_how_many_rows_follow():
    sequence = Streams(1).sequence("noise")
    few, many = SampleNoise(sequence, (2, 3), "normal"), SampleNoise(sequence, (9, 3), "normal")
    for k in (0, 70):
        np.testing.assert_array_equal(few.sample(k), many.sample(k)[:2])


def test_noise_has_mean_zero_and_deviation_one_and_no_memory():
    noise = SampleNoise(Streams(3).sequence("x"), (4, 3), "normal")
    values = np.array([noise.sample(k) for k in range(20_000)])
    assert np.abs(values.mean(axis=0)).max() < 0.03
    assert np.abs(values.std(axis=0) - 1).max() < 0.02
    lagged = (values[1:] * values[:-1]).mean(axis=0)
    assert np.abs(lagged).max() < 0.03
