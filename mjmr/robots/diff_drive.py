"""The differential drive: a free body on two driven wheels and supports that slide."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mjmr.jit import njit
from mjmr.robots.free_body import FreeBodies, twist_inertia
from mjmr.robots.platform import Array
from mjmr.robots.rest import alone, rest

if TYPE_CHECKING:
    import mujoco

WHEELS = ("wheel_left", "wheel_right")
TREADS = ("tread_left", "tread_right")


class DiffDrive(FreeBodies):
    """Wheels' velocity servos whose set points are ramped, with feed-forward.

    Commands are (forward, turn). It serves any free body with a joint ``free`` whose origin is on
    the floor below the middle of an axle along y, hinges and servos named as ``WHEELS`` and wheels'
    contact shapes, ellipsoids or spheres, named as ``TREADS``. Nothing but wheel speeds is closed:
    heading and position are what the contacts make of them.

    Attributes:
        radius: Of the wheels [m], as drawn.
        rolling_radius: At which they roll under the robot's weight [m]: MuJoCo lets a contact act
            half as deep as the shapes overlap.
        track: Between the points where the wheels touch the floor [m].
        wheel_speeds: Of one robot (2, 2): wheel speeds [rad/s], left and right, = this times
            (forward, turn), by rolling without slip.
    """

    def __init__(
        self,
        model: "mujoco.MjModel",
        prefixes: Sequence[str],
        *,
        geared: Sequence[Sequence[str]] = ((), ()),
        rolling_radius: float | None = None,
        effective_track: float | None = None,
    ):
        """Look up every index once, and the geometry of the wheels.

        Args:
            model: The compiled model.
            prefixes: Of the robots in it.
            geared: Hinges of further wheels that the left and the right servo turn (k each).
            rolling_radius: Of the wheels [m]; by default what follows from how deep the first tread
                stands in the floor.
            effective_track: Of two wheels that would turn the robot as its sides do [m]; by default
                the track.
        """
        self._half_step = model.opt.timestep / 2.0
        super().__init__(model, prefixes)
        wheels = [[model.joint(f"{p}{w}") for w in WHEELS] for p in prefixes]
        self._wheel_qpos = np.array([[j.qposadr[0] for j in row] for row in wheels])
        self._wheel_qvel = np.array([[j.dofadr[0] for j in row] for row in wheels])
        self._servo = np.array([[model.actuator(f"{p}{w}").id for w in WHEELS] for p in prefixes])
        self._act = model.actuator_actadr[self._servo]
        further = [[model.joint(f"{p}{w}") for side in geared for w in side] for p in prefixes]
        self._geared_qpos = np.array([[j.qposadr[0] for j in row] for row in further], dtype=int)
        self._geared_qvel = np.array([[j.dofadr[0] for j in row] for row in further], dtype=int)
        stands = rest(model, self._base, self._qvel[0, [2, 4]])[self._qpos[0]]
        self._height, self._pitch = float(stands[2]), 2.0 * math.atan2(stands[5], stands[3])
        self.radius = float(model.geom_size[model.geom(f"{prefixes[0]}{TREADS[0]}").id, 0])
        self.rolling_radius = rolling_radius or self.radius + self._height / 2.0
        hubs = [model.body_pos[model.jnt_bodyid[j.id]] for j in wheels[0]]
        self.track = float(hubs[0][1] - hubs[1][1])
        self.wheel_speeds = wheel_speeds(self.rolling_radius, effective_track or self.track)
        sideways = np.insert(self.wheel_speeds, 1, 0.0, axis=1)
        turning = np.concatenate([self._wheel_qvel[0], self._geared_qvel[0]])
        sides = [0, 1] + [side for side, names in enumerate(geared) for _ in names]
        inertia = twist_inertia(alone(model, self._base), self._qvel[0], turning, sideways[sides])
        # a servo of gain k gives the torque t when its set point is t / k ahead
        share = np.linalg.inv(self.wheel_speeds).T
        share /= float(model.actuator_gainprm[self._servo[0, 0], 0])
        self._ahead = share @ inertia[np.ix_([0, 2], [0, 2])]
        # mass times how far its centre is ahead of the axle: what turning asks of the wheels
        self._turning = share * inertia[1, 2]

    def place(self, data: "mujoco.MjData", poses: Array) -> None:
        """Put the robots at rest at ``poses``, as deep in the floor as weight presses them."""
        yaw, pitch = poses[:, 2] / 2.0, self._pitch / 2.0
        data.qpos[self._qpos[:, :2]] = poses[:, :2]
        data.qpos[self._qpos[:, 2]] = self._height
        data.qpos[self._qpos[:, 3]] = np.cos(yaw) * np.cos(pitch)
        data.qpos[self._qpos[:, 4]] = -np.sin(yaw) * np.sin(pitch)
        data.qpos[self._qpos[:, 5]] = np.cos(yaw) * np.sin(pitch)
        data.qpos[self._qpos[:, 6]] = np.sin(yaw) * np.cos(pitch)
        data.qpos[self._wheel_qpos] = 0.0
        data.qpos[self._geared_qpos] = 0.0
        data.qvel[self._qvel] = 0.0
        data.qvel[self._wheel_qvel] = 0.0
        data.qvel[self._geared_qvel] = 0.0
        data.act[self._act] = 0.0

    def wheel_angles(self, data: "mujoco.MjData") -> Array:
        """Angles the wheels have turned (n, 2) [rad], left and right, forwards positive."""
        return data.qpos[self._wheel_qpos]

    def ramp(self, data: "mujoco.MjData", start: Array, target: Array, period: float) -> None:
        """Ramp the wheels' set points between two commands (n, 2) over one period.

        They are ahead by what the torque of the ramp takes and by what it takes to turn a centre
        of mass that is not on the axle, and shifted by half a step as in
        :class:`mjmr.robots.planar.PlanarDrive`.
        """
        _ramp(
            data.act, data.ctrl, self._act, self._servo, self.wheel_speeds, self._ahead,
            self._turning, start, target, period, self._half_step,
        )  # fmt: skip


def wheel_speeds(radius: float, track: float) -> Array:
    """Speeds [rad/s] of the left and the right wheel (2, 2) per unit of (forward, turn)."""
    return np.array([[1.0, -track / 2.0], [1.0, track / 2.0]]) / radius


@njit
def _ramp(act, ctrl, set_point, servo, speeds, ahead, turning, start, target, period, half_step):
    for i in range(start.shape[0]):
        forward, turn = 0.5 * (start[i, 0] + target[i, 0]), 0.5 * (start[i, 1] + target[i, 1])
        for k in range(2):
            # acceleration of the centre of mass towards and around the axle, mid-ramp
            begin = turning[k, 1] * forward * turn - turning[k, 0] * turn * turn
            slope = 0.0
            for c in range(2):
                rate = (target[i, c] - start[i, c]) / period
                begin += speeds[k, c] * start[i, c] + ahead[k, c] * rate
                slope += speeds[k, c] * rate
            act[set_point[i, k]] = begin - slope * half_step
            ctrl[servo[i, k]] = slope
