import numpy as np

from controllers.helping.state_sharing import find_mate, measure, untroubled


def _stuck_then_progressing(state, level, steps):
    """Stuck until in trouble, then nearer every step; returns steps until out of trouble."""
    while not state.trouble[0]:
        measure(state, 0, 0, 5.0, 0.1, level)
    for _ in range(steps):  # stuck some more: the pressure goes to its cap
        measure(state, 0, 0, 5.0, 0.1, level)
    far, count = 50.0, 0
    measure(state, 0, 1, far, 0.1, level)
    while state.trouble[0]:
        far -= 0.2
        count += 1
        measure(state, 0, 1, far, 0.1, level)
    return count


def test_each_follow_lasts_longer():
    state = untroubled(2)
    lengths = [_stuck_then_progressing(state, 5, 100) for _ in range(4)]
    assert lengths == [5, 10, 15, 20]  # Nt * Cr
    assert state.transitions[0] == 5


def test_steps_that_cancel_are_no_progress():
    state = untroubled(1)
    for k in range(60):
        measure(state, 0, 0, 3.0 + 0.15 * (k % 2), 0.1, 20)
    assert state.trouble[0]


def test_a_mate_in_trouble_is_no_help_and_the_last_place_is_kept():
    state = untroubled(3)
    state.trouble[0] = True
    position = np.zeros((3, 2))
    heard = np.zeros((3, 3), dtype=bool)
    distance, bearing = np.full((3, 3), 2.0), np.zeros((3, 3))
    heard[0, 1] = heard[0, 2] = True
    distance[0, 1] = 1.0
    state.trouble[1] = True
    assert find_mate(state, 0, position, heard, distance, bearing, 0.01)
    assert state.mate[0] == 2
    assert state.follows[0] == 1
    heard[:] = False
    assert find_mate(state, 0, position, heard, distance, bearing, 0.01)
    position[0] = [2.0, 0.0]  # there, and nobody in sight: it waits
    assert find_mate(state, 0, position, heard, distance, bearing, 0.01)
    assert state.waits[0]
    np.testing.assert_allclose(state.place[0], [2.0, 0.0])
    heard[0, 2] = True
    assert find_mate(state, 0, position, heard, distance, bearing, 0.01)
    assert state.follows[0] == 2
    state.trouble[0] = False
    assert not find_mate(state, 0, position, heard, distance, bearing, 0.01)
