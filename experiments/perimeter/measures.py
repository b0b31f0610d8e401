"""What a trial is judged by: from truth, after and beside the loop."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from controllers.perimeter import ACQUIRE, MOVING, SEARCHING, TRACKING
from experiments.perimeter.reckoning import Reckoning
from experiments.perimeter.sensing import AIM, INSIDE
from experiments.perimeter.worlds import HALF
from mjmr.geometry import rotate, wrap_angle

JOINED = 30.0  # s after joining, from which tracking counts
WINDOW = 5  # periods of 0.1 s over which turn rates and speeds are taken
STOPPED = 0.005  # m/s
STILL = 30.0  # s, at the end, in which nobody may move


class Drift:
    """Where the trucks would be by dead reckoning, without the bus between; from the start.

    With a localizer nobody steers by it: then it is by the rear wheels alone.
    """

    def __init__(self, scene: Any, localization: str):
        """Begin where they start."""
        trucks = scene.trucks
        self._encoders = trucks.encoders
        self._compass = trucks.compass if localization == "odometry-compass" else None
        self._seen_at = float("nan")
        self._reckoning = Reckoning(scene)

    def see(self) -> None:
        """Take the counts, if there are new ones."""
        if self._encoders.sampled_at != self._seen_at:
            self._seen_at = self._encoders.sampled_at
            heading = None if self._compass is None else self._compass.read()
            self._reckoning.step(self._encoders.read(), heading)

    def errors(self, poses: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Distances (n,) [m] and headings (n,) [rad] from where they are (n, 3)."""
        off = self._reckoning.poses - poses
        return np.hypot(off[:, 0], off[:, 1]), np.abs(wrap_angle(off[:, 2]))


class Log:
    """Poses and states at every tick, and what they come to."""

    def __init__(
        self, simulation: Any, scene: Any, senses: Any, team: Any, failure: Any,
        condition: Mapping[str, Any],
    ):  # fmt: skip
        """Watch."""
        self._simulation, self._scene, self._senses = simulation, scene, senses
        self._team, self._failure, self._condition = team, failure, condition
        self._times: list[float] = []
        self._poses: list[np.ndarray] = []
        self._states: list[np.ndarray] = []
        self._agree: list[np.ndarray] = []
        self._heard: list[np.ndarray] = []  # every second
        self._meter = None
        if condition["mode"] != "unicycle":
            from mjmr.metrics import ContactMeter

            self._meter = ContactMeter(simulation)
        self._drift = Drift(scene, condition["localization"])
        self._hops = np.zeros(scene.trucks.n, dtype=np.int64)
        self._sees_at = float("nan")
        simulation.observe(self._see)

    def _see(self) -> None:
        simulation, team = self._simulation, self._team
        self._times.append(simulation.time)
        self._poses.append(simulation.truth.poses(self._scene.trucks))
        self._states.append(team.state.copy())
        if len(self._times) % 10 == 1:
            self._heard.append(self.links() > 0)
        self._drift.see()
        entering = (team.state == MOVING) & np.isnan(team.joined)
        self._hops = np.where(entering, np.maximum(self._hops, team.hops), self._hops)
        if self._condition["sensing"] == "both":
            self._compare()

    def _compare(self) -> None:
        from controllers.perimeter.vision import inside

        trucks = self._scene.trucks
        if trucks.eye.sampled_at == self._sees_at:
            return
        self._sees_at = trucks.eye.sampled_at
        pair = np.stack([trucks.spot.read(), inside(trucks.eye.read())])
        tracks = self._team.state >= ACQUIRE
        self._agree.append(pair[:, tracks])

    def links(self) -> np.ndarray:
        """Who was heard of within the last second (n, n)."""
        radio = self._senses.radio
        n = self._scene.trucks.n
        if not radio.messages_sent.any():
            return np.zeros((n, n))
        _, sent = radio.latest()
        with np.errstate(invalid="ignore"):
            return (self._simulation.time - sent <= 1.0).astype(float)

    def settled(self, seconds: float) -> bool:
        """Whether every truck joined at least ``seconds`` [s] ago."""
        joined = self._team.joined[self._failure.on]
        return bool((self._simulation.time - joined >= seconds).all())

    def metrics(self) -> dict[str, Any]:
        """Everything measured."""
        times, poses = np.array(self._times), np.stack(self._poses)
        states = np.stack(self._states)
        return {
            "time_s": float(times[-1]),
            **self._joining(),
            **self._tracking(times, poses, states),
            **self._spacing(times, poses, states),
            **self._envelope(times, poses, states),
            **self._failing(times, poses, states),
            **self._contacts(poses, times),
            **self._agreement(),
            **self._drifted(poses[-1]),
            "states": _runs(times, states),
            **self._graphs(poses, times),
        }

    def _drifted(self, poses: Any) -> dict[str, float]:
        """Of who is switched on, in the end."""
        way, turn = self._drift.errors(poses)
        on = self._failure.on
        return {
            "drift_m": float(way.mean()),
            "drift_worst_m": float(way[on].max()),
            "drift_worst_deg": float(np.degrees(turn[on].max())),
        }

    def _joining(self) -> dict[str, Any]:
        team, on = self._team, self._failure.on
        joined, sensed, told = team.joined, team.sensed, team.told & on
        own = np.isfinite(joined) & ~team.told
        first = np.nanmin(sensed) if np.isfinite(sensed).any() else np.nan
        # told robots join after somebody sensed it
        late = joined[told & np.isfinite(joined)]
        return {
            "all_track": bool(np.isfinite(joined[on]).all()),
            "all_track_end": bool((self._states[-1] == TRACKING)[on].all()),
            "tracking": int(np.isfinite(joined).sum()),
            "joins": " ".join(f"{t:.1f}" for t in np.sort(joined[np.isfinite(joined)])),
            "last_joined_s": float(np.max(joined[on]))
            if np.isfinite(joined[on]).all()
            else float(self._condition["duration"]),
            "first_sensed_s": _number(first),
            "by_relay": int((told & np.isfinite(joined)).sum()),
            "own_finders": int(own.sum()),
            "most_hops": int(self._hops.max()),
            "finder_first": bool((late > first).all()) if len(late) else True,
        }

    def _tracking(self, times: Any, poses: Any, states: Any) -> dict[str, Any]:
        """Error of the look-ahead point: how far it is off the edge."""
        scene, team = self._scene, self._team
        spot = poses[..., :2] + rotate(np.array(AIM[:2]), poses[..., 2])
        error = np.array([scene.depth(s, t) for s, t in zip(spot, times, strict=True)])
        since = times[:, None] - team.joined
        tracks = (states >= ACQUIRE) & (since >= 0)
        if self._failure.kind == "removed" and self._failure.robot >= 0:
            tracks[:, self._failure.robot] = False  # it was carried
        steady = tracks & (since >= JOINED)
        centre = scene.lobes[:, :2].mean(axis=0)
        angle = np.unwrap(np.arctan2(*(poses[..., :2] - centre).transpose(2, 0, 1)[::-1]), axis=0)
        step = np.diff(angle, axis=0)[steady[1:]]
        return {
            "rms_m": _rms(error[steady]),
            "rms_join_m": _rms(error[tracks]),
            "worst_m": float(np.abs(error[steady]).max()) if steady.any() else -1.0,
            "deepest_m": float((error * tracks).max()),
            "anticlockwise_rad": float(step.sum()),
            "steady_s": float(steady.sum() * 0.1),
        }

    def _spacing(self, times: Any, poses: Any, states: Any) -> dict[str, Any]:
        """Gaps between neighbours along the perimeter in the end, and whether anybody moves."""
        on = self._failure.on
        tracks = (states[-1] >= ACQUIRE) & on
        n = int(tracks.sum())
        centre = self._scene.lobes[:, :2].mean(axis=0)
        ratio = least = -1.0
        if n > 1:
            at = np.sort(np.arctan2(*(poses[-1, tracks, :2] - centre).T[::-1]))
            gaps = np.diff(np.append(at, at[0] + 2 * np.pi)) * n / (2 * np.pi)
            ratio, least = float(gaps.max()), float(gaps.min())
        last = times >= times[-1] - STILL
        way = (
            np.hypot(*np.diff(poses[..., :2], axis=0).transpose(2, 0, 1)) / np.diff(times)[:, None]
        )
        moving = (way > STOPPED)[:, on].any(axis=1)
        moved = np.flatnonzero(moving)
        return {
            "gap_ratio": ratio,
            "least_gap": least,
            "even": bool(n == on.sum() and ratio <= 1.1 and least >= 0.9),
            "stopped": bool(not moving[last[1:]].any()),
            "moving_share": float(moving[last[1:]].mean()),
            "stopped_at_s": float(times[1:][moved[-1]]) if len(moved) else 0.0,
            "longest_stop_s": _longest(~moving) * 0.1,
            "desired_m": float(np.nanmedian(self._team.desired))
            if np.isfinite(self._team.desired).any() else -1.0,
        }  # fmt: skip

    def _envelope(self, times: Any, poses: Any, states: Any) -> dict[str, Any]:
        yaw = np.unwrap(poses[..., 2], axis=0)
        span = times[WINDOW:] - times[:-WINDOW]
        turn = np.abs(yaw[WINDOW:] - yaw[:-WINDOW]) / span[:, None]
        way = np.hypot(*(poses[WINDOW:, :, :2] - poses[:-WINDOW, :, :2]).transpose(2, 0, 1))
        speed = way / span[:, None]
        keep = np.ones(turn.shape, dtype=bool)
        if self._failure.kind == "removed" and self._failure.robot >= 0:
            keep[:, self._failure.robot] = False  # it was carried
        return {"top_turn": float(turn[keep].max()), "top_speed": float(speed[keep].max())}

    def _failing(self, times: Any, poses: Any, states: Any) -> dict[str, Any]:
        failure, robot = self._failure, self._failure.robot
        none = {"reported_s": -1.0, "stop_way_m": -1.0, "stopped_after_s": -1.0, "again": False,
                "gave_up_s": -1.0}  # fmt: skip
        if failure.kind == "camera" and robot >= 0:
            changes = [
                c for c in self._senses.bus.changes if (c.robot, c.device) == (robot, INSIDE)
            ]
            gone = [c.time for c in changes if c.kind == "removed"]
            back = [c.time for c in changes if c.kind == "added"]
            step = np.hypot(*np.diff(poses[:, robot, :2], axis=0).T) / np.diff(times)
            after = times[1:] > failure.at
            still = np.flatnonzero(after & (step < STOPPED))
            until = (times[1:] > failure.at + 3.0) & (times[1:] < failure.at + 20.0)
            none |= {
                "reported_s": gone[0] - failure.at if gone else -1.0,
                "stopped_after_s": float(times[1:][still[0]] - failure.at) if len(still) else -1.0,
                "stop_way_m": float((step * 0.1)[until].sum()),
                "again": bool(back and (step[times[1:] > back[0]] > STOPPED).any()),
            }
        if failure.kind == "lie":
            moving = states[:, 0] == MOVING
            if moving.any():
                first = int(np.argmax(moving))
                rest = np.flatnonzero(states[first:, 0] != MOVING)
                # who meets the spill on the way has not given anything up
                if len(rest) and states[first + rest[0], 0] == SEARCHING:
                    none["gave_up_s"] = float(times[first + rest[0]] - times[first])
        return none

    def _contacts(self, poses: Any, times: Any) -> dict[str, Any]:
        n = poses.shape[1]
        nearest = float("inf")
        if n > 1:
            a, b = np.triu_indices(n, 1)
            way = poses[:, a, :2] - poses[:, b, :2]
            nearest = float(np.hypot(way[..., 0], way[..., 1]).min())
        wall = float((HALF - np.abs(poses[..., :2])).min())
        if self._meter is None:
            return {"contacts": -1, "obstacle_contact_s": -1.0, "nearest_m": nearest,
                    "wall_m": wall}  # fmt: skip
        return {
            "contacts": int(self._meter.episodes),
            "obstacle_contact_s": float(self._meter.obstacles),
            "nearest_m": nearest,
            "wall_m": wall,
        }

    def _agreement(self) -> dict[str, Any]:
        if not self._agree:
            return {"compared": 0, "agree": -1.0}
        pairs = np.concatenate(self._agree, axis=1)
        pairs = pairs[:, np.isfinite(pairs).all(axis=0)]
        same = float((pairs[0] == pairs[1]).mean()) if pairs.size else -1.0
        return {"compared": int(pairs.shape[1]), "agree": same}

    def _graphs(self, poses: Any, times: Any) -> dict[str, str]:
        """Pairs over time as runs ``i-j:from-to`` [s], space between.

        ``graph``: who is within radio range of whom, by true poses; ``heard``: who of whom one has
        heard the other in the last second, which is what the radio really carried.
        """
        reach, times = self._condition["d_com"], times[::10]
        heard, told = np.stack(self._heard), {"graph": [], "heard": []}
        for i, j in zip(*np.triu_indices(poses.shape[1], 1), strict=True):
            way = poses[::10, i, :2] - poses[::10, j, :2]
            near = np.hypot(way[:, 0], way[:, 1]) <= reach
            for name, flags in (("graph", near), ("heard", heard[:, i, j] | heard[:, j, i])):
                told[name] += [f"{i}-{j}:{a:.0f}-{b:.0f}" for a, b in _spans(times, flags)]
        return {name: " ".join(runs) for name, runs in told.items()}


def _rms(values: Any) -> float:
    return float(np.sqrt((values**2).mean())) if values.size else -1.0


def _number(value: float) -> float:
    return float(value) if np.isfinite(value) else -1.0


def _longest(flags: Any) -> int:
    """Length of the longest run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(int), [0]])))
    return int((edges[1::2] - edges[::2]).max()) if len(edges) else 0


def _spans(times: Any, flags: Any) -> list[tuple[float, float]]:
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(int), [0]])))
    ends = np.append(times, times[-1])
    return [(float(ends[a]), float(ends[b])) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _runs(times: Any, states: Any) -> str:
    """States over time: ``i:state@from,state@from ...`` [s], a space between robots."""
    told = []
    for i, row in enumerate(states.T):
        starts = np.flatnonzero(np.append(True, row[1:] != row[:-1]))
        told.append(f"{i}:" + ",".join(f"{row[k]}@{times[k]:.1f}" for k in starts))
    return " ".join(told)
