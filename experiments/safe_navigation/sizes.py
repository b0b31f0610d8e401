"""How much each size runs: the same experiments, with other numbers.

E1 (the paper's Figure 8): search on and off over vision error. E2 (Figure 9): margins over vision
error. E3 (timing) is measured on the trials of E1. Beyond the paper: failures, an overlapped
start, command latency, a stranger, carts, and the physical mode with both drives and with vision.
"""

from mjmr.conditions import Grid
from mjmr.study import Size

_CROSSES = ("cross4", "cross10")
_SIGMAS = (0.0, 1.0, 2.0, 3.0, 4.0, 5.0)
_MARGINS = (1.0, 2.0, 3.0, 4.0)
OMNI_MARGIN = 10.0  # mm
VISION_MARGIN = 4.0  # mm
VISION_SIGMA = 0.4  # mm along x and y: the error of the vision, measured on images of other seeds
CARTS = ("carts", "carts-apart")
OMNI = {"drive": "omni", "limits": "measured", "margin_mm": OMNI_MARGIN}
VISION = {"margin_mm": VISION_MARGIN, "sigma_mm": VISION_SIGMA}

QUICK = Size(
    "quick",
    grids=(
        Grid(scene=("A", "cross4"), search=(True, False), sigma_mm=(0.0, 4.0), duration=10.0),
        Grid(scene="cross10", duration=10.0),
        Grid(scene="cross4", sigma_mm=(0.0, 4.0), margin_mm=(1.0, 4.0), duration=10.0),
        Grid(scene="cross4", failure=("stopped", "reports-lost"), duration=10.0),
        Grid(scene="cross4", failure="dead", fail_safe=True, duration=10.0),
        Grid(scene="overlap", duration=5.0),
        Grid(scene="cross4", latency=1, predict=(True, False), duration=10.0),
        Grid(mode="physical", scene=("A", "cross4"), margin_mm=1.0, duration=10.0),
        Grid(mode="physical", scene="cross4", search=False, duration=10.0),
        Grid(mode="physical", scene="straight", duration=5.0, seeds=1),
        Grid(scene="stranger10", foresee=(True, False), duration=10.0, seeds=2),
        Grid(scene="stranger10", search=False, duration=10.0, seeds=2),
        Grid(scene="carts", search=(True, False), duration=10.0, seeds=2),
        Grid(
            mode="physical",
            scene="straight",
            drive="omni",
            limits=("paper", "measured"),
            duration=5.0,
            seeds=2,
        ),
        Grid(mode="physical", scene="cross4", **OMNI, duration=10.0, seeds=1),
        Grid(scene="gallery", sensing="vision", mode="physical", duration=1.0, seeds=1),
        Grid(mode="physical", scene="cross4", **VISION, sensing="vision", duration=2.0, seeds=1),
    ),
    default_seeds=3,
    expected_minutes=0.4,
    note="10 s runs, 3 seeds, two noise levels; shows the values, decides few claims",
)


def _whole(seeds: int, zero_seeds: int, physical_seeds: int) -> tuple[Grid, ...]:
    return (
        Grid(scene=("A", *_CROSSES), search=(True, False), sigma_mm=_SIGMAS, seeds=seeds),
        Grid(scene="cross4", sigma_mm=_SIGMAS, margin_mm=_MARGINS, seeds=seeds),
        Grid(scene="cross10", sigma_mm=_SIGMAS, margin_mm=4.0, seeds=seeds),
        Grid(scene="A", motion="bisection", seeds=seeds),
        Grid(
            scene=("A", *_CROSSES),
            failure=("stopped", "dead", "reports-lost", "commands-lost"),
            seeds=zero_seeds,
        ),
        Grid(
            scene=("A", *_CROSSES),
            failure=("dead", "commands-lost"),
            fail_safe=True,
            seeds=zero_seeds,
        ),
        Grid(scene="overlap", duration=5.0, seeds=zero_seeds),
        Grid(scene="cross4", latency=1, predict=(True, False), seeds=zero_seeds),
        Grid(mode="physical", scene=("A", *_CROSSES), margin_mm=1.0, seeds=physical_seeds),
        Grid(mode="physical", scene="cross4", search=False, seeds=physical_seeds),
        Grid(mode="physical", scene="straight", duration=10.0, seeds=1),
        Grid(scene="stranger10", foresee=(True, False), seeds=seeds),
        Grid(scene="stranger10", search=False, seeds=seeds),
        Grid(scene=CARTS, search=(True, False), seeds=seeds),
        Grid(mode="physical", scene=CARTS, margin_mm=1.0, seeds=physical_seeds),
        Grid(
            mode="physical",
            scene="cross4",
            margin_mm=1.0,
            latency=(1, 2, 3),
            predict=(True, False),
            seeds=physical_seeds,
        ),
        Grid(
            mode="physical",
            scene="straight",
            drive="omni",
            limits=("paper", "measured"),
            dt_ms=(5.0, 2.0),
            duration=10.0,
            seeds=12,
        ),
        Grid(mode="physical", scene=("A", "cross4"), **OMNI, seeds=physical_seeds),
        Grid(mode="physical", scene="gallery", sensing="vision", duration=10.0, seeds=10),
        Grid(
            mode="physical",
            scene=("A", "cross4"),
            **VISION,
            sensing=("vision", "late-report"),
            seeds=physical_seeds,
        ),
    )


STANDARD = Size("standard", grids=_whole(24, 16, 20), default_seeds=24, expected_minutes=20.0)
FULL = Size(
    "full",
    grids=_whole(40, 40, 40),
    default_seeds=40,
    expected_minutes=40.0,
    note="the paper's own count: 40 runs of 30 s for each data point",
)
