"""ForceTorque: what one body of every robot bears on its parent, at a site between them."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.randomness import SampleNoise
from mjmr.sensors.base import check_errors
from mjmr.sensors.site_sensors import SiteSensor

if TYPE_CHECKING:
    from mjmr.group import Group


class ForceTorque(SiteSensor):
    """Force and torque from a body on the one that carries it, in the frame of a site on the body.

    Something of weight m g that rests level on the sensor reads (0, 0, -m g). The body must be part
    of the robot by a joint or a weld: what lies on it, or is held, counts with it. It does not
    saturate, and needs forces: :class:`mjmr.simulation.Simulation`.
    """

    name = "force_torque"
    kinds = ("FORCE", "TORQUE")

    def __init__(
        self,
        *,
        rate: float = 100.0,
        latency: float = 0.0,
        phase: float = 0.0,
        site: str = "",
        body: str = "",
        position: ArrayLike = (0.0, 0.0, 0.0),
        force_noise: float = 0.0,
        torque_noise: float = 0.0,
        force_bias: float = 0.0,
        torque_bias: float = 0.0,
    ):
        """Set schedule, place and errors, the latter alike for all three axes.

        Args:
            rate: Samples a second [Hz].
            latency: [s].
            phase: Instant of the first sample [s].
            site: Of the robot's model, on the body whose load is measured; or give a place:
            body: Of the robot, whose load is measured; default: its first, which bears nothing if
                it is free.
            position: In the frame of that body (3,) [m].
            force_noise: Standard deviation of every sample [N].
            torque_noise: Standard deviation of every sample [Nm].
            force_bias: Standard deviation of an offset that stays for the trial [N].
            torque_bias: Standard deviation of an offset that stays for the trial [Nm].

        Raises:
            InvalidInputError: Errors that are negative or not finite, or both a site and a place.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        check_errors(
            force_noise=force_noise,
            torque_noise=torque_noise,
            force_bias=force_bias,
            torque_bias=torque_bias,
        )
        self._place(site, body, position)
        self._noise_scale = np.repeat([force_noise, torque_noise], 3)
        self._bias_scale = np.repeat([force_bias, torque_bias], 3)

    def read(self) -> NDArray[np.float64]:
        """Newest sample delivered by now, shape (n, 6), in the frame of the site.

        Columns 0 to 2: force along x, y, z [N]; 3 to 5: torque about x, y, z [Nm]. NaN before the
        first delivery.
        """
        return super().read()

    def prepare(self, sequence: np.random.SeedSequence, group: "Group") -> None:
        """Set up the noise stream and indices, and draw the offsets."""
        super().prepare(sequence, group)
        noise, bias = sequence.spawn(2)
        self._noise = SampleNoise(noise, (group.n, 6), "normal")
        self._bias = self._bias_scale * SampleNoise(bias, (group.n, 6), "normal").sample(0)

    def compute(self, state: Any, number: int) -> NDArray[np.float64]:
        """Turn MuJoCo's sign around and add the errors."""
        # MuJoCo gives what the parent exerts on the child
        sample = self._bias - state
        if self._noise_scale.any():
            sample = sample + self._noise_scale * self._noise.sample(number)
        return sample
