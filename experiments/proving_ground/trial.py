"""One trial: the test its condition names, on the platform its condition names."""

import importlib
from collections.abc import Mapping
from typing import Any

from experiments.proving_ground.course import Metrics
from mjmr.errors import UnknownNameError
from mjmr.robots import PLATFORMS

MODULES = {
    "pioneer2dx": "pioneer",
    "koala": "koala",
    "aibo_ers7": "aibo",
    "tamiya_txt1": "txt1",
    "nims": "nims",
    "round_pusher": "round_pusher",
    "soccer_bot": "soccer",
    "tj_pro": "tj_pro",
    "four_wheeler": "four_wheeler",
    "sensors": "sensors",
}


def module(platform: str) -> Any:
    """Module that has the tests (``TESTS``) and the claims of a platform."""
    return importlib.import_module(f"experiments.proving_ground.{MODULES[platform]}")


def trial(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Run one test.

    Args:
        condition: See the study's parameters.
        seed: Of the trial.

    Raises:
        UnknownNameError: The platform has no such test; lists those it has.
    """
    tests = module(condition["platform"]).TESTS
    if condition["platform"] in PLATFORMS:
        from experiments.proving_ground.noise import noise

        tests = {**tests, "noise": noise}
    if condition["test"] not in tests:
        raise UnknownNameError(f"test of {condition['platform']}", condition["test"], tests)
    return tests[condition["test"]](condition, seed)


def prepare() -> None:
    """Compile what the trials need, by driving one robot a moment."""
    from experiments.proving_ground.course import hall
    from mjmr.robots.pioneer2dx import Pioneer2DX
    from mjmr.simulation import Simulation

    world = hall(2.0)
    world.add_group(Pioneer2DX, [[0.0, 0.0, 0.0]])
    for _ in Simulation(world).ticks(0.05):
        pass
