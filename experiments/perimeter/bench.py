"""Speed of the study: closed loops with rays and with rendered pictures, controllers included."""

import time
from collections.abc import Callable
from typing import Any

import mujoco

from experiments.perimeter.sensing import mount
from experiments.perimeter.trial import prepare, trial
from experiments.perimeter.worlds import build
from mjmr.bench import conditions, interleave, spread
from mjmr.errors import MissingGLError
from mjmr.render import Renderer
from mjmr.simulation import Simulation
from mjmr.study import Study

_BUNCH = {"task": "stay", "start": "bunch"}
_CASES = {
    "searching, rays": ({"task": "stay", "duration": 60.0}, 15.0),
    "on a growing edge, rays": ({**_BUNCH, "growth": 0.0125, "duration": 60.0}, 15.0),
    "on a growing edge, five cameras at 5 Hz": (
        {**_BUNCH, "growth": 0.0125, "sensing": "camera", "duration": 10.0},
        1.5,
    ),
    "searching by sonars and odometers, rays": (
        {"task": "stay", "duration": 60.0, "obstacles": "sonars", "localization": "odometry"},
        15.0,
    ),
    "two followers with cameras at 10 Hz": (
        {"task": "formation", "path": "circle", "heard": "nothing", "duration": 31.0},
        0.0,
    ),
    "unicycle bodies, rays": ({**_BUNCH, "mode": "unicycle", "duration": 60.0}, 0.0),
}
_LOOKS = {"whatever its camera sees": True, "everything there is": False}


def bench() -> str:
    """Measure; returns the table."""
    from experiments.perimeter import study

    prepare()

    def job(values: dict[str, Any]) -> Callable[[], float]:
        condition = study.condition(**values)

        def run() -> float:
            start = time.process_time()
            metrics = trial(condition, 0)
            return float(metrics["time_s"]) / (time.process_time() - start)

        return run

    rounds = interleave({name: job(values) for name, (values, _) in _CASES.items()}, rounds=5)
    lines = [
        conditions(),
        "simulated s per CPU s, five trucks (followers: three), compiling the world included, "
        "median [lowest, highest]:",
    ]
    for name, figure in rounds.items():
        least = _CASES[name][1]
        aim = f" (at least {least:g} is wanted)" if least else ""
        lines.append(f"  {name:40s} {spread(figure)}{aim}")
    return "\n".join([*lines, *pictures()])


def pictures(rounds: int = 5) -> list[str]:
    """CPU time of a picture with and without leaving out what its camera cannot see."""
    from experiments.perimeter import study

    try:
        figures = interleave({name: _look(study, on) for name, on in _LOOKS.items()}, rounds)
    except MissingGLError as e:
        return [f"pictures: {e}"]
    return [
        "CPU ms a picture of 160 x 120, five trucks on a disc, round shapes of 360 sides, median "
        "[lowest, highest]:",
        *(f"  {name:40s} {spread(figure)}" for name, figure in figures.items()),
    ]


def _look(study: Study, leaves_out: bool) -> Callable[[], float]:
    scene = build(study.condition(**_BUNCH), 0)
    mount(scene, study.condition(**_BUNCH))
    simulation = Simulation(scene.world, dt_max=0.01)
    model, data = simulation.model, simulation.data
    mujoco.mj_camlight(model, data)
    renderer = Renderer(model, 160, 120, sides=360)
    renderer.leaves_out = leaves_out
    eyes = [f"{name}/eye" for name in simulation.team.names]

    def run() -> float:
        start = time.process_time()
        for eye in eyes:
            renderer.picture(data, eye)
        return 1000.0 * (time.process_time() - start) / len(eyes)

    return run
