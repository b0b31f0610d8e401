"""The theory in numbers: the linear model advanced exactly between changes of the graph."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.consensus import CanonicalModel, check_structure, equal_gains, graph, spread
from experiments.consensus.graphs import (
    EXAMPLE_41,
    Schedule,
    random_admissible,
    refuse_hopeless,
    static,
    three,
)
from experiments.consensus.lemmas import lemmas
from experiments.consensus.roles import PUBLISHED, gains_rule
from mjmr.errors import InvalidInputError
from mjmr.randomness import Streams

Array = NDArray[np.float64]
Metrics = dict[str, float | int | str | bool | None]
START = np.array([[6.0, 3.0], [2.0, 5.0], [4.0, 2.0]])
"""The paper's hand positions [m]."""
_STEP = 0.25  # s, between two looks at the spread


class Runner:
    """Advances a model exactly, keeping transitions and how far they are from stochastic.

    Attributes:
        row_error: Largest distance of a transition's row sum from one.
        least: Least entry of a transition.
    """

    def __init__(self, degrees: Any):
        """Args: degrees: Relative degrees (q,)."""
        self.model = CanonicalModel(degrees)
        self.row_error, self.least = 0.0, np.inf
        self._kept: dict[tuple[bytes, float], Array] = {}

    def advance(self, state: Array, gains: Array, duration: float) -> Array:
        """State (sum l, m) after constant gains, (q, q) or (m, q, q) by channel."""
        if gains.ndim == 3:
            columns = [self._transition(g, duration) @ state[:, s] for s, g in enumerate(gains)]
            return np.stack(columns, axis=1)
        return self._transition(gains, duration) @ state

    def follow(
        self, state: Array, schedule: Schedule, gains: list[Array], begin: float, end: float
    ) -> Array:
        """State at ``end`` after the gains of each of a schedule's instants since ``begin`` [s]."""
        for k, duration in schedule.pieces(begin, end):
            state = self.advance(state, gains[k], duration)
        return state

    def _transition(self, gains: Array, duration: float) -> Array:
        key = gains.tobytes(), round(duration, 9)
        if key not in self._kept:
            found = self.model.transition(gains, duration)
            self.row_error = max(self.row_error, float(np.abs(found.sum(axis=1) - 1).max()))
            self.least = min(self.least, float(found.min()))
            self._kept[key] = found
        return self._kept[key]


def run(
    runner: Runner, start: Array, schedule: Schedule, duration: float, near: float = 0.01,
    velocity: Array | None = None, channel_gains: list[Array] | None = None,
) -> Metrics:  # fmt: skip
    """Follow a schedule.

    Args:
        runner: Of the model.
        start: Outputs (q, m) [m].
        schedule: Graphs and gains.
        duration: [s].
        near: Spread whose first instant for good is told [m].
        velocity: Of the outputs at the start (q, m) [m/s]; None: at rest.
        channel_gains: In place of the schedule's gains, (m, q, q) at each instant.

    Returns:
        ``x_m``, ``y_m`` of the mean, ``spread_m``, ``near_s`` (NaN: never for good), and how far
        transitions are from stochastic.
    """
    state = runner.model.start(start, velocity)
    gains = schedule.gains if channel_gains is None else channel_gains
    since, before = np.nan, 0.0
    times = _STEP * np.arange(1, int(np.ceil(duration / _STEP - 1e-9)) + 1)
    for time in np.minimum(times, duration):
        state, before = runner.follow(state, schedule, gains, before, time), time
        apart = spread(state[runner.model.outputs])
        if apart > near:
            since = np.nan
        elif np.isnan(since):
            since = time
    y = state[runner.model.outputs]
    middle = y.mean(axis=0)
    low, high = start.min(axis=0), start.max(axis=0)
    return {
        "x_m": float(middle[0]),
        "y_m": float(middle[1]),
        "channel_gap_m": float(abs(middle[0] - middle[1])),
        "spread_m": spread(y),
        "near_s": float(since),
        "line_m": float(abs(middle[0] + 2 * middle[1] - 12.0)),
        "outside_m": float(np.maximum(low - middle, middle - high).max()),
        "row_error": runner.row_error,
        "least": runner.least,
    }


def trial(condition: Mapping[str, Any], seed: int, parts: Mapping[str, Any] = PUBLISHED) -> Metrics:
    """Metrics of one linear condition."""
    streams = Streams(seed)
    experiment = condition["experiment"]
    if experiment == "lemmas":
        return lemmas(streams.generator("lemmas"))
    if experiment == "example-4.1":
        return _example_41(condition["degree"], streams.generator("start"))
    if experiment == "random-sequence":
        return _random_sequence(streams.generator("sequence"))
    if experiment == "graph":
        return _graph(condition, streams, parts)
    if experiment == "mixed-channels":
        return _mixed_channels(condition, parts)
    return _three(condition, streams, parts)


def degrees_of(text: str, q: int) -> list[int]:
    """Relative degrees of q systems from ``"2"`` or ``"1 2 3"``.

    Raises:
        InvalidInputError: Another number of them, no numbers, or one below 1.
    """
    try:
        found = [int(part) for part in text.split()]
    except ValueError:
        raise InvalidInputError(
            f"degrees are whole numbers separated by spaces; got {text!r}"
        ) from None
    if len(found) == 1:
        found *= q
    if len(found) != q:
        raise InvalidInputError(f"there are {q} robots; got {len(found)} degrees in {text!r}")
    return list(CanonicalModel(found).degrees)


def planned(
    condition: Mapping[str, Any], streams: Streams, parts: Mapping[str, Any] = PUBLISHED
) -> tuple[Runner, Schedule]:
    """What three robots of the linear model run.

    Raises:
        InvalidInputError: Relative degrees that cannot be, or graphs that never meet the condition.
    """
    schedule = three(
        condition["schedule"], condition["dwell"], condition["duration"], condition["weight"],
        streams.generator("leaders"), gains_rule(parts, 3),
    )  # fmt: skip
    refuse_hopeless(schedule, condition["anyway"])
    return Runner(degrees_of(condition["degrees"], 3)), schedule


def _three(condition: Mapping[str, Any], streams: Streams, parts: Mapping[str, Any]) -> Metrics:
    duration = condition["duration"]
    runner, schedule = planned(condition, streams, parts)
    channels = None
    if condition["weight_y"] > 0:
        other = three(
            condition["schedule"], condition["dwell"], duration, condition["weight_y"],
            streams.generator("leaders"), gains_rule(parts, 3),
        )  # fmt: skip
        channels = [np.stack(pair) for pair in zip(schedule.gains, other.gains, strict=True)]
    return run(runner, START, schedule, duration, channel_gains=channels)


def reference(schedule: Schedule, duration: float) -> Array:
    """Consensus point (2,) [m] of the linear model with the paper's starts, after a duration."""
    found = run(Runner([2, 2, 2]), START, schedule, duration)
    return np.array([found["x_m"], found["y_m"]], dtype=np.float64)


def _example_41(degree: int, rng: np.random.Generator) -> Metrics:
    """Four robots under the graph of Example 4.1 with equal weights, from random places."""
    start = rng.uniform(-5.0, 5.0, (4, 2))
    gains = equal_gains(EXAMPLE_41)
    runner = Runner([degree] * 4)
    matrix = runner.model.expanded(gains)
    slow = np.sort(np.linalg.eigvals(matrix - np.eye(len(matrix))).real)[::-1]
    schedule = Schedule([graph(EXAMPLE_41)], [gains], 1e9)
    found = run(runner, start, schedule, 1000.0)
    found["slow"] = float(slow[1])  # the largest is the leader's, 0
    off = np.hypot(found["x_m"] - start[1, 0], found["y_m"] - start[1, 1])  # pyright: ignore
    found["off_leader_m"] = float(off)
    return found


def _random_sequence(rng: np.random.Generator) -> Metrics:
    q, degree = int(rng.integers(3, 13)), int(rng.integers(1, 4))
    start = rng.uniform(-5.0, 5.0, (q, 2))
    graphs, gains = random_admissible(q, 24, rng)
    report = check_structure(graphs, gains, epsilon=0.01)
    runner = Runner([degree] * q)
    state = runner.model.start(start)
    dwells = rng.uniform(0.5, 5.0, len(gains))
    periods = 0
    # the sequence is one period of an infinite one
    while spread(state[runner.model.outputs]) >= 1e-3 and periods < 200:
        for weights, dwell in zip(gains, dwells, strict=True):
            state = runner.advance(state, weights, float(dwell))
        periods += 1
    middle = state[runner.model.outputs].mean(axis=0)
    return {
        "admissible": report.holds,
        "q": q,
        "degree": degree,
        "spread_m": spread(state[runner.model.outputs]),
        "seconds": float(periods * dwells.sum()),
        "outside_m": float(
            np.maximum(start.min(axis=0) - middle, middle - start.max(axis=0)).max()
        ),
        "row_error": runner.row_error,
        "least": runner.least,
    }


def _mixed_channels(condition: Mapping[str, Any], parts: Mapping[str, Any]) -> Metrics:
    """Gains whose blocks are not diagonal: a tenth of each own weight goes to the other channel."""
    schedule = three(
        condition["schedule"], condition["dwell"], condition["duration"], condition["weight"],
        np.random.default_rng(0), gains_rule(parts, 3),
    )  # fmt: skip
    # systems are (robot, channel): a channel of its own would be all the theory allows
    mix = np.array([[0.9, 0.1], [0.1, 0.9]])
    wide = [
        np.kron(np.diag(np.diag(g)), mix) + np.kron(g - np.diag(np.diag(g)), np.eye(2))
        for g in schedule.gains
    ]
    runner = Runner([2] * 6)
    state = runner.model.start(START.reshape(6, 1))
    state = runner.follow(state, schedule, wide, 0.0, condition["duration"])
    y = state[runner.model.outputs, 0].reshape(3, 2)
    middle = y.mean(axis=0)
    return {
        "x_m": float(middle[0]),
        "y_m": float(middle[1]),
        "channel_gap_m": float(abs(middle[0] - middle[1])),
        "spread_m": spread(y),
    }


def _graph(condition: Mapping[str, Any], streams: Streams, parts: Mapping[str, Any]) -> Metrics:
    """Time to agreement of n robots under one graph; gives up after ``duration``."""
    n = condition["robots"]
    start = streams.generator("start").uniform(-0.5, 0.5, (n, 2))
    schedule = static(
        condition["graph"], n, 1e9, condition["weight"], streams.generator("graph"),
        gains_rule(parts, n, many=True),
    )  # fmt: skip
    runner = Runner([2] * n)
    state = runner.model.start(start)
    step, time = 1.0, 0.0
    matrix = runner.model.expanded(schedule.gains[0])
    rates = np.sort(np.linalg.eigvals(matrix - np.eye(len(matrix))).real)[::-1]
    while spread(state[runner.model.outputs]) > 0.1 and time < condition["duration"]:
        state = runner.advance(state, schedule.gains[0], step)
        time += step
    apart = spread(state[runner.model.outputs])
    return {
        "agree_s": time if apart <= 0.1 else float("nan"),
        "spread_m": apart,
        "slow": float(rates[1]),
    }
