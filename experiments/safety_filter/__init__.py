"""Safety filter: a barrier beside the velocity-space search, on wheels and on the soccer field.

The declaration; cheap to import. Swaps on wheels are in swap.py, the soccer field is
safe-navigation's own; one trial reads top to bottom in trial.py, what is claimed and what decides
it is in claims.py.
"""

from pathlib import Path

from experiments.safety_filter.sizes import FULL, QUICK, STANDARD
from mjmr.conditions import Parameter
from mjmr.parts import Method, Part
from mjmr.study import Study

_HERE = "experiments.safety_filter"

study = Study(
    name="safety-filter",
    title="A control-barrier filter over a team's velocities",
    paper=(
        "Z. Qu, J. Wang and R. A. Hull, Multi-Objective Cooperative Control of Dynamical Systems, "
        "~2005 (the control that is filtered); L. Wang, A. D. Ames and M. Egerstedt, Safety "
        "barrier certificates for collisions-free multirobot systems, IEEE T-RO 33(3), 2017 (the "
        "filter)"
    ),
    summary=(
        "One quadratic program over the team, set up once and warm-started, moves wished "
        "velocities as little as keeps everybody apart. Ten skid-steer robots swap places across "
        "a circle under hand-point control, with the filter, with the velocity-space search of "
        "safe-navigation, with neither, and under plain consensus; and safe-navigation's own "
        "scenes are run with either kind of safety. MuJoCo bodies throughout; poses are an "
        "overhead camera's reports."
    ),
    parameters=(
        Parameter(
            "scene",
            "swap: places opposite on a circle, starts displaced by the seed; symmetric: the same, "
            "exactly on the circle, whatever the seed; A, cross4, cross10: safe-navigation's",
            "swap",
            ("swap", "symmetric", "A", "cross4", "cross10"),
        ),
        Parameter(
            "method",
            "none: straight to the goal (in A, cross4 and cross10 safe-navigation's planner and "
            "motion control); consensus: plain consensus, the goals its formation; barrier and "
            "search: as none, through the barrier or the velocity-space search",
            "barrier",
            ("none", "consensus", "barrier", "search"),
        ),
        Parameter(
            "right",
            "whether wishes are turned 0.45 rad right while somebody is nearer ahead than 2.5 "
            "times the distance kept (ours)",
            True,
        ),
        Parameter("robots", "how many swap", 10, least=2),
        Parameter(
            "margin_mm",
            "kept around every disc, so that two are twice this further apart",
            25.0,
            unit="mm",
            least=0.0,
        ),
        Parameter(
            "pace",
            "the barrier's gamma, in units of deceleration / top speed: at 1 a gap is used up no "
            "faster than bodies can brake from top speed",
            1.0,
            least=0.01,
        ),
        Parameter(
            "sigma_mm", "deviation of reported positions along x and y", 0.0, unit="mm", least=0.0
        ),
        Parameter(
            "duration", "of a run, simulated; swaps end when all are home", 60.0, unit="s",
            least=0.05,
        ),
    ),
    sizes=(QUICK, STANDARD, FULL),
    trial=f"{_HERE}.trial:trial",
    claims=f"{_HERE}.claims:claims",
    film=f"{_HERE}.film:film",
    plots=f"{_HERE}.plots:plots",
    world=f"{_HERE}.trial:world",
    bench=f"{_HERE}.bench:bench",
    prepare=f"{_HERE}.trial:prepare",
    parts=(
        Part(
            role="filter",
            doc="safe velocities from positions, velocities and wishes; takes method barrier",
            default="controllers.safety:Barrier",
            constructor=("bounds", "boxes", "n", "config", "rng"),
            methods=(
                Method(
                    name="step",
                    arguments=("position", "velocity", "wish", "active"),
                    returns=("n", 2),
                    unit="m/s, world frame",
                    doc="every cycle; position, velocity and wish (n, 2) [m, m/s, m/s], world "
                    "frame, and active (n,) bool, who obeys",
                ),
            ),
            optional=("infeasible: calls without a solution so far; 0 if absent",),
        ),
    ),
    verdicts=Path(__file__).with_name("verdicts.json"),
)  # fmt: skip
