"""Getting up: which sequence a fallen robot plays next, until it stands or has had enough."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.legged.keyframes import KeyframePlayer, Keyframes
from controllers.legged.posture import BACK, LEFT, RIGHT, STANDING
from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True)
class GetUpPlan:
    """How a robot gets up.

    Attributes:
        stand: With its belly down.
        off_left: From its left side to the belly.
        off_right: From its right side.
        off_back_left: From its back, when that leans to the left; keyframes that roll a robot
            over its left side would fight its weight otherwise.
        off_back_right: The same to the right.
        tries: Most times that it begins from wherever it lies.
    """

    stand: Keyframes
    off_left: Keyframes
    off_right: Keyframes
    off_back_left: Keyframes
    off_back_right: Keyframes
    tries: int = 5

    def __post_init__(self):
        if self.tries < 1:
            raise InvalidInputError(f"tries must be 1 or more; got {self.tries}")

    @property
    def sequences(self) -> tuple[Keyframes, ...]:
        """In the order :class:`GetUp` expects them in its player."""
        backs = self.off_back_left, self.off_back_right
        return self.stand, self.off_left, self.off_right, *backs


class GetUp:
    """Decides for n robots, each whenever its sequence is over.

    A robot that lies on a side or its back rolls onto its belly; from there, or if its trunk is
    upright, it stands up. If that does not end in an upright trunk it tries again.

    Attributes:
        active: Robots that are getting up (n,).
        tries: How often they have begun (n,).
    """

    def __init__(self, player: KeyframePlayer, first: int, n: int, tries: int):
        """Start with nobody getting up.

        Args:
            player: Whose sequences from ``first`` are those of :attr:`GetUpPlan.sequences`.
            first: Index of the first of them.
            n: Number of robots.
            tries: Most of them.
        """
        self._player, self._stand, self._most = player, first, tries
        # what to play in each posture
        self._choice = np.full(5, first)
        self._choice[[LEFT, RIGHT, BACK]] = first + np.arange(1, 4)
        self.active = np.zeros(n, dtype=bool)
        self.tries = np.zeros(n, dtype=np.int64)

    def start(self, mask: Mask) -> None:
        """Let robots (n,) begin, with all their tries."""
        self.active = self.active | mask
        self.tries = np.where(mask, 0, self.tries)
        self._player.stop(mask)

    def decide(
        self, posture: NDArray[np.int64], leans_right: Mask, angles: Array
    ) -> tuple[Mask, Mask]:
        """Start the next sequences, where one is due.

        Args:
            posture: Of each robot (n,).
            leans_right: Whether each robot's right side is lower than its left (n,).
            angles: Their targets now (n, j) [rad].

        Returns:
            Robots (n,) that stand now, and robots that have given up; neither are active any more.
        """
        now = self._player.sequence
        due = self.active & ~self._player.playing
        stood = due & (now == self._stand)
        up = stood & (posture == STANDING)
        choice = self._choice[posture] + ((posture == BACK) & leans_right)
        # standing up after a roll belongs to the same try
        fresh = (choice != self._stand) | stood | (self.tries == 0)
        again = due & ~up
        given_up = again & fresh & (self.tries >= self._most)
        go = again & ~given_up
        self.tries = self.tries + (go & fresh)
        self._player.start(go, choice, angles)
        self.active = self.active & ~up & ~given_up
        return up, given_up

    def state(self) -> Any:
        """Who is getting up and how often each has tried; copies. The player has the rest."""
        return self.active.copy(), self.tries.copy()

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        self.active, self.tries = (part.copy() for part in state)
