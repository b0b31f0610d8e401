"""Claims on sweeps of d_des and of the number of robots, on unicycle bodies."""

from experiments.perimeter.conditions import STAY
from experiments.perimeter.evidence import both, flags, share
from experiments.perimeter.sizes import COUNTS, LONG, ROOMY, TIGHT
from mjmr.claims import Bound, Claim

_SWEPT = {**STAY, "mode": "unicycle"}
_SHORT = "unicycle bodies, 600 s from a bunch on a static disc"
_LONG = f"unicycle bodies, {LONG:g} s from a bunch on a static disc"


def swept() -> list[Claim]:
    """Every one; a reference run has the window of d_des, [1 - .1 / (N - 1), 1.01] chords.

    They were written when it was known what trucks do at 0.8, 1 and 1.2 chords, and after seeds
    1000 and 1001 had been seen: of six robots or more not all stood still for 30 s after 600 s.
    """
    even, stopped = flags("even"), flags("stopped")
    return [
        Claim(
            id="sweep-low-does-not-surround",
            text="if d_des is too low, the swarm will not surround the perimeter",
            how=f"{_SHORT}; five robots, d_des of {_listed(TIGHT)} chords: trials that end "
            "unevenly and stopped",
            bound=Bound(">=", 100.0),
            unit="%",
            needs={**_SWEPT, "factor": TIGHT},
            evaluate=share(both(flags("even", False), stopped)),
        ),
        Claim(
            id="sweep-chord-even-and-stopped",
            text="when the swarm is uniformly distributed, it stops",
            how=f"{_SHORT}; five robots, d_des of 1 chord: trials that end evenly and stopped",
            bound=Bound(">=", 100.0),
            unit="%",
            needs={**_SWEPT, "factor": 1.0},
            evaluate=share(both(even, stopped)),
        ),
        Claim(
            id="sweep-high-surrounds-and-moves",
            text="if d_des is too high, the swarm will surround the perimeter, but continue moving",
            how=f"{_SHORT}; five robots, d_des of {_listed(ROOMY)} chords: trials that end evenly, "
            "and not stopped",
            bound=Bound(">=", 100.0),
            unit="%",
            needs={**_SWEPT, "factor": ROOMY},
            evaluate=share(both(even, flags("stopped", False))),
        ),
        Claim(
            id="sweep-robots",
            text="the swarm will reconfigure until the perimeter is uniformly surrounded",
            how=f"{_LONG}; {_listed(COUNTS)} robots, d_des of 1 - .05 / (N - 1) chords: trials "
            "that end evenly and stopped (two are exempt: no chord is longer than the diameter)",
            bound=Bound(">=", 100.0),
            unit="%",
            needs={**_SWEPT, "robots": COUNTS, "duration": LONG},
            evaluate=share(both(even, stopped)),
        ),
    ]


def _listed(values: tuple[float, ...]) -> str:
    return ", ".join(f"{v:g}" for v in values[:-1]) + f" and {values[-1]:g}"
