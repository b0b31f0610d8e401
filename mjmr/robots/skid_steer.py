"""The skid-steer drive: a free body on several wheels a side, geared together, one motor a side."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mjmr.jit import njit
from mjmr.robots.diff_drive import WHEELS, DiffDrive
from mjmr.robots.platform import Array

if TYPE_CHECKING:
    import mujoco

GEARED = tuple((f"{wheel}_front", f"{wheel}_rear") for wheel in WHEELS)
_INTEGRAL = 20.0  # gain of the controller's integral part [1/s]


class SkidSteerDrive(DiffDrive):
    """Ramped velocity servos, one a side, whose speeds a controller closes as real firmware does.

    Commands are (forward, turn). Wheels named as ``WHEELS`` have the servos; the model gears
    further ones of a side to them, by default those in front of and behind a middle one. In a turn
    the wheels scrub: what that takes from the motors would slow the sides by about a tenth, so an
    integral part at every ``frame`` makes the wheels' *encoders* follow the command. Speeds of the
    sides come from a turn by the effective track, and both from rims by the rolling radius, as of
    firmware calibrated on the floor at a working turn rate: what the robot then does is up to the
    contacts.

    Attributes:
        frame: Between two corrections [s]; the Koala's own.
    """

    frame = 0.01

    def __init__(
        self,
        model: "mujoco.MjModel",
        prefixes: Sequence[str],
        *,
        rolling_radius: float,
        effective_track: float,
        geared: Sequence[Sequence[str]] = GEARED,
    ):
        """Look up every index once; see :class:`mjmr.robots.diff_drive.DiffDrive`."""
        super().__init__(
            model,
            prefixes,
            geared=geared,
            rolling_radius=rolling_radius,
            effective_track=effective_track,
        )
        servo = self._servo[0, 0]
        # what gives all the torque there is: more would only wind up
        self._most = float(model.actuator_forcerange[servo, 1] / model.actuator_gainprm[servo, 0])
        self._reset()

    def place(self, data: "mujoco.MjData", poses: Array) -> None:
        """Put the robots at rest at ``poses``, as deep in the floor as weight presses them."""
        super().place(data, poses)
        self._reset()

    def ramp(self, data: "mujoco.MjData", start: Array, target: Array, period: float) -> None:
        """Ramp the sides' set points between two commands (n, 2) over one period."""
        _roll(self._wanted, self._speed, self._slope, data.time - self._since)
        self._since = data.time
        self._speed = start @ self.wheel_speeds.T
        self._slope = (target - start) @ self.wheel_speeds.T / period
        super().ramp(data, start, target, period)
        data.act[self._act] += self._correction

    def servo(self, data: "mujoco.MjData", time: float) -> None:
        """Correct the set points by how far the wheels lag behind the angles asked for."""
        _roll(self._wanted, self._speed, self._slope, data.time - self._since)
        self._since = data.time
        _correct(
            data.act, self._act, data.qpos, self._wheel_qpos, self._wanted, self._correction,
            self._most,
        )  # fmt: skip

    def state(self) -> Any:
        """Angles and speeds asked for and the integral part, for snapshots; a copy."""
        arrays = (self._wanted, self._speed, self._slope, self._correction)
        return tuple(a.copy() for a in arrays), self._since

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        arrays, self._since = state
        self._wanted, self._speed, self._slope, self._correction = (a.copy() for a in arrays)

    def _reset(self) -> None:
        # of both sides' wheels: angles [rad], speed [rad/s] and its slope at the instant _since [s]
        self._wanted, self._speed, self._slope, self._correction = np.zeros((4, *self._act.shape))
        self._since = 0.0


@njit
def _roll(wanted, speed, slope, elapsed):
    """Move the angles and speeds asked for on by ``elapsed`` [s]; all (n, 2)."""
    for i in range(wanted.shape[0]):
        for k in range(2):
            wanted[i, k] += (speed[i, k] + 0.5 * slope[i, k] * elapsed) * elapsed
            speed[i, k] += slope[i, k] * elapsed


@njit
def _correct(act, set_point, qpos, wheel, wanted, correction, most):
    """Shift set points by what the integral part has changed since the last frame."""
    for i in range(wanted.shape[0]):
        for k in range(2):
            angle = qpos[wheel[i, k]]
            fresh = min(max(_INTEGRAL * (wanted[i, k] - angle), -most), most)
            # a wheel that is held does not run after what it has missed
            wanted[i, k] = angle + fresh / _INTEGRAL
            act[set_point[i, k]] += fresh - correction[i, k]
            correction[i, k] = fresh
