"""A team under hand control: from relative places of outputs to commands of unicycles.

The relative form (Qu, Wang and Hull, section 5, with l = 2) gives every hand point an acceleration;
feedback linearization turns it into changes of forward speed and turn rate, which an inner velocity
loop follows. The speeds that are changed are the set points the drives have reached.
"""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from controllers.consensus.hand import command_of_velocity, command_rates, hand_velocity
from controllers.consensus.rules import RelativeForm
from mjmr.errors import InvalidInputError

if TYPE_CHECKING:
    from controllers.safety import BarrierFilter

Array = NDArray[np.float64]


class HandTeam:
    """Turns relative outputs into commands (forward [m/s], turn [rad/s]), one call a tick.

    Attributes:
        length: L, from the axle to the hand point [m].
        period: Between two calls [s].
        barrier: Filter of the hands' velocities, or None.
        law: What gives accelerations; has the ``step`` of :class:`RelativeForm`.
    """

    def __init__(
        self,
        length: float,
        period: float,
        barrier: "BarrierFilter | None" = None,
        law: Any = None,
    ):
        """Args: see the class; ``law`` None: the paper's.

        Raises:
            InvalidInputError: A length or period that is not positive.
        """
        if not (length > 0 and period > 0):
            raise InvalidInputError(f"length and period are positive; got {length} m, {period} s")
        self.length, self.period, self.barrier = float(length), float(period), barrier
        self.law = RelativeForm(0) if law is None else law

    def step(
        self,
        yaw: Array,
        executed: Array,
        relative: Array,
        gains: Array,
        hands: Array | None = None,
        reference: tuple[Array, Array] | None = None,
    ) -> Array:
        """Commands (n, 2) of the next period.

        Args:
            yaw: Of the robots (n,) [rad]; ``relative`` is in the axes it is measured from.
            executed: (forward, turn) the drives have reached (n, 2).
            relative: Outputs, hand points less offsets, from robot row to column (n, n, 2) [m];
                NaN where nothing is known.
            gains: (n, n), rows summing to one.
            hands: Hand points (n, 2) [m], for a barrier.
            reference: Velocity and acceleration (n, 2) each at which the outputs' common value and
                the own offset are known to move; the law sees velocities less these. None: they
                stand, as in the paper.

        Raises:
            InvalidInputError: There is a barrier and no hands.
        """
        velocity = hand_velocity(yaw, executed, self.length)
        if reference is None:
            wanted = self.law.step(velocity, relative, gains)
        else:
            wanted = reference[1] + self.law.step(velocity - reference[0], relative, gains)
        if self.barrier is None:
            rates = command_rates(yaw, executed, wanted, self.length)
            return executed + rates * self.period
        if hands is None:
            raise InvalidInputError("a barrier needs to know where the hands are")
        safe = self.barrier.filter(hands, velocity + wanted * self.period)
        return command_of_velocity(yaw, safe, self.length)


class Scan:
    """Who sees nobody and has not agreed yet turns on the spot until somebody comes into view.

    It turns to the side on which it saw somebody last, anticlockwise if it never did.

    Ours: the paper's robots are heard or not; a robot whose graph comes from its own eyes and that
    sees nobody would stand for ever.
    """

    def __init__(self, n: int, *, patience: float, rate: float, settled: float):
        """Nobody has been seen yet.

        Args:
            n: Robots.
            patience: Without seeing anybody before it turns [s].
            rate: Of the turn [rad/s].
            settled: Who was this near to all it last saw [m] stays as it is.
        """
        self._patience, self._rate, self._settled = patience, rate, settled
        self._since = np.full(n, -np.inf)
        self._error = np.full(n, np.inf)
        self._side = np.ones(n)

    def step(
        self, time: float, relative: Array, seen: Array, bearing: Array, command: Array
    ) -> Array:
        """Commands (n, 2), those of robots that scan replaced.

        Args:
            time: [s].
            relative: As of :meth:`HandTeam.step`.
            seen: Who sees whom now (n, n).
            bearing: At which (n, n) [rad], left positive; NaN where not seen.
            command: (n, 2).
        """
        others = seen & ~np.eye(len(seen), dtype=bool)
        anybody = others.any(axis=1)
        self._since[anybody] = time
        far = np.where(others, np.linalg.norm(np.nan_to_num(relative), axis=2), 0.0).max(axis=1)
        self._error[anybody] = far[anybody]
        left = np.where(others, np.nan_to_num(bearing), 0.0).sum(axis=1) >= 0
        self._side[anybody] = np.where(left, 1.0, -1.0)[anybody]
        lost = (time - self._since > self._patience) & (self._error > self._settled)
        turn = np.column_stack([np.zeros(len(command)), self._rate * self._side])
        return np.where(lost[:, None], turn, command)
