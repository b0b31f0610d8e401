"""A read-only table of trials: selected by condition, read as arrays, and aware of what was read.

A claim gets a :class:`Table` of every trial its run was to make, finished or not. The table notes
the rows it is asked for, so that a claim which rests on a failed trial is found out even if its
author did not think of failures.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from mjmr.conditions import Condition, Parameter, Value, as_tuple, find_parameter, matches
from mjmr.errors import InvalidInputError, MjmrError, UnknownNameError

Metric = float | int | str | bool | None


class NoTrialsError(MjmrError):
    """A selection of a table holds no finished trials."""


@dataclass(frozen=True)
class Row:
    """One trial that is to be, or was, made.

    Args:
        condition: Complete condition.
        seed: Its seed.
        status: ``ok``, ``failed``, ``no-gl`` or ``missing`` (not run, or not yet).
        metrics: What the trial returned; names that start with ``wall_`` are wall-clock times.
        error: One line about a failure.
    """

    condition: Condition
    seed: int
    status: str
    metrics: Mapping[str, Metric] = field(default_factory=dict)
    error: str = ""


class Table:
    """Immutable view over trials. Arrays have one entry per finished trial, in table order."""

    def __init__(self, rows: Sequence[Row], parameters: Sequence[Parameter]):
        """View all of ``rows``, of a study with these parameters."""
        self._all = tuple(rows)
        self._index = tuple(range(len(self._all)))
        self._parameters = tuple(parameters)
        self._read: set[int] = set()
        self._filter = ""

    def __len__(self) -> int:
        """Number of trials, finished or not."""
        return len(self._index)

    def where(self, **wanted: Value | Sequence[Value]) -> "Table":
        """The trials whose condition has these values; a sequence means any of its values.

        Raises:
            UnknownNameError: A name or value the study does not declare.
        """
        typed = {
            name: tuple(find_parameter(self._parameters, name).check(v) for v in as_tuple(value))
            for name, value in wanted.items()
        }
        told = ", ".join(f"{n}={','.join(map(str, v))}" for n, v in typed.items())
        return self._view(
            [i for i in self._index if matches(self._all[i].condition, typed)],
            ", ".join(filter(None, (self._filter, told))),
        )

    def where_seed(self, least: int = 0, below: int | None = None) -> "Table":
        """The trials whose seed is at least ``least`` and, unless None, less than ``below``."""
        end = math.inf if below is None else below
        told = f"seed >= {least}" + ("" if below is None else f" and < {below}")
        return self._view(
            [i for i in self._index if least <= self._all[i].seed < end],
            ", ".join(filter(None, (self._filter, told))),
        )

    def split(self, name: str) -> Iterator[tuple[Value, "Table"]]:
        """Each value of a parameter that occurs, with its trials, in order of appearance."""
        for value in self.distinct(name):
            yield value, self.where(**{name: value})

    def distinct(self, name: str) -> list[Value]:
        """Values of a parameter that occur, in order of appearance.

        Raises:
            UnknownNameError: The study has no such parameter.
        """
        find_parameter(self._parameters, name)
        return list(dict.fromkeys(self._all[i].condition[name] for i in self._index))

    @property
    def conditions(self) -> list[Condition]:
        """Distinct conditions, in order of appearance."""
        return list(dict.fromkeys(self._all[i].condition for i in self._index))

    @property
    def seeds(self) -> np.ndarray:
        """Seeds of the finished trials, shape (n,), aligned with :meth:`values`."""
        return np.array([row.seed for row in self._finished()], dtype=np.int64)

    @property
    def rows(self) -> tuple[Row, ...]:
        """The trials themselves, finished or not."""
        self._read.update(self._index)
        return tuple(self._all[i] for i in self._index)

    @property
    def failed(self) -> int:
        """Number of trials that were run and failed."""
        return self._count("failed")

    @property
    def missing(self) -> int:
        """Number of trials not run, or not yet."""
        return self._count("missing")

    @property
    def finished(self) -> int:
        """Number of trials with metrics."""
        return self._count("ok")

    def values(self, metric: str) -> np.ndarray:
        """A metric of the finished trials.

        Returns:
            Shape (n,): bool if every value is one, float64 for numbers (None is nan), else text.

        Raises:
            NoTrialsError: The selection holds no finished trials.
            UnknownNameError: No finished trial of it has this metric; lists those they have.
        """
        rows = self._finished()
        if not any(metric in row.metrics for row in rows):
            raise UnknownNameError("metric", metric, self.metrics)
        found = [row.metrics.get(metric) for row in rows]
        if all(isinstance(v, bool) for v in found):
            return np.array(found, dtype=bool)
        if any(isinstance(v, str) for v in found):
            return np.array(["" if v is None else str(v) for v in found])
        return np.array([np.nan if v is None else v for v in found], dtype=np.float64)

    def by_seed(self, metric: str) -> dict[int, Any]:
        """A metric by seed, for a selection with one condition only.

        Raises:
            InvalidInputError: Several conditions are selected, so that a seed occurs twice.
        """
        if len(self.conditions) > 1:
            raise InvalidInputError(
                f"by_seed needs one condition; {len(self.conditions)} are selected"
            )
        return dict(zip(self.seeds.tolist(), self.values(metric).tolist(), strict=True))

    def pair(self, other: "Table", metric: str) -> tuple[np.ndarray, np.ndarray]:
        """A metric of two selections, paired on seed.

        A trial's partner has the same seed and the same condition, apart from parameters that are
        constant within each selection (those the two selections differ by).

        Returns:
            Two arrays of shape (n,); entry i of both is one pair.

        Raises:
            InvalidInputError: A trial without a partner, or with several.
        """
        ignored = {
            p.name
            for p in self._parameters
            if len(self.distinct(p.name)) <= 1 and len(other.distinct(p.name)) <= 1
        }
        mine, theirs = self._keyed(metric, ignored), other._keyed(metric, ignored)
        if mine.keys() != theirs.keys():
            alone = len(mine.keys() ^ theirs.keys())
            raise InvalidInputError(f"{alone} trials have no partner of the same seed")
        return np.array(list(mine.values())), np.array([theirs[k] for k in mine])

    @property
    def metrics(self) -> list[str]:
        """Names of the metrics the finished trials have, in order of appearance."""
        names: dict[str, None] = {}
        for i in self._index:
            names.update(dict.fromkeys(self._all[i].metrics))
        return list(names)

    def fresh(self) -> "Table":
        """The same trials, with nothing read yet."""
        table = self._view(self._index, self._filter)
        table._read = set()
        return table

    def read(self) -> list[Row]:
        """The trials that were read through this table or any selection of it."""
        return [self._all[i] for i in sorted(self._read)]

    def _view(self, index: Sequence[int], told: str) -> "Table":
        table = Table.__new__(Table)
        table._all, table._parameters, table._read = self._all, self._parameters, self._read
        table._index, table._filter = tuple(index), told
        return table

    def _finished(self) -> list[Row]:
        self._read.update(self._index)
        rows = [self._all[i] for i in self._index if self._all[i].status == "ok"]
        if not rows:
            kind = "finished trials" if self._index else "trials"
            raise NoTrialsError(f"no {kind}{' with ' if self._filter else ''}{self._filter}")
        return rows

    def _count(self, status: str) -> int:
        return sum(self._all[i].status == status for i in self._index)

    def _keyed(self, metric: str, ignored: set[str]) -> dict[tuple, Any]:
        values, keyed = self.values(metric), {}
        for row, value in zip(self._finished(), values, strict=True):
            key = row.seed, *((n, v) for n, v in row.condition.items() if n not in ignored)
            if key in keyed:
                raise InvalidInputError(f"seed {row.seed} has several partners")
            keyed[key] = value
        return keyed
