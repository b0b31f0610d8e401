"""Separation-bearing control: a follower keeps a distance and a bearing to its leader.

Source: J. P. Desai, J. P. Ostrowski and V. Kumar, Modeling and control of formations of
nonholonomic mobile robots, IEEE T-RA 17(6), 2001 (l-psi control), with the follower's reference
point ahead of its axle; not in the testbed's paper, which has no formation law.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError
from mjmr.geometry import wrap_angle

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class SeparationBearing:
    """The law's numbers.

    Attributes:
        separation: l_d, from the leader to the follower's reference point [m].
        bearing: psi_d, of that point from the leader's heading [rad].
        ahead: d, of the reference point from the follower's axle [m].
        separation_gain: a1 [1/s].
        bearing_gain: a2 [1/s].
    """

    separation: float
    bearing: float
    ahead: float = 0.3
    separation_gain: float = 0.5
    bearing_gain: float = 0.5

    def __post_init__(self):
        positive = (self.separation, self.ahead, self.separation_gain, self.bearing_gain)
        if not min(positive) > 0:
            raise InvalidInputError(
                "separation, ahead and both gains must be positive; got "
                f"{', '.join(f'{v:g}' for v in positive)}"
            )

    def command(self, seen: Array, leader: Array) -> Array:
        """(forward, turn) (n, 2) of followers, so that l' = a1 (l_d - l), psi' = a2 (psi_d - psi).

        Args:
            seen: Of each follower's leader (n, 3): where it is in the follower's frame [m, m] and
                its heading less the follower's [rad].
            leader: (forward, turn) of each leader (n, 2).

        Returns:
            Not limited; where a follower stands across its way (|gamma| within 0.01 rad of 90
            degrees, where the law is singular) as at that limit.
        """
        # from the leader to the point ahead of the follower's axle, in the follower's frame
        x, y = self.ahead - seen[:, 0], -seen[:, 1]
        apart = np.maximum(np.hypot(x, y), 1e-6)
        psi = wrap_angle(np.arctan2(y, x) - seen[:, 2])
        gamma = wrap_angle(seen[:, 2] + psi)
        cos = np.cos(gamma)
        cos = np.where(cos < 0, -1.0, 1.0) * np.maximum(np.abs(cos), 0.01)
        v, w = leader[:, 0], leader[:, 1]
        rho = (self.separation_gain * (self.separation - apart) + v * np.cos(psi)) / cos
        error = wrap_angle(self.bearing - psi)
        turn = (cos / self.ahead) * (
            self.bearing_gain * apart * error - v * np.sin(psi) + apart * w + rho * np.sin(gamma)
        )
        forward = rho - self.ahead * turn * np.sin(gamma) / cos
        return np.column_stack([forward, turn])
