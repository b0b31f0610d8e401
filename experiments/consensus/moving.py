"""A formation that moves: the leader follows a path, or everybody's place turns or swings.

The leader, who hears nobody, knows the path; in u_1 = y_1 its own output gives way to the path's
point, so it has no lag. Followers obey the paper's law, with or without what the leader tells of
velocity and acceleration. Everybody knows the offsets as functions of time.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.consensus import harmonic_error, ramp_lag
from experiments.consensus.graphs import leader_of
from experiments.consensus.linear import START
from experiments.consensus.physical import RATE, Metrics, Team
from experiments.consensus.roles import PUBLISHED
from mjmr.randomness import Streams

Array = NDArray[np.float64]
PATHS = ("line", "circle", "rotate", "scale")
SWING = 0.3
"""Of the formation's size, path scale."""


@dataclass(frozen=True)
class Path:
    """What a formation does.

    Attributes:
        kind: One of ``PATHS``.
        start: Of the leader's output (2,) [m].
        speed: Of the leader's output on line and circle [m/s].
        rate: At which circle, turn and swing go round [rad/s].
        places: Offsets at the start (n, 2) [m].
    """

    kind: str
    start: Array
    speed: float
    rate: float
    places: Array

    def point(self, time: float) -> Array:
        """Of the path at ``time`` [s]: place, velocity and acceleration (3, 2)."""
        place, zero = np.zeros(2), np.zeros(2)
        if self.kind == "line":
            place, moves, bends = np.array([self.speed * time, 0.0]), [self.speed, 0.0], zero
        elif self.kind == "circle":
            c, s = math.cos(self.rate * time), math.sin(self.rate * time)
            radius = self.speed / self.rate
            place, moves = radius * np.array([s, 1.0 - c]), self.speed * np.array([c, s])
            bends = self.speed * self.rate * np.array([-s, c])
        else:
            moves = bends = zero
        return np.array([self.start + place, moves, bends])

    def offsets(self, time: float) -> Array:
        """Of everybody at ``time`` [s]: place, velocity and acceleration (3, n, 2)."""
        d, w = self.places, self.rate
        c, s = math.cos(w * time), math.sin(w * time)
        if self.kind == "rotate":
            across = np.column_stack([-d[:, 1], d[:, 0]])
            turned = c * d + s * across
            return np.array([turned, w * (c * across - s * d), -w * w * turned])
        if self.kind == "scale":
            return np.array([(1 + SWING * s) * d, SWING * w * c * d, -SWING * w * w * s * d])
        return np.array([d, 0 * d, 0 * d])

    def swing(self, errors: Array, times: Array) -> NDArray[np.complex128]:
        """What :meth:`error` predicts, of outputs less the path (k, n, 2) [m] over whole turns."""
        if self.kind == "line":
            return errors.mean(axis=0).astype(complex)
        return 2.0 * np.einsum("kij,k->ij", errors, np.exp(-1j * self.rate * times)) / len(times)

    def rms(self, amplitudes: NDArray[np.complex128]) -> Array:
        """Root mean square (n,) [m] of errors with these amplitudes."""
        share = 1.0 if self.kind == "line" else 0.5
        return np.sqrt(share * (np.abs(amplitudes) ** 2).sum(axis=1))

    def error(self, gains: Array, leader: int, delay: float, told: bool) -> NDArray[np.complex128]:
        """Outputs less the path in the end (n, 2) [m], by the closed loop.

        On a line what they are, else the complex amplitudes at the rate of turn.
        """
        if self.kind == "line":
            lag = ramp_lag(gains, leader, [self.speed, 0.0], delay=delay, told=told)
            return -lag.astype(complex)
        path, swing = np.zeros(2, dtype=complex), 0j * self.places
        if self.kind == "circle":
            path = self.speed / self.rate * np.array([-1j, -1.0])
        elif self.kind == "rotate":
            swing = self.places + 1j * np.column_stack([self.places[:, 1], -self.places[:, 0]])
        else:
            swing = -1j * SWING * self.places
        return harmonic_error(gains, leader, self.rate, path, swing, delay=delay, told=told)


class MovingTeam(Team):
    """Robots in a formation that moves.

    Attributes:
        leader: Who knows the path.
        path: What the formation does.
        told: Whether velocities and accelerations are told.
        theory: Of outputs less the path, by the closed loop; see :meth:`Path.error`.
    """

    def __init__(
        self, condition: Mapping[str, Any], seed: int, parts: Mapping[str, Any] = PUBLISHED
    ):
        """See :class:`experiments.consensus.physical.Team`."""
        self.told = condition["feedforward"] == "told"
        super().__init__(condition, seed, parts)
        self._errors: list[Array] = []
        self._times: list[float] = []
        self.simulation.observe(self._look)

    @property
    def times(self) -> Array:
        """Of :attr:`errors` (k,) [s]."""
        return np.array(self._times)

    @property
    def errors(self) -> Array:
        """True outputs less the path's point (k, n, 2) [m], at every period so far."""
        return np.array(self._errors)

    def formation(self, time: float) -> Array:
        """Offsets (n, 2) [m] at ``time`` [s]."""
        return self.path.offsets(time)[0]

    def _places(self, condition: Mapping[str, Any], streams: Streams) -> tuple[Array, Array, Any]:
        start, offsets, _ = super()._places(condition, streams)
        self.leader = leader_of(condition["schedule"])
        self.path = Path(
            condition["path"], START[self.leader], condition["speed"], condition["turn_rate"],
            offsets,
        )  # fmt: skip
        delay = max(condition["delay"], 1.0 / RATE)  # what is told in a tick is heard in the next
        # a loop that has no end, since somebody does not hear the leader, is told before it runs
        gains = self.schedule.gains[-1]
        self.theory = self.path.error(gains, self.leader, delay, self.told)
        times = np.linspace(0.0, condition["duration"], 200)
        way = np.array([self.path.point(float(t))[0] for t in times])
        room = 1.5 + (1.0 + SWING) * np.hypot(*offsets.T).max()
        low = np.minimum(way.min(axis=0), start.min(axis=0)) - room
        return start, offsets, (*low, *(np.maximum(way.max(axis=0), start.max(axis=0)) + room))

    def _words(
        self, time: float, output: Array, heard: Array | None, gains: Array
    ) -> tuple[Array, tuple[Array, Array] | None]:
        offsets, point = self.path.offsets(time), self.path.point(time)
        reference, known = np.zeros((2, self.n, 2)), output
        if self.told:
            if heard is not None:
                reference = _passed_on(heard[..., 2:], gains)
            reference[:, self.leader] = point[1:]
            known = np.concatenate([output, *reference], axis=1)
            reference = reference + offsets[1:]
        reference[:, self.leader] = point[1:] + offsets[1:, self.leader]
        moves, bends = reference
        return known, (moves, bends)

    def _relative(self, time: float, relative: Array, output: Array) -> Array:
        # the leader's own output gives way to the path's point
        relative[self.leader, self.leader] = self.path.point(time)[0] - output[self.leader]
        return relative

    def _look(self) -> None:
        time = self.simulation.time
        self._times.append(time)
        self._errors.append(self.log.output - self.path.point(time)[0])


def _passed_on(heard: Array, gains: Array) -> Array:
    """Velocity and acceleration (2, n, 2) as heard (n, n, 4) from those whom one weights."""
    weights = np.where(np.isfinite(heard[..., 0]), gains, 0.0)
    np.fill_diagonal(weights, 0.0)
    total = np.maximum(weights.sum(axis=1, keepdims=True), 1e-300)
    found = np.einsum("ij,ijk->ik", weights / total, np.nan_to_num(heard))
    return np.array([found[:, :2], found[:, 2:]])


def measure(team: MovingTeam) -> Metrics:
    """Errors of a formation that moves, over its last turn.

    Returns:
        ``rms_i_m`` of each robot's output from the path's point, ``theory_i_m`` by the closed
        loop, ``lag_off``, the largest difference of the two over followers as a share of the
        latter (NaN if that is below 1 cm), ``swing_off`` likewise, of the errors' constant parts
        (on a line) or swings, direction and phase included; ``formation_rms_m`` over the
        followers, and ``leader_rms_m``; contacts of robots and with walls, distance and peaks.
    """
    team.run(team.condition["duration"])
    log, path = team.log, team.path
    turn = round(2.0 * math.pi / path.rate * RATE)
    late = team.errors[-turn:]
    rms = np.sqrt((late**2).sum(axis=2).mean(axis=0))
    theory = path.rms(team.theory)
    follows = np.arange(team.n) != team.leader
    off = np.abs(rms - theory)[follows] / np.maximum(theory[follows], 1e-12)
    apart = path.rms(path.swing(late, team.times[-turn:]) - team.theory)[follows]
    apart = apart / np.maximum(theory[follows], 1e-12)
    found: Metrics = {f"rms_{i + 1}_m": float(v) for i, v in enumerate(rms)}
    found |= {f"theory_{i + 1}_m": float(v) for i, v in enumerate(theory)}
    return {
        **found,
        "lag_off": float(off.max()) if theory[follows].min() >= 0.01 else math.nan,
        "swing_off": float(apart.max()) if theory[follows].min() >= 0.01 else math.nan,
        "formation_rms_m": float(np.sqrt((rms[follows] ** 2).mean())),
        "leader_rms_m": float(rms[team.leader]),
        "contacts": log.meter.episodes,
        "wall_contact_seconds": log.meter.obstacles,
        "least_distance_m": log.least_distance,
        "peak_speed": float(log.peak[0]),
        "peak_turn": float(log.peak[1]),
        "outputs": " ".join(f"{v:.3f}" for v in np.array(log.outputs).ravel()),
    }
