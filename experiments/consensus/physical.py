"""Skid-steered robots that agree, in MuJoCo, on what they hear or on what they see."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.consensus import (
    HandTeam,
    Scan,
    hand_position,
    hand_velocity,
    offset_relative,
    reducible,
    rooted,
    spread,
)
from controllers.safety import BarrierConfig, BarrierFilter
from experiments.consensus.arena import HAND, Eyes, add_team, hall, mount_rays
from experiments.consensus.graphs import Schedule, refuse_hopeless, static, three
from experiments.consensus.linear import START, reference
from experiments.consensus.refusals import refuse_unfit
from experiments.consensus.roles import PUBLISHED, gains_rule
from mjmr.faults import Fault
from mjmr.geometry import rotate
from mjmr.metrics import ContactMeter
from mjmr.radio import Radio
from mjmr.randomness import Streams
from mjmr.robots.four_wheeler import FourWheeler
from mjmr.sensors.compass import Compass
from mjmr.sensors.localizer import Localizer
from mjmr.simulation import Simulation

Array = NDArray[np.float64]
Metrics = dict[str, float | int | str | bool | None]
RATE = 50.0
"""Of the control loop [Hz]."""
FAULT_AT = 10.0
"""When a robot dies or freezes [s]."""
_BOUNDS = (-2.0, -2.5, 10.0, 9.0)
_SPACING = 2.2  # m, of the lattice in which many robots agree
_NEAR = 0.1  # m, spread that counts as agreement
_SAMPLES = 1.0  # s, between what is kept for plots


class Team:
    """Robots with what they sense and say, their controller, and what is measured of them."""

    def __init__(
        self,
        condition: Mapping[str, Any],
        seed: int,
        parts: Mapping[str, Any] = PUBLISHED,
        cameras: bool = False,
    ):
        """Build the world of a condition and put the robots into it.

        Args:
            condition: See the study's parameters.
            seed: Of the trial.
            parts: Classes of the roles ``gains`` and ``law``.
            cameras: Whether there are cameras besides rays, :attr:`cameras`, which nobody uses.

        Raises:
            InvalidInputError: Parameters that do not go together, or graphs that never meet
                Assumption 4.2 and nobody asked for them.
        """
        refuse_unfit(condition)
        self.condition = condition
        streams = Streams(seed)
        self.many = condition["experiment"] == "graph"
        self.sighted = condition["sight"] != "given"
        count = condition["robots"] if self.many else len(START)
        self.rule = gains_rule(parts, count, self.many)
        self.schedule: Any = None if self.sighted else self._schedule(condition, streams)
        start, self.offsets, bounds = self._places(condition, streams)
        self.start = start
        self.n = len(start)
        heading = self._headings(condition, start + self.offsets, streams)
        poses = np.column_stack([start + self.offsets, heading])
        poses[:, :2] -= HAND * np.column_stack([np.cos(heading), np.sin(heading)])
        world = hall(bounds)
        calibrated = condition["calibrated"]
        self.robots = add_team(
            world, poses, calibrated=calibrated, masts=not self.many, virtual=condition["virtual"]
        )
        cone = math.radians(condition["cone_deg"])
        self.eyes: Any = None
        self.cameras: Any = Eyes(self.robots, cone) if cameras else None
        if self.sighted:
            self.robots.mount(Compass(rate=RATE))
            camera = condition["sight"] == "camera"
            self.eyes = Eyes(self.robots, cone) if camera else mount_rays(world, cone)
        if not self.sighted or condition["avoid"] != "none":
            self.robots.mount(Localizer(rate=RATE, position_noise=condition["noise"]))
        self._add_fault(condition["fault"])
        self.simulation = Simulation(
            world, seed=seed, control_period=1 / RATE, dt_max=0.01 if self.many else 0.005
        )
        self.radio = None
        if not self.sighted:
            self.radio = Radio(self.simulation, latency=condition["delay"], loss=condition["loss"])
        self.barrier = None
        if condition["avoid"] != "none":
            # hands this far apart leave the middles a diameter and the margin apart
            distance = 2 * FourWheeler.radius + 2 * HAND + 0.05
            self.barrier = BarrierFilter(self.n, BarrierConfig(distance=distance, top_speed=1.0))
        self.control = HandTeam(HAND, 1 / RATE, self.barrier, parts["law"](self.n))
        self.scan = Scan(self.n, patience=1.0, rate=0.5, settled=_NEAR)
        self.sight = Sight(self.n, condition["weight"], self.rule)
        self.log = Log(self)

    def run(self, duration: float, until_agreed: bool = False) -> None:
        """Drive for a duration [s], or until the spread is small, looked at once a second."""
        left = duration
        while left > 1e-9:
            span = min(left, 1.0) if until_agreed else left
            for time in self.simulation.ticks(span):
                self.tick(time)
            left -= span
            if until_agreed and self.log.spread_now <= _NEAR:
                return

    def caption(self) -> str:
        """How far they are now, and who heard whom at the last look."""
        heard = self.log.heard[-1] if self.log.heard else np.zeros((self.n, self.n), dtype=bool)
        links = zip(*np.nonzero(heard & ~np.eye(self.n, dtype=bool)), strict=True)
        hears = ", ".join(f"{i} hears {j}" for i, j in links) or "nobody hears anybody"
        return f"spread {self.log.spread_now:.2f} m; {hears}"

    def formation(self, time: float) -> Array:
        """Offsets (n, 2) [m] at ``time`` [s]."""
        return self.offsets

    def tick(self, time: float) -> None:
        """Sense and drive at ``time`` [s]; inside of the simulation's ticks."""
        robots = self.robots
        if self.sighted:
            command, heard = self._by_sight(time)
        else:
            command, heard = self._by_radio(time)
        robots.drive(command)
        if self.simulation.noted:
            self.simulation.note(links=heard & ~np.eye(self.n, dtype=bool))

    def _by_radio(self, time: float) -> tuple[Array, NDArray[np.bool_]]:
        assert self.radio is not None
        pose = self.robots.localizer.read()
        hands = hand_position(pose, HAND)
        output = hands - self.formation(time)
        k = self.schedule.at(time)
        gains = self.schedule.gains[k]
        # what is told now is heard in the next tick at the earliest
        heard = self.radio.latest()[0] if time > 0 else None
        told, reference = self._words(time, output, heard, gains)
        self.radio.broadcast_arrays(told.astype(np.float32))
        if heard is None:
            heard = np.full((self.n, self.n, told.shape[1]), np.nan)
        relative = self._relative(time, heard[..., :2] - output[:, None], output)
        command = self.control.step(
            pose[:, 2], self.robots.executed, relative, gains, hands, reference
        )
        return command, self.schedule.graphs[k]

    def _words(
        self, time: float, output: Array, heard: Array | None, gains: Array
    ) -> tuple[Array, tuple[Array, Array] | None]:
        """What robots tell (n, c), their outputs first, and what they take for their motion."""
        return output, None

    def _relative(self, time: float, relative: Array, output: Array) -> Array:
        """Outputs from robot row to robot column (n, n, 2) [m], as the law sees them."""
        return relative

    def _by_sight(self, time: float) -> tuple[Array, NDArray[np.bool_]]:
        yaw = self.robots.compass.read()
        relative = self.sight.step(self.eyes, yaw, self.robots.executed, self.offsets, 1 / RATE)
        hands = None
        if self.barrier is not None:
            hands = hand_position(self.robots.localizer.read(), HAND)
        command = self.control.step(yaw, self.robots.executed, relative, self.sight.gains, hands)
        if self.condition["scan"]:
            command = self.scan.step(time, relative, self.sight.seen, self.sight.bearing, command)
        return command, self.sight.seen

    def _schedule(self, condition: Mapping[str, Any], streams: Streams) -> Schedule:
        duration = condition["duration"]
        if self.many:
            schedule = static(
                condition["graph"], condition["robots"], duration, condition["weight"],
                streams.generator("graph"), self.rule,
            )  # fmt: skip
        else:
            schedule = three(
                condition["schedule"], condition["dwell"], duration, condition["weight"],
                streams.generator("leaders"), self.rule,
            )  # fmt: skip
        refuse_hopeless(schedule, condition["anyway"])
        return schedule

    def _places(self, condition: Mapping[str, Any], streams: Streams) -> tuple[Array, Array, Any]:
        """Outputs at the start (n, 2), offsets (n, 2), bounds."""
        if not self.many:
            # outward: everybody's place is on the side it comes from; crossed: 1 and 2 pass by
            order = [1, 0, 2] if condition["places"] == "crossed" else [0, 1, 2]
            angle = 2 * np.pi * np.array(order) / 3
            radius = condition["side"] / math.sqrt(3)
            return START, radius * np.column_stack([np.cos(angle), np.sin(angle)]), _BOUNDS
        n = condition["robots"]
        side = math.ceil(math.sqrt(n))
        row, column = np.divmod(np.arange(n), side)
        lattice = _SPACING * (np.column_stack([column, row]) - (side - 1) / 2)
        half = _SPACING * side / 2 + 1.5
        start = streams.generator("start").uniform(-0.5, 0.5, (n, 2))
        return start, lattice, (-half, -half, half, half)

    def _headings(self, condition: Mapping[str, Any], hands: Array, streams: Streams) -> Array:
        rng = streams.generator("headings")
        if condition["heading"] == "random":
            return rng.uniform(-np.pi, np.pi, len(hands))
        way = hands.mean(axis=0) - hands
        return np.arctan2(way[:, 1], way[:, 0]) + rng.uniform(-0.3, 0.3, len(hands))

    def _add_fault(self, fault: str) -> None:
        if fault == "follower-dies":
            self.robots.faults.add(Fault(kind="dead", robot=2, start=FAULT_AT))
        elif fault == "leader-freezes":
            # stands and goes on talking
            self.robots.faults.add(Fault(kind="stopped", robot=0, start=FAULT_AT))


class Sight:
    """Who sees whom, and where those are who are seen, between looks by dead reckoning.

    Attributes:
        seen: Flags (n, n) of the newest look, everybody seeing itself.
        gains: That follow from them (n, n).
        bearing: Of those seen (n, n) [rad], left positive.
        looks: Looks so far.
        reducible: Of these, whose graph was reducible.
        rooted: Of these, whose graph had somebody seen by all, directly or through others.
    """

    def __init__(self, n: int, weight: float, rule: Any):
        """Nobody has been seen yet.

        Args:
            n: Robots.
            weight: That each gives to all it sees together.
            rule: The part that gives weights.
        """
        self._n, self._weight, self._rule = n, weight, rule
        self.seen = np.eye(n, dtype=bool)
        self.gains = np.eye(n)
        self.bearing = np.full((n, n), np.nan)
        self.looks = self.reducible = self.rooted = 0
        self._at = -math.inf
        self._relative = np.full((n, n, 2), np.nan)

    def step(self, eyes: Any, yaw: Array, executed: Array, offsets: Array, period: float) -> Array:
        """Relative outputs (n, n, 2) [m], world axes as the compass has them."""
        # those seen are taken to stand still until the next look
        self._relative -= (hand_velocity(yaw, executed, HAND) * period)[:, None]
        if eyes.sampled_at > self._at:
            self._at = eyes.sampled_at
            found = eyes.read()
            place = found[..., :1] * np.stack(
                [np.cos(found[..., 1]), np.sin(found[..., 1])], axis=-1
            )
            place[..., 0] -= HAND  # from hand to hand
            self._relative = offset_relative(rotate(place, yaw[:, None]), offsets)
            self.bearing = found[..., 1]
            self.seen = np.isfinite(found[..., 0]) | np.eye(self._n, dtype=bool)
            self.gains = self._rule.step(self.seen, self._weight)
            self.looks += 1
            self.reducible += reducible(self.seen)
            self.rooted += rooted(self.seen)
        return self._relative


class Log:
    """What really happens: observers' eyes alone.

    Attributes:
        output: True outputs, hand points less offsets (n, 2) [m].
        times: Of what is kept [s].
        outputs: True outputs, hand points less offsets, at these (k, n, 2) [m].
        heard: Who heard whom at these (k, n, n).
    """

    def __init__(self, team: Team):
        """Watch a team."""
        self._team = team
        self.output = team.start
        self._pairs = np.triu_indices(team.n, 1)
        self.times: list[float] = []
        self.outputs: list[Array] = []
        self.heard: list[NDArray[np.bool_]] = []
        self.near_since = math.nan
        self.first_near = math.nan
        self.least_distance = math.inf
        self.peak = np.zeros(2)
        self.meter = ContactMeter(team.simulation)
        self._next = 0.0
        team.simulation.observe(self._look)

    @property
    def spread_now(self) -> float:
        """Of the true outputs [m]."""
        return spread(self.output)

    def _near(self) -> bool:
        # no spread is below the outputs' extent along x or y, which takes n steps and not n^2
        return bool(np.ptp(self.output, axis=0).max() <= _NEAR) and self.spread_now <= _NEAR

    def _look(self) -> None:
        team = self._team
        truth, time = team.simulation.truth, team.simulation.time
        pose, twist = truth.poses(team.robots), truth.twists(team.robots)
        self.output = hand_position(pose, HAND) - team.formation(time)
        if not self._near():
            self.near_since = math.nan
        elif math.isnan(self.near_since):
            self.near_since = time
            if math.isnan(self.first_near):
                self.first_near = time
        if not team.many:
            i, j = self._pairs
            apart = np.linalg.norm(pose[i, :2] - pose[j, :2], axis=1)
            self.least_distance = min(self.least_distance, float(apart.min()))
        self.peak = np.maximum(
            self.peak, [np.hypot(*twist[:, :2].T).max(), np.abs(twist[:, 2]).max()]
        )
        if time >= self._next - 1e-9:
            self._next += _SAMPLES
            self.times.append(time)
            self.outputs.append(self.output)
            if team.sighted:
                self.heard.append(team.sight.seen.copy())
            else:
                self.heard.append(team.schedule.graphs[team.schedule.at(time)])


def measure(team: Team) -> Metrics:
    """Metrics of three robots, or of a crowd under one graph."""
    team.run(team.condition["duration"], until_agreed=team.many)
    log = team.log
    common: Metrics = {
        "spread_m": log.spread_now,
        "near_s": log.near_since,
        "first_near_s": log.first_near,
        "contacts": log.meter.episodes,
        "wall_contact_seconds": log.meter.obstacles,
        "peak_speed": float(log.peak[0]),
        "peak_turn": float(log.peak[1]),
    }
    if team.many:
        return {"agree_s": log.first_near, **common}
    common.pop("wall_contact_seconds")
    final, middle = log.output, log.output.mean(axis=0)
    found: Metrics = {
        **common,
        "x_m": float(middle[0]),
        "y_m": float(middle[1]),
        "channel_gap_m": float(abs(middle[0] - middle[1])),
        "line_m": float(abs(middle[0] + 2 * middle[1] - 12.0) / math.sqrt(5.0)),
        "outside_m": float(
            np.maximum(team.start.min(axis=0) - middle, middle - team.start.max(axis=0)).max()
        ),
        "least_distance_m": log.least_distance,
        "pair_spread_m": spread(final[:2]),
        "outputs": " ".join(f"{v:.3f}" for v in np.array(log.outputs).ravel()),
        "heard": " ".join(str(int(v)) for v in _codes(log.heard)),
    }
    if team.sighted:
        found["reducible"] = team.sight.reducible / team.sight.looks
        found["rooted"] = team.sight.rooted / team.sight.looks
    else:
        wanted = reference(team.schedule, team.condition["duration"])
        found["error_m"] = float(np.hypot(*(middle - wanted)))
        pair = final[:2].mean(axis=0)
        found["pair_error_m"] = float(np.hypot(*(pair - wanted)))
        found["leader_error_m"] = float(np.linalg.norm(final - final[0], axis=1).max())
    if team.barrier is not None:
        found["infeasible"] = team.barrier.infeasible
        found["filtered"] = team.barrier.solved
    return found


def _codes(heard: list[NDArray[np.bool_]]) -> NDArray[np.int64]:
    """Graphs as numbers: bit i n + j is set if i hears j."""
    flags = np.array(heard).reshape(len(heard), -1)
    return (flags @ (1 << np.arange(flags.shape[1]))).astype(np.int64)
