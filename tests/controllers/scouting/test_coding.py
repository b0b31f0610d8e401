"""Groups of four bytes: what passes, what does not, and what coding costs."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controllers.scouting.coding import (
    KINDS,
    SEEDS,
    Codec,
    crc8,
    from_code,
    polynomial_remainders,
    to_code,
)
from mjmr.errors import InvalidInputError, UnknownNameError

FIRST, SECOND = st.integers(0, 127), st.integers(0, 255)


def bitwise_crc8(value, seed):
    """By the book: shift, and subtract 0x107 where a one falls out."""
    register = seed ^ value
    for _ in range(8):
        register <<= 1
        if register & 0x100:
            register ^= 0x107
    return register


@given(st.integers(0, 255), st.integers(0, 255))
def test_the_table_is_the_division(value, seed):
    assert crc8(value, seed) == bitwise_crc8(value, seed)


def test_published_check_value():
    """CRC-8/SMBUS of "123456789" is 0xF4."""
    register = 0
    for byte in b"123456789":
        register = int(crc8(byte, register))
    assert register == 0xF4


def test_the_printed_example_is_the_remainder_modulo_two_bits():
    """Bytes 25, 2, 9, 3: the paper's example, matched by x^2 + 1 and by CRC-3 (x^3 + x^2 + 1)."""
    assert Codec("two-bit").encode(25, 9) == bytes([25, 2, 9, 3])
    crc3 = polynomial_remainders(0b101, 3)
    assert crc3[[25, 9]].tolist() == [2, 3]
    plain = [polynomial_remainders(p, 8)[[25, 9]].tolist() for p in range(256)]
    assert [2, 3] not in plain, "by no polynomial of degree 8, zero start, not reflected"


@settings(deadline=None)  # the first call compiles
@given(FIRST, SECOND, st.integers(0, KINDS - 1))
def test_what_is_sent_is_what_is_heard(first, second, kind):
    codec = Codec(kinds=KINDS)
    group = codec.encode(first, second, kind)
    assert len(group) == 4
    assert codec.kind([list(group)]).tolist() == [kind]
    assert (group[0], group[2]) == (first, second)


@settings(deadline=None)
@given(FIRST, SECOND, st.data())
def test_one_two_or_three_wrong_bits_are_noticed(first, second, data):
    bits = data.draw(st.sets(st.integers(0, 31), min_size=1, max_size=3))
    codec = Codec(kinds=KINDS)
    group = bytearray(codec.encode(first, second))
    for bit in bits:
        group[bit // 8] ^= 1 << bit % 8
    assert not codec.valid([list(group)])[0]


def test_kinds_are_six_bits_apart():
    """Of all ways to turn a group of one kind into one of another, the shortest."""
    weight = np.array([bin(k).count("1") for k in range(256)])
    data = np.arange(256)
    apart = [int((weight + weight[crc8(data ^ d)]).min()) for d in range(256)]
    for j, (a, b) in enumerate(SEEDS):
        for c, d in SEEDS[:j]:
            assert apart[a ^ c] + apart[b ^ d] >= 6


def test_neither_silence_nor_any_wrong_phase_of_a_vector_passes():
    codec = Codec()
    assert not codec.valid([[0, 0, 0, 0]])[0]
    messages = [codec.encode(a, c) for a in range(128) for c in range(256)]
    for late in (1, 2, 3):
        groups = np.array([list(m[late:] + m[:late]) for m in messages])
        assert not codec.valid(groups).any()


def test_one_start_value_lets_halves_swap_and_silence_pass():
    codec = Codec("crc8-one-seed")
    assert codec.valid([[0, 0, 0, 0]])[0]
    m = codec.encode(100, 27)
    assert codec.valid([list(m[2:] + m[:2])])[0]
    assert codec.impostors(m) >= 1
    assert Codec().impostors(Codec().encode(100, 27)) == 0


def test_a_direction_is_below_128():
    group = [200, int(crc8(200)), 9, int(crc8(9, 0xFF))]
    assert not Codec().valid([group])[0]


@given(st.floats(-180, 180), st.floats(-180, 180))
def test_coding_costs_half_a_step_across_and_half_a_unit_along(x, y):
    d = float(np.hypot(x, y))
    first, second = to_code((x, y))
    assert 0 <= first <= 127
    assert 0 <= second <= 255
    off = float(np.hypot(*(from_code(first, second) - (x, y))))
    assert off <= np.sqrt(0.25 + (0.0245 * d) ** 2) + 0.01


def test_far_away_is_sent_as_the_farthest():
    assert to_code((300.0, 0.0)) == (0, 255)
    assert to_code((-10.0, -1e-9))[0] == 64


def test_bad_input():
    with pytest.raises(UnknownNameError, match="check of a message 'crc9'; valid: crc8"):
        Codec("crc9")
    with pytest.raises(InvalidInputError, match="two-bit has 1 to 1 kinds; got 2"):
        Codec("two-bit", 2)
    with pytest.raises(InvalidInputError, match="0 to 127 and 0 to 255; got 128 and 3"):
        Codec().encode(128, 3)
    with pytest.raises(InvalidInputError, match="knows kinds 0 to 0; got 1"):
        Codec().encode(1, 3, kind=1)
