"""TJPro: a round robot on two hobby servos, 0.18 m across, 0.8 kg (assets/tj_pro/README.md)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from mjmr.errors import InvalidInputError
from mjmr.robots.diff_drive import WHEELS, DiffDrive
from mjmr.robots.platform import Array, Drive
from mjmr.robots.unicycle import Unicycle

if TYPE_CHECKING:
    import mujoco

    from mjmr.sensors.base import Sensor
    from mjmr.world import World


class TJPro(Unicycle):
    """Mekatronix TJ Pro; commands are (forward [m/s], turn [rad/s]).

    The origin is on the floor below the middle of the axle, which is the middle of the round body.
    Two hobby servos turn the wheels, and nothing measures how far: a servo that is 5 % fast stays
    so, and the robot drives in an arc where it is told to drive straight on.

    Commands that ask a wheel for more than a servo's top speed are scaled down as a whole, so that
    the path keeps its curvature.

    Attributes:
        wheel_radius: [m].
        trip: From where its infra-red detectors are tripped [m].
        servo_gains: Speed of each robot's left and right servo over what it is told (n, 2), or of
            all of them (2,).
    """

    name = "tj_pro"
    title = "Mekatronix TJ Pro"
    grade = "C"
    radius = 0.09
    height = 0.065
    max_twist = (0.18, 2.77)
    braking = 2.0
    wheels = WHEELS
    wheel_radius = 0.035
    rolling_radius = 0.034677
    track = 0.13
    effective_track = track
    disc_radius = 0.028
    trip = 0.10

    def __init__(
        self,
        *,
        acceleration: float = 3.2,
        turn_acceleration: float = 30.0,
        servo_gains: ArrayLike = (1.0, 1.0),
    ):
        """Set what the base does.

        Args:
            acceleration: Bound of the forward speed's changes [m/s^2].
            turn_acceleration: Bound of the yaw rate's changes [rad/s^2].
            servo_gains: Speed of the left and the right servo over what it is told, of each robot
                (n, 2) or of all (2,); :func:`draw_servo_gains` draws them.

        Raises:
            InvalidInputError: A bound or a gain that is not positive and finite, or gains of
                another shape.
        """
        super().__init__(acceleration=acceleration, turn_acceleration=turn_acceleration)
        gains = np.array(servo_gains, dtype=np.float64)
        if gains.ndim not in (1, 2) or gains.shape[-1] != 2:
            raise InvalidInputError(
                f"servo_gains must have shape (2,) or (n, 2), left and right; got {gains.shape}"
            )
        if not ((gains > 0) & np.isfinite(gains)).all():
            raise InvalidInputError("servo_gains must be positive and finite")
        gains.setflags(write=False)
        self.servo_gains = gains
        self._exact = bool((gains == 1.0).all())

    def check_site(self, world: "World", poses: Array, names: Sequence[str]) -> None:
        """Refuse gains of another number of robots."""
        if self.servo_gains.ndim == 2 and len(self.servo_gains) != len(names):
            raise InvalidInputError(
                f"servo_gains has {len(self.servo_gains)} rows for {len(names)} robots"
            )

    def bind(self, model: "mujoco.MjModel", prefixes: Sequence[str]) -> Drive:
        """Drive of the robots attached under ``prefixes``."""
        return DiffDrive(model, prefixes)

    def default_sensors(self) -> "dict[str, Sensor]":
        """Two infra-red detectors that trip at 0.10 m, polled 10 times a second."""
        from mjmr.sensors.proximity import InfraredProximity

        return {"proximity": InfraredProximity(trip=self.trip, rate=10.0)}

    @property
    def always_allowed(self) -> float:
        """A command none of whose entries is above this needs no clamping."""
        return self.max_twist[0] / (1.0 + self.effective_track / 2.0)

    def clamp(self, command: Array) -> Array:
        """Scale commands (n, 2) so that no servo is told more than ``max_twist[0]`` at the rim."""
        rim = self.rim_speeds(command)
        over = rim > self.max_twist[0]
        if not over.any():
            return command
        return command * np.where(over, self.max_twist[0] / np.maximum(rim, 1e-300), 1.0)[:, None]

    def mistuned(self, command: Array) -> Array:
        """What the servos make of commands (n, 2): each wheel's speed times its servo's gain."""
        if self._exact:
            return command
        half = self.effective_track / 2.0
        gains = self.servo_gains
        left = gains[..., 0] * (command[:, 0] - half * command[:, 1])
        right = gains[..., 1] * (command[:, 0] + half * command[:, 1])
        return np.column_stack([(left + right) / 2.0, (right - left) / (2.0 * half)])


def draw_servo_gains(rng: np.random.Generator, n: int, spread: float = 0.05) -> Array:
    """Servos as they come out of the box: gains (n, 2), uniform in 1 +- ``spread``.

    Raises:
        InvalidInputError: A spread outside 0 to below 1.
    """
    if not 0.0 <= spread < 1.0:
        raise InvalidInputError(f"a spread of servos' speeds is 0 to below 1; got {spread}")
    return rng.uniform(1.0 - spread, 1.0 + spread, (n, 2))
