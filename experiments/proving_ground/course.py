"""What all tests share: drive a course, keep what really happened, and the forms of claims."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mjmr.claims import Bound, Claim, Evidence, Table
from mjmr.errors import MjmrError
from mjmr.group import Group
from mjmr.simulation import Simulation
from mjmr.world import World

Array = NDArray[np.float64]
Metrics = dict[str, float | int | bool]
Measure = Callable[[Table, Bound], Evidence]
ALL = ("quick", "standard", "full")
SHORT = {"pioneer2dx": "pioneer", "aibo_ers7": "aibo", "tamiya_txt1": "txt1"}
LARGE = ("standard", "full")


class NothingMeasuredError(MjmrError):
    """So little happened in a trial that its errors would look good for that alone."""


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
    def ways(self) -> Array:
        """Lengths of the robots' paths (n,) [m]."""
        return np.hypot(*np.diff(self.poses[:, :, :2], axis=0).transpose(2, 0, 1)).sum(axis=0)

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


def demand(what: str, found: float, least: float) -> None:
    """Refuse a trial in which not enough happened: a robot at rest is off no line.

    Args:
        what: Was counted, with its unit.
        found: How much of it there was.
        least: How much is needed.

    Raises:
        NothingMeasuredError: Less, or not a number; the trial fails, and with it its claims.
    """
    if not found >= least:
        raise NothingMeasuredError(
            f"nothing was measured: {what} came to {found:.3g}; at least {least:.3g} are needed"
        )


def hall(half: float = 8.0, **options: Any) -> World:
    """An empty square hall whose walls are ``2 half`` [m] apart."""
    return World(bounds=[-half, -half, half, half], wall_height=0.5, floor="concrete", **options)


def worst(values: Sequence[float], bound: Bound, n: int) -> Evidence:
    """Of several values that must all satisfy a bound, the one that is nearest to not doing so."""
    found = min(values, key=bound.margin)
    low, high = min(values), max(values)
    why = f"worst of {low:.4g} to {high:.4g}" if low < high else ""
    return Evidence(float(found), n=n, why=why)


def by_condition(table: Table, metric: str, of: Callable[[Array], Any] = np.mean) -> list[float]:
    """What ``of`` makes of a metric's values under each condition.

    Raises:
        NoTrialsError: No trial has finished.
    """
    table.values(metric)
    return [float(of(table.where(**c).values(metric))) for c in table.conditions]


def every(metric: str) -> Measure:
    """A metric that must satisfy the bound in every trial: its worst value."""
    return lambda table, bound: worst(table.values(metric).tolist(), bound, table.finished)


def means(metric: str) -> Measure:
    """A metric whose mean must satisfy the bound under every condition: its worst mean."""
    return lambda table, bound: worst(by_condition(table, metric), bound, table.finished)


def apart(metric: str, parameter: str, relative: bool = False, absolute: bool = False) -> Measure:
    """How far a metric's means at the values of a parameter are apart at most.

    Everything else alike; ``relative``: as a share of their mean; ``absolute``: of magnitudes, for
    commands whose mirror images are compared.
    """

    def evaluate(table: Table, bound: Bound) -> Evidence:
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
    measure: Measure | str,
    *,
    published: str = "no number",
    unit: str = "",
    sizes: tuple[str, ...] = ALL,
    **needs: Any,
) -> Claim:
    """A line of a platform's sheet, as a claim on the trials of one test.

    ``measure`` may be a metric's name: then :func:`every` trial must satisfy the bound.
    """
    measured = every(measure) if isinstance(measure, str) else measure
    return Claim(
        id=f"{SHORT.get(platform, platform)}-{name}",
        text=text,
        how=how,
        bound=bound,
        published=published,
        unit=unit,
        sizes=sizes,
        needs={"platform": platform, "test": test, **needs},
        evaluate=lambda table: measured(table, bound),
    )
