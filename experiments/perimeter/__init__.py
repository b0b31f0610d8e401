"""Perimeter: Fierro et al.'s trucks that find, surround and follow the edge of a spill.

The declaration; cheap to import. The hall is in worlds.py, the paper's loop reads top to bottom in
trial.py, what is claimed and what decides it is in claims.py.
"""

from pathlib import Path

from experiments.perimeter.sizes import FULL, QUICK, STANDARD
from mjmr.conditions import Parameter
from mjmr.study import Study

_HERE = "experiments.perimeter"

study = Study(
    name="perimeter",
    title="A multi-robot testbed for biologically-inspired cooperative control",
    paper=(
        "R. Fierro, J. Clark, D. Hougen and S. Commuri, A Multi-Robot Testbed for Biologically-"
        "Inspired Cooperative Control, in Multi-Robot Systems: From Swarms to Intelligent "
        "Automata, vol. III, Springer, 2005"
    ),
    summary=(
        "Five TXT-1 trucks search a hall of 100 x 100 m by spirals for a red spill, tell each "
        "other by a radio of 25 m that relays, approach, and track its edge by a camera that "
        "looks down to the left; spacing spreads them. Every sensor is on the truck's message bus, "
        "and can be unplugged. With the literal and the repaired spacing rule, static and growing "
        "spills, failures, and a leader with two followers."
    ),
    parameters=(
        Parameter(
            "task",
            "join: until 90 s after the last truck tracks, at most the duration; stay: the whole "
            "duration; formation: a leader and two followers; envelope: what a truck can do",
            "join",
            ("join", "stay", "formation", "envelope"),
        ),
        Parameter(
            "mode",
            "physical: trucks in MuJoCo; unicycle: planar kinematic bodies without contact, for "
            "sweeps",
            "physical",
            ("physical", "unicycle"),
        ),
        Parameter(
            "sensing",
            "of the look-ahead point. rays: one ray a truck at 10 Hz; camera: rendered pictures of "
            "160 x 120 at 5 Hz and a red mask; both: by rays, at 5 Hz, pictures compared with them",
            "rays",
            ("rays", "camera", "both"),
        ),
        Parameter("robots", "how many", 5, least=1),
        Parameter("radius", "of the spill at time 0", 10.0, unit="m", least=0.6),
        Parameter("growth", "of its radius", 0.0, unit="m/s"),
        Parameter("edge", "disc, or three discs that overlap", "disc", ("disc", "lobes")),
        Parameter("d_com", "range of the radio", 25.0, unit="m", least=0.0),
        Parameter("spacing", "rule of equation 8", "repaired", ("repaired", "literal")),
        Parameter("factor", "d_des in even chords; 0: 1 - .05 / (robots - 1)", 0.0, least=0.0),
        Parameter(
            "estimated",
            "whether d_des is estimated on line from who tracks and the circle tracked, not given",
            False,
        ),
        Parameter("gain", "of the approach: 0.3 / 2 pi or 0.3", "soft", ("soft", "stiff")),
        Parameter(
            "start",
            "scattered over the hall; on the perimeter, in a bunch or evenly",
            "scattered",
            ("scattered", "bunch", "even"),
        ),
        Parameter(
            "failure",
            "camera: of the first that tracks for 10 s, unplugged for 20 s; radio: all off; lie: "
            "robot 0 is told a false location; removed: robot 0, after 60 s; added: the last "
            "robot, after 60 s",
            "none",
            ("none", "camera", "radio", "lie", "removed", "added"),
        ),
        Parameter("wrong", "share of wrong readings of the ray", 0.0, least=0.0, most=1.0),
        Parameter(
            "path",
            "of the leader (formation); circle and eight begin at once, as does the eight's change "
            "of side, and runs into a wall; eight-smooth: curvature without jumps; -middle: where "
            "no wall is in the way",
            "straight",
            ("straight", "circle", "eight", "eight-smooth", "eight-middle", "eight-smooth-middle"),
        ),
        Parameter(
            "heard",
            "of the leader (formation), a tick old: moved on by the speeds told with it, or plain; "
            "nothing: followers see two poles on the leader with a camera, by which they estimate "
            "its speeds",
            "extrapolated",
            ("extrapolated", "plain", "nothing"),
        ),
        Parameter(
            "dt_ms", "largest physics timestep; it divides 0.1 s", 10.0, unit="ms", least=0.1
        ),
        Parameter("duration", "of a run at most, simulated", 900.0, unit="s", least=1.0),
    ),
    sizes=(QUICK, STANDARD, FULL),
    trial=f"{_HERE}.trial:trial",
    claims=f"{_HERE}.claims:claims",
    film=f"{_HERE}.film:film",
    plots=f"{_HERE}.plots:plots",
    world=f"{_HERE}.worlds:world",
    bench=f"{_HERE}.bench:bench",
    prepare=f"{_HERE}.trial:prepare",
    verdicts=Path(__file__).with_name("verdicts.json"),
)
