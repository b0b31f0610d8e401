"""What walks a legged robot: an engine that turns its own commands into joint targets."""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Proprioception:
    """What n robots know of themselves at the start of a frame.

    Attributes:
        joint_angles: Measured (n, k) [rad], in the order of the platform's joints.
        accelerometer: What it reads (n, 3) [m/s^2], body frame: a robot that stands upright reads
            +9.81 along z. It is of the physics step before the frame.
        time: Since the start [s].
    """

    joint_angles: Array
    accelerometer: Array
    time: float


class BoundMotion(Protocol):
    """An engine at work on the n robots of a group."""

    def targets(self, command: Array, proprioception: Proprioception) -> Array:
        """Joint targets (n, k) [rad] of the frame that begins now, called once every frame.

        Args:
            command: In force (n, c), within :attr:`Motion.command_limits`; not to be changed.
            proprioception: Of the same robots; not to be changed.

        Returns:
            In the order of the platform's joints. The servos clip them to the joints' ranges and
            go there no faster than the joints can.
        """
        ...

    def state(self) -> Any:
        """All that later targets depend on, for snapshots; a copy."""
        ...

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned; the engine must leave ``state`` as it is."""
        ...


class Motion(Protocol):
    """An engine as it is given to a platform; the platform names what its joints are.

    Attributes:
        command_names: Of the columns of a command.
        command_limits: Lowest and highest of each (c, 2). Commands beyond are clipped and counted.
            Zero, within them, is the command in force until the first one.
    """

    command_names: tuple[str, ...]
    command_limits: Array

    def bind(self, n: int) -> BoundMotion:
        """Begin afresh for n robots that stand at rest in the platform's home pose."""
        ...
