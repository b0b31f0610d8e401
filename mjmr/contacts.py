"""Forces of the contacts the last physics step worked with, as arrays."""

from typing import Any

import numpy as np
from numpy.typing import NDArray


def normal_forces(model: Any, data: Any) -> NDArray[np.float64]:
    """Normal force of every contact [N], shape (ncon,); 0 of those left out.

    Args:
        model: A ``mujoco.MjModel``.
        data: Its ``mujoco.MjData``.
    """
    import mujoco

    contact = data.contact
    address = contact.efc_address
    forces = np.zeros(len(address))
    active = address >= 0
    if not active.any():
        return forces
    first = address[active]
    if model.opt.cone == mujoco.mjtCone.mjCONE_PYRAMIDAL:
        # a normal force is one number in an elliptic cone, and the sum of a pyramid's edges
        dim = contact.dim[active]
        ends = np.where(dim > 1, 2 * (dim - 1), 1) + first
        spans = np.column_stack([first, ends]).ravel()
        # the 0 at the end lets the last contact's rows end beyond them
        forces[active] = np.add.reduceat(np.append(data.efc_force, 0.0), spans)[::2]
    else:
        forces[active] = data.efc_force[first]
    return forces
