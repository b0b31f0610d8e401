"""Claims on every trial of trucks that look for or follow a spill, whatever else is asked of them.

They stand beside those on single experiments, and were written when the verdicts of these at size
standard were known, three seeds each; the controller has changed since.
"""

from experiments.perimeter.evidence import extreme, share, untouched
from mjmr.claims import Bound, Claim

_EVERY = {"task": ("join", "stay"), "mode": "physical"}
_WHERE = "all trials of trucks that look for or follow a spill"


def everywhere() -> list[Claim]:
    """Every one."""
    return [
        Claim(
            id="contact-everywhere",
            text="without collisions",
            how=f"{_WHERE}: those without any contact of trucks with each other, walls or the "
            "spill",
            bound=Bound(">=", 100.0),
            unit="%",
            needs=_EVERY,
            evaluate=share(untouched),
        ),
        Claim(
            id="turn-everywhere",
            text="-0.3 <= w <= 0.3 rad/s",
            published="0.3 rad/s",
            how=f"{_WHERE}: largest turn rate over 0.5 s",
            bound=Bound("<=", 0.305),
            unit="rad/s",
            needs=_EVERY,
            evaluate=extreme("top_turn"),
        ),
        Claim(
            id="speed-everywhere",
            text="0 <= v <= 2 m/s",
            published="2 m/s",
            how=f"{_WHERE}: largest speed over 0.5 s",
            bound=Bound("<=", 2.0),
            unit="m/s",
            needs=_EVERY,
            evaluate=extreme("top_speed"),
        ),
    ]
