"""Trot engine: mixes gaits by what is commanded, for n robots as arrays."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.legged.gait_set import GaitSet, feet
from controllers.legged.leg import ERS7, LegGeometry, UnreachableError
from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]
SETS = ("forward", "backward", "sideways", "turning")
_STAND = 4  # column of the weights, after those of SETS
_SAMPLES = 256  # of a period when a table is checked
_STANDING = np.eye(len(SETS) + 1)[_STAND]
# of the shares of a command: with 2 some mixtures of full commands are out of reach
_NORM = 1.5


class Rates(NamedTuple):
    """How a table of joint angles goes with the servos' rates.

    Attributes:
        peak: Fastest joint over its limit; above 1 the servos lag behind.
        clipped: Share of joints and frames that are over.
    """

    peak: float
    clipped: float


@dataclass(frozen=True, kw_only=True)
class Trot:
    """A trot with a gait for each direction, mixed by their shares of a command.

    A command's share in a direction is its part of the full speed there. Where the sum of the
    shares to the power of 1.5 is above one, the command is scaled down. Gaits are mixed in
    proportion to the shares; which gait is under way and how long strokes are change by at most
    their full range in ``ramp``, so starts, stops and turns are smooth. A robot commanded nothing
    stands in ``home``.

    Attributes:
        forward: Gait forwards.
        backward: Gait backwards.
        sideways: Gait to either side.
        turning: Gait on the spot.
        full: Commands at which the gaits are what they were made for (4,), in their order:
            forwards, backwards, sideways [m/s] and turning [rad/s].
        home: Leg joints' angles (12,) [rad] of a robot that stands.
        leg: The legs.
        rates: Fastest that rotator, elevator and knee turn (3,) [rad/s].
        frame: Between two targets [s].
        ramp: From nothing to a full command [s].
        dead: Share below which a command is none.

    Raises:
        UnreachableError: A gait at its full command sends a foot where it cannot reach.
        InvalidInputError: It needs more than the servos' rates and is not marked ``clipped``.
    """

    forward: GaitSet
    backward: GaitSet
    sideways: GaitSet
    turning: GaitSet
    full: tuple[float, float, float, float]
    home: tuple[float, ...]
    leg: LegGeometry = ERS7
    rates: tuple[float, float, float] = (4.865, 5.280, 5.280)
    frame: float = 0.008
    ramp: float = 0.5
    dead: float = 0.01

    def __post_init__(self):
        if min(self.full) <= 0 or not (self.frame > 0 and self.ramp >= self.frame):
            raise InvalidInputError(
                f"a trot needs positive full commands and a ramp of a frame or more; got "
                f"{self.full}, {self.ramp} s"
            )
        if len(self.home) != 12:
            raise InvalidInputError(f"home has 12 leg joints; got {len(self.home)}")
        for name, command in zip(SETS, self.full_commands, strict=True):
            gait: GaitSet = getattr(self, name)
            try:
                rates = self.table_rates(command)
            except UnreachableError as error:
                raise UnreachableError(f"gait {name} at its full command: {error}") from None
            if rates.peak > 1.0 and not gait.clipped:
                raise InvalidInputError(
                    f"gait {name} needs {rates.peak:.2f} of the servos' rates at its full command; "
                    f"make its strokes shorter or mark it as clipped"
                )

    @property
    def full_commands(self) -> Array:
        """Full command of each gait (4, 3)."""
        ahead, back, side, turn = self.full
        return np.array([[ahead, 0, 0], [-back, 0, 0], [0, side, 0], [0, 0, turn]], dtype=float)

    @property
    def command_limits(self) -> Array:
        """Lowest and highest forward, left and turn (3, 2)."""
        ahead, back, side, turn = self.full
        return np.array([[-back, ahead], [-side, side], [-turn, turn]])

    def shares(self, command: Array) -> Array:
        """Shares of ``SETS`` (n, 4) in commands (n, 3)."""
        parts = np.empty((len(command), 4))
        parts[:, 0], parts[:, 1] = command[:, 0], -command[:, 0]
        parts[:, 2:] = np.abs(command[:, 1:])
        return np.maximum(parts, 0.0) / self.full

    def table_rates(self, command: ArrayLike) -> Rates:
        """What a steady command (3,) needs of the servos; raises as :meth:`table` does."""
        phases, row, twist = self._steady(command)
        step = self.frame / row[0, 0]
        now, then = (
            self.leg.angles(feet(self.leg, row, p, twist)) for p in (phases, phases + step)
        )
        share = np.abs(then - now) / (self.frame * np.array(self.rates))
        return Rates(float(share.max()), float((share > 1.0).mean()))

    def bind(self, n: int) -> "BoundTrot":
        """Begin afresh for n robots that stand in ``home``."""
        return BoundTrot(self, n)

    def rows(self) -> Array:
        """Parameters of ``SETS`` and of standing (5, 12)."""
        gaits = np.array([getattr(self, name).row() for name in SETS])
        stand = gaits.mean(axis=0)
        angles = np.array(self.home).reshape(4, 3)
        local = (self.leg.feet(angles) - self.leg.hips)[[0, 2]]
        stand[3:11] = np.ravel([-local[:, 2], np.zeros(2), local[:, 0], local[:, 1]])
        return np.vstack([gaits, stand])

    def _steady(self, command: ArrayLike) -> tuple[Array, Array, Array]:
        twist = np.reshape(np.asarray(command, dtype=np.float64), (1, 3))
        shares = self.shares(twist)
        if shares.sum() == 0:
            raise InvalidInputError("a robot that is commanded nothing has no gait")
        row = shares / shares.sum() @ self.rows()[:_STAND]
        return np.arange(_SAMPLES) / _SAMPLES, row, twist


class BoundTrot:
    """A trot at work on n robots.

    Attributes:
        clamped: Frames in which a command was beyond the full ones and scaled down (n,).
        unreachable: Feet sent beyond their reach, and put at the nearest, so far (n,).
    """

    def __init__(self, trot: Trot, n: int):
        """Start with n standing robots; see :meth:`Trot.bind`."""
        self._trot, self.n = trot, n
        self._rows = trot.rows()
        ahead, back, side, turn = trot.full
        self._step = np.array([max(ahead, back), side, turn]) * trot.frame / trot.ramp
        self._phase = np.zeros(n)
        self._weights = np.zeros((n, len(SETS) + 1))
        self._twist = np.zeros((n, 3))
        self.clamped = np.zeros(n, dtype=np.int64)
        self.unreachable = np.zeros(n, dtype=np.int64)
        self.reset(np.ones(n, dtype=bool))

    def legs(self, command: Array) -> Array:
        """Leg joints' angles (n, 12) [rad] for the frame that begins now.

        Args:
            command: Forward, left [m/s], anticlockwise [rad/s] (n, 3), body frame.

        Raises:
            InvalidInputError: Another shape, or a number that is not finite.
        """
        command = np.asarray(command, dtype=np.float64)
        if command.shape != (self.n, 3) or not np.isfinite(command).all():
            raise InvalidInputError(
                f"a trot takes finite commands of shape ({self.n}, 3); got {command}"
            )
        trot = self._trot
        shares = trot.shares(command)
        size = (shares**_NORM).sum(axis=1) ** (1.0 / _NORM)
        over = size > 1.0 + 1e-9
        self.clamped += over
        scale = np.where(over, 1.0 / np.maximum(size, 1.0), 1.0)
        moving = size > trot.dead
        wanted = np.zeros_like(self._weights)
        wanted[:, :_STAND] = shares / np.maximum(shares.sum(axis=1, keepdims=True), 1e-300)
        wanted[~moving] = _STANDING
        target = command * (scale * moving)[:, None]
        self._twist += np.clip(target - self._twist, -self._step, self._step)
        self._weights = _towards(self._weights, wanted, trot.frame / trot.ramp)
        # not a matrix product: its bits depend on the number of robots
        rows = (self._weights[:, :, None] * self._rows).sum(axis=1)
        angles, reached = trot.leg.solve(feet(trot.leg, rows, self._phase, self._twist))
        self.unreachable += (~reached).sum(axis=1)
        stands = self._weights[:, _STAND] >= 1.0
        self._phase = np.where(stands, 0.0, np.remainder(self._phase + trot.frame / rows[:, 0], 1))
        return angles.reshape(self.n, 12)

    def reset(self, mask: NDArray[np.bool_]) -> None:
        """Let the robots of a mask (n,) stand, as at the start."""
        self._phase[mask] = 0.0
        self._twist[mask] = 0.0
        self._weights[mask] = _STANDING

    def state(self) -> Any:
        """All that later angles depend on, and the counts; copies."""
        parts = self._phase, self._weights, self._twist, self.clamped, self.unreachable
        return tuple(part.copy() for part in parts)

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        parts = (part.copy() for part in state)
        self._phase, self._weights, self._twist, self.clamped, self.unreachable = parts


def _towards(now: Array, wanted: Array, step: float) -> Array:
    """Weights (n, m) that go from ``now`` along the straight line; the greatest by ``step``."""
    ahead = wanted - now
    largest = np.abs(ahead).max(axis=1, keepdims=True)
    # the whole way when it is short, so that weights of standing become exactly one
    return np.where(largest <= step, wanted, now + ahead * step / np.maximum(largest, step))
