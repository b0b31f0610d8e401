"""PropPlaces: the joints of a compiled model that say where the props are that can move."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mjmr.disc import JOINTS, Disc, disc_poses, disc_positions

if TYPE_CHECKING:
    import mujoco

    from mjmr.world import World


class PropPlaces:
    """Every mover of a world in one compiled model."""

    def __init__(self, model: "mujoco.MjModel", world: "World"):
        """Look up every index once."""
        movers = world.movers
        discs = np.array([isinstance(prop, Disc) for _, prop in movers], dtype=bool)
        first = np.array([model.joint(name).qposadr[0] for name, _ in movers], dtype=np.int64)
        self._free, self._discs = np.flatnonzero(~discs), np.flatnonzero(discs)
        self._free_qpos = first[self._free, None] + np.arange(7)
        self._disc_qpos = first[self._discs, None] + np.arange(len(JOINTS))
        self._n = len(movers)

    def poses(self, data: "mujoco.MjData") -> NDArray[np.float64]:
        """Poses of the movers (k, 7): position, quaternion; a new array.

        From the joints: MuJoCo computes places of bodies as a step begins, so that after it they
        are a step old.
        """
        poses = np.empty((self._n, 7))
        poses[self._free] = data.qpos[self._free_qpos]
        poses[self._discs] = disc_poses(data.qpos[self._disc_qpos])
        return poses

    def place(self, data: "mujoco.MjData", poses: NDArray[np.float64]) -> None:
        """Put the movers at poses (k, 7): position, quaternion; for pictures."""
        data.qpos[self._free_qpos] = poses[self._free]
        data.qpos[self._disc_qpos] = disc_positions(poses[self._discs])
