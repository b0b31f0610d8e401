"""Mind: one robot's share of goal-sharing and state-sharing, fed by its own senses and its radio.

The controllers are the same as in the abstract trials; there one call works on the whole team, here
every robot calls them on a memory of its own, in which the rows of others are what they told.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from controllers.helping import goal_sharing, state_sharing
from controllers.helping.explorer import Settings, decide, next_point
from experiments.helping_navigation.words import enter, read, say

Array = NDArray[np.float64]
Sees = Callable[[Array], bool]


class Look:
    """What one robot perceived at one instant.

    Attributes:
        position: Its own in its own frame (2,) [m].
        distance: Of each robot (n,) [m]; NaN: not in sight.
        bearing: Of each robot in its own frame (n,) [rad].
        clear: Whether the straight way to each is free for its body (n,).
    """

    def __init__(self, position: Array, distance: Array, bearing: Array, clear: NDArray[np.bool_]):
        """Args: as the attributes."""
        self.position, self.distance, self.bearing = position, distance, bearing
        self.clear = clear & np.isfinite(distance)


class Mind:
    """What robot i of n knows, and what it goes to.

    Attributes:
        known: Goals, its own and others'.
        offered: Offers for its own goal.
        state: Trouble, its own and what others told of theirs.
    """

    def __init__(self, i: int, n: int, ghosts: int, settings: Settings, shares_state: bool):
        """Args: i: Which robot. n: Of the team. ghosts: It remembers. settings: Numbers.

        shares_state: Whether it goes to mates when in trouble.
        """
        self.i, self._n, self._settings, self._shares_state = i, n, settings, shares_state
        self.known = goal_sharing.memory(n, ghosts)
        self.offered = goal_sharing.offers(n, ghosts)
        self.state = state_sharing.untroubled(n)
        self._then: Look | None = None

    def aim_at(self, goal: Array) -> None:
        """Take a new goal (2,) [m] of one's own, in F_i."""
        goal_sharing.new_goal(self.known, self.offered, self.i, float(goal[0]), float(goal[1]))
        state_sharing.calm(self.state, self.i)

    def place_goal(self, goal: Array) -> None:
        """Correct where one's own goal lies (2,) [m] in F_i: localization moves it there."""
        self.known.goal[self.i, self.i] = goal

    def listen(self, messages: list[tuple[int, Array]]) -> None:
        """Hear what was said at the last look by who was in sight then.

        Args:
            messages: Sender and words, said at the instant of the last :meth:`look`.
        """
        then, i = self._then, self.i
        if then is None:
            return
        n, known = self._n, self.known
        heard = np.zeros((n, n), dtype=bool)
        position, distance, bearing = np.zeros((n, 2)), np.zeros((n, n)), np.zeros((n, n))
        position[i], distance[i], bearing[i] = then.position, then.distance, then.bearing
        for j, message in messages:
            words = read(message, n)
            self.state.trouble[j] = words.trouble
            # one who was not in sight, or says it did not see me, shares no line with me
            if not (then.clear[j] and np.isfinite(words.bearing[i])):
                continue
            enter(known, j, words)
            heard[i, j], position[j], bearing[j, i] = True, words.position, words.bearing[i]
        goal_sharing.share_goals(known, position, heard, distance, bearing)
        goal_sharing.reflect(
            known, self.offered, position, heard, distance, bearing, self._settings.keep_promise
        )

    def look(self, now: Look, sees: Sees) -> Array:
        """Check which goals and ghosts are in sight; returns what to say.

        Args:
            now: What it perceives.
            sees: Whether a place (2,) [m] in F_i is in sight and the way to it free.
        """
        known, i = self.known, self.i
        position = np.zeros((self._n, 2))
        position[i] = now.position
        for owner in np.flatnonzero(known.number[i]):
            if owner == i:
                continue
            count = known.ghosts[i, owner]
            ghost = known.path[i, owner, max(count - 1, 0)]
            goal_sharing.check_goal(
                known, position, i, owner, sees(known.goal[i, owner]), count == 0 or sees(ghost)
            )
        known.last[i] = now.position
        self._then = now
        return say(known, i, bool(self.state.trouble[i]), now.position, now.bearing)

    def decide(self, sees: Sees, sees_goal: bool, hears: NDArray[np.bool_]) -> tuple[int, Array]:
        """What to go to for one's own goal.

        Args:
            sees: As for :meth:`look`, whose instant this is.
            sees_goal: Whether its own goal is in sight.
            hears: From whom words came at the last instant (n,).

        Returns:
            Mode and target (2,) [m] in F_i.
        """
        now, i, n = self._then, self.i, self._n
        assert now is not None
        position, distance, bearing = np.zeros((n, 2)), np.zeros((n, n)), np.zeros((n, n))
        position[i], distance[i], bearing[i] = now.position, now.distance, now.bearing
        heard = np.zeros((n, n), dtype=bool)
        heard[i] = now.clear & hears
        x, y, there = next_point(self.offered, i)
        mode, tx, ty = decide(
            self.known, self.offered, self.state, i, position, heard, distance, bearing,
            sees_goal, there and sees(np.array([x, y])), self._settings,
            self._shares_state,
        )  # fmt: skip
        return mode, np.array([tx, ty])
