"""One run: the loop of the paper's experiment, whatever the field.

The experimenter puts the scout down in the nest, then each worker when it is due, and picks up who
has finished or driven for too long. All else the robots do.
"""

import math
from dataclasses import dataclass, field

import numpy as np

from controllers.scouting import LOOP, ScoutTeam
from controllers.scouting.machine import WAIT
from experiments.scout_workers.field import Array, Field, Flags, Senses, Tally

SCOUT_LIMIT, WORKER_LIMIT = 1800.0, 300.0  # s
RUN_LIMIT = 7200.0  # s, should the nest stay blocked


@dataclass(kw_only=True)
class Plan:
    """What the experimenter does.

    Attributes:
        finish: Who has seen the goal is picked up there (``remove``), stays (``park``), drives
            home and is picked up in the nest (``home``); ``search`` picks workers up and lets the
            scout search on.
        airtime: A message is repeated for this long [s].
        failure: ``none``; ``scout-killed``: the scout dies when it first sees the goal, before it
            sends; ``bad-checksum``: the scout's second byte is sent wrong; ``worker-dead``: the
            first worker dies half-way, where ``dies_beyond`` says.
        told: Vector given to the workers at the start (2,) [units], in place of a scout's; None.
        dies_beyond: x beyond which the first worker dies [m].
        patience: After a scout that cannot report, the run goes on for this long [s].
    """

    finish: str = "search"
    airtime: float = math.inf
    failure: str = "none"
    told: Array | None = None
    dies_beyond: float = math.inf
    patience: float = 60.0


@dataclass(kw_only=True)
class Outcome:
    """What came of a run; arrays over the team, NaN where nothing did.

    Attributes:
        left: When each robot was put down [s].
        found: When each saw the goal [s].
        found_after: The same, since it was put down [s].
        claimed: Its own reckoning when it saw the goal (n, 2) [units].
        goal_at: Where it really was then (n, 2) [m].
        way_at: Path length then [m].
        bumps_at: Loops with a pressed bumper until then, or until the end.
        first_valid: When a worker first knew a goal [s].
        reported: When the scout began to send [s].
        given_up: Picked up after too long a drive.
        died: Who was killed.
        tally: At the end.
        ended: [s].
        trails: Where the robots were in every loop (n, 2) [m], NaN where one does not run; kept
            only if asked for.
    """

    left: Array
    found: Array
    claimed: Array
    goal_at: Array
    way_at: Array
    bumps_at: Array
    given_up: Flags
    died: Flags
    first_valid: float = math.nan
    reported: float = math.nan
    tally: Tally | None = None
    ended: float = 0.0
    trails: list[Array] = field(default_factory=list)

    @property
    def found_after(self) -> Array:
        """Time from being put down to seeing the goal (n,) [s]."""
        return self.found - self.left


def run(where: Field, team: ScoutTeam, plan: Plan, *, keep_trails: bool = False) -> Outcome:
    """Run until every worker has finished or given up, or the scout has."""
    n = team.n
    nan = np.full(n, np.nan)
    out = Outcome(
        left=nan.copy(), found=nan.copy(), claimed=np.full((n, 2), np.nan),
        goal_at=np.full((n, 2), np.nan), way_at=nan.copy(), bumps_at=nan.copy(),
        given_up=np.zeros(n, dtype=bool), died=np.zeros(n, dtype=bool),
    )  # fmt: skip
    scouts = team.memory.role == 0
    gone = np.zeros(n, dtype=bool)
    if plan.told is not None:
        team.tell(plan.told)
    patience = math.inf
    while True:
        now = where.time
        receivers, groups = where.listen()
        team.hear(receivers, groups)
        if math.isnan(out.first_valid) and team.records.known[~scouts].any():
            out.first_valid = now
        _pick_up(where, team, plan, out, gone, now)
        for i in np.flatnonzero(team.released & ~gone & np.isnan(out.left)):
            if not where.put_down(int(i)):
                break
            out.left[i] = now
        senses = where.sense()
        _kill(where, team, plan, out, senses)
        running = where.running
        command = team.step(now, *senses, active=running)
        for i in np.flatnonzero(team.reports):
            _note(where, team, out, int(i), now)
            message = team.message(int(i))
            if scouts[i]:
                out.reported = now
                if plan.failure == "bad-checksum":
                    message = bytes([message[0], message[1] ^ 0x5A]) + message[2:]
            if message:
                where.transmit(int(i), message, plan.airtime)
        if keep_trails:
            place = where.tally().place
            place[~running] = np.nan
            out.trails.append(place)
        if plan.failure in ("scout-killed", "bad-checksum"):
            if math.isinf(patience) and (out.died[scouts].any() or not math.isnan(out.reported)):
                patience = now + plan.patience
            if now >= patience:
                break
        over = gone | out.died | ~np.isnan(out.found)
        if (over | scouts).all() and (over[scouts].all() or (~scouts).any()):
            break
        idle = (team.state[~scouts] == WAIT).all() and np.isnan(out.left[~scouts]).all()
        if scouts.any() and now >= SCOUT_LIMIT and idle and not team.records.known[~scouts].any():
            break
        if now >= RUN_LIMIT:
            break
        where.advance(command)
    out.ended = where.time
    out.tally = where.tally()
    missing = np.isnan(out.way_at)
    out.bumps_at[missing] = out.tally.bumps[missing]
    return out


def _pick_up(
    where: Field, team: ScoutTeam, plan: Plan, out: Outcome, gone: Flags, now: float
) -> None:
    """Take away who has finished, and workers that have driven for too long."""
    if plan.finish != "park":
        for i in np.flatnonzero(team.done & ~gone):
            where.take_away(int(i))
            gone[i] = True
    with np.errstate(invalid="ignore"):
        late = (now - out.left > WORKER_LIMIT - LOOP / 2) & (team.memory.role == 1)
    for i in np.flatnonzero(late & ~gone & np.isnan(out.found) & ~out.died):
        where.take_away(int(i))
        gone[i] = out.given_up[i] = True


def _kill(where: Field, team: ScoutTeam, plan: Plan, out: Outcome, senses: Senses) -> None:
    """Let die who is to."""
    if plan.failure == "scout-killed" and senses.goal[0] and not out.died[0]:
        where.kill(0)
        out.died[0] = True
    first = team.scouts
    if plan.failure == "worker-dead" and first < team.n and not out.died[first]:
        x = where.tally().place[first, 0]
        if not math.isnan(out.left[first]) and x > plan.dies_beyond:
            where.kill(first)
            out.died[first] = True


def _note(where: Field, team: ScoutTeam, out: Outcome, i: int, now: float) -> None:
    tally = where.tally()
    out.found[i] = now
    out.claimed[i] = team.memory.travelled[i]
    out.goal_at[i] = tally.place[i]
    out.way_at[i] = tally.way[i]
    out.bumps_at[i] = tally.bumps[i]
