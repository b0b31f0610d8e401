"""What the physical trials run: a tour of targets, the trap, a standing chain, in MuJoCo."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from experiments.helping_navigation.crew import CrewSetup
from experiments.helping_navigation.journey import JourneySetup
from mjmr.faults import Fault
from mjmr.office import Office, load_office

Array = NDArray[np.float64]
_START = (8.0, 6.0)  # m: R1 in the corridor of world 1
# a chain in world 1: R1 in the upper right room sees R2, that R3, that R4, and that the goal
CHAIN_START = (14.6, 8.6)
CHAIN_GOAL = (3.9, 2.4)
CHAIN_POSTS = ((14.5, 5.9), (8.2, 6.2), (3.9, 5.9))
TRAP_START, TRAP_GOAL = (8.0, 5.0), (12.0, 5.0)


@cache
def office(name: str) -> Office:
    """One of the offices in the folder ``offices``, whose doors Pioneers fit through."""
    return load_office(Path(__file__).with_name("offices") / f"{name}.json", clearance=0.34)


def tour(
    place: Any, targets: ArrayLike, *, planner: str, robots: int, chain: bool, seed: int,
    lost: bool = False, err_max: float = 0.0, radio_loss: float = 0.0, wheel_error: float = 0.0,
    leg_time: float = 900.0, start: tuple[float, float] = _START, dead_after: float = np.inf,
) -> JourneySetup:  # fmt: skip
    """R1 visits targets, the others go round the office's first route.

    Args:
        place: An office with ``size``, ``walls`` and ``routes``.
        targets: Of R1 (k, 2) [m].
        planner: Of R1; the potential field goes with state-sharing.
        robots: How many, R1 included.
        chain: Whether whole ways are offered.
        seed: Draws the phase of the patrol, and frames if the supporters are lost.
        lost: Whether the supporters' own frames lie anywhere, turned by any angle.
        err_max: Of perceived distances.
        radio_loss: Share of messages lost.
        wheel_error: Of odometry, see :class:`CrewSetup`.
        leg_time: After which a target is given up [s].
        start: Of R1 (2,) [m].
        dead_after: The last supporter dies then [s].
    """
    rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(27, 1)))
    route = np.asarray(place.routes[0])
    helpers = robots - 1
    first = int(rng.integers(len(route)))
    phase = [(first + len(route) * k // max(helpers, 1)) % len(route) for k in range(helpers)]
    # on the way to the first waypoint, where that is farthest from R1
    starts: list[tuple[float, ...]] = [(*start, 0.0)]
    for p in phase:
        before, ahead = route[p - 1], route[p]
        away = ahead - before
        spots = before + np.linspace(0.1, 0.9, 9)[:, None] * away
        clear = np.array([min(np.hypot(*(s - q[:2])) for q in starts) for s in spots])
        starts.append((*spots[int(np.argmax(clear))], float(np.arctan2(away[1], away[0]))))
    frames = np.zeros((robots, 3))
    frames[0] = starts[0]  # R1 knows where it is, or it would not know where its goals are
    draw = rng.uniform([-20, -20, -np.pi], [20, 20, np.pi], (helpers, 3))
    if lost:
        frames[1:] = draw
    faults = []
    if dead_after < np.inf and helpers:
        faults.append(Fault(kind="dead", robot=robots - 1, start=dead_after))
    return JourneySetup(
        crew=CrewSetup(
            office={"size": place.size, "walls": place.walls},
            starts=np.array(starts),
            frames=frames,
            err_max=err_max,
            radio_loss=radio_loss,
            wheel_error=wheel_error,
        ),
        targets=np.asarray(targets, dtype=np.float64),
        planner=planner,
        chain=chain,
        shares_state=planner == "potential-field",
        routes=[route] * helpers,
        phase=phase,
        leg_time=leg_time,
        faults=faults,
    )


def trap(
    place: Any, *, shares_state: bool, robots: int, seed: int, leg_time: float = 1500.0,
    chain: bool = False,
) -> JourneySetup:  # fmt: skip
    """R1 in a dead end with its goal behind the wall, and a potential field (figures 9 and 10).

    Args:
        place: The office called trap.
        shares_state: Whether R1 goes to mates when in trouble.
        robots: R1 included.
        seed: Draws the phase of the patrol.
        leg_time: Duration at most [s].
        chain: Whether whole ways are offered.
    """
    rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(27, 2)))
    helpers = robots - 1
    route = np.asarray(place.routes[0])
    first = int(rng.integers(len(route)))
    phase = [(first + len(route) * k // max(helpers, 1)) % len(route) for k in range(helpers)]
    starts: list[tuple[float, ...]] = [(*TRAP_START, 0.0)]
    for p in phase:
        away = route[p] - route[p - 1]
        starts.append((*(route[p - 1] + 0.5 * away), float(np.arctan2(away[1], away[0]))))
    return JourneySetup(
        crew=CrewSetup(
            office={"size": place.size, "walls": place.walls},
            starts=np.array(starts),
            frames=np.vstack([starts[0], np.zeros((helpers, 3))]),
            marks=np.array([TRAP_GOAL]),
        ),
        targets=np.array([TRAP_GOAL]),
        planner="potential-field",
        chain=chain,
        shares_state=shares_state,
        routes=[route] * helpers,
        phase=phase,
        leg_time=leg_time,
    )


def standing_chain(
    place: Any, *, planner: str, seed: int, dead: bool = False, radio_loss: float = 0.0,
    lost: bool = False, chain: bool = False, leg_time: float = 900.0,
) -> JourneySetup:  # fmt: skip
    """R1 sees its goal by three mirrors that stand in world 1.

    Args:
        place: World 1.
        planner: Of R1.
        seed: Draws R1's heading, and frames if the supporters are lost.
        dead: Whether the middle relay is dead from the start.
        radio_loss: Share of messages lost.
        lost: Whether the supporters' own frames lie anywhere.
        chain: Whether whole ways are offered.
        leg_time: Duration at most [s].
    """
    rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(27, 3)))
    starts = np.array([(*p, rng.uniform(-np.pi, np.pi)) for p in (CHAIN_START, *CHAIN_POSTS)])
    starts[0, :2] += rng.uniform(-0.2, 0.2, 2)
    frames = np.zeros((len(starts), 3))
    frames[0] = starts[0]
    draw = rng.uniform([-20, -20, -np.pi], [20, 20, np.pi], (len(starts) - 1, 3))
    if lost:
        frames[1:] = draw
    return JourneySetup(
        crew=CrewSetup(
            office={"size": place.size, "walls": place.walls},
            starts=starts,
            frames=frames,
            radio_loss=radio_loss,
        ),
        targets=np.array([CHAIN_GOAL]),
        planner=planner,
        chain=chain,
        shares_state=False,
        routes=[np.array([post]) for post in CHAIN_POSTS],
        leg_time=leg_time,
        faults=[Fault(kind="dead", robot=2, start=0.0)] if dead else [],
    )
