"""Conditions of a study: named, typed values, one for every declared parameter.

A :class:`Condition` is what a trial runs under. Its canonical JSON key identifies it in results,
so a condition is always complete (defaults filled in) and its values have the declared kinds.
"""

import itertools
import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from mjmr.errors import InvalidInputError, UnknownNameError

Value = bool | int | float | str
Filter = Mapping[str, tuple[Value, ...]]

_WORDS = {"true": True, "on": True, "yes": True, "false": False, "off": False, "no": False}
_RESERVED = ("seed", "seeds", "status", "error")


@dataclass(frozen=True)
class Parameter:
    """One named quantity a study varies.

    Args:
        name: A Python identifier; not ``seed``, ``seeds``, ``status`` or ``error``.
        doc: What it is, one sentence.
        default: Its value where a grid does not name it.
        values: The values allowed; None allows every value of the kind.
        unit: SI unit, empty if none.
        kind: ``bool``, ``int``, ``float`` or ``str``; None takes the default's.
        least: Smallest number allowed; None for any.
        most: Largest number allowed; None for any.

    Raises:
        InvalidInputError: The declaration contradicts itself.
    """

    name: str
    doc: str
    default: Value
    values: tuple[Value, ...] | None = None
    unit: str = ""
    kind: type | None = None
    least: float | None = None
    most: float | None = None

    def __post_init__(self):
        if not self.name.isidentifier() or self.name in _RESERVED:
            raise InvalidInputError(
                f"a parameter's name must be an identifier and none of {', '.join(_RESERVED)}, "
                f"not {self.name!r}"
            )
        if self.kind is None:
            object.__setattr__(self, "kind", type(self.default))
        if self.kind not in (bool, int, float, str):
            raise InvalidInputError(
                f"parameter {self.name}: kind must be bool, int, float or str, not {self.kind}"
            )
        if self.values is not None:
            values = tuple(self._typed(v) for v in self.values)
            if not values or len(set(values)) < len(values):
                raise InvalidInputError(f"parameter {self.name}: values must be distinct, not none")
            object.__setattr__(self, "values", values)
        object.__setattr__(self, "default", self.check(self.default))

    def check(self, value: object) -> Value:
        """The value in the declared kind.

        Raises:
            UnknownNameError: Not among the values allowed; lists them, nearest first.
            InvalidInputError: Not of the declared kind, or not finite.
        """
        typed = self._typed(value)
        if not isinstance(typed, str):
            unit = f" {self.unit}" if self.unit else ""
            for bound, word, beyond in (
                (self.least, "least", self.least is not None and typed < self.least),
                (self.most, "most", self.most is not None and typed > self.most),
            ):
                if beyond:
                    raise InvalidInputError(
                        f"{self.name} must be at {word} {bound:g}{unit}; got {typed:g}{unit}"
                    )
        if self.values is not None and typed not in self.values:
            raise UnknownNameError(
                f"value of {self.name}", format_value(typed), map(format_value, self.values)
            )
        return typed

    def parse(self, text: str) -> Value:
        """The value written as ``text``, in the declared kind; the inverse of `format_value`.

        Raises:
            InvalidInputError: As for :meth:`check`.
        """
        value: object = text
        try:
            if self.kind is bool:
                value = _WORDS[text.strip().lower()]
            elif self.kind is not str:
                value = self.kind(text)  # pyright: ignore[reportOptionalCall]
        except (ValueError, KeyError):
            if self.values is not None:
                raise UnknownNameError(
                    f"value of {self.name}", text, map(format_value, self.values)
                ) from None
            raise InvalidInputError(f"{self.name} takes {self.describe()}, not {text!r}") from None
        return self.check(value)

    def describe(self) -> str:
        """What may be given, for help and errors."""
        if self.values is not None:
            return ", ".join(map(format_value, self.values))
        words = {bool: "true or false", int: "a whole number", float: "a number", str: "a word"}
        return words[self.kind]  # pyright: ignore[reportArgumentType]

    def _typed(self, value: object) -> Value:
        item = getattr(value, "item", None)  # numpy scalars
        given: Any = item() if callable(item) else value
        if self.kind is float and type(given) in (int, float) and math.isfinite(float(given)):
            return float(given) + 0.0  # -0.0 becomes 0.0: equal values have one key
        if self.kind is not float and type(given) is self.kind:
            return given
        raise InvalidInputError(f"{self.name} takes {self._kind_words()}, not {given!r}")

    def _kind_words(self) -> str:
        words = {bool: "true or false", int: "an int", float: "a finite number", str: "a str"}
        return words[self.kind]  # pyright: ignore[reportArgumentType]


class Condition(Mapping[str, Value]):
    """An immutable, hashable mapping with a value for every parameter of a study."""

    __slots__ = ("_items", "key")

    def __init__(self, items: Mapping[str, Value]):
        """Freeze ``items``; use :func:`complete` to check them and fill in defaults."""
        self._items = dict(items)
        self.key = condition_key(self._items)

    def __getitem__(self, name: str) -> Value:
        if name not in self._items:
            raise UnknownNameError("condition", name, self._items)
        return self._items[name]

    def __contains__(self, name: object) -> bool:
        return name in self._items

    def __iter__(self) -> Iterator[str]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)

    def __hash__(self) -> int:
        return hash(self.key)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Condition) and self.key == other.key

    def __reduce__(self):
        return Condition, (self._items,)

    def __repr__(self) -> str:
        return f"Condition({self})"

    def __str__(self) -> str:
        return " ".join(f"{name}={format_value(value)}" for name, value in self._items.items())


def condition_key(condition: Mapping[str, Value]) -> str:
    """Canonical JSON of a condition: names sorted, no spaces, floats by their shortest repr."""
    return json.dumps(dict(condition), sort_keys=True, separators=(",", ":"), allow_nan=False)


def format_value(value: Value) -> str:
    """A value as one writes it on the command line."""
    return ("true" if value else "false") if isinstance(value, bool) else str(value)


def complete(parameters: Sequence[Parameter], given: Mapping[str, object]) -> Condition:
    """The condition with the values given and defaults elsewhere, in order of declaration.

    Raises:
        UnknownNameError: A name or value that is not declared.
        InvalidInputError: A value of the wrong kind.
    """
    for name in given:
        find_parameter(parameters, name)
    return Condition(
        {p.name: p.check(given[p.name]) if p.name in given else p.default for p in parameters}
    )


def find_parameter(parameters: Sequence[Parameter], name: str) -> Parameter:
    """The parameter called ``name``.

    Raises:
        UnknownNameError: There is none; lists those there are, nearest first.
    """
    for parameter in parameters:
        if parameter.name == name:
            return parameter
    raise UnknownNameError("condition", name, [p.name for p in parameters])


def parse_filter(
    parameters: Sequence[Parameter], texts: Iterable[str]
) -> dict[str, tuple[Value, ...]]:
    """Typed filter from texts ``key=value[,value...]``.

    Raises:
        UnknownNameError: An undeclared name or value.
        InvalidInputError: No ``=``, a name twice, or a value of the wrong kind.
    """
    found: dict[str, tuple[Value, ...]] = {}
    for text in texts:
        name, equals, values = text.partition("=")
        if not equals:
            raise InvalidInputError(f"expected key=value[,value...], not {text!r}")
        parameter = find_parameter(parameters, name)
        if name in found:
            raise InvalidInputError(f"{name} is given twice; join its values with commas")
        found[name] = tuple(dict.fromkeys(parameter.parse(v) for v in values.split(",")))
    return found


def parse_condition(parameters: Sequence[Parameter], texts: Iterable[str]) -> Condition:
    """Complete condition from texts ``key=value``, defaults elsewhere.

    Raises:
        InvalidInputError: As for :func:`parse_filter`, or more than one value for a name.
    """
    given = {}
    for name, values in parse_filter(parameters, texts).items():
        if len(values) > 1:
            raise InvalidInputError(f"{name} takes one value here, not {len(values)}")
        given[name] = next(iter(values))
    return complete(parameters, given)


def matches(condition: Mapping[str, Value], wanted: Filter) -> bool:
    """Whether every filtered name has one of its values in the condition."""
    return all(condition[name] in values for name, values in wanted.items())


class Grid:
    """A product of lists of values over the parameters' defaults, with its own seed count.

    ``Grid(scene=["A", "cross4"], sigma_mm=[0.0, 4.0], search=True)`` is four conditions.
    """

    def __init__(self, seeds: int | None = None, **values: Value | Sequence[Value]):
        """Declare.

        Args:
            seeds: Seeds of these conditions; None takes the size's.
            **values: One value or a sequence of them for each parameter that is not at its default.

        Raises:
            InvalidInputError: Seeds below 1, or an empty list.
        """
        if seeds is not None and seeds < 1:
            raise InvalidInputError(f"seeds must be at least 1, not {seeds}")
        self.seeds = seeds
        self.values: dict[str, tuple[Value, ...]] = {n: as_tuple(v) for n, v in values.items()}
        for name, listed in self.values.items():
            if not listed:
                raise InvalidInputError(f"grid: no value for {name}")

    def conditions(self, parameters: Sequence[Parameter]) -> list[Condition]:
        """Every condition of the product, the parameter declared last varying fastest.

        Raises:
            UnknownNameError: A name or value that is not declared.
        """
        for name in self.values:
            find_parameter(parameters, name)
        lists = [self.values.get(p.name, (p.default,)) for p in parameters]
        names = [p.name for p in parameters]
        return [
            complete(parameters, dict(zip(names, product, strict=True)))
            for product in itertools.product(*lists)
        ]

    def __repr__(self) -> str:
        return f"Grid(seeds={self.seeds}, {self.values})"


def as_tuple(value: object) -> tuple:
    """A scalar or text as a tuple of one; a sequence or array as a tuple."""
    if isinstance(value, str) or not isinstance(value, Iterable):
        return (value,)
    return tuple(value)
