"""The explorer's own planner on scans, where it loses sight of its point."""

import numpy as np
import pytest

from controllers.helping import Settings
from experiments.helping_navigation import guide as module
from experiments.helping_navigation.guide import Guide

ANGLES = np.radians(np.arange(-180.0, 180.0))
GOAL = np.array([6.0, 0.0])
STEPS = 15  # of the 20 that a point may be out of sight


def _go(guide: Guide, start: float) -> None:
    """Steps along x, nothing around."""
    for k in range(STEPS):
        pose = np.array([start + 0.01 * k, 0.0, 0.0])
        guide.look(pose, np.full(360, np.inf), ANGLES)
        guide.step(pose, GOAL, np.full(360, np.inf), ANGLES)


@pytest.mark.parametrize("between", ["new_goal", "pause"])
def test_steps_without_sight_of_a_point_count_anew_with_a_new_line(monkeypatch, between):
    monkeypatch.setattr(module, "sees", lambda *_: False)
    guide = Guide("visbug", Settings(), np.array([10.0, 10.0]))
    _go(guide, 0.0)
    if between == "pause":
        guide.pause(np.zeros(3))
    else:
        guide.new_goal()
    _go(guide, 1.0)
    line = guide._line
    assert line is not None
    np.testing.assert_allclose(line[0], [1.0, 0.0])  # where it was drawn after that, and kept
    _go(guide, 2.0)  # 20 in a row are too many: another line
    line = guide._line
    assert line is not None
    assert line[0][0] > 2.0
