"""How much each size runs: the same experiments, with other numbers.

Paired conditions share their list of maps: both c of foraging push the same discs.
"""

from collections.abc import Sequence

from mjmr.conditions import Grid
from mjmr.study import Size

LIMIT = 2620.0  # s, the paper's
SHORT = 60.0  # s, in which transport's table over p is asked
LONG = 300.0  # s, that three robots may take for weight 2, and that failures are watched for
P = (0.0, 1.0, 2.0, 3.0, 4.0)
FORAGING = {"task": "foraging", "p": 1.0}
CONSTRUCTION = {"task": "construction", "b": True}
TRANSPORT = {"task": "transport", "c": 1.0}
TOO_FEW = ((1, 1), (2, 1), (2, 2))  # weight, robots
WEIGHTS = (0, 1, 2)
HEADINGS = (0.0, 22.0, 45.0, 90.0)  # deg
OFF_NORMALS = (60.0, 67.5, 75.0)  # deg
TIMESTEPS = (10.0, 5.0)  # ms


def pushing_grids(seeds: int, timesteps: Sequence[float] = TIMESTEPS) -> list[Grid]:
    """Conditions of every test of :mod:`experiments.versatile_pushing.pushing`, by their task."""
    dt = tuple(timesteps)
    return [
        Grid(task="stall", dt_ms=dt, seeds=seeds),
        Grid(task="held", weight=(1, 2), heading_deg=HEADINGS, dt_ms=dt, seeds=seeds),
        Grid(
            task=("moved", "moved-from-rest"), weight=WEIGHTS, heading_deg=HEADINGS, dt_ms=dt,
            seeds=seeds,
        ),
        Grid(task="wedged", weight=1, off_normal_deg=OFF_NORMALS, dt_ms=dt, seeds=seeds),
        Grid(task="wedged-anywhere", weight=1, dt_ms=dt, seeds=4 * seeds),
    ]  # fmt: skip


QUICK = Size(
    "quick",
    grids=(
        Grid(**FORAGING, map=(0, 1), c=(0.0, 1.0), duration=LONG, seeds=1),
        Grid(**CONSTRUCTION, map=0, duration=LONG, seeds=1),
        Grid(**TRANSPORT, weight=1, robots=(2, 3), p=(0.0, 2.0, 4.0), duration=SHORT, seeds=2),
        Grid(**TRANSPORT, weight=1, robots=1, p=2.0, duration=SHORT, seeds=1),
        Grid(**TRANSPORT, weight=1, robots=3, p=2.0, failure="stopped", duration=SHORT, seeds=1),
        Grid(**TRANSPORT, weight=1, robots=2, p=2.0, failure="camera", duration=SHORT, seeds=1),
        Grid(**TRANSPORT, weight=1, robots=2, p=0.0, recovery=True, duration=SHORT, seeds=1),
        Grid(task="vision", duration=9.0, seeds=1),
        *pushing_grids(1, (10.0,)),
    ),
    default_seeds=1,
    expected_minutes=0.4,
    note="two maps, one or two trials of each kind; shows the values, decides few claims",
)


def _whole(
    maps: int, foraging: int, nests: int, construction: int, trials: int, limit: float
) -> tuple[Grid, ...]:
    """Grids of a large size.

    Args:
        maps: Of foraging.
        foraging: Trials of each map and c.
        nests: Maps of construction.
        construction: Trials of each.
        trials: Of each weight, team and p.
        limit: What transport of weights 0 and 2 may take [s].
    """
    table = {"p": P, "seeds": trials}
    few = tuple(
        Grid(**TRANSPORT, weight=w, robots=n, p=2.0, duration=LIMIT, seeds=1) for w, n in TOO_FEW
    )
    stops = tuple(
        Grid(
            **TRANSPORT, weight=w, robots=(w + 1, w + 2), p=2.0, failure="stopped",
            duration=LONG, seeds=trials,
        )
        for w in (1, 2)
    )  # fmt: skip
    spares = tuple(
        Grid(
            **TRANSPORT, weight=w, robots=w + 2, p=2.0, failure="stopped", recovery=True,
            duration=LONG, seeds=trials,
        )
        for w in (1, 2)
    )  # fmt: skip
    return (
        Grid(**FORAGING, map=tuple(range(maps)), c=(0.0, 1.0), duration=LIMIT, seeds=foraging),
        Grid(**CONSTRUCTION, map=tuple(range(nests)), duration=LIMIT, seeds=construction),
        Grid(**TRANSPORT, **table, weight=1, robots=(3, 4), duration=SHORT),
        Grid(**TRANSPORT, weight=1, robots=2, p=P[:-1], duration=SHORT, seeds=trials),
        # neither 0 nor 100 %: a share against a bound between wants more trials
        Grid(**TRANSPORT, weight=1, robots=2, p=P[-1], duration=SHORT, seeds=max(trials, 20)),
        Grid(**TRANSPORT, **table, weight=0, robots=(1, 2, 3, 4), duration=limit),
        Grid(**TRANSPORT, **table, weight=2, robots=(3, 4), duration=limit),
        *few,
        *stops,
        *spares,
        Grid(
            **TRANSPORT, weight=1, robots=2, p=2.0, failure="camera", duration=SHORT, seeds=trials
        ),
        Grid(**TRANSPORT, **table, weight=1, robots=(2, 3, 4), recovery=True, duration=120.0),
        Grid(**TRANSPORT, weight=1, robots=1, p=2.0, recovery=True, duration=LONG, seeds=trials),
        Grid(task="vision", map=(0, 1, 2), duration=45.0, seeds=1),
        Grid(**FORAGING, map=(0, 1, 2), vision="camera", duration=LIMIT, seeds=1),
        Grid(**CONSTRUCTION, map=0, vision="camera", duration=LIMIT, seeds=1),
        Grid(**TRANSPORT, weight=1, robots=2, p=2.0, vision="camera", duration=SHORT, seeds=3),
        *pushing_grids(3),
    )


STANDARD = Size(
    "standard", grids=_whole(30, 1, 6, 2, 6, LONG), default_seeds=6, expected_minutes=12.0
)
FULL = Size(
    "full",
    grids=(
        *_whole(30, 10, 3, 10, 10, LIMIT),
        Grid(**TRANSPORT, weight=1, robots=(2, 3, 4), p=P, duration=LIMIT, seeds=10),
    ),
    default_seeds=10,
    expected_minutes=120.0,
    note="the paper's own counts: 30 x 10 x 2, 3 x 10 and 45 x 10 trials of at most 2,620 s",
)
