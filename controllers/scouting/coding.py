"""Four-byte groups of the scout's message: two values, each with a check of its own.

A group is (a, check of a, c, check of c): a direction scaled to 0..127 and a displacement in whole
3-inch units, 0..255. Source: MacKunis and Raviv 2003, section 3.3. The paper names an 8-bit CRC
without its polynomial; x^8 + x^2 + x + 1 (0x07) is our choice.

One start value for both checks, as the paper's example has it, accepts the two halves swapped and
a channel of zeros. Ours differ per field and per kind of group, and the first value must be below
128; ``Codec("crc8-one-seed")`` and ``Codec("two-bit")`` (the remainder modulo x^2 + 1, which the
example's bytes are) are there to be compared. Kinds are chosen far apart: six bits must be read
wrong before a group passes as one of another kind. Who knows fewer kinds is misled less often.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.jit import njit

Bytes = NDArray[np.uint8]
Ints = NDArray[np.int64]

GROUP = 4
DIRECTIONS, FARTHEST = 128, 255
CHECKS = ("crc8", "crc8-one-seed", "two-bit")
VECTOR, RECORD, VIA = 0, 1, 2  # kinds of group; via-point k has kind VIA + k
VIA_POINTS = 4
KINDS = VIA + VIA_POINTS
SEEDS = ((0x00, 0xFF), (0x03, 0x00), (0x05, 0x0F), (0x06, 0x53), (0x09, 0xA9), (0x14, 0x18))
"""Start values of the two checks, by kind; the first are the paper's message's."""


def polynomial_remainders(polynomial: int, degree: int) -> Bytes:
    """Remainder of every byte times x^degree modulo a polynomial over GF(2), shape (256,).

    Args:
        polynomial: Its coefficients below the leading one, bit k for x^k.
        degree: 1 to 8.
    """
    found = np.arange(256)
    for _ in range(8):
        top = found & 0x80
        found = (found << 1) & 0xFF
        found = np.where(top > 0, found ^ (polynomial << (8 - degree)), found)
    return (found >> (8 - degree)).astype(np.uint8)


CRC8 = polynomial_remainders(0x07, 8)


def crc8(values: ArrayLike, seed: int = 0) -> Bytes:
    """CRC-8 (0x07, not reflected) of single bytes, from a start value; shape of ``values``."""
    return CRC8[np.asarray(values, dtype=np.uint8) ^ np.uint8(seed)]


def _two_bit(values: ArrayLike) -> Bytes:
    """Remainder modulo x^2 + 1: the parities of the odd and the even bits, as a byte 0..3."""
    v = np.asarray(values, dtype=np.uint8)
    v = (v ^ (v >> 4)) & 0xF
    return ((v ^ (v >> 2)) & 0x3).astype(np.uint8)


@njit
def _kinds(groups: Bytes, tables: Bytes, found: Ints) -> None:
    for i in range(len(groups)):
        a, b, c, d = groups[i, 0], groups[i, 1], groups[i, 2], groups[i, 3]
        found[i] = -1
        if a >= 128:
            continue
        for kind in range(len(tables)):
            if tables[kind, 0, a] == b and tables[kind, 1, c] == d:
                found[i] = kind


@dataclass(frozen=True)
class Codec:
    """Packs pairs of values into groups, and says of groups whether and what they are.

    Args:
        check: ``"crc8"``, ``"crc8-one-seed"`` or ``"two-bit"``.
        kinds: How many kinds of group there are, vectors first; checks that do not tell kinds
            apart have one.

    Raises:
        UnknownNameError: Another check.
        InvalidInputError: Kinds out of range.
    """

    check: str = "crc8"
    kinds: int = 1
    _tables: Bytes = field(init=False, repr=False, compare=False)

    def __post_init__(self):
        if self.check not in CHECKS:
            raise UnknownNameError("check of a message", self.check, CHECKS)
        most = KINDS if self.check == "crc8" else 1
        if not 1 <= self.kinds <= most:
            raise InvalidInputError(f"{self.check} has 1 to {most} kinds; got {self.kinds}")
        if self.check == "crc8":  # (kind, field, value)
            tables = [[crc8(np.arange(256), s) for s in pair] for pair in SEEDS[: self.kinds]]
        else:
            one = crc8(np.arange(256)) if self.check == "crc8-one-seed" else _two_bit(range(256))
            tables = [[one, one]]
        object.__setattr__(self, "_tables", np.array(tables, dtype=np.uint8))

    def encode(self, first: int, second: int, kind: int = VECTOR) -> bytes:
        """A group of two values.

        Args:
            first: 0 to 127.
            second: 0 to 255.
            kind: What they mean; a codec that cannot tell kinds apart knows vectors alone.

        Raises:
            InvalidInputError: A value or kind out of range.
        """
        if not (0 <= first < DIRECTIONS and 0 <= second <= FARTHEST):
            raise InvalidInputError(
                f"a group takes 0 to 127 and 0 to 255; got {first} and {second}"
            )
        if not 0 <= kind < self.kinds:
            raise InvalidInputError(f"this codec knows kinds 0 to {self.kinds - 1}; got {kind}")
        check = self._tables[kind]
        return bytes([first, int(check[0, first]), second, int(check[1, second])])

    def kind(self, groups: ArrayLike) -> Ints:
        """Kind of each group (k,), -1 where a check or the range of the first value fails.

        Args:
            groups: Bytes as they were read, shape (k, 4).
        """
        g = np.ascontiguousarray(groups, dtype=np.uint8).reshape(-1, GROUP)
        found = np.empty(len(g), dtype=np.int64)
        _kinds(g, self._tables, found)
        return found

    def valid(self, groups: ArrayLike) -> NDArray[np.bool_]:
        """Whether each group passes its checks (k,)."""
        return self.kind(groups) >= 0

    def impostors(self, message: bytes) -> int:
        """How many wrong phases of an endless repetition of ``message`` pass as groups.

        Checks of 8 bits let a few messages through read one or three bytes late, whatever the
        start values; a sender that can choose sends another one.
        """
        m = len(message)
        twice = np.frombuffer(message + message, dtype=np.uint8)
        late = [k for k in range(m) if k % GROUP]
        return int(self.valid(np.array([twice[k : k + GROUP] for k in late])).sum())


def to_code(vector: Sequence[float]) -> tuple[int, int]:
    """Direction 0..127 and displacement 0..255 of a vector in units, rounded to nearest.

    A displacement beyond 255 units (19.4 m) is sent as 255.
    """
    x, y = float(vector[0]), float(vector[1])
    turn = np.arctan2(y, x) / (2.0 * np.pi)
    return round(turn * DIRECTIONS) % DIRECTIONS, min(round(float(np.hypot(x, y))), FARTHEST)


def from_code(first: ArrayLike, second: ArrayLike) -> NDArray[np.float64]:
    """Vectors (..., 2) in units, of directions 0..127 and displacements."""
    angle = np.asarray(first, dtype=np.float64) * (2.0 * np.pi / DIRECTIONS)
    d = np.asarray(second, dtype=np.float64)
    return np.stack([d * np.cos(angle), d * np.sin(angle)], axis=-1)
