"""Claims: what a paper says, bounds that decide it, and verdicts.

A verdict is ``holds`` if the whole interval satisfies the bound, ``fails`` if none of it does,
``inconclusive`` if it straddles the bound, and ``not testable`` with the reason otherwise.
"""

import math
import traceback
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from mjmr.conditions import Value, format_value
from mjmr.errors import InvalidInputError, UnknownNameError, one_line
from mjmr.table import NoTrialsError, Row, Table

__all__ = ["Bound", "Claim", "Evidence", "Row", "Table", "Verdict", "judge", "judge_all"]

HOLDS, FAILS, INCONCLUSIVE, NOT_TESTABLE = "holds", "fails", "inconclusive", "not testable"
_OPERATORS = ("<=", "<", ">=", ">", "==", "in")


@dataclass(frozen=True)
class Bound:
    """What a measured value must satisfy.

    Args:
        op: ``<=``, ``<``, ``>=``, ``>``, ``==`` or ``in``.
        value: A number; for ``in`` the pair ``(low, high)``, ends included.
        tolerance: For ``==`` alone: largest distance from ``value`` that still counts.

    Raises:
        InvalidInputError: Another operator, or a value or tolerance that does not fit it.
    """

    op: str
    value: float | tuple[float, float]
    tolerance: float = 0.0

    def __post_init__(self):
        if self.op not in _OPERATORS:
            raise UnknownNameError("operator of a bound", self.op, _OPERATORS)
        ends = self.value if isinstance(self.value, tuple) else (self.value, self.value)
        if isinstance(self.value, tuple) != (self.op == "in") or len(ends) != 2:
            raise InvalidInputError("a bound takes a number, or for 'in' a pair (low, high)")
        if self.tolerance and self.op != "==":
            raise InvalidInputError(
                f"a bound has a tolerance with == alone; got {self.op} with {self.tolerance:g}"
            )
        if any(math.isnan(e) for e in ends) or ends[0] > ends[1] or not self.tolerance >= 0.0:
            raise InvalidInputError(f"not a bound: {self.op} {self.value} +- {self.tolerance}")

    @staticmethod
    def within(low: float, high: float) -> "Bound":
        """Bound of a value between ``low`` and ``high``, ends included."""
        return Bound("in", (low, high))

    def judge(self, low: float, high: float) -> str:
        """Verdict on an interval ``[low, high]``; give a value twice where there is none."""
        inside = self._contains(low) and self._contains(high)
        if inside:
            return HOLDS
        return INCONCLUSIVE if self._touches(low, high) else FAILS

    def margin(self, value: float) -> float:
        """How far inside the bound a value lies; negative outside."""
        low, high = self._allowed()
        return min(value - low, high - value)

    def _allowed(self) -> tuple[float, float]:
        if isinstance(self.value, tuple):
            return self.value
        if self.op == "==":
            return self.value - self.tolerance, self.value + self.tolerance
        return (-math.inf, self.value) if self.op[0] == "<" else (self.value, math.inf)

    def _contains(self, x: float) -> bool:
        low, high = self._allowed()
        return low <= x <= high and not (self.op in "<>" and x == self.value)

    def _touches(self, low: float, high: float) -> bool:
        bottom, top = self._allowed()
        if self.op == "<":
            return low < top
        if self.op == ">":
            return high > bottom
        return low <= top and high >= bottom

    def __str__(self) -> str:
        if isinstance(self.value, tuple):
            return f"in [{self.value[0]:g}, {self.value[1]:g}]"
        margin = f" +- {self.tolerance:g}" if self.tolerance else ""
        return f"{self.op} {self.value:g}{margin}"


class _Estimate(Protocol):
    @property
    def value(self) -> float: ...
    @property
    def interval(self) -> tuple[float, float]: ...
    @property
    def n(self) -> int: ...


@dataclass(frozen=True)
class Evidence:
    """What a claim's measurement gave.

    Args:
        measured: The value the bound is about; None if it could not be measured (say why).
        interval: Its interval ``(low, high)``; None if the value is exact.
        n: Trials or pairs it rests on.
        why: Reason if not measured; otherwise a remark.
    """

    measured: float | None
    interval: tuple[float, float] | None = None
    n: int = 0
    why: str = ""

    @staticmethod
    def of(estimate: _Estimate, why: str = "") -> "Evidence":
        """Evidence from a :class:`mjmr.statistics.Estimate`."""
        return Evidence(estimate.value, estimate.interval, estimate.n, why)

    @staticmethod
    def untestable(why: str) -> "Evidence":
        """Evidence of a claim that cannot be measured here."""
        return Evidence(None, why=why)


@dataclass(frozen=True, kw_only=True)
class Claim:
    """One statement of a paper and what decides it.

    Args:
        id: Short, unique in the study, for example ``"search-reduces-metric"``.
        text: The paper's words.
        published: The paper's number as printed, or ``"words only"``.
        how: How it is measured, one sentence.
        bound: What the measured value must satisfy.
        bound_source: ``"paper"`` or ``"ours"``.
        sizes: The sizes that decide it; at others the value is shown without a verdict.
        unit: SI unit of the measured value.
        needs: Values of parameters the table is narrowed to before ``evaluate`` sees it.
        evaluate: From the table of trials to evidence.
        timing: Measures wall time; never sets an exit code and is not compared by ``--check``.
    """

    id: str
    text: str
    how: str
    bound: Bound
    evaluate: Callable[[Table], Evidence]
    published: str = "words only"
    bound_source: str = "ours"
    sizes: tuple[str, ...] = ("standard", "full")
    unit: str = ""
    needs: Mapping[str, Value | Sequence[Value]] = field(default_factory=dict)
    timing: bool = False

    def __post_init__(self):
        if self.bound_source not in ("paper", "ours"):
            raise UnknownNameError("bound source", self.bound_source, ("paper", "ours"))
        if not self.sizes or isinstance(self.sizes, str):
            raise InvalidInputError(f"claim {self.id}: sizes must be a tuple of at least one name")


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """A claim judged.

    Args:
        claim: The claim.
        verdict: ``holds``, ``fails``, ``inconclusive`` or ``not testable``.
        measured: The value measured, or None.
        interval: Its interval, or None.
        n: Trials or pairs it rests on.
        why: Reason or remark.
        simulation: Values of the parameter ``mode`` among the trials read, joined by commas.
        error: Traceback if ``evaluate`` raised: a mistake in the study, not a finding.
    """

    claim: Claim
    verdict: str
    measured: float | None = None
    interval: tuple[float, float] | None = None
    n: int = 0
    why: str = ""
    simulation: str = ""
    error: str = ""


def judge_all(claims: Iterable[Claim], table: Table, size: str) -> list[Verdict]:
    """Judge every claim on the same trials; see :func:`judge`."""
    return [judge(claim, table, size) for claim in claims]


def judge(claim: Claim, table: Table, size: str) -> Verdict:
    """Judge a claim on the trials of a size.

    Never raises for what ``evaluate`` does: its mistake makes the claim not testable and is in
    :attr:`Verdict.error`.
    """
    fresh = table.fresh()
    evidence, obstacle, error = None, "", ""
    try:
        evidence = claim.evaluate(fresh.where(**claim.needs))
        obstacle = _unusable(evidence)
    except NoTrialsError as e:
        obstacle = f"{e} at size {size}"
    except Exception as e:
        obstacle = f"evaluation error: {one_line(e)}"
        error = traceback.format_exc()
    read = fresh.read()
    common: dict[str, Any] = {"claim": claim, "simulation": _simulation(read)}
    incomplete = _incomplete(read)
    if incomplete and (obstacle or any(row.status in ("failed", "no-gl") for row in read)):
        # Trials that are not there explain whatever the evaluation made of the rest, and a value
        # beside failed ones would mislead.
        return Verdict(verdict=NOT_TESTABLE, why=incomplete, **common)
    if obstacle or evidence is None or evidence.measured is None:
        return Verdict(verdict=NOT_TESTABLE, why=obstacle, error=error, **common)
    measured = float(evidence.measured)
    interval = evidence.interval and (float(evidence.interval[0]), float(evidence.interval[1]))
    common |= {"measured": measured, "interval": interval, "n": int(evidence.n)}
    if incomplete:
        return Verdict(verdict=NOT_TESTABLE, why=incomplete, **common)
    if size not in claim.sizes:
        why = f"decided at size {', '.join(claim.sizes)}"
        return Verdict(verdict=NOT_TESTABLE, why=why, **common)
    verdict = claim.bound.judge(*(interval or (measured, measured)))
    return Verdict(verdict=verdict, why=evidence.why, **common)


def _unusable(evidence: Evidence) -> str:
    if not isinstance(evidence, Evidence):
        raise TypeError(f"evaluate must return Evidence, not {type(evidence).__name__}")
    if evidence.measured is None:
        return evidence.why or "not measured"
    if math.isnan(evidence.measured):
        return "the measured value is not a number"
    if evidence.interval is not None:
        low, high = evidence.interval
        if math.isnan(low) or math.isnan(high):
            return "the interval is not a number"
        if low > high:
            raise ValueError(f"interval ends the wrong way round: {low}, {high}")
    return ""


def _incomplete(read: list[Row]) -> str:
    said = {
        "failed": "failed",
        "no-gl": "need off-screen OpenGL, which is not there",
        "missing": "not run",
    }
    for status, words in said.items():
        count = sum(row.status == status for row in read)
        if count:
            return f"{count} of {len(read)} {words}"
    return ""


def _simulation(read: list[Row]) -> str:
    modes = (format_value(r.condition["mode"]) for r in read if "mode" in r.condition)
    return ", ".join(dict.fromkeys(modes))
