"""Claims of ours that faults really struck in the runs that are about them.

Written after the claims on what the faults cost had been measured; they stand beside those. Without
them a fault that never came would look like one that costs nothing.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from experiments.scout_workers.evidence import PLAIN
from experiments.scout_workers.sizes import CHOSEN
from mjmr.claims import Bound, Claim, Evidence
from mjmr.table import Table

_PAIR: dict[str, Any] = {
    **{k: v for k, v in PLAIN.items() if k != "failure"}, "experiment": "maze", "robots": 2,
}  # fmt: skip
_ALL, _LARGE = ("quick", "standard", "full"), ("standard", "full")


def struck() -> list[Claim]:
    """One of each fault, and each field it is run in."""
    found = []
    for mode in ("planar", "physical"):
        plain = {**_PAIR, "mode": mode}
        small = _ALL if mode == "planar" else _LARGE
        found += [
            _claim(
                f"ir-dead-struck-{mode}",
                "share of runs in which the dead detectors had something to be tripped by",
                {**plain, "maze": CHOSEN if mode == "planar" else "m3", "failure": "ir-dead"},
                _over("hidden"),
                small,
            ),
            _claim(
                f"scout-killed-struck-{mode}",
                "m3: share of runs in which the scout died",
                {**plain, "maze": "m3", "failure": "scout-killed"},
                _over("died"),
                small,
            ),
            _claim(
                f"worker-dead-struck-{mode}",
                "corridor: share of runs in which the first worker died",
                {**plain, "robots": 3, "maze": "corridor", "failure": "worker-dead"},
                _over("died"),
                _LARGE,
            ),
        ]
    bits = {k: v for k, v in PLAIN.items() if k != "bit_error"}
    return [
        *found,
        _claim(
            "bad-checksum-struck",
            "m3: share of runs in which groups were read, and every one was dropped",
            {**_PAIR, "mode": "planar", "maze": "m3", "failure": "bad-checksum"},
            _all_dropped,
            _ALL,
        ),
        _claim(
            "bit-errors-struck",
            "m3, 5 % of bits read wrong: share of runs in which less of the groups read was "
            "accepted than in the run of the same seed without errors",
            {**bits, "mode": "planar", "experiment": "maze", "robots": 2, "maze": "m3",
             "bit_error": (0.0, 0.05)},
            _fewer_accepted,
            _LARGE,
        ),
    ]  # fmt: skip


def _claim(
    name: str,
    how: str,
    needs: dict[str, Any],
    evaluate: Callable[[Table], Evidence],
    sizes: tuple[str, ...],
) -> Claim:
    return Claim(
        id=name,
        text="ours: the fault was really there in every run",
        how=how,
        bound=Bound(">=", 1.0),
        sizes=sizes,
        needs=needs,
        evaluate=evaluate,
    )


def _share(flags) -> Evidence:
    """Of the very runs the other claims are about: no sample of others, so no interval."""
    flags = np.asarray(flags, dtype=bool)
    return Evidence(float(flags.mean()), n=len(flags))


def _over(metric: str) -> Callable[[Table], Evidence]:
    return lambda table: _share(table.values(metric) > 0)


def _all_dropped(table: Table) -> Evidence:
    read, dropped = table.values("groups_read"), table.values("groups_dropped")
    return _share((read > 0) & (dropped == read))


def _fewer_accepted(table: Table) -> Evidence:
    shares = []
    for error in (0.0, 0.05):
        rows = table.where(bit_error=error)
        read, accepted = rows.by_seed("groups_read"), rows.by_seed("groups_accepted")
        shares.append({seed: accepted[seed] / read[seed] for seed in read if read[seed]})
    common = sorted(set(shares[0]) & set(shares[1]))
    if not common:
        return Evidence.untestable("no runs of both kinds in which groups were read")
    return _share([shares[1][s] < shares[0][s] for s in common])
