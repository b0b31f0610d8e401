"""The relative form: agreement from relative positions and one's own velocity alone.

For relative degree 2 (hand point dp/dt = w, dw/dt = v) the canonical control with rows summing to
one becomes v_i = -2 w_i + sum_j g_ij (p_j - p_i); derived from Qu, Wang and Hull, section 5.
"""

import numpy as np
from numpy.typing import NDArray

from controllers.consensus.gains import check_gains
from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]


def acceleration(velocity: Array, relative: Array, gains: Array) -> Array:
    """Accelerations (n, m) that let hand points agree.

    Args:
        velocity: Own velocities (n, m) [m/s], each in any axes, those of its row of ``relative``.
        relative: From robot row to robot column (n, n, m) [m]; NaN where not seen.
        gains: (n, n), rows summing to one; weights of those not seen count as the robot's own.

    Raises:
        InvalidInputError: Shapes that do not fit, or gains that cannot be.
    """
    n = len(velocity)
    if relative.shape != (n, n, velocity.shape[1]) or gains.shape != (n, n):
        raise InvalidInputError(
            f"relative positions and gains of {n} robots have shapes ({n}, {n}, m) and ({n}, {n}); "
            f"got {relative.shape} and {gains.shape}"
        )
    seen = np.nan_to_num(relative, nan=0.0)
    return -2.0 * velocity + np.einsum("ij,ijm->im", check_gains(gains, n), seen)


def offset_relative(relative: Array, offsets: Array) -> Array:
    """Relative positions (n, n, m) of hand points less their places in a formation.

    Agreement on y_i = p_i - d_i puts the robots in the formation of the offsets d (n, m).
    """
    return relative - (offsets[None] - offsets[:, None])
