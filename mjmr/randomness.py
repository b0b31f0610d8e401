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
