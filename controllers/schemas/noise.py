"""Noise: a random heading, held for a while."""

import math
from dataclasses import dataclass

import numpy as np

from controllers.schemas.base import Schema, View
from controllers.schemas.percepts import Array
from mjmr.errors import InvalidInputError


@dataclass(slots=True)
class _Headings:
    rng: np.random.Generator
    epoch: int
    vectors: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Noise(Schema):
    """Unit vectors of random heading, each robot's own, drawn anew every ``hold`` seconds.

    Which headings come depends on the seed and the time alone, not on who looks when.

    Source: R. C. Arkin, IJRR 8(4), 1989, schema *noise*.

    Attributes:
        hold: [s].
    """

    hold: float

    @property
    def label(self) -> str:
        """Noise."""
        return "noise"

    def __post_init__(self):
        if not (self.hold > 0 and math.isfinite(self.hold)):
            raise InvalidInputError(f"noise: hold must be positive and finite; got {self.hold} s")

    def start(self, n: int, rng: np.random.Generator) -> _Headings:
        """No heading yet."""
        return _Headings(rng, -1, np.zeros((n, 2)))

    def field(self, view: View) -> Array:
        """Vectors (n, 2) of this moment."""
        memory = view.memory(self)
        # a time that is a whole number of holds but for rounding begins the next one
        epoch = math.floor(view.time / self.hold + 1e-9)
        while memory.epoch < epoch:
            angle = memory.rng.uniform(-np.pi, np.pi, view.n)
            memory.vectors = np.column_stack([np.cos(angle), np.sin(angle)])
            memory.epoch += 1
        return memory.vectors
