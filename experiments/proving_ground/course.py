"""What all tests share: drive a course, keep what really happened, and the forms of claims."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mjmr.claims import Bound, Claim, Evidence, Table
from mjmr.group import Group
from mjmr.simulation import Simulation
from mjmr.world import World

Array = NDArray[np.float64]
Metrics = dict[str, float | int | bool]
Test = Callable[[Mapping[str, Any], int], Metrics]
ALL = ("quick", "standard", "full")
LARGE = ("standard", "full")


@dataclass(frozen=True)
class Log:
    """What happened, at the control instants.

    Attributes:
        times: (k,) [s].
        poses: (k, n, 3) [m, m, rad], world frame.
        twists: (k, n, 3) [m/s, m/s, rad/s], body frame.
        tilt: Largest angle of a base's z axis to the vertical at any physics step [rad].
    """

    times: Array
    poses: Array
    twists: Array
    tilt: float

    @property
    def yaw(self) -> Array:
        """Headings without jumps (k, n) [rad]."""
        return np.unwrap(self.poses[:, :, 2], axis=0)


class Course:
    """A simulation whose truth is kept while it is driven.

    Attributes:
        simulation: The simulation.
        group: Whose truth is kept.
    """

    def __init__(self, simulation: Simulation, group: Group):
        """Start to keep what ``group`` does."""
        self.simulation, self.group = simulation, group
        self._seen: list[tuple[float, Array, Array]] = []
        model, data = simulation.model, simulation.data
        bases = [model.jnt_bodyid[model.body(f"{p}base").jntadr[0]] for p in group.prefixes]
        self._tilt = 1.0

        def upright() -> None:
            self._tilt = min(self._tilt, float(data.xmat[bases, 8].min()))

        simulation.watch_steps(upright)
        simulation.observe(self._see)

    def _see(self) -> None:
        truth = self.simulation.truth
        self._seen.append((self.simulation.time, truth.poses(self.group), truth.twists(self.group)))

    def drive(self, commands: Array) -> "Course":
        """Give a command (c,), or one a robot (n, c), each tick: ``commands`` has a row a tick."""
        simulation, group = self.simulation, self.group
        ticks = simulation.ticks(len(commands) * simulation.control_period)
        shape = group.command.shape
        for command, _ in zip(commands, ticks, strict=True):
            group.drive(np.broadcast_to(command, shape))
        return self

    @property
    def log(self) -> Log:
        """What happened so far."""
        times, poses, twists = zip(*self._seen, strict=True)
        return Log(np.array(times), np.array(poses), np.array(twists), math.acos(self._tilt))


def profile(command: Sequence[float], periods: int, ramp: int = 5, rest: int = 6) -> Array:
    """Commands (k, c) that go up in equal steps, hold, come down: the area is ``periods`` full."""
    share = np.arange(1, ramp + 1) / ramp
    whole = np.concatenate([share, np.ones(periods - ramp), share[::-1][1:], np.zeros(rest)])
    return whole[:, None] * np.asarray(command)


def hall(half: float = 8.0, **options: Any) -> World:
    """An empty square hall whose walls are ``2 half`` [m] apart."""
    return World(bounds=[-half, -half, half, half], wall_height=0.5, floor="concrete", **options)


def largest(metric: str) -> Callable[[Table], Evidence]:
    """The largest value of a metric over all trials."""

    def evaluate(table: Table) -> Evidence:
        values = table.values(metric)
        return Evidence(float(values.max()), n=len(values))

    return evaluate


def every(metric: str) -> Callable[[Table], Evidence]:
    """The middle of a metric's range over all trials; the whole range must satisfy the bound."""

    def evaluate(table: Table) -> Evidence:
        values = table.values(metric)
        low, high = float(values.min()), float(values.max())
        return Evidence(float(np.median(values)), (low, high), len(values), why="range of trials")

    return evaluate


def apart(
    metric: str, parameter: str, relative: bool = False, absolute: bool = False
) -> Callable[[Table], Evidence]:
    """How far a metric's means at the values of a parameter are apart at most.

    Everything else alike; ``relative``: as a share of their mean; ``absolute``: of magnitudes, for
    commands whose mirror images are compared.
    """

    def evaluate(table: Table) -> Evidence:
        alike: dict[Any, list[float]] = {}
        for condition in table.conditions:
            key = tuple((k, v) for k, v in condition.items() if k != parameter)
            value = float(np.mean(table.where(**condition).values(metric)))
            alike.setdefault(key, []).append(abs(value) if absolute else value)
        spans = [
            (max(v) - min(v)) / (abs(float(np.mean(v))) if relative else 1.0)
            for v in alike.values()
            if len(v) > 1
        ]
        if not spans:
            return Evidence.untestable(f"only one {parameter} was run")
        return Evidence(max(spans), n=table.finished)

    return evaluate


def sheet(
    platform: str,
    test: str,
    name: str,
    text: str,
    how: str,
    bound: Bound,
    evaluate: Callable[[Table], Evidence],
    *,
    published: str = "no number",
    unit: str = "",
    sizes: tuple[str, ...] = ALL,
    **needs: Any,
) -> Claim:
    """A line of a platform's sheet, as a claim on the trials of one test."""
    short = platform.split("_")[-1] if platform != "aibo_ers7" else "aibo"
    return Claim(
        id=f"{short}-{name}",
        text=text,
        how=how,
        bound=bound,
        published=published,
        unit=unit,
        sizes=sizes,
        needs={"platform": platform, "test": test, **needs},
        evaluate=evaluate,
    )
