"""Random streams of a trial: one seed, spawned by name, never global."""

import hashlib

import numpy as np

from mjmr.errors import InvalidInputError


class Streams:
    """Independent random streams that depend on (seed, name) alone, not on who asks first."""

    def __init__(self, seed: int):
        """Args: seed: The trial's seed.

        Raises:
            InvalidInputError: It is negative or no whole number.
        """
        if seed != int(seed) or seed < 0:
            raise InvalidInputError(f"a seed is a whole number, 0 or more; got {seed}")
        self.seed = seed

    def sequence(self, name: str) -> np.random.SeedSequence:
        """Seed sequence of the stream called ``name``."""
        digest = hashlib.sha256(name.encode()).digest()
        key = tuple(int.from_bytes(digest[i : i + 4], "little") for i in range(0, 16, 4))
        return np.random.SeedSequence(self.seed, spawn_key=key)

    def generator(self, name: str) -> np.random.Generator:
        """A fresh generator at the start of the stream called ``name``."""
        return np.random.Generator(np.random.PCG64(self.sequence(name)))


class SampleNoise:
    """Random numbers that depend on (stream, row, sample number) alone.

    Samples are drawn in blocks, so reading sample 5 costs no draw of samples 0 to 4 later on, and
    skipping a sample changes nothing in the next.
    """

    _BLOCK = 64

    def __init__(self, sequence: np.random.SeedSequence, shape: tuple[int, ...], kind: str):
        """Prepare.

        Args:
            sequence: The stream.
            shape: Shape of one sample, rows (robots) first.
            kind: ``"normal"`` (mean 0, deviation 1) or ``"uniform"`` (0 to 1).
        """
        self._key = sequence.generate_state(2, np.uint64)
        self._shape, self._kind = shape, kind
        self._index = -1
        self._block = np.empty(0)

    def sample(self, number: int) -> np.ndarray:
        """Sample ``number``, shape ``shape``; a view, not to be written to."""
        index, offset = divmod(number, self._BLOCK)
        if index != self._index:
            bits = np.random.Philox(key=self._key, counter=[0, 0, 0, index])
            draw = np.random.Generator(bits)
            # rows first: a row's numbers do not depend on how many rows follow
            size = (self._shape[0], self._BLOCK, *self._shape[1:])
            block = draw.standard_normal(size) if self._kind == "normal" else draw.random(size)
            self._block, self._index = block, index
        return self._block[:, offset]


class Drift:
    """A bias that wanders: a stationary first-order Gauss-Markov process, deviation 1.

    Its correlation falls to 1/e over the correlation time. Sample ``k`` depends on (stream, row, k)
    alone: whoever skips samples or goes back gets the same ones.
    """

    _BLOCK = 64

    def __init__(self, sequence: np.random.SeedSequence, shape: tuple[int, ...], keep: float):
        """Prepare.

        Args:
            sequence: The stream.
            shape: Shape of one sample, rows (robots) first.
            keep: Correlation of two samples in a row, ``exp(-period / correlation time)``.
        """
        self._noise = SampleNoise(sequence, shape, "normal")
        self._keep, self._kick = keep, (1.0 - keep**2) ** 0.5
        self._starts: list[np.ndarray] = []  # of every block passed so far
        self._value, self._number = np.empty(shape), -1

    def sample(self, number: int) -> np.ndarray:
        """Sample ``number``, shape ``shape``; not to be written to."""
        block = min(number // self._BLOCK, len(self._starts) - 1)
        if block >= 0 and not block * self._BLOCK <= self._number <= number:
            self._value, self._number = self._starts[block], block * self._BLOCK
        while self._number < number:
            self._number += 1
            fresh = self._noise.sample(self._number)
            first = self._number == 0
            self._value = fresh.copy() if first else self._keep * self._value + self._kick * fresh
            if self._number == len(self._starts) * self._BLOCK:
                self._starts.append(self._value)
        return self._value
