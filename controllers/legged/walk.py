"""Motion engine that walks and holds the head, for robots with the ERS-7's 20 joints."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.legged.ers7_gaits import ERS7_HOME, ERS7_TROT
from controllers.legged.gait import BoundTrot, Trot
from controllers.legged.head import ERS7_HEAD, HeadGeometry

Array = NDArray[np.float64]
_HEAD = slice(12, 15)


class Walk:
    """Legs that trot, a head that goes where it is told, other joints at home.

    It is a motion engine as :mod:`mjmr.robots.motion` describes them.

    Attributes:
        command_names: ``forward``, ``left`` [m/s], ``turn`` [rad/s], and ``tilt``, ``pan``,
            ``nod``: angles of the head's joints tilt1, pan and tilt2 [rad].
        command_limits: Lowest and highest of each (6, 2).
        trot: Of the legs.
    """

    command_names: tuple[str, ...] = ("forward", "left", "turn", "tilt", "pan", "nod")

    def __init__(self, trot: Trot = ERS7_TROT, head: HeadGeometry = ERS7_HEAD):
        """Choose the legs' gaits and the head whose limits the commands have."""
        self.trot = trot
        self.command_limits = np.vstack([trot.command_limits, head.limits])

    def bind(self, n: int) -> "BoundWalk":
        """Begin afresh for n robots that stand at rest in their home pose."""
        home = np.concatenate([self.trot.home, ERS7_HOME[12:]])
        return BoundWalk(self.trot.bind(n), np.tile(home, (n, 1)))


class BoundWalk:
    """A walk at work on n robots.

    Attributes:
        trot: Of their legs, with its counts.
    """

    def __init__(self, trot: BoundTrot, home: Array):
        """Start with n standing robots; see :meth:`Walk.bind`."""
        self.trot, self._home = trot, home

    def targets(self, command: Array, proprioception: Any) -> Array:
        """Joint targets (n, 20) [rad] of the frame that begins now.

        Args:
            command: See :class:`Walk`, (n, 6).
            proprioception: Not used: this engine senses nothing.
        """
        targets = self._home.copy()
        targets[:, :12] = self.trot.legs(command[:, :3])
        targets[:, _HEAD] = command[:, 3:]
        return targets

    def state(self) -> Any:
        """All that later targets depend on; a copy."""
        return self.trot.state()

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        self.trot.set_state(state)
