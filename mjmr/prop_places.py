"""PropPlaces: the joints of a compiled model that say where the props are that can move."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mjmr.disc import JOINTS, Disc, disc_positions

if TYPE_CHECKING:
    import mujoco

    from mjmr.world import World


class PropPlaces:
    """Every mover of a world in one compiled model."""

    def __init__(self, model: "mujoco.MjModel", world: "World"):
        """Look up every index once."""
        movers = world.movers
        discs = np.array([isinstance(prop, Disc) for _, prop in movers], dtype=bool)
        self._free, self._discs = np.flatnonzero(~discs), np.flatnonzero(discs)
        first = [model.joint(movers[k][0]).qposadr[0] for k in self._free]
        self._free_qpos = np.array(first, dtype=np.int64).reshape(-1, 1) + np.arange(7)
        first = [model.joint(movers[k][0]).qposadr[0] for k in self._discs]
        self._disc_qpos = np.array(first, dtype=np.int64).reshape(-1, 1) + np.arange(len(JOINTS))

    def place(self, data: "mujoco.MjData", poses: NDArray[np.float64]) -> None:
        """Put the movers at poses (k, 7): position, quaternion; for pictures."""
        data.qpos[self._free_qpos] = poses[self._free]
        data.qpos[self._disc_qpos] = disc_positions(poses[self._discs])
