"""Helping navigation: teammates that lend their eyes (Sgorbissa and Arkin, c. 2003).

The declaration; cheap to import. Point robots, as the paper simulates them, make the tables; the
sizes are in sizes.py.
"""

from pathlib import Path

from experiments.helping_navigation.sizes import FULL, QUICK, STANDARD
from mjmr.conditions import Parameter
from mjmr.parts import Method, Part
from mjmr.study import Study

_HERE = "experiments.helping_navigation"

study = Study(
    name="helping-navigation",
    title="Teammates that lend their eyes to a robot with a weak planner",
    paper=(
        "A. Sgorbissa and R. C. Arkin, Local Navigation Strategies for a Team of Robots, c. 2003"
    ),
    summary=(
        "A robot visits targets in an office by a local planner (potential field, Avoid Past or "
        "VisBug-21). One to three patrolling robots tell it, in sight of each other only and "
        "without a common frame, whether they see, saw, or can relay sight of its target, and "
        "whether they are in trouble. Two readings of what is told are run side by side: literal "
        "(a length and a place) and chain (the whole list of ghosts). The tables come from point "
        "robots in polygons, which is what the paper simulates."
    ),
    parameters=(
        Parameter(
            "mode",
            "point: point robots in polygons, as in the paper; physical: Pioneers in MuJoCo",
            "point",
            ("point", "physical"),
        ),
        Parameter(
            "scene",
            "tour: targets in random rooms; trap: a dead end (figures 9 and 10); chain: standing "
            "supporters that relay sight of the target; markers: what four cameras make of the "
            "teammates' markers (mode physical)",
            "tour",
            ("tour", "trap", "chain", "markers"),
        ),
        Parameter("world", "office", "world1", ("world1", "world2", "trap")),
        Parameter(
            "planner",
            "of the explorer; shortest-path knows the map and is the yardstick",
            "avoid-past",
            ("avoid-past", "visbug", "potential-field", "shortest-path"),
        ),
        Parameter("robots", "the explorer and its supporters", 1, (1, 2, 3, 4)),
        Parameter(
            "reading",
            "of goal-sharing; literal: D and a place; chain: the list of ghosts; none: alone",
            "none",
            ("none", "literal", "chain"),
        ),
        Parameter("shares_state", "whether the explorer goes to mates when in trouble", False),
        Parameter("level", "Cr of state-sharing", 20, least=1),
        Parameter("noise", "whether mates are misperceived (section 6.1)", False),
        Parameter(
            "err_max", "largest relative error of a mate's distance", 0.0, least=0.0, most=0.99
        ),
        Parameter(
            "fault",
            "dead: a supporter neither hears nor tells; radio: a fifth of all messages is lost; "
            "lost: the supporters' frames lie anywhere, turned by any angle",
            "none",
            ("none", "dead", "radio", "lost"),
        ),
        Parameter(
            "targets", "of a trial; in the scene markers looks round of each robot", 60, least=1
        ),
    ),
    sizes=(QUICK, STANDARD, FULL),
    trial=f"{_HERE}.trial:trial",
    claims=f"{_HERE}.claims:claims",
    film=f"{_HERE}.film:film",
    plots=f"{_HERE}.plots:plots",
    world=f"{_HERE}.physical:world",
    bench=f"{_HERE}.bench:bench",
    prepare=f"{_HERE}.trial:prepare",
    verdicts=Path(__file__).with_name("verdicts.json"),
    parts=(
        Part(
            role="planner",
            doc=(
                "the local planner A of the explorer, in place of the one a condition names; it "
                "runs in Python, several times slower than the compiled ones"
            ),
            default="controllers.helping.planners:Published",
            constructor=("settings", "walls", "size"),
            methods=(
                Method(name="begin", doc="another goal"),
                Method(
                    name="pause",
                    arguments=("position",),
                    doc="a step in which it does not steer; position (2,) [m]",
                ),
                Method(
                    name="step",
                    arguments=("position", "target", "ranges"),
                    returns=(2,),
                    unit="steps, at most 1 long",
                    doc=(
                        "position and target (2,) [m], ranges (32,) [m]: free way along "
                        "controllers.helping.RAYS, up to 3 m"
                    ),
                ),
            ),
        ),
    ),
)
