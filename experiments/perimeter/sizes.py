"""How much each size runs: the same experiments, with other numbers."""

from mjmr.conditions import Grid
from mjmr.study import Size

JOIN = {"task": "join", "start": "scattered"}
STAY = {"task": "stay", "start": "bunch", "duration": 600.0}
GROWTH = 0.0125  # m/s, the paper's
FACTORS = (0.0, 0.8, 1.2)  # of the even chord; 0: 1 - .05 / (n - 1)
SIXTH = 1.0  # of the chord of six: d_des is not below it, and they may stop
LATER = 660.0  # s: 60 s, then 600 s to be even again
AFTERWARDS = "after quick's seed 0 and half a standard run had been seen"  # of claims, on them
PATHS = ("straight", "circle", "eight")
TIGHT, ROOMY = (0.6, 0.7, 0.8, 0.9, 0.95), (1.05, 1.1, 1.2, 1.3, 1.4)
SWEEP = (*TIGHT, 1.0, *ROOMY)  # d_des in even chords
COUNTS = (3, 4, 5, 6, 7, 8)  # robots
LONG = 900.0  # s: eight stop after 700 (seeds 1000 and 1001)
SEEN = ("straight", "circle", "eight-middle", "eight-smooth-middle")  # by camera
MIDDLE = ("eight-middle", "eight-smooth-middle")  # where no wall is in the way
RANGES = (0.0, 10.0, 25.0, 150.0)  # m, of the radio


def grids(join: int, few: int, ranges: int, sweep: int) -> tuple[Grid, ...]:
    """Conditions of a size that decides claims.

    Args:
        join: Seeds of the trials in which a team finds a spill.
        few: Seeds of everything else.
        ranges: Seeds of the sweep of radio ranges, on unicycle bodies.
        sweep: Seeds of the other sweeps on them, and of followers with cameras.
    """
    return (
        Grid(**JOIN, seeds=join),
        Grid(**JOIN, growth=GROWTH, seeds=few),
        Grid(**JOIN, radius=20.0, seeds=few),
        Grid(**JOIN, gain="stiff", seeds=few),
        Grid(**STAY, factor=FACTORS, seeds=few),
        Grid(**STAY, spacing="literal", seeds=few),
        Grid(**STAY, growth=GROWTH, seeds=few),
        Grid(**STAY, estimated=True, seeds=few),
        Grid(**STAY, estimated=True, growth=GROWTH, seeds=few),
        Grid(
            task="stay", start="even", failure=("removed", "added"), estimated=True,
            robots=5, duration=LATER, seeds=few,
        ),
        Grid(
            task="stay", start="even", failure="added", robots=6, factor=SIXTH, duration=LATER,
            seeds=few,
        ),
        Grid(**JOIN, failure=("camera", "radio", "lie"), seeds=few),
        Grid(task="stay", start="bunch", sensing="camera", duration=120.0, seeds=few),
        Grid(task="stay", start="bunch", sensing="both", duration=60.0, seeds=1),
        Grid(task="stay", start="bunch", wrong=0.2, duration=200.0, seeds=few),
        Grid(task="stay", start="bunch", radius=15.0, growth=-GROWTH, duration=300.0, seeds=few),
        Grid(**JOIN, edge="lobes", seeds=few),
        Grid(task="formation", path=(*PATHS, "eight-smooth"), seeds=few),
        Grid(task="formation", path=PATHS, heard="plain", seeds=few),
        Grid(task="envelope", seeds=few),
        Grid(**JOIN, mode="unicycle", d_com=RANGES, seeds=ranges),
        Grid(**STAY, mode="unicycle", factor=SWEEP, seeds=sweep),
        Grid(**{**STAY, "duration": LONG}, mode="unicycle", robots=(2, *COUNTS), seeds=sweep),
        Grid(task="formation", path=MIDDLE, seeds=few),
        Grid(task="formation", path=SEEN, heard="nothing", seeds=sweep),
        Grid(task="formation", path=MIDDLE[0], heard="plain", seeds=few),
        Grid(**JOIN, obstacles="sonars", localization=("localizer", "odometry"), seeds=few),
        Grid(**JOIN, localization=("odometry", "odometry-compass"), seeds=few),
        Grid(**STAY, obstacles="sonars", localization=("localizer", "odometry"), seeds=few),
        Grid(**STAY, localization="odometry", seeds=few),
        Grid(
            task="stay", start="scattered", obstacles="sonars",
            localization=("localizer", "odometry"), seeds=few,
        ),
        Grid(task="stay", start="scattered", localization="odometry", seeds=few),
    )  # fmt: skip


QUICK = Size(
    "quick",
    grids=(
        Grid(task="stay", start="bunch", mode="unicycle", duration=30.0, seeds=1),
        Grid(task="stay", start="bunch", duration=30.0, seeds=1),
        Grid(task="formation", path="circle", duration=45.0, seeds=1),
        Grid(task="envelope", seeds=1),
    ),
    default_seeds=1,
    expected_minutes=0.3,
    note="half a minute of tracking, a circle of three, one truck's limits; decides few claims",
)
STANDARD = Size("standard", grids=grids(20, 5, 8, 3), default_seeds=5, expected_minutes=40.0)
FULL = Size(
    "full",
    grids=(
        *grids(60, 10, 20, 10),
        Grid(**STAY, mode="unicycle", robots=(2, 3, 4, 6, 7, 8), seeds=5),
    ),
    default_seeds=10,
    expected_minutes=100.0,
)
