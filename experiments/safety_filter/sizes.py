"""How much each size runs."""

from mjmr.conditions import Grid
from mjmr.study import Size

QUICK = Size("quick", (Grid(scene="swap", seeds=1),), 1, 0.1)
STANDARD = Size("standard", (Grid(scene="swap"),), 20, 3.0)
FULL = Size("full", (Grid(scene="swap"),), 40, 10.0)
