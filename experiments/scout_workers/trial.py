"""One trial: the experiment its condition names."""

import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from controllers.scouting import UNIT, Codec, ScoutTeam
from controllers.scouting.records import kinds_needed
from experiments.scout_workers import bug2, open_field, stream, study, trap
from experiments.scout_workers.field import Array, Field, Setting
from experiments.scout_workers.mazes import maze
from experiments.scout_workers.options import Given, behaviour, compass
from experiments.scout_workers.physical import PhysicalField
from experiments.scout_workers.planar import PlanarField
from experiments.scout_workers.run import Outcome, Plan, run
from experiments.scout_workers.shortest import of_maze
from mjmr.byte_channel import ByteTiming
from mjmr.errors import InvalidInputError
from mjmr.randomness import Streams

Metrics = dict[str, float | int | bool | None]
FIELDS = {"planar": PlanarField, "physical": PhysicalField}
AIRTIME = 5.0  # s, of a message where finishers send too
CORRIDOR_MIDDLE = 1.3  # m, beyond which the first worker dies there


def trial(condition: Given, seed: int) -> Metrics:
    """Run one experiment.

    Args:
        condition: See the study's parameters.
        seed: Of the trial.

    Raises:
        InvalidInputError: The mode has no such experiment.
    """
    experiments: dict[str, tuple[tuple[str, ...], Callable[[Given, int], Metrics]]] = {
        "maze": (("planar", "physical"), pair),
        "succession": (("planar", "physical"), succession),
        "scaling": (("planar", "physical"), scaling),
        "open": (("planar",), open_field.open_field),
        "trap": (("planar",), trap.trap),
        "phase": (("radio",), stream.phase),
        "errors": (("radio",), stream.errors),
        "codes": (("radio",), stream.codes),
    }
    modes, function = experiments[condition["experiment"]]
    if condition["mode"] not in modes:
        raise InvalidInputError(
            f"experiment {condition['experiment']} is of mode {' or '.join(modes)}; got "
            f"{condition['mode']}"
        )
    return function(condition, seed)


def build(given: Given, seed: int) -> tuple[Field, ScoutTeam, Plan]:
    """Field, controllers and plan of a condition that is run in a maze."""
    place = maze(given["maze"])
    n = given["robots"]
    codec = Codec(given["check"], kinds_needed(given["succession"]))
    told = behaviour(given)
    team = ScoutTeam(n, rng=Streams(seed).generator("controllers"), behaviour=told, codec=codec)
    setting = Setting(
        n=n,
        seed=seed,
        size=place.size,
        blocks=place.blocks,
        nest=place.nest,
        goal=place.goal,
        compass=compass(given),
        servo_spread=given["servo_pct"] / 100.0,
        timing=ByteTiming(bit_error=given["bit_error"]),
        codec=codec,
        blind=(np.arange(n) >= team.scouts) & (given["failure"] == "ir-dead"),
    )
    plan = Plan(
        finish=given["finish"],
        airtime=math.inf if given["succession"] == "none" else AIRTIME,
        failure=given["failure"],
        told=(place.goal - place.nest) / UNIT if given["vector"] == "exact" else None,
        dies_beyond=CORRIDOR_MIDDLE,
    )
    return FIELDS[given["mode"]](setting), team, plan


def _run(given: Given, seed: int) -> tuple[Outcome, Metrics]:
    field, team, plan = build(given, seed)
    start = time.process_time()
    out = run(field, team, plan)
    assert out.tally is not None
    read, accepted, dropped, undetected = out.tally.groups
    place = maze(given["maze"])
    error = np.hypot(*(out.claimed[0] * UNIT + place.nest - out.goal_at[0]))
    return out, {
        "scout_s": _number(out.found_after[0]),
        "scout_error_m": _number(float(error)),
        "latency_s": _number(out.first_valid - out.reported),
        "groups_read": read,
        "groups_accepted": accepted,
        "groups_dropped": dropped,
        "groups_undetected": undetected,
        "hidden": int(out.tally.hidden.sum()),
        "left": int(np.isfinite(out.left[1:]).sum()),
        "ended_s": out.ended,
        "wall_real_time": out.ended / max(time.process_time() - start, 1e-9),
    }


def pair(given: Given, seed: int) -> Metrics:
    """Scout and workers in a maze; the last worker is the one that is looked at.

    A scout that finds nothing in 1800 s counts as a worker that does not arrive.
    """
    out, metrics = _run(given, seed)
    last = given["robots"] - 1
    way = out.way_at[last] / of_maze(given["maze"])
    hands = bug2.of_maze(given["maze"])
    return metrics | {
        "over_bug2": _number(out.way_at[last] / min(hands)),
        "bug2_ratio": min(hands) / of_maze(given["maze"]),
        "bug2_other_ratio": max(hands) / of_maze(given["maze"]),
        "success": bool(np.isfinite(out.found[last])),
        "worker_s": _number(out.found_after[last]),
        "path_ratio": _number(way),
        "bumps": int(out.bumps_at[last]),
        "died": int(out.died.sum()),
    }


def succession(given: Given, seed: int) -> Metrics:
    """Ten workers or more one after the other: their ways over the shortest one."""
    out, metrics = _run(given, seed)
    ways = out.way_at[1:] / of_maze(given["maze"])
    metrics |= {f"path_{k + 1:02d}": _number(w) for k, w in enumerate(ways)}
    there = np.isfinite(ways)
    number = np.arange(1, len(ways) + 1)
    slope = np.polyfit(number[there], ways[there], 1)[0] if there.sum() > 2 else math.nan
    return metrics | {
        "success": float(there.mean()),
        "path_early": _mean(ways[:3]),
        "path_late": _mean(ways[-3:]),
        "slope": _number(float(slope)),
    }


def scaling(given: Given, seed: int) -> Metrics:
    """Many workers at once: the share that sees the goal within 300 s."""
    out, metrics = _run(given, seed)
    ways = out.way_at[1:] / of_maze(given["maze"])
    return metrics | {
        "success": float(np.isfinite(out.found[1:]).mean()),
        "worker_s": _median(out.found_after[1:]),
        "path_ratio": _median(ways),
        "bumps": float(out.bumps_at[1:].mean()),
    }


def prepare() -> None:
    """Compile what the trials need: a run on the plane, and a moment in MuJoCo."""
    trial(study.condition(vector="exact"), 0)
    field, team, _ = build(study.condition(mode="physical"), 0)
    field.put_down(0)
    for _ in range(4):
        field.advance(team.step(field.time, *field.sense(), active=field.running))


def _number(value: Any) -> float | None:
    return float(value) if math.isfinite(value) else None


def _mean(values: Array) -> float | None:
    there = values[np.isfinite(values)]
    return float(there.mean()) if len(there) else None


def _median(values: Array) -> float | None:
    there = values[np.isfinite(values)]
    return float(np.median(there)) if len(there) else None
