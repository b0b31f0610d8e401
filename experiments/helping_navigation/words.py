"""What robots say: one radio message with all that goal-sharing and state-sharing tell.

A message is an array of numbers: trouble, own position in one's own frame, the bearing at which
one sees each robot of the team (NaN: not in sight), and for each owner whose goal one knows its
Id, goal, D and ghosts.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from controllers.helping.goal_sharing import Memory

Array = NDArray[np.float64]
_OWNER = 7  # numbers an owner takes without its ghosts


class Words(NamedTuple):
    """A message, read.

    Args:
        trouble: Whether the sender is in trouble.
        position: Of the sender in its own frame (2,) [m].
        bearing: At which it sees each robot, in its own frame (n,) [rad].
        owners: Rows of numbers as they were sent, one for each goal it knows.
    """

    trouble: bool
    position: Array
    bearing: Array
    owners: list[Array]


def say(known: Memory, i: int, trouble: bool, position: Array, bearing: Array) -> Array:
    """What robot i tells.

    Args:
        known: Its memory.
        i: The robot.
        trouble: Whether it is in trouble.
        position: Its own (2,) [m], in F_i.
        bearing: At which it sees each robot (n,) [rad], in F_i; NaN: not in sight.

    Returns:
        The message.
    """
    parts = [np.array([float(trouble), *position]), bearing]
    for o in np.flatnonzero(known.number[i]):
        count = int(known.ghosts[i, o])
        parts.append(
            np.array([
                o, known.number[i, o], *known.goal[i, o], known.distance[i, o],
                known.ghost_distance[i, o], count,
            ])
        )  # fmt: skip
        parts.append(known.path[i, o, :count].ravel())
    return np.concatenate(parts)


def read(message: Array, n: int) -> Words:
    """Read a message of a team of n."""
    owners, at = [], 3 + n
    while at < len(message):
        end = at + _OWNER + 2 * int(message[at + 6])
        owners.append(message[at:end])
        at = end
    return Words(bool(message[0]), message[1:3], message[3 : 3 + n], owners)


def enter(known: Memory, j: int, words: Words) -> None:
    """Put what robot j told into its row of one's own memory, which others' rows are copies of."""
    known.number[j], known.ghosts[j] = 0, 0
    known.distance[j] = known.ghost_distance[j] = np.inf
    for row in words.owners:
        o, count = int(row[0]), int(row[6])
        known.number[j, o], known.goal[j, o] = int(row[1]), row[2:4]
        known.distance[j, o], known.ghost_distance[j, o], known.ghosts[j, o] = row[4], row[5], count
        known.path[j, o, :count] = row[_OWNER:].reshape(-1, 2)
