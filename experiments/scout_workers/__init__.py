"""Scout and workers: one vector is all they share. The declaration; cheap to import."""

from pathlib import Path

from experiments.scout_workers.sizes import FULL, QUICK, STANDARD
from mjmr.conditions import Parameter
from mjmr.study import Study

_HERE = "experiments.scout_workers"
MAZES = ("m1", "m2", "m3", "m4", "f1", "f2", "f3", "corridor")

study = Study(
    name="scout-workers",
    title="A scout's one vector leads its workers to the goal",
    paper=(
        "W. MacKunis, D. Raviv, A Simplistic Approach to Reactive Multi-Robot Navigation in "
        "Unknown Environments, ASEE Annual Conference, 2003"
    ),
    summary=(
        "A scout wanders from a nest, adds up compass headings to one direction and displacement "
        "and sends these in four bytes over a one-way radio when it sees the goal; workers drive "
        "by them with two infrared detectors and a bumper, without a map. In MuJoCo with TJ Pro "
        "robots, and on a plane with discs (named so) where many runs are asked for. The radio is "
        "a byte stream with its own clocks and errors."
    ),
    parameters=(
        Parameter(
            "mode",
            "planar: discs that are blocked and slide; physical: MuJoCo; radio: bytes alone",
            "planar",
            ("planar", "physical", "radio"),
        ),
        Parameter(
            "experiment",
            "what is run",
            "maze",
            ("maze", "succession", "scaling", "open", "trap", "phase", "errors", "codes"),
        ),
        Parameter("maze", "m1 to m4 settings were chosen on, f1 to f3 are fresh", "m3", MAZES),
        Parameter("robots", "scout and workers, one or more", 2, least=2),
        Parameter("margin_deg", "heading error a worker tolerates", 35.0, unit="deg"),
        Parameter("avoid_deg", "a step of a turn away", 20.0, unit="deg"),
        Parameter(
            "forced",
            "units forward after a turn away before the heading is compared; 0: in every loop",
            1,
            least=0,
        ),
        Parameter(
            "compass",
            "card: noise 2 deg, drift, bias by place up to 5 deg; white: noise alone; exact",
            "card",
            ("card", "white", "exact"),
        ),
        Parameter("compass_deg", "readings are multiples of it", 2.0, unit="deg", least=0.0),
        Parameter("servo_pct", "servos are up to this much fast or slow", 5.0, unit="%", least=0.0),
        Parameter("bit_error", "share of bits read wrong", 0.0, least=0.0),
        Parameter("byte_error", "share of bytes read as another one", 0.0, least=0.0),
        Parameter("check", "of a message", "crc8", ("crc8", "crc8-one-seed", "two-bit")),
        Parameter("vector", "whose the workers' is", "scout", ("scout", "exact")),
        Parameter(
            "succession",
            "what finishers tell: nothing, mean vector, via-points of shorter paths, both",
            "none",
            ("none", "average", "via", "both"),
        ),
        Parameter(
            "finish",
            "who saw the goal is picked up, stays, or drives home; search: so do scouts",
            "search",
            ("search", "remove", "park", "home"),
        ),
        Parameter("release", "from one worker to the next", 5.0, unit="s", least=0.0),
        Parameter(
            "failure",
            "what goes wrong on purpose",
            "none",
            ("none", "ir-dead", "scout-killed", "bad-checksum", "worker-dead"),
        ),
        Parameter("depth", "of the trap's lips", 0.0, unit="m", least=0.0),
        Parameter("spacing_ms", "from one read to the next", 5.0, unit="ms", least=0.001),
        Parameter("pause_ms", "from a group's last read to the next", 20.0, unit="ms", least=0.001),
        Parameter("jitter_ms", "deviation of every such interval", 0.0, unit="ms", least=0.0),
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
)
