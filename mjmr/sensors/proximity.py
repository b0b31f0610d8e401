"""InfraredProximity: infra-red detectors that only say whether something is near."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError
from mjmr.sensors.rangers import InfraredRanger

Flags = NDArray[np.bool_]


class InfraredProximity(InfraredRanger):
    """Infra-red emitters and detectors with a threshold: tripped by a return nearer than ``trip``.

    Each is an :class:`mjmr.sensors.rangers.InfraredRanger` whose range is compared with the
    threshold, noise included; what such a ranger does not see, dark surfaces and slants, does not
    trip it. With ``drop_out=1`` it is dead: it never trips.

    Attributes:
        trip: [m], from the site.
    """

    name = "proximity"

    def __init__(
        self,
        *,
        trip: float,
        sites: str | Sequence[str] = "ir",
        beam_width: float = math.radians(20.0),
        rate: float = 10.0,
        **options: Any,
    ):
        """Set the threshold; see :class:`mjmr.sensors.rangers.Ranger` for the rest.

        Args:
            trip: A nearest return up to this far away trips the detector [m].
            sites: Of the robot's model.
            beam_width: Full angle of the cone [rad].
            rate: Polls a second [Hz].
            options: Of :class:`mjmr.sensors.rangers.InfraredRanger`; ``max_range`` is half as much
                again as the threshold unless given.

        Raises:
            InvalidInputError: A threshold that is not positive, or beyond ``max_range``.
        """
        if not 0 < trip < math.inf:
            raise InvalidInputError(f"a detector's threshold must be positive; got {trip} m")
        options.setdefault("max_range", 1.5 * trip)
        super().__init__(sites=sites, beam_width=beam_width, rate=rate, **options)
        if trip > self.max_range:
            raise InvalidInputError(
                f"a detector's threshold lies within max_range = {self.max_range:g} m; got {trip} m"
            )
        self.trip = float(trip)

    def read(self) -> Any:
        """Newest poll delivered by now, shape (n, k): which detectors were tripped.

        Nothing has tripped before the first delivery.
        """
        return super().read()

    @property
    def reading_bounds(self) -> tuple[bool, bool]:
        """Least and largest value of a reading."""
        return False, True

    def compute(self, state: Any, number: int) -> Any:
        """Ranges against the threshold; what was dropped out does not trip."""
        return super().compute(state, number) <= self.trip

    def nothing(self) -> Any:
        """None tripped."""
        return np.zeros((self._group.n, len(self._names)), dtype=bool)
