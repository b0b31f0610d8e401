"""Robots that patrol agree by radio on the mean of what each of them measured.

Everybody has a lane of its own, so that nobody meets anybody; a radio reaches a disc, so that who
hears whom changes as they pass each other. Each reads the same quantity once, with noise of its
own. Ten times a second they tell each other what the service asks them to, and nothing else.
"""

import math
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
from mjmr.reach import Reach
from mjmr.sensors.localizer import Localizer
from mjmr.simulation import Simulation

Array = NDArray[np.float64]
QUANTITY, DEVIATION = 20.0, 1.0
"""What all measure, and the noise of one reading."""
LANES = 1.8
"""Apart [m]."""
_HALF = np.array([3.0, 0.25])  # m, half axes of a lane, an ellipse
_EVERY = round(RATE / ROUNDS)  # ticks from round to round
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


class AverageTeam:
    """Robots on their lanes, what they drive by, tell each other, and what is measured of them.

    Attributes:
        n: Robots.
        condition: See the study's parameters.
        readings: What each measured (n,).
        service: What they agree with.
        rounds: Of telling so far.
        connected: Of these, in which everybody was linked to everybody, directly or not.
        links: Of these, pairs in reach, summed.
    """

    def __init__(
        self, condition: Mapping[str, Any], seed: int, parts: Mapping[str, Any] = PUBLISHED
    ):
        """Put robots on their lanes.

        Args:
            condition: See the study's parameters.
            seed: Of the trial.
            parts: Classes of the roles; ``law`` alone is used.

        Raises:
            InvalidInputError: Parameters that do not go together.
        """
        refuse_unfit(condition)
        self.condition = condition
        n, streams = condition["robots"], Streams(seed)
        self.n = n
        self.patrol = Patrol(n, condition["patrol"], streams.generator("patrol"))
        self.readings = QUANTITY + DEVIATION * streams.generator("readings").normal(size=n)
        place, moves, _ = self.patrol.at(0.0)
        ahead = moves if condition["patrol"] else np.tile([1.0, 0.0], (n, 1))
        yaw = np.arctan2(ahead[:, 1], ahead[:, 0])
        poses = np.column_stack([place, yaw])
        poses[:, :2] -= HAND * np.column_stack([np.cos(yaw), np.sin(yaw)])
        room = _HALF[0] + 2.0
        world = hall((-room, -2.0, room, LANES * (n - 1) + 2.0))
        self.robots = add_team(world, poses, calibrated=True, masts=False)
        self.robots.mount(Localizer(rate=RATE))
        self.simulation = Simulation(world, seed=seed, control_period=1 / RATE, dt_max=0.01)
        reach = condition["reach"]
        self.radio = Radio(
            self.simulation, range=reach, latency=condition["delay"], loss=condition["loss"]
        )
        self.control = HandTeam(HAND, 1 / RATE, law=parts["law"](n))
        self.service = RULES[condition["rule"]](self.readings)
        self.meter = ContactMeter(self.simulation)
        self.rounds = self.connected = self.links = 0
        self._near = Reach(self.simulation, reach)  # for metrics
        self._aims, self._own, self._gains = np.full((n, n, 2), np.nan), np.arange(n), np.eye(n)
        self._ticks, self._told_at = 0, math.nan

    def run(self, duration: float) -> None:
        """Drive and agree for a duration [s]."""
        for time in self.simulation.ticks(duration):
            self.tick(time)

    def tick(self, time: float) -> None:
        """Drive at ``time`` [s] and tell, if it is time to; inside of the simulation's ticks."""
        pose = self.robots.localizer.read()
        place, moves, bends = self.patrol.at(time)
        self._aims[self._own, self._own] = place - hand_position(pose, HAND)
        command = self.control.step(
            pose[:, 2], self.robots.executed, self._aims, self._gains, reference=(moves, bends)
        )
        self.robots.drive(command)
        if self._ticks % _EVERY == 0:
            self._tell(time)
        self._ticks += 1

    def caption(self) -> str:
        """What they make of the mean now."""
        found = self.service.estimate
        mean = self.readings.mean()
        return f"estimates {found.min():.2f} to {found.max():.2f}, mean of readings {mean:.2f}"

    def _tell(self, time: float) -> None:
        if self.rounds:
            self.service.hear(of_this_round(*self.radio.latest(), self._told_at))
        self.radio.broadcast_arrays(self.service.message())
        self._told_at = time
        near = self._near.now()
        self.rounds += 1
        self.connected += rooted(near)
        self.links += int(np.triu(near, 1).sum())
        if self.simulation.noted:
            self.simulation.note(links=near & ~np.eye(self.n, dtype=bool))


def measure(team: AverageTeam) -> Metrics:
    """How well robots know the mean of their readings in the end.

    Returns:
        ``average_error``, the largest distance of a robot's estimate from the readings' mean;
        ``average_bias``, the mean of the estimates less that; ``disagreement``, the largest
        difference of two estimates; ``reading_error``, the largest distance of a reading from
        their mean, for comparison; ``connected``, the share of rounds in which everybody was
        linked to everybody, directly or not; ``bytes_per_s`` that a robot sends.
    """
    duration = team.condition["duration"]
    team.run(duration)
    estimate, mean = team.service.estimate, float(team.readings.mean())
    return {
        "average_error": float(np.abs(estimate - mean).max()),
        "average_bias": float(estimate.mean() - mean),
        "disagreement": float(np.ptp(estimate)),
        "reading_error": float(np.abs(team.readings - mean).max()),
        "rounds": team.service.rounds,
        "connected": team.connected / max(team.rounds, 1),
        "links": team.links / max(team.rounds, 1),
        "crowded": int(getattr(team.service, "crowded", 0)),
        "bytes_per_s": float(team.radio.bytes_sent.mean() / duration),
        "contacts": team.meter.episodes,
    }
