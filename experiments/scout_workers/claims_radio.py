"""Claims about the byte stream."""

from typing import Any

from experiments.scout_workers.evidence import extreme, total
from mjmr.claims import Bound, Claim, Evidence
from mjmr.table import Table

_ALL = ("quick", "standard", "full")
_RADIO: dict[str, Any] = {"mode": "radio", "check": "crc8"}


def _furthest(value: float):
    """The gap between valid groups that is furthest from ``value`` [ms]."""

    def evaluate(table: Table) -> Evidence:
        ends = [*table.values("period_least_ms"), *table.values("period_most_ms")]
        return Evidence(max(ends, key=lambda v: abs(v - value)), n=len(ends) // 2)

    return evaluate


def radio() -> list[Claim]:
    """Every claim of the radio by itself."""
    return [*_periods(), *_checks()]


def _periods() -> list[Claim]:
    phase = {**_RADIO, "experiment": "phase", "jitter_ms": 0.0}
    found = []
    for spacing, pause, period in ((5.0, 20.0, 140.0), (5.0, 15.0, 60.0), (5.0, 10.0, 100.0),
                                   (6.0, 16.0, 340.0)):  # fmt: skip
        paper = period == 140.0
        needs = {**phase, "spacing_ms": spacing, "pause_ms": pause}
        cycle = 3 * spacing + pause
        found.append(
            Claim(
                id=f"period-{period:.0f}",
                text="certain to happen approximately once every 140 milliseconds"
                if paper
                else "not in the paper: what another receive cycle gives by arithmetic",
                published="140 ms, once in four groups" if paper else "words only",
                how=(
                    f"reads {spacing:g} ms apart, a group every {cycle:g} ms, clean channel: time "
                    "between two valid groups, 700 start phases, the furthest off"
                ),
                bound=Bound.within(period - 1.0, period + 1.0),
                bound_source="ours",
                unit="ms",
                sizes=_ALL,
                needs=needs,
                evaluate=_furthest(period),
            )
        )
        if period in (140.0, 60.0):
            found.append(
                Claim(
                    id=f"never-{period:.0f}",
                    text="proper sequencing of data is certain to be achieved"
                    if paper
                    else "not in the paper: a cycle of 30 ms never meets half of the phases",
                    how="the same: share of start phases that hear no valid group in 8 s",
                    bound=Bound("<=", 0.0) if paper else Bound.within(0.4, 0.6),
                    sizes=_ALL,
                    needs=needs,
                    evaluate=extreme("never"),
                )
            )
    return found


def _checks() -> list[Claim]:
    errors = {"mode": "radio", "experiment": "errors", "byte_error": 0.01}

    def worse(table: Table) -> Evidence:
        two, eight = (table.where(check=c).values("corrupted_share") for c in ("two-bit", "crc8"))
        return Evidence(float(two.mean() - eight.mean()), n=len(two))

    return [
        *(
            Claim(
                id=f"no-{what}",
                text="the data must be received in the correct order",
                how=how,
                bound=Bound("<=", 0.0),
                sizes=_ALL,
                needs={**_RADIO, "experiment": "codes"},
                evaluate=total(what),
            )
            for what, how in (
                ("swapped", "all 32768 messages: how many pass with their halves swapped"),
                ("zeros", "whether a silent channel, all zeros, passes"),
                (
                    "late",
                    "all 32768 messages read one or three bytes late: how many of these pass",
                ),
            )
        ),
        Claim(
            id="undetected",
            text="calculated using the 8-bit Cyclic Redundancy Check (CRC) method",
            how="1 % of bytes read as another: groups that pass though not sent so / groups read",
            bound=Bound("<=", 0.001),
            sizes=_ALL,
            needs={**errors, "check": "crc8"},
            evaluate=extreme("undetected_share"),
        ),
        Claim(
            id="two-bit-worse",
            text="not in the paper: two check bits, which the printed example has",
            how="the same, wrong phases left out: share with two bits - share with CRC-8",
            bound=Bound(">", 0.001),
            sizes=_ALL,
            needs={**errors, "check": ("crc8", "two-bit")},
            evaluate=worse,
        ),
        Claim(
            id="one-seed-swaps",
            text="not in the paper: one start value for both checks does not protect the order",
            how="all messages: share that passes with its halves swapped",
            bound=Bound(">", 0.4),
            sizes=_ALL,
            needs={"mode": "radio", "experiment": "codes", "check": "crc8-one-seed"},
            evaluate=lambda t: Evidence(
                float(t.values("swapped")[0] / t.values("messages")[0]), n=1
            ),
        ),
    ]
