"""State-sharing: a robot in trouble goes to one in sight that is not.

Source: Sgorbissa and Arkin, section 5. ``Tr`` flips at ``Cr`` although ``Pr`` is capped at ``Nt *
Cr``: ``Cr`` is read as the level and ``Nt * Cr`` as the cap, so that each later follow can last
longer. Progress is a new smallest distance to the present target, started again when the target
changes: from step to step, distances in a local minimum go up and down.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mjmr.jit import njit


class Trouble(NamedTuple):
    """State of n robots.

    Args:
        transitions: Nt (n,), from 1.
        pressure: Pr (n,).
        trouble: Tr (n,).
        target: A number for what each robot goes to (n,); another number is another target.
        best: Smallest distance to it so far (n,) [m].
        mate: Whom each robot goes to for help (n,); -1 nobody.
        waits: Whether it stands where it saw its mate last (n,).
        place: Where it last saw it (n, 2) [m], in its own frame.
        follows: How often each robot went to a mate (n,), since the start.
    """

    transitions: NDArray[np.int64]
    pressure: NDArray[np.int64]
    trouble: NDArray[np.bool_]
    target: NDArray[np.int64]
    best: NDArray[np.float64]
    mate: NDArray[np.int64]
    waits: NDArray[np.bool_]
    place: NDArray[np.float64]
    follows: NDArray[np.int64]


def untroubled(n: int) -> Trouble:
    """State of ``n`` robots at the start."""
    return Trouble(
        transitions=np.ones(n, dtype=np.int64),
        pressure=np.zeros(n, dtype=np.int64),
        trouble=np.zeros(n, dtype=np.bool_),
        target=np.full(n, -1, dtype=np.int64),
        best=np.full(n, np.inf),
        mate=np.full(n, -1, dtype=np.int64),
        waits=np.zeros(n, dtype=np.bool_),
        place=np.zeros((n, 2)),
        follows=np.zeros(n, dtype=np.int64),
    )


@njit
def calm(state, i):
    """Robot i starts afresh: at a new goal."""
    state.transitions[i], state.pressure[i], state.trouble[i] = 1, 0, False
    state.target[i], state.best[i] = -1, np.inf
    leave_mate(state, i)


@njit
def leave_mate(state, i):
    """Robot i goes elsewhere."""
    state.mate[i], state.waits[i] = -1, False


@njit
def measure(state, i, target, distance, closer, level):
    """Rule 1: one step's progress of robot i, and what it makes of its state.

    Args:
        state: Changed in place.
        i: The robot.
        target: A number for what it goes to.
        distance: To it [m].
        closer: Progress means nearer by at least this [m].
        level: Cr.
    """
    if target != state.target[i]:
        state.target[i], state.best[i] = target, distance
        return
    if distance <= state.best[i] - closer:
        state.best[i] = distance
        state.pressure[i] = max(0, state.pressure[i] - 1)
    else:
        most = state.transitions[i] * level
        state.pressure[i] = min(most, state.pressure[i] + state.transitions[i])
    if state.pressure[i] >= level:
        state.trouble[i] = True
    elif state.trouble[i] and state.pressure[i] == 0:
        state.trouble[i] = False
        state.transitions[i] += 1


@njit
def find_mate(state, i, position, heard, distance, bearing, arrive):
    """Rules 2 and 3: whom robot i goes to, in ``state.mate[i]`` and ``state.place[i]``.

    It keeps to the mate it has while that is in sight and not in trouble, else takes the nearest
    one that is. If none is in sight, it goes where it saw its mate last and waits there: the mate
    stays its target until it is out of trouble (mate -1 then, so that seeing one again is another
    target and another follow).

    Args:
        state: Changed in place.
        i: The robot.
        position: Own positions (n, 2) [m], row i in F_i.
        heard: Shape (n, n): whether i hears j.
        distance: Shape (n, n) [m]: of j as i perceives it.
        bearing: Shape (n, n) [rad]: of j in F_i as i perceives it.
        arrive: At the place of a mate that has left when nearer than this [m].

    Returns:
        Whether it goes to a mate.
    """
    if not state.trouble[i]:
        leave_mate(state, i)
        return False
    mate = state.mate[i]
    if mate >= 0 and not heard[i, mate]:
        far = np.hypot(state.place[i, 0] - position[i, 0], state.place[i, 1] - position[i, 1])
        if far < arrive:
            state.mate[i], state.waits[i] = -1, True
    mate = state.mate[i]
    if mate < 0 or not heard[i, mate] or state.trouble[mate]:
        nearest = np.inf
        for j in range(heard.shape[0]):
            if j != i and heard[i, j] and not state.trouble[j] and distance[i, j] < nearest:
                nearest, mate = distance[i, j], j
    if mate < 0:
        return state.waits[i]
    if state.mate[i] < 0:
        state.follows[i] += 1
    state.mate[i], state.waits[i] = mate, False
    if heard[i, mate]:
        state.place[i, 0] = position[i, 0] + distance[i, mate] * np.cos(bearing[i, mate])
        state.place[i, 1] = position[i, 1] + distance[i, mate] * np.sin(bearing[i, mate])
    return True
