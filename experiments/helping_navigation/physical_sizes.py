"""How much of the physical mode each size runs; sizes.py adds these to the point robots' grids."""

from mjmr.conditions import Grid

_EXPLORING = ("avoid-past", "visbug")
_READINGS = ("literal", "chain")
_STATE = {"planner": "potential-field", "shares_state": True}
_P = {"mode": "physical"}
MEASURED_ERROR = 0.1  # err_max of the noise, above what markers were seen with on other seeds


def _tours(targets: int, seeds: int) -> tuple[Grid, ...]:
    common = {**_P, "targets": targets, "seeds": seeds}
    return (
        Grid(planner=_EXPLORING, **common),
        Grid(planner=_EXPLORING, robots=4, reading=_READINGS, **common),
        Grid(robots=4, reading=_READINGS, **_STATE, **common),
    )


def _faults(targets: int, seeds: int) -> tuple[Grid, ...]:
    common = {
        **_P, "planner": "avoid-past", "robots": 4, "reading": "chain", "targets": targets,
        "seeds": seeds,
    }  # fmt: skip
    return (
        Grid(fault=("dead", "radio", "lost"), **common),
        Grid(**common),
        Grid(noise=True, err_max=MEASURED_ERROR, **common),
    )


def _trap(seeds: int) -> Grid:
    return Grid(
        **_P, scene="trap", world="trap", planner="potential-field", robots=2, reading="literal",
        shares_state=(False, True), targets=1, seeds=seeds,
    )  # fmt: skip


def _chain(seeds: int) -> tuple[Grid, ...]:
    common = {**_P, "scene": "chain", "robots": 4, "targets": 1, "seeds": seeds}
    return (
        Grid(planner="avoid-past", reading=_READINGS, **common),
        Grid(planner=_EXPLORING, reading="literal", fault=("dead", "radio"), **common),
        Grid(planner="avoid-past", reading="literal", fault="lost", **common),
    )


def _markers(looks: int, seeds: int) -> Grid:
    return Grid(**_P, scene="markers", robots=4, reading="chain", targets=looks, seeds=seeds)


PHYSICAL = {
    "quick": (
        Grid(
            **_P, scene="chain", planner="avoid-past", robots=4, reading="chain", targets=1, seeds=1
        ),
        _markers(3, 1),
    ),
    "standard": (*_tours(20, 1), *_faults(10, 1), _trap(3), *_chain(4), _markers(40, 2)),
    "full": (*_tours(20, 3), *_faults(20, 3), _trap(10), *_chain(10), _markers(60, 5)),
}
