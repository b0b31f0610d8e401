"""Schemas as vector fields over a whole team, and their weighted sums.

A motor schema maps what a robot perceives to the vector it wants to follow; behaviours are weighted
sums of schemas (R. C. Arkin, Motor Schema-Based Mobile Robot Navigation, IJRR 8(4), 1989). Here
schemas are written as in the papers and added with ``+`` and a weight::

    noise = Noise(hold=5.0)
    wander = 0.6 * noise + Avoid("obstacles", reach=1.5, stop=0.34)

One schema may stand in several sums, or be what another one turns towards: it has one memory and
is evaluated once a step.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from controllers.schemas.percepts import Array, Percepts, Things
from mjmr.errors import InvalidInputError, UnknownNameError


class Schema(ABC):
    """A vector field over the team."""

    @property
    @abstractmethod
    def label(self) -> str:
        """A few words, as diagrams show them."""

    @abstractmethod
    def field(self, view: "View") -> Array:
        """Vectors (n, 2) in the percepts' axes; of length 1 at full strength, 0 where idle."""

    def start(self, n: int, rng: np.random.Generator) -> Any:
        """Memory of n robots, changed in place by :meth:`field`; None for what remembers nothing.

        Args:
            n: Robots of the team.
            rng: For this schema alone.
        """
        return None

    @property
    def percepts(self) -> tuple[str, ...]:
        """Names of what it perceives itself."""
        return ()

    @property
    def asks(self) -> "tuple[Schema, ...]":
        """Schemas whose vectors it needs."""
        return ()

    def __mul__(self, weight: float) -> "Blend":
        return Blend([(weight, self)])

    __rmul__ = __mul__

    def __add__(self, other: "Schema | Blend") -> "Blend":
        return Blend([(1.0, self)]) + other


class Blend:
    """A weighted sum of schemas.

    Attributes:
        terms: Weights and schemas, in order.
    """

    def __init__(self, terms: Sequence[tuple[float, Schema]] = ()):
        """Take the terms; none at all is standing still.

        Raises:
            InvalidInputError: A weight that is negative or not finite (names its schema).
        """
        for weight, schema in terms:
            if not isinstance(schema, Schema):
                raise InvalidInputError(f"a blend is made of schemas; got {type(schema).__name__}")
            if not (math.isfinite(weight) and weight >= 0):
                raise InvalidInputError(
                    f"the weight of {schema.label!r} must be 0 or more and finite; got {weight}"
                )
        self.terms = tuple((float(weight), schema) for weight, schema in terms)

    def __add__(self, other: "Schema | Blend") -> "Blend":
        right = ((1.0, other),) if isinstance(other, Schema) else other.terms
        return Blend([*self.terms, *right])

    def __mul__(self, factor: float) -> "Blend":
        return Blend([(weight * factor, schema) for weight, schema in self.terms])

    __rmul__ = __mul__

    def __iter__(self) -> Iterator[tuple[float, Schema]]:
        return iter(self.terms)

    def field(self, view: "View") -> Array:
        """Sum of the vectors (n, 2); a new array."""
        total = np.zeros((view.n, 2))
        for weight, schema in self.terms:
            if weight > 0:
                total += weight * view.field(schema)
        return total


class Memories:
    """The memories of all schemas that a team's behaviours are made of."""

    def __init__(self, blends: Sequence[Blend], n: int, rng: np.random.Generator):
        """Start every schema once, in order of appearance, each with a generator of its own."""
        self.schemas = all_schemas(blends)
        streams = rng.spawn(len(self.schemas))
        self.n = n
        self._of = {
            id(schema): schema.start(n, stream)
            for schema, stream in zip(self.schemas, streams, strict=True)
        }

    def __getitem__(self, schema: Schema) -> Any:
        return self._of[id(schema)]


def all_schemas(blends: Sequence[Blend]) -> list[Schema]:
    """Every schema in these sums and every one they ask, once, in order of appearance."""
    found: dict[int, Schema] = {}

    def collect(schema: Schema) -> None:
        if id(schema) not in found:
            found[id(schema)] = schema
            for asked in schema.asks:
                collect(asked)

    for blend in blends:
        for _, schema in blend:
            collect(schema)
    return list(found.values())


class View:
    """One step as schemas and cues see it: percepts, time, memories, vectors found so far.

    Attributes:
        time: [s].
        n: Robots.
        state_time: How long each robot (n,) has been in its state [s].
    """

    def __init__(
        self, percepts: Percepts, time: float, memories: Memories, state_time: Array | None = None
    ):
        """Args as the attributes; ``percepts`` by name."""
        self._percepts, self._memories = percepts, memories
        self.time, self.n = time, memories.n
        self.state_time = np.zeros(self.n) if state_time is None else state_time
        self._fields: dict[int, Array] = {}
        self._things: dict[str, Things] = {}
        self._vectors: dict[str, Array] = {}
        self._directions: dict[int | str, Array] = {}

    def things(self, name: str) -> Things:
        """What is perceived under a name; a vector counts as one point a robot.

        Raises:
            UnknownNameError: Nothing is; lists what there is.
            InvalidInputError: It is not of n robots.
        """
        found = self._things.get(name)
        if found is None:
            if name not in self._percepts:
                raise UnknownNameError("percept", name, self._percepts)
            given = self._percepts[name]
            found = given if isinstance(given, Things) else Things.of(given)
            if found.n != self.n:
                raise InvalidInputError(
                    f"percept {name!r} must be of {self.n} robots; got {found.n}"
                )
            self._things[name] = found
        return found

    def vector(self, name: str) -> Array:
        """The nearest thing's offset (n, 2) [m]; NaN where there is none; not to be changed."""
        found = self._vectors.get(name)
        if found is None:
            nearest = self.things(name)
            nearest = nearest if nearest.offset.shape[1] == 1 else nearest.nearest()
            found = np.where(nearest.valid, nearest.offset[:, 0], np.nan)
            self._vectors[name] = found
        return found

    def direction(self, of: "str | Schema") -> Array:
        """Unit vectors (n, 2) towards a percept or along a schema; 0 where there is none.

        Not to be changed.
        """
        key = of if isinstance(of, str) else id(of)
        found = self._directions.get(key)
        if found is None:
            vector = self.vector(of) if isinstance(of, str) else self.field(of)
            found = self._directions[key] = unit(vector)
        return found

    def field(self, schema: Schema) -> Array:
        """A schema's vectors (n, 2) in this step; not to be changed."""
        found = self._fields.get(id(schema))
        if found is None:
            found = self._fields[id(schema)] = schema.field(self)
        return found

    def memory(self, schema: Schema) -> Any:
        """What a schema's :meth:`Schema.start` returned."""
        return self._memories[schema]


def unit(vector: Array) -> Array:
    """Vectors (n, 2) of length 1; 0 where the length is 0 or not a number."""
    length = np.hypot(vector[:, 0], vector[:, 1])[:, None]
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(length > 0, vector / length, 0.0)


def check_ranges(schema: str, **ranges: float) -> None:
    """Refuse a schema's ranges [m] that are negative or not a number.

    Raises:
        InvalidInputError: Names the schema and the range.
    """
    for name, value in ranges.items():
        if not value >= 0:
            raise InvalidInputError(f"{schema}: {name} must be 0 or more; got {value}")


def label_of(source: "str | Schema") -> str:
    """A percept's name or a schema's label."""
    return source if isinstance(source, str) else source.label
