"""Average consensus on a number a robot, as a service to other systems."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.consensus.gains import metropolis_gains
from mjmr.errors import InvalidInputError
from mjmr.finite import finite, numbers

Array = NDArray[np.float64]
_MEMORY = 5  # rounds in which somebody heard counts as a neighbour: loss must not look like leaving


class AverageConsensus:
    """Robots agree on the mean of their numbers by talking to neighbours.

    Each round every robot replaces its estimate by a weighted mean of those it hears (Metropolis
    weights, links both ways). The sum is kept in every round, whatever the graph, so that joint
    connection over time is enough for the mean.

    Over a radio a robot knows no links: it tells its estimate and how many it hears, and weighs
    those it heard this round. Then the sum is kept only while who hears is heard: a lost message
    moves one robot and not the other, and what all agree on in the end is no longer the mean.
    :class:`RatioConsensus` is for such radios.

    Attributes:
        estimate: Of each robot (n, ...).
        rounds: Done so far.
        crowded: Times a robot heard so many more than it had told that its weights were scaled
            down, which does not keep the sum.
    """

    def __init__(self, values: ArrayLike):
        """Begin with the robots' own numbers (n, ...)."""
        found = numbers(values)
        if found is None or not found.ndim or not len(found) or not np.isfinite(found).all():
            raise InvalidInputError(
                "average consensus is of the finite numbers of 1 robot or more, equally many each"
            )
        self.estimate: Array = found
        self.rounds = self.crowded = 0
        n = len(self.estimate)
        self._silent = np.full((n, n), _MEMORY + 1)
        self._told = np.zeros(n)

    def step(self, linked: ArrayLike) -> Array:
        """One round over the links (n, n) there are now; the new estimates, a copy."""
        gains = metropolis_gains(linked)
        if len(gains) != len(self.estimate):
            raise InvalidInputError(
                f"links of {len(self.estimate)} robots; got shape {gains.shape}"
            )
        self.estimate = np.tensordot(gains, self.estimate, axes=1)
        self.rounds += 1
        return self.estimate.copy()

    def message(self) -> Array:
        """What robots tell this round (n, 2): their estimate, and how many they heard of late."""
        self._told = (self._silent <= _MEMORY).sum(axis=1).astype(np.float64)
        return np.column_stack([self._scalars(), self._told])

    def hear(self, messages: Any) -> Array:
        """End a round with what was heard of it; the new estimates, a copy.

        Args:
            messages: (n, n, 2), receiver first; NaN where nothing was heard this round.

        Raises:
            InvalidInputError: Another shape, or estimates that are no single numbers.
        """
        own = self._scalars()
        given = _messages(messages, len(own), 2)
        heard = np.isfinite(given[..., 0])
        np.fill_diagonal(heard, False)
        self._silent = np.where(heard, 1, self._silent + 1)
        theirs, degree = np.where(heard, given[..., 0], 0.0), np.where(heard, given[..., 1], 0.0)
        weights = heard / (1.0 + np.maximum(degree, self._told[:, None]))
        # who has told that it hears nobody has its numbers counted from the next round on
        weights[(degree == 0) | (self._told[:, None] == 0)] = 0.0
        total = weights.sum(axis=1)
        self.crowded += int((total > 1.0).sum())
        weights /= np.maximum(total, 1.0)[:, None]
        self.estimate = own + (weights * (theirs - own[:, None])).sum(axis=1)
        self.rounds += 1
        return self.estimate.copy()

    def _scalars(self) -> Array:
        if self.estimate.ndim != 1:
            raise InvalidInputError(
                f"robots tell one number each; got estimates of shape {self.estimate.shape}"
            )
        return self.estimate


class RatioConsensus:
    """The mean over links that lose messages: ratio consensus with running sums.

    Each robot has a value and a weight, its number and 1 at first, and every round shares both
    alike among itself and whom it heard in the round before. It tells each not the share but the
    sum of all shares so far; who hears it after a loss takes what it missed. Nothing is lost for
    good while links come back, and value over weight tends to the mean at every robot. Who goes out
    of reach for ever takes along what was on its way to it. Given weights only grow: a sum of less
    weight than what was taken was overtaken on its way, and is left; one heard again adds nothing.

    Source: C. N. Hadjicostis, N. H. Vaidya and A. D. Dominguez-Garcia, Robust distributed average
    consensus via exchange of running sums, IEEE TAC 61(6), 2016; after D. Kempe, A. Dobra and
    J. Gehrke, Gossip-based computation of aggregate information, FOCS 2003 (push-sum). Sums are
    told by link and not by sender, so that a link that breaks holds only what it was given.

    Attributes:
        rounds: Done so far.
    """

    def __init__(self, values: ArrayLike, weights: ArrayLike | None = None):
        """Begin with the robots' own numbers.

        Args:
            values: (n,).
            weights: Of each in the mean (n,), 0 or more; None: all alike.

        Raises:
            InvalidInputError: No such numbers.
        """
        n = np.size(values) if numbers(values) is not None else 0
        if finite(values, (n,)) is None or not n:
            raise InvalidInputError("ratio consensus is of one finite number a robot, 1 or more")
        self.rounds = 0
        self._own = _weighted(values, weights, n)
        self._mass = self._own.copy()
        self._owed = np.zeros((n, 2))  # of replace, not yet taken from what a robot has
        self._given = np.zeros((n, n, 2))  # running sums, giver first
        self._taken = np.zeros((n, n, 2))  # the last heard of them, taker first
        self._links = np.zeros((n, n), dtype=bool)

    @property
    def estimate(self) -> Array:
        """Of each robot (n,); NaN of those no weight has come to yet."""
        known = self._mass[:, 1] > 1e-12
        return np.where(known, self._mass[:, 0] / np.where(known, self._mass[:, 1], 1.0), np.nan)

    def replace(self, values: ArrayLike, weights: ArrayLike | None = None) -> None:
        """Robots have other numbers or weights from now on; arguments and errors as at first.

        Each puts the difference into what it has; the mean is followed as fast as rounds spread it.
        Who loses more weight than half of what it has gives that up as more comes in, so that no
        weight is ever negative; estimates are off the new mean until then.
        """
        new = _weighted(values, weights, len(self._own))
        self._owed = self._owed + new - self._own
        self._own = new
        self._settle()

    def message(self) -> Array:
        """Share, and what robots tell this round (n, 2 n): for each robot the sums given to it."""
        self._settle()
        share = self._mass / (1.0 + self._links.sum(axis=1))[:, None]
        self._given += np.where(self._links[..., None], share[:, None], 0.0)
        self._mass = share
        return self._given.reshape(len(share), -1).copy()

    def hear(self, messages: Any) -> Array:
        """End a round with what was heard of it; the new estimates.

        Args:
            messages: (n, n, 2 n), receiver first; NaN where nothing was heard this
                round.

        Raises:
            InvalidInputError: Another shape.
        """
        n = len(self._mass)
        given = _messages(messages, n, 2 * n).reshape(n, n, n, 2)
        sums = given[np.arange(n), :, np.arange(n)]  # (taker, giver, 2): those given to the taker
        heard = np.isfinite(sums[..., 0])
        np.fill_diagonal(heard, False)
        self._links = heard
        newer = heard & (sums[..., 1] >= self._taken[..., 1])
        self._mass = self._mass + np.where(newer[..., None], sums - self._taken, 0.0).sum(axis=1)
        self._taken = np.where(newer[..., None], sums, self._taken)
        self.rounds += 1
        return self.estimate

    def _settle(self) -> None:
        """Put what is owed into what robots have, no more than half of whose weight it takes."""
        lost = np.maximum(-self._owed[:, 1], 0.0)
        room = 0.5 * self._mass[:, 1]
        part = np.where(lost > room, room / np.maximum(lost, 1e-300), 1.0)[:, None] * self._owed
        self._mass = self._mass + part
        self._owed = self._owed - part


def of_this_round(values: Array, sent: Array, since: float) -> Array:
    """What a radio has of each sender (n, n, c), NaN where that was sent before ``since`` [s].

    Args:
        values: The newest of each, receiver first.
        sent: When each was sent (n, n) [s]; NaN: never.
        since: When this round's messages were sent.
    """
    with np.errstate(invalid="ignore"):
        return np.where((sent >= since - 1e-9)[..., None], values, np.nan)


def _weighted(values: ArrayLike, weights: ArrayLike | None, n: int) -> Array:
    own, share = finite(values, (n,)), finite(np.ones(n) if weights is None else weights, (n,))
    if own is None or share is None or (share < 0).any():
        raise InvalidInputError(
            f"values and weights are {n} finite numbers each, weights 0 or more; got {values} and "
            f"{weights}"
        )
    return np.column_stack([own * share, share])


def _messages(given: Any, n: int, columns: int) -> Array:
    found = numbers(given)
    if found is None or found.shape != (n, n, columns):
        told = "no numbers" if found is None else f"shape {found.shape}"
        raise InvalidInputError(f"messages have shape ({n}, {n}, {columns}); got {told}")
    return found
