"""Motion engine of a legged robot that walks, kicks, and gets up when it has fallen."""

from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.legged.ers7_gaits import ERS7_HOME, ERS7_TROT
from controllers.legged.ers7_keyframes import ERS7_GET_UP, ERS7_KICKS
from controllers.legged.get_up import GetUp, GetUpPlan
from controllers.legged.head import ERS7_HEAD, HeadGeometry
from controllers.legged.keyframes import KeyframePlayer
from controllers.legged.kicks import Kick
from controllers.legged.posture import STANDING, Posture
from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
WALK, KICK_FORWARD, KICK_LEFT, KICK_RIGHT, GET_UP = range(5)
WALKING, KICKING, GETTING_UP, FALLEN, GIVEN_UP = range(5)
STATUSES = ("walking", "kicking", "getting up", "fallen", "given up")
FRAME = 0.008  # s
_LEGS, _HEAD = slice(0, 12), slice(12, 15)


class BoundGait(Protocol):
    """A gait at work on n robots."""

    def legs(self, command: Array) -> Array:
        """Leg joints (n, 12) [rad] of the next frame for forward, left, turn (n, 3)."""
        ...

    def reset(self, mask: Mask) -> None:
        """Let robots of a mask (n,) stand, as at the start."""
        ...

    def state(self) -> Any:
        """All that later targets depend on; a copy."""
        ...

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        ...


class Gait(Protocol):
    """What walks."""

    @property
    def command_limits(self) -> Array:
        """Lowest and highest forward, left [m/s] and turn [rad/s] (3, 2)."""
        ...

    def bind(self, n: int) -> BoundGait:
        """Begin afresh for n robots that stand."""
        ...


class AiboMotion:
    """Legs that walk, a head that goes where it is told, and actions that take the whole body.

    Commands are ``forward``, ``left`` [m/s] and ``turn`` [rad/s] of the gait, ``tilt``, ``pan``
    and ``nod`` (tilt1, pan and tilt2) [rad] of the head, and ``action``: ``WALK``,
    ``KICK_FORWARD``, ``KICK_LEFT``, ``KICK_RIGHT`` or ``GET_UP``. An action begins when its code
    is new and runs to its end, whatever is commanded meanwhile; to do it again, command another
    code between. Kicks begin in any pose, but a fallen robot gets up first and does not kick
    after. ``GET_UP`` is for robots that lie, also on their bellies, which the accelerometer cannot
    tell from standing; a standing robot lies down and gets up.

    It is a motion engine as :mod:`mjmr.robots.motion` describes them, for the ERS-7's 20 joints.

    Attributes:
        command_names: Of the columns.
        command_limits: Lowest and highest of each (7, 2).
    """

    command_names: tuple[str, ...] = ("forward", "left", "turn", "tilt", "pan", "nod", "action")

    def __init__(
        self,
        gait: Gait = ERS7_TROT,
        *,
        head: HeadGeometry = ERS7_HEAD,
        automatic: bool = True,
        plan: GetUpPlan = ERS7_GET_UP,
        kicks: Mapping[int, Kick] = ERS7_KICKS,
        patience: float = 0.4,
    ):
        """Put the parts together.

        Args:
            gait: What walks.
            head: Whose limits the commands have.
            automatic: Whether robots get up without being told.
            plan: How.
            kicks: By their codes, ``KICK_FORWARD`` to ``KICK_RIGHT``.
            patience: How long a trunk is not upright before the robot counts as fallen [s].

        Raises:
            InvalidInputError: A kick is missing or has another code.
        """
        if set(kicks) != {KICK_FORWARD, KICK_LEFT, KICK_RIGHT}:
            raise InvalidInputError(
                f"kicks have the codes {KICK_FORWARD}, {KICK_LEFT} and {KICK_RIGHT}; got "
                f"{sorted(kicks)}"
            )
        self.gait = gait
        self.automatic, self.plan, self.patience = automatic, plan, patience
        self.kicks = dict(kicks)
        self.command_limits = np.vstack([gait.command_limits, head.limits, [[WALK, GET_UP]]])

    def bind(self, n: int) -> "BoundAiboMotion":
        """Begin afresh for n robots that stand at rest in their home pose."""
        return BoundAiboMotion(self, n)

    def command(
        self, twist: ArrayLike = (0, 0, 0), head: ArrayLike = ERS7_HOME[_HEAD], action: Any = WALK
    ) -> Array:
        """A command (n, 7) from its parts, broadcast against each other.

        Args:
            twist: Forward, left [m/s], anticlockwise [rad/s] (n, 3) or (3,).
            head: tilt1, pan, tilt2 (n, 3) or (3,) [rad]; by default at home.
            action: Codes (n,) or one.
        """
        parts = [np.atleast_2d(twist), np.atleast_2d(head), np.reshape(action, (-1, 1))]
        n = max(len(part) for part in parts)
        return np.hstack([np.broadcast_to(p, (n, p.shape[1])) for p in parts]).astype(np.float64)


class BoundAiboMotion:
    """The engine at work on n robots.

    Attributes:
        status: What each is doing (n,), an index into ``STATUSES``; telemetry.
        posture: How each stands or lies by its accelerometer (n,); telemetry.
    """

    def __init__(self, motion: AiboMotion, n: int):
        """Start with n standing robots; see :meth:`AiboMotion.bind`."""
        self._motion = motion
        self._gait = motion.gait.bind(n)
        kicks = [motion.kicks[code].keyframes for code in (KICK_FORWARD, KICK_LEFT, KICK_RIGHT)]
        self._player = KeyframePlayer([*kicks, *motion.plan.sequences], n, frame=FRAME)
        self._get_up = GetUp(self._player, len(kicks), n, motion.plan.tries)
        self._posture = Posture(n, frame=FRAME)
        self._patience = round(motion.patience / FRAME)
        self.status = np.full(n, WALKING)
        self.posture = np.full(n, STANDING)
        self._code = np.full(n, WALK)
        self._down = np.zeros(n, dtype=np.int64)  # frames since the trunk left the upright
        self._targets = np.tile(ERS7_HOME, (n, 1))

    @property
    def tries(self) -> NDArray[np.int64]:
        """How often each has begun to get up since it last fell (n,); telemetry."""
        return self._get_up.tries.copy()

    def targets(self, command: Array, proprioception: Any) -> Array:
        """Joint targets (n, 20) [rad] of the frame that begins now.

        Args:
            command: See :class:`AiboMotion`, (n, 7).
            proprioception: Its ``accelerometer`` (n, 3) [m/s^2] is used.
        """
        self.posture = self._posture.update(proprioception.accelerometer)
        upright = self.posture == STANDING
        self._down = np.where(upright, 0, self._down + 1)
        self._finish_actions()
        self._begin_actions(np.rint(command[:, 6]).astype(np.int64), upright)
        if (self.status == GETTING_UP).any():
            up, given_up = self._get_up.decide(
                self.posture, self._posture.up[:, 1] > 0.0, self._targets
            )
            self.status = np.where(up, WALKING, np.where(given_up, GIVEN_UP, self.status))
        whole = self.status == GETTING_UP
        whole |= self.status == KICKING
        # fallen robots stretch their legs as if they stood, and wait
        twist = np.where((self.status == WALKING)[:, None], command[:, :3], 0.0)
        targets = np.tile(ERS7_HOME, (len(command), 1))
        targets[:, _LEGS] = self._gait.legs(twist)
        targets[:, _HEAD] = command[:, 3:6]
        if whole.any():
            targets = np.where(whole[:, None], self._player.targets(), targets)
            self._gait.reset(whole)
        self._targets = targets
        return targets

    def _finish_actions(self) -> None:
        if not (self.status == KICKING).any():
            return
        kicked = (self.status == KICKING) & self._player.ended
        self._player.stop(kicked)
        self.status = np.where(kicked, WALKING, self.status)

    def _begin_actions(self, code: NDArray[np.int64], upright: Mask) -> None:
        new, self._code = code != self._code, code
        idle = (self.status != KICKING) & (self.status != GETTING_UP)
        fallen = idle & (self._down >= self._patience)
        # a robot that was stood up by hand walks on
        state = np.where(fallen & (self.status != GIVEN_UP), FALLEN, self.status)
        self.status = np.where(idle & upright, WALKING, state)
        rise = idle & new & (code == GET_UP)
        if self._motion.automatic:
            rise |= self.status == FALLEN
        self._get_up.start(rise)
        kick = idle & new & (self.status == WALKING) & (code != WALK) & ~rise
        self._player.start(kick, code - KICK_FORWARD, self._targets)
        self.status = np.where(rise, GETTING_UP, np.where(kick, KICKING, self.status))

    def state(self) -> Any:
        """All that later targets depend on; copies."""
        arrays = self.status, self.posture, self._code, self._down, self._targets
        parts = self._gait, self._player, self._get_up, self._posture
        return tuple(a.copy() for a in arrays), tuple(part.state() for part in parts)

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        arrays, states = state
        copies = (a.copy() for a in arrays)
        self.status, self.posture, self._code, self._down, self._targets = copies
        parts = self._gait, self._player, self._get_up, self._posture
        for part, its in zip(parts, states, strict=True):
            part.set_state(its)
