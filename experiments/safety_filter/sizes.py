"""How much each size runs: the same experiments, with other numbers.

Swaps: the barrier alone and under noise, without its rule, beside the velocity search, beside
nothing and beside plain consensus; the symmetric start; other numbers of robots. The soccer field:
barrier, search and nothing on safe-navigation's scenes.
"""

from mjmr.conditions import Grid
from mjmr.study import Size

FIELDS = ("A", "cross4", "cross10")
NOISE = 10.0  # mm
# of the field: what each kind of safety is run with; the search's margin is that of its own study
BARRIER = {"method": "barrier", "right": False, "pace": 2.0, "margin_mm": 25.0}
SEARCH = {"method": "search", "right": False, "margin_mm": 1.0}
NONE = {"method": "none", "right": False, "margin_mm": 1.0}
PLAIN = {"right": False, "duration": 20.0}
CROWDS = (5, 20)

QUICK = Size(
    "quick",
    grids=(
        Grid(scene="symmetric", seeds=1),
        Grid(scene="swap", seeds=1),
        Grid(scene="swap", method="none", right=False, duration=5.0, seeds=1),
        Grid(scene=("A", "cross10"), **BARRIER, duration=5.0, seeds=1),
        Grid(scene=("A", "cross10"), **SEARCH, duration=5.0, seeds=1),
    ),
    default_seeds=1,
    expected_minutes=0.3,
    note="one jittered swap and the symmetric one; 5 s of the field; decides few claims",
)


def _whole(seeds: int, others: int, few: int) -> tuple[Grid, ...]:
    return (
        Grid(scene="swap", seeds=seeds),
        Grid(scene="swap", sigma_mm=NOISE, seeds=seeds),
        Grid(scene="symmetric", right=(True, False), seeds=1),
        Grid(scene="symmetric", method="search", right=(True, False), seeds=1),
        Grid(scene="swap", method="search", seeds=others),
        Grid(scene="swap", method="search", right=False, seeds=few),
        Grid(scene="swap", right=False, seeds=few),
        Grid(scene="swap", method=("none", "consensus"), **PLAIN, seeds=few),
        Grid(scene="swap", method=("barrier", "search"), robots=CROWDS, duration=90.0, seeds=2),
        Grid(scene=FIELDS, **BARRIER, duration=30.0, seeds=others),
        Grid(scene=FIELDS, **SEARCH, duration=30.0, seeds=others),
        Grid(scene=FIELDS, **NONE, duration=30.0, seeds=few),
    )


STANDARD = Size("standard", grids=_whole(20, 12, 5), default_seeds=20, expected_minutes=5.0)
FULL = Size("full", grids=_whole(60, 40, 20), default_seeds=60, expected_minutes=15.0)
