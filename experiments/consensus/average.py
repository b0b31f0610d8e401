"""Robots that patrol agree by radio on the mean of what each of them measured.

Everybody has a lane of its own, so that nobody meets anybody; a radio reaches a disc, so that who
hears whom changes as they pass each other. Each reads the same quantity once, with noise of its
own. Ten times a second they tell each other what the service asks them to, and nothing else.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.consensus import (
    AverageConsensus,
    HandTeam,
    RatioConsensus,
    hand_position,
    of_this_round,
    rooted,
)
from experiments.consensus.arena import HAND, add_team, hall
from experiments.consensus.physical import RATE, Metrics
from experiments.consensus.refusals import ROUNDS, refuse_unfit
from experiments.consensus.roles import PUBLISHED
from mjmr.metrics import ContactMeter
from mjmr.radio import Radio
from mjmr.randomness import Streams
from mjmr.sensors.localizer import Localizer
from mjmr.simulation import Simulation

Array = NDArray[np.float64]
QUANTITY, DEVIATION = 20.0, 1.0
"""What all measure, and the noise of one reading."""
LANES = 1.8
"""Apart [m]."""
_HALF = np.array([3.0, 0.25])  # m, half axes of a lane, an ellipse
_PACE = 0.4  # m/s, at most, on a lane
_STANDING = 1.0  # m along the lane from its middle, at most, for robots that stand
RULES = {"metropolis": AverageConsensus, "ratio": RatioConsensus}


class Patrol:
    """Where robots are to be on their lanes."""

    def __init__(self, n: int, moves: bool, rng: np.random.Generator):
        """Args: n: Robots. moves: Whether they patrol. rng: Draws phases and paces."""
        self._middle = np.column_stack([np.zeros(n), LANES * np.arange(n)])
        self._rate = rng.uniform(0.7, 1.0, n) * rng.choice([-1.0, 1.0], n) * _PACE / _HALF[0]
        self._phase = rng.uniform(-np.pi, np.pi, n)
        if not moves:
            self._rate = np.zeros(n)
            self._phase = np.arccos(rng.uniform(-_STANDING, _STANDING, n) / _HALF[0])

    def at(self, time: float) -> Array:
        """Place, velocity and acceleration (3, n, 2) at ``time`` [s]."""
        angle, rate = self._rate * time + self._phase, self._rate[:, None]
        c, s = np.cos(angle), np.sin(angle)
        on = np.column_stack([c, s]) * _HALF
        moves = rate * np.column_stack([-s, c]) * _HALF
        return np.array([self._middle + on, moves, -(rate**2) * on], dtype=np.float64)


def trial(condition: Mapping[str, Any], seed: int, parts: Mapping[str, Any] = PUBLISHED) -> Metrics:
    """How well robots know the mean of their readings in the end.

    Returns:
        ``average_error``, the largest distance of a robot's estimate from the readings' mean;
        ``average_bias``, the mean of the estimates less that; ``disagreement``, the largest
        difference of two estimates; ``reading_error``, the largest distance of a reading from
        their mean, for comparison; ``connected``, the share of rounds in which everybody was
        linked to everybody, directly or not; ``bytes_per_s`` that a robot sends.
    """
    refuse_unfit(condition)
    n, streams = condition["robots"], Streams(seed)
    patrol = Patrol(n, condition["patrol"], streams.generator("patrol"))
    readings = QUANTITY + DEVIATION * streams.generator("readings").normal(size=n)
    point = patrol.at(0.0)
    ahead = point[1] if condition["patrol"] else np.tile([1.0, 0.0], (n, 1))
    yaw = np.arctan2(ahead[:, 1], ahead[:, 0])
    poses = np.column_stack([point[0], yaw])
    poses[:, :2] -= HAND * np.column_stack([np.cos(yaw), np.sin(yaw)])
    room = _HALF[0] + 2.0
    world = hall((-room, -2.0, room, LANES * (n - 1) + 2.0))
    robots = add_team(world, poses, calibrated=True, masts=False)
    robots.mount(Localizer(rate=RATE))
    simulation = Simulation(world, seed=seed, control_period=1 / RATE, dt_max=0.01)
    reach = condition["reach"]
    radio = Radio(simulation, range=reach, latency=condition["delay"], loss=condition["loss"])
    control = HandTeam(HAND, 1 / RATE, law=parts["law"](n))
    service = RULES[condition["rule"]](readings)
    watch = _Links(simulation, robots, reach)
    meter = ContactMeter(simulation)
    every, told_at = round(RATE / ROUNDS), None
    for tick, time in enumerate(simulation.ticks(condition["duration"])):
        pose = robots.localizer.read()
        point = patrol.at(time)
        aims = np.full((n, n, 2), np.nan)
        aims[np.arange(n), np.arange(n)] = point[0] - hand_position(pose, HAND)
        moves = (point[1], point[2])
        robots.drive(control.step(pose[:, 2], robots.executed, aims, np.eye(n), reference=moves))
        if tick % every == 0:
            if told_at is not None:
                service.hear(of_this_round(*radio.latest(), told_at))
            radio.broadcast_arrays(service.message())
            told_at = time
            watch.count()
    estimate, mean = service.estimate, float(readings.mean())
    return {
        "average_error": float(np.abs(estimate - mean).max()),
        "average_bias": float(estimate.mean() - mean),
        "disagreement": float(np.ptp(estimate)),
        "reading_error": float(np.abs(readings - mean).max()),
        "rounds": service.rounds,
        "connected": watch.connected / max(watch.rounds, 1),
        "links": watch.links / max(watch.rounds, 1),
        "crowded": int(getattr(service, "crowded", 0)),
        "bytes_per_s": float(radio.bytes_sent.mean() / condition["duration"]),
        "contacts": meter.episodes,
    }


class _Links:
    """Who was in reach of whom, for metrics: observers' eyes alone.

    Attributes:
        rounds: Counted.
        connected: Of these, in which everybody was linked to everybody, directly or not.
        links: Of these, pairs in reach, summed.
    """

    def __init__(self, simulation: Simulation, robots: Any, reach: float):
        self._simulation, self._robots, self._reach = simulation, robots, reach
        self._near = np.eye(robots.n, dtype=bool)
        self.rounds = self.connected = self.links = 0
        simulation.observe(self._look)

    def count(self) -> None:
        """Count the links there were at the last look."""
        self.rounds += 1
        self.connected += rooted(self._near)
        self.links += int(np.triu(self._near, 1).sum())

    def _look(self) -> None:
        at = self._simulation.truth.poses(self._robots)[:, :2]
        self._near = ((at[:, None] - at[None]) ** 2).sum(axis=2) <= self._reach**2
