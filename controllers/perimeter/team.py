"""The hybrid controller over a whole team: states, and the law of each."""

import numpy as np
from numpy.typing import NDArray

from controllers.perimeter import percepts
from controllers.perimeter.approach import Edge, acquire, approach, way_off
from controllers.perimeter.avoidance import Avoidance, Neighbours
from controllers.perimeter.config import PerimeterConfig, even_factors
from controllers.perimeter.doubt import Doubt
from controllers.perimeter.estimate import TrackedCircles
from controllers.perimeter.percepts import Percepts
from controllers.perimeter.relay import Relay
from controllers.perimeter.spiral import Boundary, Spiral
from controllers.perimeter.states import ACQUIRE, MOVING, SEARCHING, TRACKING, TRANSITIONS
from controllers.perimeter.tracking import Zigzag, bang_bang, spacing
from mjmr.geometry import rotate

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
_SPEAKERS = [percepts.X, percepts.Y, percepts.YAW, percepts.STATE, percepts.SPEED]


class PerimeterTeam:
    """n robots that search, are told, approach, acquire and track.

    Each row is computed from that robot's own sensors and from what its own radio heard; the team's
    rows are computed at once.

    Attributes:
        state: Of each robot (n,), index into ``STATES``.
        entered: When it was entered (n,) [s].
        told: Who was ever MOVING before it first tracked (n,).
        joined: When each first tracked (n,) [s], NaN: not yet.
        sensed: When each first sensed a perimeter (n,) [s], NaN: not yet.
        relay: The news.
        desired: d_des of each robot (n,) [m]; NaN while it is not known.
    """

    def __init__(self, n: int, config: PerimeterConfig, rng: np.random.Generator):
        """Start searching.

        Args:
            n: How many robots.
            config: What they are told.
            rng: For the senses of spirals.
        """
        self.config = config
        self.state = np.full(n, SEARCHING, dtype=np.int64)
        self.entered = np.zeros(n)
        self.told = np.zeros(n, dtype=bool)
        self.joined, self.sensed = np.full(n, np.nan), np.full(n, np.nan)
        self.relay = Relay(n)
        self.desired = np.full(n, config.desired or np.nan)
        self._spiral, self._boundary = Spiral(n, config, rng), Boundary(n, config)
        self._avoidance, self._zigzag = Avoidance(n, config), Zigzag(n, config)
        self._doubt = Doubt(n, config)
        self._circles = TrackedCircles(n)
        self._seen_at = np.full(n, -np.inf)
        self._deadline = np.full(n, np.inf)
        self._goal = np.full((n, 2), np.nan)
        self._speed = np.zeros(n)

    def step(self, now: Percepts) -> Array:
        """(forward, turn) (n, 2) [m/s, rad/s] from what the robots know now."""
        c, time = self.config, now.time
        with np.errstate(invalid="ignore"):
            fresh = time - now.sent <= c.forget_after
        near = Neighbours(now.pose, now.heard[..., _SPEAKERS], fresh)
        edge = Edge(now.edge, c)
        known = np.isfinite(edge.error)
        self._seen_at = np.where(known, time, self._seen_at)
        place = now.pose[:, :2] + rotate(now.edge, now.pose[:, 2])
        self.relay.hear(now, fresh)
        self.relay.sense(known & np.isfinite(now.pose[:, 0]), place, time)
        self._switch(now, edge.error, edge.tangent)
        state, tracks = self.state, self.state == TRACKING
        self._circles.add(now.pose, tracks)

        wall = self._boundary.command(now.pose)
        roams = (state == SEARCHING) | (state == MOVING)
        self._boundary.active &= roams
        search = self._spiral.command(time, (state == SEARCHING) & ~self._boundary.active)
        off = way_off(now.pose, self._goal)
        command = np.where((state == MOVING)[:, None], approach(off, c), search)
        command = np.where((self._boundary.active & roams)[:, None], wall, command)
        command = np.where((state == ACQUIRE)[:, None], acquire(edge, c), command)
        command = np.where(tracks[:, None], self._track(now, near, edge.error, tracks), command)
        # a bay: what comes next is ahead of it before it is nearest (ours)
        with np.errstate(invalid="ignore"):
            bay = (state >= ACQUIRE) & (edge.bearing > 0) & (now.room < c.nose_margin)
        command = np.where(bay[:, None], [c.least_speed, -c.top_turn], command)
        heading = np.where(state == MOVING, off, 0.0)
        heading = np.nan_to_num(np.where(state == ACQUIRE, edge.onto, heading))
        command = self._avoidance.apply(command, heading, edge.bearing, state, near, now.body)
        command = self._boundary.bound(command, wall, roams)
        # who does not know where it is, or tracks without a sensor, stands still
        blind = ~np.isfinite(now.pose).all(axis=1) | ((state >= ACQUIRE) & np.isnan(now.inside))
        command[blind] = 0.0
        self._speed = command[:, 0]
        return command

    def speak(self, now: Percepts) -> Array:
        """What each robot broadcasts (n, c), columns ``SPOKEN``."""
        relay = self.relay
        at = np.where(relay.origin >= 0, relay.told_at, np.nan)
        spoken = [now.pose, self.state, relay.place, at, relay.origin, relay.hops]
        return np.column_stack([*spoken, self._circles.radius, self._speed]).astype(np.float64)

    @property
    def hops(self) -> NDArray[np.int64]:
        """Over how many radios the news each robot holds came (n,)."""
        return self.relay.hops

    def tell(self, who: Flags, place: Array, time: float) -> None:
        """An operator tells robots ``who`` (n,) that a perimeter is at ``place`` (2,)."""
        self.relay.tell(who, place, time)

    def _track(self, now: Percepts, near: Neighbours, error: Array, tracks: Flags) -> Array:
        c = self.config
        # who acquires is on the perimeter too: whoever stands before it must make room (ours)
        apart = np.where(near.state >= ACQUIRE, near.apart, np.nan)
        if not c.desired:
            self._estimate(now, near.state == TRACKING)
        # whose circle is not known yet does not know that others are too near
        desired = np.where(np.isfinite(self.desired), self.desired, np.inf)
        wanted = np.where(np.isfinite(desired), desired, 1e3)
        forward = spacing(apart, near.bearing, wanted, c)
        joins = tracks & (self.entered == now.time)
        inside = self._doubt.believed(now.inside, self._speed, tracks)
        forward = self._doubt.limit(self._zigzag.speeds(forward, error, inside, tracks, joins))
        return np.column_stack([forward, bang_bang(inside, forward, c)])

    def _estimate(self, now: Percepts, others: Flags) -> None:
        """d_des from the number of robots that track and the mean of their circles' radii."""
        own = self._circles.radius
        heard = np.where(others, now.heard[..., percepts.RADIUS], np.nan)
        radii = np.column_stack([own, heard])
        good = np.isfinite(radii)
        count = good.sum(axis=1)
        mean = np.where(good, radii, 0.0).sum(axis=1) / np.maximum(count, 1)
        n = others.sum(axis=1) + 1
        share = self.config.factor or even_factors(n)
        chord = 2.0 * mean * np.sin(np.pi / np.maximum(n, 2))
        self.desired = np.where(count > 0, share * chord, np.nan)

    def _switch(self, now: Percepts, error: Array, tangent: Array) -> None:
        c, time = self.config, now.time
        # every sensor must be there: what cannot look to the side cannot take over
        senses = np.isfinite(error)
        self.sensed = np.where(np.isnan(self.sensed) & senses, time, self.sensed)
        lost = time - self._seen_at > c.lose_after
        with np.errstate(invalid="ignore"):
            aligned = (np.abs(error) < c.hand_over_error) & (np.abs(tangent) < c.hand_over_angle)
            # turning as slowly as bang-bang does, it must not get too near (ours)
            circle = c.track_speed / c.track_turn
            inwards = circle * (1.0 - np.cos(np.minimum(tangent, 0.0)))
            aligned &= error - inwards > -c.hand_over_error / 2.0
            astray = (np.abs(error) > 4.0 * c.hand_over_error) | (
                np.abs(tangent) > 3.0 * c.hand_over_angle
            )
        cues = {
            "senses": senses,
            "told": np.isfinite(self.relay.place[:, 0]) & (time - self.relay.told_at <= c.news_age),
            "misled": time > self._deadline,
            "aligned": aligned & np.isfinite(now.inside),
            "astray": astray,
            "lost": lost,
        }
        before = self.state.copy()
        moved = np.zeros(len(before), dtype=bool)
        for source, cue, target in TRANSITIONS:
            takes = (before == source) & cues[cue] & ~moved
            self.state[takes] = target
            moved |= takes
            if cue == "misled":
                self.relay.disbelieve(takes)
        self.entered = np.where(moved, time, self.entered)
        sets_out = moved & (self.state == MOVING)
        self._goal = np.where(sets_out[:, None], self.relay.place, self._goal)
        way = np.hypot(*(self._goal - now.pose[:, :2]).T)
        limit = time + way / c.search_speed + c.news_timeout
        self._deadline = np.where(sets_out, limit, self._deadline)
        self._deadline = np.where(self.state == MOVING, self._deadline, np.inf)
        own = self.relay.origin == np.arange(len(before))
        self.told |= sets_out & np.isnan(self.joined) & ~own
        joins = (self.state == TRACKING) & np.isnan(self.joined)
        self.joined = np.where(joins, time, self.joined)
