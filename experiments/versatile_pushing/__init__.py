"""Versatile pushing: Cherry and Zhang's one pusher for foraging, transport and construction.

The declaration; cheap to import. Worlds are in worlds.py, one trial of a task reads top to bottom
in tasks.py, what is claimed and what decides it is in claims.py.
"""

from pathlib import Path

from experiments.versatile_pushing.sizes import FULL, QUICK, STANDARD
from mjmr.conditions import Parameter
from mjmr.study import Study

_HERE = "experiments.versatile_pushing"

study = Study(
    name="versatile-pushing",
    title="Toward versatility of multi-robot systems",
    paper=(
        "C. Cherry and H. Zhang, Toward Versatility of Multi-Robot Systems, in Multi-Robot "
        "Systems: From Swarms to Intelligent Automata, vol. III, Springer, 2005"
    ),
    summary=(
        "Round robots with a turret camera push discs that slide on the floor: ten into a home "
        "zone, thirty out to a ring, one too heavy for a robot alone to its goal. One state "
        "machine over motor schemas does all three; cooperation c, position p and the build flag "
        "b are all that differs. Weight is floor friction, so that w + 1 robots move weight w and "
        "w do not. Vision is by rays or by rendered pictures and colour blobs."
    ),
    parameters=(
        Parameter(
            "task",
            "foraging, transport, construction: the paper's; vision: rays and pictures compared "
            "at the same poses, a third of the duration in each world; stall, held, moved, "
            "moved-from-rest, wedged, wedged-anywhere: checks of pushing itself",
            "foraging",
            (
                "foraging",
                "transport",
                "construction",
                "vision",
                "stall",
                "held",
                "moved",
                "moved-from-rest",
                "wedged",
                "wedged-anywhere",
            ),
        ),
        Parameter("c", "cooperation, 0 to 1", 0.0, least=0.0, most=1.0),
        Parameter("p", "position: lateral offset allowed, in robot radii", 1.0, least=0.0),
        Parameter("b", "build flag: home's polarity is reversed", False),
        Parameter("weight", "w of the large disc: w + 1 robots can move it", 0, (0, 1, 2)),
        Parameter("robots", "how many", 4, (1, 2, 3, 4)),
        Parameter("map", "number of the small discs' places", 0, least=0),
        Parameter(
            "failure",
            "stopped: robot 0 stops dead after 4 s; camera: no camera delivers anything from 4 to "
            "9 s",
            "none",
            ("none", "stopped", "camera"),
        ),
        Parameter(
            "vision",
            "arcs: rays with the camera's field, range and occlusion; camera: rendered pictures "
            "of the turret's camera, 160 x 120 at 10 Hz, and the colours in them",
            "arcs",
            ("arcs", "camera"),
        ),
        Parameter(
            "recovery",
            "whether a robot whose target stays where it is changes its own p (ours)",
            False,
        ),
        Parameter("heading_deg", "direction of the push (held, moved)", 0.0, unit="deg"),
        Parameter("off_normal_deg", "of a push off the normal (wedged)", 0.0, unit="deg"),
        Parameter(
            "dt_ms", "largest physics timestep; it divides 0.1 s", 10.0, unit="ms", least=0.1
        ),
        Parameter("duration", "of a run at most, simulated", 2620.0, unit="s", least=0.1),
    ),
    sizes=(QUICK, STANDARD, FULL),
    trial=f"{_HERE}.trial:trial",
    claims=f"{_HERE}.claims:claims",
    film=f"{_HERE}.film:film",
    plots=f"{_HERE}.plots:plots",
    world=f"{_HERE}.trial:world",
    bench=f"{_HERE}.bench:bench",
    prepare=f"{_HERE}.trial:prepare",
    verdicts=Path(__file__).with_name("verdicts.json"),
)
