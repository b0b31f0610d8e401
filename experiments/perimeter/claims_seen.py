"""Claims of followers that see their leader and hear nothing (beyond the paper)."""

from experiments.perimeter.claims_beyond import LAW, led
from experiments.perimeter.evidence import extreme, total
from experiments.perimeter.sizes import SEEN
from mjmr.claims import Bound, Claim

_HOW = (
    "leader at 0.8 m/s, seen by two poles in a camera of 100 degrees at 10 Hz, 0.1 s late, its "
    "speeds estimated, no radio"
)


def seen() -> list[Claim]:
    """Every one; bounds are those of followers that hear their leader.

    They were written after seed 1000 had been seen, and before any other of these.
    """
    return [
        *(
            Claim(
                id=f"formation-seen-{path}",
                text=LAW,
                how=f"{path}, {_HOW}: distance of each follower's point from its place, rms from "
                "30 s on; worst trial",
                bound=Bound("<=", bound),
                unit="m",
                needs=led("nothing", path),
                evaluate=extreme("place_rms_m"),
            )
            for path, bound in zip(SEEN, (0.1, 0.1, 0.3, 0.3), strict=True)
        ),
        Claim(
            id="formation-seen-contacts",
            text=LAW,
            how=f"{_HOW}: contacts of trucks, all paths together",
            bound=Bound("<=", 0.0),
            needs=led("nothing", *SEEN),
            evaluate=total("contacts"),
        ),
    ]
