"""Proving ground: every platform and sensor against its data sheet.

The declaration; cheap to import. What a platform is asked to do, and what decides it, is in the
module named after it; the sizes are in sizes.py.
"""

from pathlib import Path

from experiments.proving_ground.sizes import FULL, QUICK, STANDARD
from mjmr.conditions import Parameter
from mjmr.study import Study

_HERE = "experiments.proving_ground"

# fmt: off
TESTS = (
    "straight", "turn", "circle", "stop", "crowd", "odometry", "odometry-even", "square",
    "unicycle", "unicycle-open", "roll-over", "roll-over-steps", "walk", "get-up", "kick", "roll",
    "move", "pendulum", "tension", "dash", "lidar", "lidar-noise", "sonar", "sonar-thin", "camera",
    "camera-in-view", "schedule", "noise", "push", "aim",
)
VARIANTS = (
    "plain", "forward", "reverse", "changing", "left", "right", "front", "back", "slow", "backward",
    "turn-left", "turn-right", "lab-curve", "lab-tendon", "field-curve", "field-tendon", "planar",
    "omni",
)
# fmt: on
study = Study(
    name="proving-ground",
    title="Every platform and sensor against its data sheet",
    paper=(
        "data sheets and published measurements of the robots; each number's source is in the "
        "README beside its model (assets/)"
    ),
    summary=(
        "What every study stands on: the Pioneer 2-DX, the Koala, the AIBO ERS-7, the TXT-1 truck "
        "and NIMS drive, walk, turn, fall, kick and travel in contact physics, under commands "
        "alone, at more than one timestep and friction, and are measured against what they were "
        "asked for. The sensors are measured against geometry."
    ),
    parameters=(
        Parameter(
            "platform",
            "who is tested; sensors: what robots perceive with",
            "pioneer2dx",
            (
                "pioneer2dx",
                "koala",
                "aibo_ers7",
                "tamiya_txt1",
                "nims",
                "round_pusher",
                "soccer_bot",
                "tj_pro",
                "four_wheeler",
                "sensors",
            ),
        ),
        Parameter(
            "test",
            "which manoeuvre or measurement; each platform has its own, see its module",
            "straight",
            TESTS,
        ),
        Parameter("variant", "which kind of it, where a test has kinds", "plain", VARIANTS),
        Parameter("speed", "asked for", 0.0, unit="m/s"),
        Parameter("turn", "yaw rate asked for", 0.0, unit="rad/s"),
        Parameter("angle_deg", "steering angle asked for", 0.0, unit="deg"),
        Parameter(
            "friction",
            "of what touches the floor; 0: as in the platform's README",
            0.0,
            least=0.0,
        ),
        Parameter("dt_ms", "largest physics timestep", 5.0, unit="ms", least=0.1),
    ),
    sizes=(QUICK, STANDARD, FULL),
    trial=f"{_HERE}.trial:trial",
    claims=f"{_HERE}.claims:claims",
    film=f"{_HERE}.film:film",
    plots=f"{_HERE}.plots:plots",
    world=f"{_HERE}.film:world",
    bench=f"{_HERE}.bench:bench",
    prepare=f"{_HERE}.trial:prepare",
    verdicts=Path(__file__).with_name("verdicts.json"),
    figures=Path(__file__).with_name("figures.json"),
)
