from mjmr.conditions import Grid
from mjmr.study import Size
QUICK = Size("quick", (Grid(task="join",seeds=1),), 1, .3)
STANDARD = Size("standard", (Grid(task="join",seeds=20),), 20, 10)
FULL = Size("full", (Grid(task="join",seeds=60),), 60, 10)
