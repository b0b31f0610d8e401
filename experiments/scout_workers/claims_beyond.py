"""Claims beyond the paper: what the vector costs, the best cheap change, traps."""

from typing import Any

from experiments.scout_workers.evidence import PLAIN, median_of, successes
from experiments.scout_workers.sizes import BEST, CHOSEN, FRESH
from mjmr.claims import Bound, Claim

_MAZE: dict[str, Any] = {"mode": "planar", "experiment": "maze", "robots": 2, **PLAIN}
_TRAP: dict[str, Any] = {"experiment": "trap", "margin_deg": 35.0, "compass": "card"}


def beyond() -> list[Claim]:
    """Every claim beyond the paper."""
    return [
        Claim(
            id="exact-vector",
            text="not in the paper: failures come from the scout's vector",
            how="m1 to m4, workers are told the true vector: share that arrives",
            bound=Bound(">=", 0.97),
            needs={**_MAZE, "maze": CHOSEN, "vector": "exact"},
            evaluate=successes,
        ),
        *(
            Claim(
                id=f"forced-four{suffix}",
                text="not in the paper: four forced units and steps of 45 deg",
                how=f"{', '.join(names)}: share of workers that arrive",
                bound=Bound(">=", 0.95),
                needs={**_MAZE, **BEST, "maze": names},
                evaluate=successes,
            )
            for suffix, names in (("", CHOSEN), ("-fresh", FRESH))
        ),
        Claim(
            id="bug2",
            text="not in the paper: against Bug2 with perfect senses and the better of its hands",
            how="m1 to m4: path of workers that arrive / that of Bug2, median",
            bound=Bound("<=", 1.3),
            needs={**_MAZE, "maze": CHOSEN},
            evaluate=median_of("over_bug2"),
        ),
        Claim(
            id="wall-passed",
            text="not in the paper: a wall across the way, 0.9 m wide, no lips",
            how="exact vector, card's values: share of workers that arrive",
            bound=Bound(">=", 0.8),
            needs={**_TRAP, "depth": 0.0, "forced": 1},
            evaluate=successes,
        ),
        Claim(
            id="trap-defeats",
            text="not in the paper: the reactive scheme has no cure for concave traps",
            how="the same with lips of 0.1 m: share of workers that arrive",
            bound=Bound("<=", 0.2),
            needs={**_TRAP, "depth": 0.1, "forced": 1},
            evaluate=successes,
        ),
        Claim(
            id="trap-defeats-forced-four",
            text="not in the paper: four forced units and steps of 45 deg against a trap",
            how="lips of 0.2 m: share of workers that arrive",
            bound=Bound("<=", 0.2),
            needs={**_TRAP, "depth": 0.2, "forced": 4},
            evaluate=successes,
        ),
    ]
