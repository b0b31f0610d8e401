"""A one-way stream of bytes, to the nanosecond: what a receiver reads, when, and in which phase.

A sender repeats a message without end, every byte several times. A receiver reads groups of a few
bytes at a fixed spacing, then pauses. Nothing tells it where the message begins: groups in the
right phase come up as often as the two clocks slip past each other. With 1 ms a byte, five times
each, four bytes (20 ms) and groups read every 35 ms, 5 ms between reads, that is once in 140 ms
(MacKunis and Raviv 2003, section 3.3).

Times are whole nanoseconds, so that a read that falls on the edge of a byte falls on the same side
of it whenever it is computed. Jitter and errors of a read depend on (stream, receiver, number of
the read) alone: how often and when somebody asks changes nothing.
"""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.jit import njit

Flags = NDArray[np.bool_]
Ints = NDArray[np.int64]
_NS = 1_000_000_000
_FOREVER = np.iinfo(np.int64).max
LONGEST = 64


@dataclass(frozen=True, kw_only=True)
class ByteTiming:
    """Clocks and errors of a byte stream.

    Args:
        byte: Time a byte is on the air [s].
        repeats: Times each byte is sent.
        group: Bytes a receiver reads before it pauses.
        spacing: From one read to the next in a group [s].
        pause: From the last read of a group to the first of the next [s].
        jitter: Standard deviation of every such interval; errors add up [s].
        bit_error: Probability that a bit of a byte is read wrong.
        byte_error: Probability that a byte is read as any other one.

    Raises:
        InvalidInputError: A time that is not above 0 (jitter: negative) or not finite, a count
            below 1, or an error outside [0, 1].
    """

    byte: float = 0.001
    repeats: int = 5
    group: int = 4
    spacing: float = 0.005
    pause: float = 0.020
    jitter: float = 0.0
    bit_error: float = 0.0
    byte_error: float = 0.0

    def __post_init__(self):
        times = (self.byte, self.spacing, self.pause)
        if not all(1e-9 <= t < math.inf for t in times) or not 0 <= self.jitter < math.inf:
            raise InvalidInputError(
                f"byte, spacing and pause are finite and above 0 s, jitter 0 or more; got {times} "
                f"and {self.jitter}"
            )
        for name, value in (("repeats", self.repeats), ("group", self.group)):
            if value != int(value) or value < 1:
                raise InvalidInputError(f"{name} is a whole number, 1 or more; got {value}")
        for name, value in (("bit_error", self.bit_error), ("byte_error", self.byte_error)):
            if not 0 <= value <= 1:
                raise InvalidInputError(f"{name} is a probability, 0 to 1; got {value}")

    @property
    def cycle(self) -> float:
        """From the first read of a group to the first of the next, without jitter [s]."""
        return (self.group - 1) * self.spacing + self.pause

    def phase_period(self, message: int = 4) -> float:
        """Time between two groups of the same phase, without jitter [s], by arithmetic.

        It is the least common multiple of the cycle and the message: what :class:`ByteChannel`
        must come to where every phase can come up at all.

        Args:
            message: Bytes of the message.
        """
        return math.lcm(_ns(self.cycle), message * self.repeats * _ns(self.byte)) / _NS


class Heard(NamedTuple):
    """Groups that were read, in order of receivers and then of time.

    Attributes:
        receiver: (k,).
        time: Of the last read (k,) [s].
        data: Bytes (k, group).
        sender: Who alone was on the air in all of them, or -1 (k,). For traces: a receiver does
            not know.
        intact: A group of that sender's message, in phase and without an error (k,). For metrics.
        carrier: Whether anybody in reach was on the air in any of them (k,). For metrics.
    """

    receiver: Ints
    time: NDArray[np.float64]
    data: NDArray[np.uint8]
    sender: Ints
    intact: Flags
    carrier: Flags


def _ns(time: float) -> int:
    return round(time * _NS)


@njit
def _bits(key: np.uint64, a: int, b: int) -> np.uint64:
    """64 random bits that depend on (key, a, b) alone: two rounds of splitmix64."""
    z = key + np.uint64(a) * np.uint64(0xD1342543DE82EF95)
    for k in range(2):
        z = z + np.uint64(0x9E3779B97F4A7C15)
        z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        z = z ^ (z >> np.uint64(31))
        if k == 0:
            z = z + np.uint64(b) * np.uint64(0xA24BAED4963EE407)
    return z


@njit
def _uniform(key: np.uint64, a: int, b: int) -> float:
    return float(_bits(key, a, b) >> np.uint64(11)) * 2.0**-53


@njit
def _normal(key: np.uint64, a: int, b: int) -> float:
    u = max(_uniform(key, a, 2 * b), 1e-300)
    return np.sqrt(-2.0 * np.log(u)) * np.cos(2.0 * np.pi * _uniform(key, a, 2 * b + 1))


@njit
def _spoil(value: int, byte_error: float, bit_error: float, key: np.uint64, a: int, b: int) -> int:
    """A byte as it is read: replaced by another one, or with bits flipped."""
    if byte_error > 0.0 and _uniform(key, a, 16 * b) < byte_error:
        value = (value + 1 + int(_bits(key, a, 16 * b + 1) % np.uint64(255))) % 256
    if bit_error > 0.0:
        for k in range(8):
            if _uniform(key, a, 16 * b + 2 + k) < bit_error:
                value ^= 1 << k
    return value


@njit
def _listen(
    now, upto, next_read, number, group, spacing, pause, jitter, slot, begin, end, message, length,
    on_air, reach, byte_error, bit_error, keys, receiver, time, data, sender, intact, carrier,
):  # fmt: skip
    """Groups whose last read is at or before ``now`` [ns]; changes next_read, number (n,).

    Where nobody, or somebody out of reach, is on the air, a byte reads zero; where two are, it
    reads as anything. ``upto`` is the room there is. Returns the groups written.
    """
    found = 0
    at = np.empty(group, dtype=np.int64)
    for r in range(len(next_read)):
        while found < upto:
            t = next_read[r]
            for j in range(group):
                if j > 0:
                    t += spacing
                    if jitter > 0.0:
                        t += int(np.rint(jitter * _normal(keys[0], r, number[r] * group + j)))
                at[j] = t
            if t > now:
                break
            alone, good, first, any_ = -2, True, 0, False
            for j in range(group):
                who, several, value, place = -1, False, 0, 0
                for s in on_air:
                    if s != r and reach[s, r] and begin[s] <= at[j] < end[s]:
                        several = several or who >= 0
                        who, any_ = s, True
                        place = ((at[j] - begin[s]) // slot) % length[s]
                        value = message[s, place]
                read = number[r] * group + j
                if several:
                    who = -1
                    value = int(_bits(keys[1], r, read) % np.uint64(256))
                    good = False
                elif who < 0:
                    good = False
                else:
                    if j == 0:
                        first = place
                    # in phase, and the bytes of one group of a longer message in a row
                    if place % group != j or place != first + j:
                        good = False
                    clean = value
                    value = _spoil(value, byte_error, bit_error, keys[2], r, read)
                    good = good and value == clean
                alone = who if alone == -2 or alone == who else -1
                data[found, j] = value
            receiver[found], time[found] = r, at[group - 1]
            sender[found], intact[found] = alone, good and alone >= 0
            carrier[found] = any_
            found += 1
            next_read[r] = t + pause
            if jitter > 0.0:
                next_read[r] += int(np.rint(jitter * _normal(keys[0], r, number[r] * group)))
            number[r] += 1
    return found


class ByteChannel:
    """Every sender's stream and every receiver's clock: robots n, all on one frequency.

    Time is the caller's, and does not go back: what is heard is asked for up to an instant.
    """

    def __init__(
        self,
        n: int,
        timing: ByteTiming,
        sequence: np.random.SeedSequence,
        phase: ArrayLike | None = None,
    ):
        """Set up n robots that listen and are silent.

        Args:
            n: Robots.
            timing: Clocks and errors.
            sequence: Jitter, errors, and the receivers' phases come from it.
            phase: First read of each receiver (n,) [s]; default: drawn within one cycle.

        Raises:
            InvalidInputError: Phases of another shape, or negative.
        """
        self.n, self.timing = int(n), timing
        keys, phases = sequence.spawn(2)
        self._keys = keys.generate_state(3, np.uint64)
        if phase is None:
            drawn = np.random.Generator(np.random.PCG64(phases)).random(n)
            phase = drawn * timing.cycle
        first = np.asarray(phase, dtype=np.float64)
        if first.shape != (n,) or not (np.isfinite(first).all() and (first >= 0).all()):
            raise InvalidInputError(f"phases are {n} times of 0 s or more; got {first}")
        self._next = np.rint(first * _NS).astype(np.int64)
        self._number = np.zeros(n, dtype=np.int64)
        self._begin = np.zeros(n, dtype=np.int64)
        self._end = np.zeros(n, dtype=np.int64)
        self._message = np.zeros((n, LONGEST), dtype=np.uint8)
        self._length = np.ones(n, dtype=np.int64)
        self._now = 0

    def transmit(
        self, sender: int, message: bytes, time: float, duration: float = math.inf
    ) -> None:
        """Let a robot repeat a message from ``time`` [s] on, for ``duration`` [s].

        It replaces what the robot sent before; an empty message ends it. Listen up to that time
        first: what the old message still said is lost otherwise.

        Raises:
            InvalidInputError: A message that is no whole number of groups or longer than 64
                bytes, or a time before what was heard last.
        """
        group = self.timing.group
        if len(message) % group or len(message) > LONGEST:
            raise InvalidInputError(
                f"a message is a multiple of {group} bytes, at most {LONGEST}; got {len(message)}"
            )
        start = _ns(time)
        if start < self._now:
            raise InvalidInputError(f"{time} s has passed: the channel was read up to {self.now} s")
        self._begin[sender] = start
        endless = not math.isfinite(duration)
        self._end[sender] = _FOREVER if endless else start + _ns(duration)
        if not message:
            self._end[sender] = start
            return
        self._message[sender, : len(message)] = np.frombuffer(message, dtype=np.uint8)
        self._length[sender] = len(message)

    def listen(self, time: float, reach: ArrayLike | None = None) -> Heard:
        """Groups read since the last call, up to ``time`` [s].

        Args:
            time: Now.
            reach: Who can be heard by whom (n, n), sender first, for all that time; default:
                everybody by everybody.

        Raises:
            InvalidInputError: A time before the last one, or reach of another shape.
        """
        now, n, timing = _ns(time), self.n, self.timing
        if now < self._now:
            raise InvalidInputError(f"{time} s has passed: the channel was read up to {self.now} s")
        open_ = np.ones((n, n), dtype=bool) if reach is None else np.asarray(reach)
        if open_.shape != (n, n) or open_.dtype != bool:
            raise InvalidInputError(f"reach is ({n}, {n}) flags; got {open_.dtype} {open_.shape}")
        on_air = np.flatnonzero((self._end > self._begin) & (self._end > self._now))
        parts: list[tuple[Any, ...]] = []
        room = n * (int((now - self._now) / _ns(timing.cycle)) + 3)
        while True:
            receiver, at, sender = (np.empty(room, dtype=np.int64) for _ in range(3))
            data = np.empty((room, timing.group), dtype=np.uint8)
            intact, carrier = np.empty(room, dtype=bool), np.empty(room, dtype=bool)
            k = _listen(
                now, room, self._next, self._number, timing.group, _ns(timing.spacing),
                _ns(timing.pause), timing.jitter * _NS, timing.repeats * _ns(timing.byte),
                self._begin, self._end, self._message, self._length, on_air, open_,
                timing.byte_error, timing.bit_error, self._keys, receiver, at, data, sender,
                intact, carrier,
            )  # fmt: skip
            columns = (receiver, at / _NS, data, sender, intact, carrier)
            parts.append(tuple(column[:k] for column in columns))
            if k < room:
                break
        self._now = now
        if len(parts) == 1:
            return Heard(*parts[0])
        return Heard(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))

    @property
    def now(self) -> float:
        """Up to when it was listened to [s]."""
        return self._now / _NS

    def on_air(self, time: float) -> Flags:
        """Who is sending at ``time`` [s] (n,)."""
        now = _ns(time)
        return (self._begin <= now) & (now < self._end)

    def state(self) -> Any:
        """Clocks and streams, copies, for snapshots."""
        arrays = (self._next, self._number, self._begin, self._end, self._message, self._length)
        return self._now, tuple(a.copy() for a in arrays)

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        self._now, arrays = state
        (self._next, self._number, self._begin, self._end, self._message,
         self._length) = (a.copy() for a in arrays)  # fmt: skip
