"""Looking on."""

import numpy as np
import pytest

from mjmr.errors import MjmrError
from mjmr.kinematics import KinematicSimulation
from mjmr.recording import record
from mjmr.watch import watching
from tests.mjmr.worlds import BOTH, soccer

POSES = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]


@pytest.mark.parametrize("kind", BOTH)
def test_watchers_see_what_is_built_inside_and_nothing_else(kind):
    outer, inner = [], []
    with watching(outer.append):
        with watching(inner.append):
            both = kind(soccer(POSES)[0])
        one = kind(soccer(POSES)[0])
    kind(soccer(POSES)[0])
    assert inner == [both]
    assert outer == [both, one]


def test_notes_are_kept_only_when_somebody_keeps_them():
    simulation = KinematicSimulation(soccer(POSES)[0])
    simulation.note(goals=np.zeros((2, 2)))
    assert simulation.notes == {}
    simulation.noted = True
    simulation.note(goals=np.ones((2, 2)))
    assert simulation.notes["goals"].tolist() == [[1.0, 1.0]] * 2


def test_a_trial_without_a_simulation_cannot_be_recorded():
    with pytest.raises(MjmrError, match="no simulation"):
        record(lambda condition, seed: {}, {}, 0)
