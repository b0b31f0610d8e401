"""Legged robots as arrays: position servos whose targets move no faster than the joints can."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mjmr.errors import InvalidInputError
from mjmr.robots.free_body import FreeBodies
from mjmr.robots.motion import BoundMotion, Proprioception
from mjmr.robots.platform import Array
from mjmr.robots.rest import alone

if TYPE_CHECKING:
    import mujoco

_SETTLE = 2.0  # s; a dropped robot is at rest long before
_DROP = 0.004  # m


class JointServos(FreeBodies):
    """Free bodies with k servoed joints each; a frame is the firmware's period.

    At every frame the servos' targets go towards what is wanted by at most rate x frame. What is
    wanted comes from a motion engine, or is the command itself.

    Attributes:
        frame: Between two updates of the targets [s].
    """

    def __init__(
        self,
        model: "mujoco.MjModel",
        prefixes: Sequence[str],
        *,
        joints: Sequence[str],
        rates: Array,
        home: Array,
        frame: float,
        motion: BoundMotion | None = None,
    ):
        """Look up every index once, and find how the robots stand.

        Args:
            model: The compiled model.
            prefixes: Of the robots. Each has a joint ``free``, hinges and position servos named as
                ``joints`` and an accelerometer called ``imu``.
            joints: Names (k,).
            rates: Fastest a target moves (k,) [rad/s].
            home: Angles (k,) [rad] in which the robots are placed.
            frame: [s].
            motion: Engine for these robots; without one commands are joint angles (n, k).
        """
        self.frame = frame
        super().__init__(model, prefixes)
        hinges = [[model.joint(f"{p}{j}") for j in joints] for p in prefixes]
        self._angle = np.array([[j.qposadr[0] for j in row] for row in hinges])
        self._rate = np.array([[j.dofadr[0] for j in row] for row in hinges])
        self._servo = np.array([[model.actuator(f"{p}{j}").id for j in joints] for p in prefixes])
        self._imu = np.array([model.sensor(f"{p}imu").adr[0] for p in prefixes])
        self._imu = self._imu[:, None] + np.arange(3)
        self._low, self._high = model.actuator_ctrlrange[self._servo].transpose(2, 0, 1)
        self._step = np.asarray(rates) * frame
        self._names = [p.rstrip("/") for p in prefixes]
        self._home = np.asarray(home, dtype=np.float64)
        self._height, self._tilt, self._sagged = self._stand(model)
        self._motion = motion
        self._command = np.zeros((len(prefixes), 0))

    def place(self, data: "mujoco.MjData", poses: Array) -> None:
        """Put the robots at rest at ``poses``: as deep in the floor and sagged as weight makes."""
        half = poses[:, 2] / 2.0
        data.qpos[self._qpos[:, :2]] = poses[:, :2]
        data.qpos[self._qpos[:, 2]] = self._height
        c, s = np.cos(half), np.sin(half)
        w, x, y, z = self._tilt
        upright = np.stack([c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w], axis=-1)
        data.qpos[self._qpos[:, 3:]] = upright
        data.qpos[self._angle] = self._sagged
        data.qvel[self._qvel] = 0.0
        data.qvel[self._rate] = 0.0
        data.ctrl[self._servo] = self._home

    def joint_angles(self, data: "mujoco.MjData") -> Array:
        """Measured angles (n, k) [rad]."""
        return data.qpos[self._angle]

    def joint_rates(self, data: "mujoco.MjData") -> Array:
        """Speeds of the joints (n, k) [rad/s]."""
        return data.qvel[self._rate]

    def joint_targets(self, data: "mujoco.MjData") -> Array:
        """Targets of the servos (n, k) [rad]."""
        return data.ctrl[self._servo]

    @property
    def motion_status(self) -> Array | None:
        """What the engine says each robot is doing (n,), a copy; None if it does not say."""
        status = getattr(self._motion, "status", None)
        return None if status is None else np.array(status)

    def ramp(self, data: "mujoco.MjData", start: Array, target: Array, period: float) -> None:
        """Take the command of a period: the firmware gets ``target`` (n, c) by radio, at once."""
        self._command = target

    def servo(self, data: "mujoco.MjData", time: float) -> None:
        """Move the targets by one frame.

        Raises:
            InvalidInputError: The engine's targets have another shape or are not finite.
        """
        wanted = self._command
        if self._motion is not None:
            sensed = Proprioception(data.qpos[self._angle], data.sensordata[self._imu], time)
            wanted = self._motion.targets(self._command, sensed)
            self._check(wanted)
        now = data.ctrl[self._servo]
        ahead = np.clip(wanted, self._low, self._high) - now
        data.ctrl[self._servo] = now + np.clip(ahead, -self._step, self._step)

    def state(self) -> Any:
        """Command in force and the engine's state; the targets are in the physics."""
        return self._command, None if self._motion is None else self._motion.state()

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        self._command, motion = state
        if self._motion is not None:
            self._motion.set_state(motion)

    def _check(self, wanted: Array) -> None:
        if np.shape(wanted) != self._servo.shape:
            raise InvalidInputError(
                f"a motion engine gives targets of shape {self._servo.shape}; got "
                f"{np.shape(wanted)}"
            )
        if not np.isfinite(wanted).all():
            bad = np.flatnonzero(~np.isfinite(wanted).all(axis=1))
            names = ", ".join(self._names[i] for i in bad)
            raise InvalidInputError(f"joint targets must be finite; they are not for {names}")

    def _stand(self, model: "mujoco.MjModel") -> tuple[float, Array, Array]:
        """Height, tilt (4,) and joint angles (k,) in which the first robot comes to rest.

        It is dropped from just above the floor in a copy of the model in which nothing else
        touches it: servos give way to weight, so no closed form would do.
        """
        import mujoco

        only = alone(model, self._base)
        data = mujoco.MjData(only)
        data.qpos[self._angle] = self._home
        data.ctrl[self._servo] = self._home
        data.qpos[self._qpos[:, 2]] = 1.0
        mujoco.mj_kinematics(only, data)
        own = (model.body_rootid[model.geom_bodyid] == self._base) & (model.geom_contype > 0)
        lowest = (data.geom_xpos[own, 2] - only.geom_rbound[own]).min()
        data.qpos[self._qpos[:, 2]] = 1.0 - lowest + _DROP
        mujoco.mj_step(only, data, round(_SETTLE / only.opt.timestep))
        pose = data.qpos[self._qpos[0]]
        tilt = pose[3:].copy()
        # without the heading it may have turned to: about the vertical, which comes first
        yaw = np.arctan2(tilt[3], tilt[0])
        c, s = np.cos(yaw), np.sin(yaw)
        w, x, y, z = tilt
        tilt = np.array([c * w + s * z, c * x + s * y, c * y - s * x, c * z - s * w])
        return float(pose[2]), tilt, data.qpos[self._angle[0]].copy()
