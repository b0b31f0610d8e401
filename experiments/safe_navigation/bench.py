"""Speed of the study: plan and search, both modes, one worker against two."""

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from experiments.safe_navigation.sizes import OMNI, VISION
from experiments.safe_navigation.trial import prepare
from experiments.safe_navigation.vision import HEIGHT, WIDTH, vision_accuracy
from mjmr.bench import conditions, interleave, spread


def bench() -> str:
    """Measure; returns the table."""
    from experiments.safe_navigation import study

    prepare()
    return "\n".join(
        [conditions(), *_planning(study), *_real_time(study), *_vision(), *_workers(study)]
    )


def _planning(study: Any) -> list[str]:
    trial = study.bound_trial()
    figures: dict[str, list[float]] = {"mean": [], "p95": []}

    def job(search: bool) -> Callable[[], float]:
        condition = study.condition(scene="A", search=search, duration=10.0)

        def run() -> float:
            metrics = trial(condition, 0)
            if search:
                figures["mean"].append(metrics["wall_step_mean_us"])
                figures["p95"].append(metrics["wall_step_p95_us"])
            return metrics["wall_step_mean_us"]

        return run

    rounds = interleave({"on": job(True), "off": job(False)}, rounds=21)
    added = 100 * (rounds["on"] / rounds["off"] - 1)
    mean, p95 = np.array(figures["mean"][1:]), np.array(figures["p95"][1:])
    return [
        "plan and search, scene A, four robots, 10 s, one core, median [lowest, highest]:",
        f"  per robot and cycle: mean {spread(mean / 1000)} ms, 95th percentile "
        f"{spread(p95 / 1000)} ms (paper: 0.76 and 2.04 ms a cycle, on the hardware of 2005)",
        f"  added by the search: {spread(added)} % (paper: 9 %)",
    ]


def _real_time(study: Any) -> list[str]:
    trial = study.bound_trial()
    cases = {
        "metric, A": {"scene": "A"},
        "metric, cross4": {"scene": "cross4"},
        "metric, cross10": {"scene": "cross10"},
        "physical, A": {"mode": "physical", "scene": "A", "margin_mm": 1.0},
        "physical, cross4": {"mode": "physical", "scene": "cross4", "margin_mm": 1.0},
        "physical, cross10": {"mode": "physical", "scene": "cross10", "margin_mm": 1.0},
        "omni-wheels, A": {"mode": "physical", "scene": "A", **OMNI},
        "omni-wheels, cross4": {"mode": "physical", "scene": "cross4", **OMNI},
        "vision, cross4": {"mode": "physical", "scene": "cross4", "sensing": "vision", **VISION},
    }

    def job(values: dict[str, Any]) -> Callable[[], float]:
        condition = study.condition(**values, duration=10.0)

        def run() -> float:
            start = time.perf_counter()
            trial(condition, 0)
            return 10.0 / (time.perf_counter() - start)

        return run

    rounds = interleave({name: job(values) for name, values in cases.items()})
    lines = ["simulated s per wall s, all included, one core, median [lowest, highest]:"]
    return lines + [f"  {name:19s} {spread(figure)}" for name, figure in rounds.items()]


def _vision() -> list[str]:
    figures: dict[str, list[float]] = {"render": [], "find": []}

    def job() -> float:
        metrics = vision_accuracy(40, 0)
        for name, values in figures.items():
            values.append(float(metrics[f"wall_{name}_ms"]))
        return 0.0

    interleave({"images": job})
    render, find = (np.array(v[1:]) for v in figures.values())
    return [
        f"overhead vision, ten robots, {WIDTH} x {HEIGHT}, one core, median [lowest, highest]:",
        f"  render with noise {spread(render)} ms, find {spread(find)} ms: "
        f"{spread(1000 / (render + find))} images a second",
    ]


def _workers(study: Any) -> list[str]:
    from mjmr.executor import LocalExecutor
    from mjmr.parts import Job

    trials = [(study.condition(scene="A", duration=20.0), seed) for seed in range(40)]

    def job(workers: int) -> Callable[[], float]:
        def run() -> float:
            done = []
            for _ in LocalExecutor(workers).run(Job(study.name), trials):
                done.append(time.perf_counter())
            # from the first result on, so that starting processes does not count
            skip = 2 * workers
            return (len(done) - skip) / (done[-1] - done[skip - 1])

        return run

    rounds = interleave({"one": job(1), "two": job(2)}, rounds=3)
    ratio = rounds["two"] / rounds["one"]
    return [f"trials a second, two workers / one: {spread(ratio)}"]
