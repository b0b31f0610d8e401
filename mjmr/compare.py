"""Two runs of a study set against each other, trial by trial of the same condition and seed.

Reads two results folders and nothing else: neither needs the parts it was computed with.
"""

import csv
import io
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mjmr import statistics
from mjmr.conditions import Condition, Value, find_parameter, format_value, matches, parse_filter
from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.registry import load_study
from mjmr.store import Outcome, StoreError, read_meta, read_outcomes

Key = tuple[Condition, int]


@dataclass(frozen=True, kw_only=True)
class Difference:
    """One metric of both runs, over pairs of trials.

    Pairs of one seed under several conditions are not independent: they are averaged first, and
    interval and p rest on the seeds.

    Args:
        group: Values of the parameters the comparison is split by.
        metric: Its name.
        a: Mean in the first run.
        b: Mean in the second run.
        difference: Mean of b - a.
        low: Lower end of its 95 % bootstrap interval.
        high: Upper end.
        n: Pairs in which both values are finite numbers.
        seeds: Seeds among them.
        p: Of Wilcoxon's signed-rank test, two-sided.
        p_holm: The same adjusted by Holm for all the comparisons made here.
    """

    group: Mapping[str, Value]
    metric: str
    a: float
    b: float
    difference: float
    low: float
    high: float
    n: int
    seeds: int
    p: float
    p_holm: float = math.nan


@dataclass(frozen=True, kw_only=True)
class Run:
    """One side of a comparison.

    Args:
        folder: Its results folder.
        meta: What the results say of themselves.
        outcomes: Its trials by condition and seed.
        verdicts: Verdicts by claim id, timing claims left out; None if there are none to read.
    """

    folder: Path
    meta: Mapping[str, Any]
    outcomes: Mapping[Key, Outcome]
    verdicts: Mapping[str, str] | None

    @property
    def parts(self) -> str:
        """What was swapped, in words."""
        found = [f"{p['role']}={p['reference']}" for p in self.meta.get("parts", ())]
        return ", ".join(found) or "the published parts"

    def count(self, status: str) -> int:
        """Number of trials of a status."""
        return sum(o.status == status for o in self.outcomes.values())


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """What was found.

    Args:
        a: The first run.
        b: The second run.
        pairs: Trials that finished in both.
        only_a: Trials that finished in the first alone.
        only_b: Trials that finished in the second alone.
        rows: The metrics.
        changed: Claims whose verdicts differ: ``{id: (verdict in a, verdict in b)}``.
        warnings: What beside the parts may have made the difference.
    """

    a: Run
    b: Run
    pairs: int
    only_a: int
    only_b: int
    rows: list[Difference]
    changed: dict[str, tuple[str, str]]
    warnings: list[str]


def compare(
    a: Path,
    b: Path,
    *,
    by: Sequence[str] = (),
    only: Sequence[str] = (),
    metrics: Sequence[str] = (),
) -> Comparison:
    """Pair the trials of two results folders and compare their metrics and verdicts.

    Args:
        a: Results folder of the first run.
        b: Of the second.
        by: Parameters to split by; without any, all conditions are pooled.
        only: Conditions to keep, as texts ``key=value[,value...]``.
        metrics: Which to compare; empty takes all that are numbers, wall times left out.

    Raises:
        StoreError: A folder without results, or a damaged one.
        InvalidInputError: Different studies, no trial finished in both, or an unknown name.
    """
    first, second = _read(a), _read(b)
    names = [str(run.meta["study"]) for run in (first, second)]
    if names[0] != names[1]:
        raise InvalidInputError(f"two runs of one study are compared, not {' and '.join(names)}")
    study = load_study(str(first.meta.get("reference", names[0])))
    for name in by:
        find_parameter(study.parameters, name)
    wanted = parse_filter(study.parameters, only)
    kept = [
        {key: o for key, o in run.outcomes.items() if o.status == "ok" and matches(key[0], wanted)}
        for run in (first, second)
    ]
    common = [key for key in kept[0] if key in kept[1]]
    if not common:
        told = f" with {' '.join(only)}" if only else ""
        raise InvalidInputError(f"no trial{told} is finished in both {a} and {b}")
    pairs = [(kept[0][key], kept[1][key]) for key in common]
    return Comparison(
        a=first,
        b=second,
        pairs=len(pairs),
        only_a=len(kept[0]) - len(pairs),
        only_b=len(kept[1]) - len(pairs),
        rows=_holm(_rows(pairs, by, metrics)),
        changed=_changed(first.verdicts or {}, second.verdicts or {}),
        warnings=_warnings(first, second),
    )


def _read(folder: Path) -> Run:
    meta = read_meta(folder)
    if meta is None or "study" not in meta:
        raise StoreError(f"no results in {folder}; make them with mjmr run")
    outcomes = {(o.condition, o.seed): o for o in read_outcomes(folder)}
    return Run(folder=Path(folder), meta=meta, outcomes=outcomes, verdicts=_verdicts(folder))


def _verdicts(folder: Path) -> dict[str, str] | None:
    try:
        found = json.loads((Path(folder) / "claims.json").read_text(encoding="utf-8"))
        return {c["id"]: c["verdict"] for c in found if not c["timing"]}
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _rows(
    pairs: Sequence[tuple[Outcome, Outcome]],
    by: Sequence[str],
    metrics: Sequence[str],
) -> list[Difference]:
    groups: dict[tuple[Value, ...], list[tuple[Outcome, Outcome]]] = {}
    for pair in pairs:
        groups.setdefault(tuple(pair[0].condition[name] for name in by), []).append(pair)
    names = dict.fromkeys(name for pair in pairs for o in pair for name in o.metrics)
    walls = dict.fromkeys(name for pair in pairs for o in pair for name in o.wall)
    for name in metrics:
        if name not in names and name not in walls:
            raise UnknownNameError("metric", name, [*names, *walls])
    rows = [
        row
        for values in sorted(groups)
        for name in metrics or names
        if (row := _difference(dict(zip(by, values, strict=True)), name, groups[values]))
    ]
    for name in metrics:
        if not any(row.metric == name for row in rows):
            raise InvalidInputError(f"metric {name} is nowhere a finite number in both runs")
    return rows


def _difference(
    group: dict[str, Value], metric: str, pairs: Sequence[tuple[Outcome, Outcome]]
) -> Difference | None:
    """The row of a metric; None if no pair has it as finite numbers."""
    values = np.array([[_number(o, metric) for o in pair] for pair in pairs])
    finite = np.isfinite(values).all(axis=1)
    if not finite.any():
        return None
    seed_of_pair = np.array([pair[0].seed for pair in pairs])[finite]
    seeds, of = np.unique(seed_of_pair, return_inverse=True)
    a, b = (np.bincount(of, column) / np.bincount(of) for column in values[finite].T)
    # Pairs are resampled together, so their differences are.
    estimate = statistics.mean(b - a)
    return Difference(
        group=group,
        metric=metric,
        a=float(a.mean()),
        b=float(b.mean()),
        difference=estimate.value,
        low=estimate.low,
        high=estimate.high,
        n=int(finite.sum()),
        seeds=len(seeds),
        p=statistics.wilcoxon(a, b),
    )


def _number(outcome: Outcome, metric: str) -> float:
    value = outcome.metrics.get(metric, outcome.wall.get(metric))
    return float(value) if isinstance(value, bool | int | float) else math.nan


def _holm(rows: list[Difference]) -> list[Difference]:
    """Rows with p adjusted for their number. Source: S. Holm, Scand. J. Statist. 6 (1979)."""
    adjusted, worst = [*rows], 0.0
    for rank, i in enumerate(sorted(range(len(rows)), key=lambda i: rows[i].p)):
        worst = max(worst, min(1.0, (len(rows) - rank) * rows[i].p))
        adjusted[i] = Difference(**{**vars(rows[i]), "p_holm": worst})
    return adjusted


def _changed(a: Mapping[str, str], b: Mapping[str, str]) -> dict[str, tuple[str, str]]:
    both = {n: (a.get(n, "absent"), b.get(n, "absent")) for n in {**a, **b}} if a and b else {}
    return {name: pair for name, pair in both.items() if pair[0] != pair[1]}


def _warnings(a: Run, b: Run) -> list[str]:
    """What differs beside the parts, and what could not be compared."""
    found = []
    sizes = a.meta.get("size"), b.meta.get("size")
    if sizes[0] != sizes[1]:
        found.append(f"the runs are of sizes {sizes[0]} and {sizes[1]}")
    elif a.meta.get("digest") == b.meta.get("digest"):
        found.append("both runs are of the same configuration, source and parts")
    elif len({r.meta.get("digest_of_published", r.meta.get("digest")) for r in (a, b)}) > 1:
        found.append("configuration or source differ in more than the parts")
    for run in (a, b):
        if run.verdicts is None:
            found.append(f"{run.folder} has no claims to compare; mjmr run writes them at its end")
    mine, theirs = a.meta.get("versions", {}), b.meta.get("versions", {})
    for name in {**mine, **theirs}:
        if mine.get(name) != theirs.get(name):
            found.append(f"{name} is {mine.get(name)} in the first, {theirs.get(name)} in the last")
    return found


def to_text(comparison: Comparison, path: Path) -> str:
    """The comparison as a file of this name: rows as CSV if it ends with .csv, else all as JSON."""
    from mjmr.reports import to_json

    c = comparison
    if path.suffix == ".csv":
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        names = list(c.rows[0].group) if c.rows else []
        numbers = ("a", "b", "difference", "low", "high", "n", "p", "p_holm")
        writer.writerow([*names, "metric", *numbers])
        for row in c.rows:
            cells = [row.group[n] for n in names] + [row.metric]
            writer.writerow([*cells, *(getattr(row, n) for n in numbers)])
        return text.getvalue()
    runs = {
        side: {
            "folder": str(run.folder),
            "meta": dict(run.meta),
            "trials": len(run.outcomes),
            "failed": run.count("failed"),
            "without_partner": alone,
        }
        for side, run, alone in (("a", c.a, c.only_a), ("b", c.b, c.only_b))
    }
    return to_json(
        {
            **runs,
            "pairs": c.pairs,
            "metrics": [asdict(row) for row in c.rows],
            "verdicts_changed": {n: {"a": v[0], "b": v[1]} for n, v in c.changed.items()},
            "warnings": c.warnings,
        }
    )


def group_text(group: Mapping[str, Value]) -> str:
    """Values of a group as one writes them."""
    return " ".join(f"{name}={format_value(value)}" for name, value in group.items())
