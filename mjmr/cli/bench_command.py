"""``mjmr bench``."""

import functools
import importlib.util
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

from tyro.conf import Positional

from mjmr.cli.parsing import option, parse
from mjmr.errors import MjmrError, UnknownNameError

_MORE = """
EXAMPLES
  mjmr bench
  mjmr bench safe-navigation
  mjmr bench --size full

EXIT CODES
  0  done
  2  no such study or size, or nothing to measure
"""


@dataclass(frozen=True)
class Bench:
    """Measure speed: of the testbed, and of a study if one is named.

    Prints what was measured, under which conditions and with which spread. Nothing is written.
    """

    study: Annotated[
        Positional[str | None], option("STUDY", "Name of the study.", "the testbed alone")
    ] = None
    size: Annotated[
        str,
        option("SIZE", "Of the crowded worlds: quick (10 s), standard (1 minute) or full (5)."),
    ] = "standard"


def main(arguments: Sequence[str]) -> int:
    """Print benchmarks."""
    a = parse(Bench, "bench", arguments, _MORE)
    from mjmr.bench_crowd import SIZES
    from mjmr.registry import load_study
    from mjmr.study import resolve
    from mjmr.study_calls import call_study

    if a.size not in SIZES:
        raise UnknownNameError("size", a.size, SIZES)
    benches: list[tuple[str, Any]] = []
    if importlib.util.find_spec("mjmr.bench") is not None:
        benches.append(("mjmr", resolve("mjmr.bench:core")))
        crowds = resolve("mjmr.bench_crowd:crowds")
        benches.append(("crowds", functools.partial(crowds, a.size)))
    if a.study is not None:
        study = load_study(a.study)
        if study.bench is None:
            raise MjmrError(f"study {study.name} declares no benchmark")
        benches.append((study.name, study.resolve("bench")))
    if not benches:
        raise MjmrError("nothing to measure; name a study: mjmr bench STUDY")
    for name, bench in benches:
        result = call_study("bench", bench)
        print(f"{name}:")
        for line in _lines(result):
            print(f"  {line}")
    return 0


def _lines(result: object) -> list[str]:
    if isinstance(result, Mapping):
        return [f"{name}: {value}" for name, value in result.items()]
    return str(result).splitlines()
