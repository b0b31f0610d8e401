"""Safe navigation: Bruce and Veloso's real-time multi-robot motion planning, re-run.

The declaration; cheap to import. The scenes are in worlds.py, one trial reads top to bottom in
trial.py, what is claimed and what decides it is in claims.py.
"""

from pathlib import Path

from experiments.safe_navigation.sizes import FULL, QUICK, STANDARD
from mjmr.conditions import Parameter
from mjmr.parts import Method, Part
from mjmr.study import Study

_HERE = "experiments.safe_navigation"

study = Study(
    name="safe-navigation",
    title="Real-time multi-robot motion planning with safe dynamics",
    paper=(
        "J. Bruce and M. Veloso, Real-Time Multi-Robot Motion Planning with Safe Dynamics, in "
        "Multi-Robot Systems: From Swarms to Intelligent Automata, vol. III, Springer, 2005"
    ),
    summary=(
        "Soccer robots shuttle across an F180 field at 60 Hz under an ERRT planner that ignores "
        "dynamics, a trapezoidal motion control that ignores obstacles, and a randomized search "
        "in velocity space that makes the two safe. Mode 'metric' repeats the paper's own "
        "simulation (commands executed exactly, bodies pass through each other, interpenetration "
        "depth times time is counted); mode 'physical' drives bodies with mass through servos "
        "and contacts in MuJoCo, with an extended Kalman filter behind the camera."
    ),
    parameters=(
        Parameter("mode", "what moves the robots", "metric", ("metric", "physical")),
        Parameter(
            "scene",
            "A: three boxes, parallel lanes; cross4, cross10: no boxes, mirrored goals, a planner "
            "blind to robots; stranger10: cross10 with one robot that goes its way at 1 m/s and "
            "minds nobody; carts: three boxes that go to and fro, parallel lanes; carts-apart: "
            "the same, the boxes never nearer to each other than a robot is wide; overlap: two "
            "pairs start inside each other; straight: one robot; gallery: no run, images of ten "
            "robots at random poses, 10 for each second of duration",
            "A",
            (
                "A",
                "cross4",
                "cross10",
                "stranger10",
                "carts",
                "carts-apart",
                "overlap",
                "straight",
                "gallery",
            ),
        ),
        Parameter("search", "whether the velocity-space safety search is on", True),
        Parameter(
            "sigma_mm", "deviation of reported positions along x and y", 0.0, unit="mm", least=0.0
        ),
        Parameter("margin_mm", "added to the radius in the search", 0.0, unit="mm", least=0.0),
        Parameter(
            "failure",
            "stopped: one robot announces after a third of the time that it stops, brakes and "
            "stays; dead: the same without a word, so that the others learn it a cycle later; "
            "reports-lost: 5 % of all reports are lost; commands-lost: one robot hears nothing for "
            "a third of the time",
            "none",
            ("none", "stopped", "dead", "reports-lost", "commands-lost"),
        ),
        Parameter(
            "fail_safe",
            "whether the search also stays clear of robots that brake instead of obeying (ours)",
            False,
        ),
        Parameter(
            "motion",
            "paper: along and across the way to the target; bisection: both axes arrive together "
            "(an ablation, not in the paper)",
            "paper",
            ("paper", "bisection"),
        ),
        Parameter("latency", "cycles from a command to its execution", 0, (0, 1, 2, 3)),
        Parameter("predict", "whether the latency is compensated by predicting forward", True),
        Parameter(
            "foresee",
            "whether a stranger is expected to keep its velocity for 0.35 s; else to obey like all",
            True,
        ),
        Parameter(
            "drive",
            "planar: servos on slides, wheel contact abstract; omni: four omni-wheels, contact "
            "alone (mode physical)",
            "planar",
            ("planar", "omni"),
        ),
        Parameter(
            "limits",
            "what the navigator plans with: the paper's acceleration and braking, or those "
            "measured of this drive",
            "paper",
            ("paper", "measured"),
        ),
        Parameter(
            "sensing",
            "report: Gaussian, 60 Hz, at once; vision: rendered overhead images, 30 Hz, two "
            "cycles late (sigma_mm is then what the filter expects); late-report: Gaussian, with "
            "vision's rate and latency (both need mode physical)",
            "report",
            ("report", "late-report", "vision"),
        ),
        Parameter(
            "dt_ms", "largest physics timestep; it divides the cycle", 5.0, unit="ms", least=0.1
        ),
        Parameter("duration", "of a run, simulated", 30.0, unit="s", least=0.05),
    ),
    sizes=(QUICK, STANDARD, FULL),
    trial=f"{_HERE}.trial:trial",
    claims=f"{_HERE}.claims:claims",
    film=f"{_HERE}.film:film",
    plots=f"{_HERE}.plots:plots",
    world=f"{_HERE}.worlds:world",
    bench=f"{_HERE}.bench:bench",
    prepare=f"{_HERE}.trial:prepare",
    parts=(
        Part(
            role="navigator",
            doc="velocities of all robots from their positions, velocities and goals",
            default="controllers.motion:Navigator",
            constructor=("bounds", "boxes", "n", "config", "rng"),
            methods=(
                Method(
                    name="step",
                    arguments=("position", "velocity", "goals", "active"),
                    returns=("n", 2),
                    unit="m/s, world frame",
                    doc="every cycle; position, velocity and goals (n, 2) [m, m/s, m], world "
                    "frame, and active (n,) bool, who obeys",
                ),
                Method(
                    name="see_boxes",
                    arguments=("boxes", "velocity"),
                    optional=True,
                    doc="before a step, in scenes with carts: boxes (k, 5) as they are now and "
                    "their velocities (k, 2) [m/s]",
                ),
            ),
            optional=(
                "waypoints (n, 2) [m], world frame: drawn in films; the goals if there are none",
                "sampled (n,) bool: robots whose wish was overruled; none if absent",
            ),
        ),
    ),
    verdicts=Path(__file__).with_name("verdicts.json"),
)
