"""The last second of a simulation, kept at every control period for replays of failed trials."""

import mujoco
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_STATE = mujoco.mjtState.mjSTATE_QPOS.value | mujoco.mjtState.mjSTATE_QVEL.value


class LastSecond:
    """A ring of positions and velocities, allocated once."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, period: float):
        """Allocate for about one second of control periods [s], at least two instants."""
        self._model, self._data = model, data
        self._size = max(2, round(1.0 / period) + 1)
        self._states = np.zeros((self._size, mujoco.mj_stateSize(model, _STATE)))
        self._rows = list(self._states)  # views made once: it runs every control period
        self._times = [0.0] * self._size
        self._count = 0

    def keep(self, time: float) -> None:
        """Keep the present state as that of ``time`` [s]; the oldest is overwritten."""
        k = self._count % self._size
        mujoco.mj_getState(self._model, self._data, self._rows[k], _STATE)
        self._times[k] = time
        self._count += 1

    def clear(self) -> None:
        """Forget everything."""
        self._count = 0

    def states(self) -> tuple[Array, Array, Array]:
        """Times (k,) [s], positions (k, nq) and velocities (k, nv), oldest first; copies."""
        kept = np.arange(max(0, self._count - self._size), self._count) % self._size
        states = self._states[kept]
        nq = self._model.nq
        return np.array(self._times)[kept], states[:, :nq].copy(), states[:, nq:].copy()
