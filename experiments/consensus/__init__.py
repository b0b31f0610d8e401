"""Consensus: chains of first-order lags agree over graphs that change. The declaration."""

from pathlib import Path

from experiments.consensus.sizes import FULL, QUICK, STANDARD
from mjmr.conditions import Parameter
from mjmr.parts import Method, Part
from mjmr.study import Study

_HERE = "experiments.consensus"

study = Study(
    name="consensus",
    title="Three robots agree over graphs that change and are never strongly connected",
    paper=(
        "Z. Qu, J. Wang, R. A. Hull, Multi-Objective Cooperative Control of Dynamical Systems, "
        "about 2005"
    ),
    summary=(
        "Systems of any relative degree under row-stochastic gains reach one value a channel if "
        "their graphs meet a structure condition again and again. The theory in the linear model, "
        "advanced exactly; then four-wheel skid-steered robots in MuJoCo whose hand points agree "
        "on a formation, by a radio with loss and delay, by cameras in a limited cone, or by rays "
        "in their place; and up to a hundred of them in one hall."
    ),
    parameters=(
        Parameter("mode", "linear: the model; physical: MuJoCo", "linear", ("linear", "physical")),
        Parameter(
            "experiment",
            "what is run",
            "three",
            (
                "three",
                "graph",
                "agreement",
                "moving",
                "average",
                "example-4.1",
                "random-sequence",
                "mixed-channels",
                "lemmas",
            ),
        ),
        Parameter(
            "schedule",
            "who leads when",
            "alternate",
            (
                "alternate",
                "case-i",
                "case-ii",
                "star",
                "joint",
                "isolated",
                "decaying",
                "random-leader",
            ),
        ),
        Parameter("dwell", "between changes of the graph", 5.0, unit="s", least=0.1),
        Parameter("duration", "of a run, at most", 300.0, unit="s", least=0.1),
        Parameter("weight", "of those heard, in all", 0.2, least=0.0, most=1.0),
        Parameter(
            "weight_y", "the same for the second channel; 0: alike", 0.0, least=0.0, most=1.0
        ),
        Parameter("degrees", "relative degree of all, or of each: '1 2 3'", "2"),
        Parameter("degree", "of Example 4.1", 2, least=1),
        Parameter("anyway", "run graphs that never meet the structure condition", False),
        Parameter(
            "side",
            "of the robots' triangle; 0, the paper's one point, needs robots that are virtual",
            2.0,
            unit="m",
            least=0.0,
        ),
        Parameter("virtual", "robots pass through each other", False),
        Parameter(
            "places",
            "crossed: robots 1 and 2 have to pass each other",
            "outward",
            ("outward", "crossed"),
        ),
        Parameter("noise", "deviation of told positions", 0.0, unit="m", least=0.0),
        Parameter("loss", "share of messages", 0.0, least=0.0, most=1.0),
        Parameter("delay", "of messages", 0.0, unit="s", least=0.0),
        Parameter("fault", "at 10 s", "none", ("none", "follower-dies", "leader-freezes")),
        Parameter("calibrated", "servos reckon with the scrub of the tyres", True),
        Parameter(
            "sight",
            "where the graph comes from: given, told by radio; cameras; rays in their place",
            "given",
            ("given", "camera", "rays"),
        ),
        Parameter("cone_deg", "of sight", 90.0, unit="deg", least=1.0, most=170.0),
        Parameter("heading", "at the start", "random", ("random", "centroid")),
        Parameter("scan", "who sees nobody turns", False),
        Parameter("avoid", "barrier: a safety filter over the hands", "none", ("none", "barrier")),
        Parameter(
            "path",
            "of experiment moving: the leader's along a line or a circle; or the formation turns "
            "(rotate) or swings 30 % about its size (scale) round a leader's output that stands",
            "line",
            ("line", "circle", "rotate", "scale"),
        ),
        Parameter("speed", "of the leader, on line and circle", 0.2, unit="m/s", least=0.0),
        Parameter(
            "turn_rate", "of circle, rotate and scale", 0.1, unit="rad/s", least=0.01, most=1.0
        ),
        Parameter(
            "feedforward",
            "told: robots pass on what velocity and acceleration the formation has",
            "none",
            ("none", "told"),
        ),
        Parameter(
            "rule",
            "of experiment average: Metropolis weights of those heard, or ratio consensus with "
            "running sums",
            "metropolis",
            ("metropolis", "ratio"),
        ),
        Parameter("patrol", "of experiment average: robots go round their lanes", True),
        Parameter("reach", "of the radio, in experiment average", 2.8, unit="m", least=0.0),
        Parameter("robots", "of experiments graph and average", 10, least=2),
        Parameter(
            "graph",
            "of experiment graph",
            "ring",
            ("ring", "path", "star", "complete", "geometric"),
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
            role="gains",
            doc="weights each robot gives to whom it hears or sees, and to itself",
            default="controllers.consensus:NeighbourGains",
            constructor=("n",),
            methods=(
                Method(
                    name="step",
                    arguments=("heard", "weight"),
                    returns=("n", "n"),
                    unit="rows 0 or more that sum to one, 0 where nobody is heard",
                    doc="for every graph of a schedule and every look: heard (n, n) bool, row "
                    "hears column and itself, and the condition's weight; experiment graph has "
                    "controllers.consensus:EqualGains unless another takes the role, and "
                    "experiment average has weights of its own, those of rule",
                    check="experiments.consensus.roles:refuse_gains",
                ),
            ),
        ),
        Part(
            role="law",
            doc="accelerations of the hand points, in mode physical",
            default="controllers.consensus:RelativeForm",
            constructor=("n",),
            methods=(
                Method(
                    name="step",
                    arguments=("velocity", "relative", "gains"),
                    returns=("n", 2),
                    unit="m/s^2, axes of the argument",
                    doc="50 times a second; own velocities (n, 2) [m/s], outputs from robot row "
                    "to robot column (n, n, 2) [m], NaN where nothing is known, and gains (n, n)",
                ),
            ),
        ),
    ),
    verdicts=Path(__file__).with_name("verdicts.json"),
)
