"""Claims of the formation law on eights that fit into the hall.

``formation-eight`` and the others on it were committed with a scene whose second circle reaches the
wall. They stay as they are; these stand beside them, with the same bounds.
"""

from experiments.perimeter.claims_beyond import LAW, led
from experiments.perimeter.evidence import extreme, total
from experiments.perimeter.sizes import MIDDLE
from mjmr.claims import Bound, Claim

_SEEN = (
    "in the middle of the hall; written after it had been seen that on the other the trucks drive "
    "into a wall"
)


def in_the_middle() -> list[Claim]:
    """Every one."""
    found = []
    for name, path, heard in (
        ("formation-eight", MIDDLE[0], "extrapolated"),
        ("formation-plain-eight", MIDDLE[0], "plain"),
        ("formation-eight-smooth", MIDDLE[1], "extrapolated"),
    ):
        found.append(
            Claim(
                id=f"{name}-middle",
                text=LAW,
                how=f"as {name}, {_SEEN}",
                bound=Bound("<=", 0.3),
                unit="m",
                needs=led(heard, path),
                evaluate=extreme("place_rms_m"),
            )
        )
    for name, metric, unit, words in (
        ("contacts", "contacts", "", "contacts of trucks with each other"),
        ("walls", "obstacle_contact_s", "s", "time that trucks touch walls"),
    ):
        found.append(
            Claim(
                id=f"formation-middle-{name}",
                text="(not in the paper) the same",
                how=f"{words}, both eights {_SEEN}",
                bound=Bound("<=", 0.0),
                unit=unit,
                needs=led("extrapolated", *MIDDLE),
                evaluate=total(metric),
            )
        )
    return found
