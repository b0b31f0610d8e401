"""The radio by itself: when groups come in the right phase, and which wrong ones get through."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from controllers.scouting.coding import DIRECTIONS, FARTHEST, Codec
from mjmr.byte_channel import ByteChannel, ByteTiming
from mjmr.randomness import Streams

PHASES = 700  # receivers, their first reads spread evenly over the message and a cycle
SECONDS = 8.0
BLOCKS, BLOCK_SECONDS, LISTENERS = 40, 20.0, 100


def timing(
    given: Mapping[str, Any], *, bit_error: float = 0.0, byte_error: float = 0.0
) -> ByteTiming:
    """Clocks of a condition."""
    return ByteTiming(
        spacing=given["spacing_ms"] / 1000,
        pause=given["pause_ms"] / 1000,
        jitter=given["jitter_ms"] / 1000,
        bit_error=bit_error,
        byte_error=byte_error,
    )


def phase(given: Mapping[str, Any], seed: int) -> dict[str, Any]:
    """A clean channel, a message without false phases, receivers in every phase.

    Returns:
        Time between two valid groups (mean, least, most) [ms], the share of receivers that never
        hear one, the longest wait for the first [ms], what arithmetic says [ms], and how many
        valid groups were not the message.
    """
    rng = Streams(seed).generator("message")
    codec, clock = Codec(given["check"]), timing(given)
    message = _message(codec, rng)
    phases = np.concatenate([[0.0], (np.arange(PHASES) + rng.random()) * 0.055 / PHASES])
    channel = ByteChannel(PHASES + 1, clock, Streams(seed).sequence("radio"), phases)
    channel.transmit(0, message, 0.0)
    heard = channel.listen(SECONDS)
    valid = codec.valid(heard.data) & (heard.receiver > 0)
    gaps, firsts = [], []
    for r in range(1, PHASES + 1):
        at = heard.time[valid & (heard.receiver == r)]
        if len(at):
            firsts.append(at[0])
            gaps.append(np.diff(at))
    between = 1000 * np.concatenate(gaps) if gaps else np.array([np.nan])
    return {
        "period_ms": float(between.mean()),
        "period_least_ms": float(between.min()),
        "period_most_ms": float(between.max()),
        "first_ms": float(1000 * max(firsts)) if firsts else None,
        "arithmetic_ms": 1000 * clock.phase_period(),
        "never": 1.0 - len(firsts) / PHASES,
        "wrong": int((valid & ~heard.intact).sum()),
    }


def errors(given: Mapping[str, Any], seed: int) -> dict[str, Any]:
    """Forty messages, bytes read wrong: groups that pass though not sent so.

    Of these, ``corrupted`` are not just the message in a wrong phase.
    """
    streams = Streams(seed)
    rng, codec = streams.generator("message"), Codec(given["check"])
    clock = timing(given, byte_error=given["byte_error"], bit_error=given["bit_error"])
    read = accepted = undetected = corrupted = 0
    sequences = streams.sequence("radio").spawn(BLOCKS)
    for sequence in sequences:
        channel = ByteChannel(LISTENERS + 1, clock, sequence)
        message = _message(codec, rng)
        channel.transmit(0, message, 0.0)
        heard = channel.listen(BLOCK_SECONDS)
        there = heard.receiver > 0
        good = codec.valid(heard.data) & there
        read += int(there.sum())
        accepted += int(good.sum())
        wrong = good & ~heard.intact
        undetected += int(wrong.sum())
        phases = np.array([list(message[k:] + message[:k]) for k in range(len(message))])
        late = (heard.data[:, None] == phases).all(axis=2).any(axis=1)
        corrupted += int((wrong & ~late).sum())
    return {
        "groups": read,
        "accepted": accepted,
        "undetected": undetected,
        "undetected_share": undetected / read,
        "corrupted_share": corrupted / read,
    }


def codes(given: Mapping[str, Any], seed: int) -> dict[str, Any]:
    """Every message there is: which of its wrong phases pass, and whether silence does.

    Args:
        given: The check.
        seed: Does not matter.
    """
    codec = Codec(given["check"])
    swapped = late = 0
    for a in range(DIRECTIONS):
        for c in range(FARTHEST + 1):
            m = codec.encode(a, c)
            passes = codec.valid([list(m[k:] + m[:k]) for k in (1, 2, 3)])
            swapped += int(passes[1])
            late += int(passes[0]) + int(passes[2])
    return {
        "swapped": swapped,
        "late": late,
        "messages": DIRECTIONS * (FARTHEST + 1),
        "zeros": int(codec.valid([[0, 0, 0, 0]])[0]),
    }


def _message(codec: Codec, rng: np.random.Generator) -> bytes:
    """Some message; of a codec that is meant to, one without false phases."""
    while True:
        a, c = int(rng.integers(DIRECTIONS)), int(rng.integers(FARTHEST + 1))
        message = codec.encode(a, c)
        if codec.check != "crc8" or not codec.impostors(message):
            return message
