"""How much each size runs: the same tests, with other numbers of seeds."""

from mjmr.conditions import Grid
from mjmr.study import Size

_BOTH = (2.0, 5.0)


def _pioneer(worlds: int) -> tuple[Grid, ...]:
    tests = ("straight", "turn", "circle", "stop")
    grids = [Grid(platform="pioneer2dx", test=tests, dt_ms=_BOTH, seeds=1)]
    if worlds:
        crowd = {"test": "crowd", "variant": ("forward", "reverse"), "dt_ms": (5.0, 10.0)}
        grids.append(Grid(platform="pioneer2dx", **crowd, seeds=worlds))
    return tuple(grids)


QUICK = Size(
    "quick",
    grids=_pioneer(0),
    default_seeds=1,
    expected_minutes=0.4,
    note="no crowds, few falls and kicks; decides what one run decides",
)
STANDARD = Size("standard", grids=_pioneer(3), default_seeds=30, expected_minutes=10.0)
FULL = Size("full", grids=_pioneer(10), default_seeds=100, expected_minutes=60.0)
