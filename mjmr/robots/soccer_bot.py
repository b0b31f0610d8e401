"""SoccerBot: a RoboCup F180 robot, 90 mm in radius, 2.5 kg (assets/soccer_bot/README.md)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mjmr.assets import model_path
from mjmr.errors import UnknownNameError
from mjmr.geometry import wrap_angle
from mjmr.robots.markings import TEAM_COLOURS, draw_digit, marker_colours
from mjmr.robots.platform import Array, Drive, Platform

if TYPE_CHECKING:
    import mujoco

    from mjmr.sensors.base import Sensor

DRIVES = ("planar",)


class SoccerBot(Platform):
    """Holonomic soccer robot; commands are body-frame twists (forward, left, anticlockwise)."""

    name = "soccer_bot"
    radius = 0.090
    height = 0.150
    max_twist = (3.0, 12.0)
    braking = 6.0

    def __init__(self, drive: str = "planar"):
        """Args: drive: ``"planar"``: two slides and a hinge with force-limited velocity servos.

        Raises:
            UnknownNameError: Unknown drive.
        """
        if drive not in DRIVES:
            raise UnknownNameError("drive of SoccerBot", drive, DRIVES)
        self.drive_name = drive

    def model(self, number: int, team: str) -> "mujoco.MjSpec":
        """Model of one robot with its team's ring, its dot pattern and its number on the back."""
        import mujoco

        spec = mujoco.MjSpec.from_file(str(model_path(self.name)))
        for key in list(spec.keys):
            spec.delete(key)
        rgba = TEAM_COLOURS[team]
        spec.material("team").rgba = rgba
        base = spec.body("base")
        top = np.array(spec.site("top").pos)
        dots = [(0.0, 0.0, 0.025, rgba)]
        for (x, y), colour in zip(_DOTS, marker_colours(number), strict=True):
            dots.append((x, y, 0.020, colour))
        for x, y, radius, colour in dots:
            base.add_geom(
                type=mujoco.mjtGeom.mjGEOM_CYLINDER,
                pos=top + [x, y, 0.0006],
                size=[radius, 0.0006, 0],
                rgba=colour,
                contype=0,
                conaffinity=0,
                group=1,
                mass=0,
            )
        draw_digit(spec.site("back"), base, number % 10, height=0.05)
        return spec

    def bind(self, model: "mujoco.MjModel", prefixes: Sequence[str]) -> Drive:
        """Drive of the robots attached under ``prefixes``."""
        return PlanarDrive(model, prefixes)

    def default_sensors(self) -> "dict[str, Sensor]":
        """An exact overhead localizer at 60 Hz."""
        from mjmr.sensors.localizer import Localizer

        return {"localizer": Localizer(rate=60.0)}


# front left, back left, back right, front right: the league's layout keeps the front open
_DOTS = ((0.035, 0.0548), (-0.0548, 0.035), (-0.0548, -0.035), (0.035, -0.0548))


class PlanarDrive:
    """Slide, slide, hinge: velocity servos whose set point is ramped, with feed-forward."""

    servo_steps: int | None = None

    def __init__(self, model: "mujoco.MjModel", prefixes: Sequence[str]):
        """Look up every index once."""
        self._half_step = model.opt.timestep / 2.0
        joints = [[model.joint(f"{p}{j}") for j in ("x", "y", "yaw")] for p in prefixes]
        self._qpos = np.array([[j.qposadr[0] for j in row] for row in joints])
        self._qvel = np.array([[j.dofadr[0] for j in row] for row in joints])
        servos = [[model.actuator(f"{p}{a}") for a in ("x", "y", "yaw")] for p in prefixes]
        self._servo = np.array([[a.id for a in row] for row in servos])
        self._act = np.array([[model.actuator_actadr[a.id] for a in row] for row in servos])
        self._feed = np.array(
            [[model.actuator(f"{p}{a}_feed").id for a in ("x", "y", "yaw")] for p in prefixes]
        )
        for row, prefix, actuators in zip(joints, prefixes, servos, strict=True):
            limits = model.numeric(f"{prefix}drive_limit").data
            for joint, limit, servo in zip(row, limits, actuators, strict=True):
                _limit_force(model, joint.id, float(limit), servo.id)

    def place(self, data: "mujoco.MjData", poses: Array) -> None:
        """Put the robots at rest at ``poses``."""
        data.qpos[self._qpos] = poses
        data.qvel[self._qvel] = 0.0
        data.act[self._act] = 0.0

    def poses(self, data: "mujoco.MjData") -> Array:
        """Poses (n, 3), world frame."""
        poses = data.qpos[self._qpos]
        poses[:, 2] = wrap_angle(poses[:, 2])
        return poses

    def twists(self, data: "mujoco.MjData") -> Array:
        """Twists (n, 3), body frame."""
        return _turn(data.qvel[self._qvel], -data.qpos[self._qpos[:, 2]])

    def ramp(self, data: "mujoco.MjData", start: Array, target: Array, period: float) -> None:
        """Ramp the servos' set points from ``start`` to ``target`` over one period.

        The drive pushes in the body frame, so the end of the ramp is turned by the yaw the ramp
        itself will add. MuJoCo's integrator moves a body for a whole step at the velocity of the
        step's end, so that velocities belong half a step before their positions; the set point is
        shifted by as much, which makes the distance covered in a period that of the ramp.
        """
        yaw = data.qpos[self._qpos[:, 2]]
        begin = _turn(start, yaw)
        end = _turn(target, yaw + (start[:, 2] + target[:, 2]) * (period / 2.0))
        acceleration = (end - begin) / period
        data.act[self._act] = begin - acceleration * self._half_step
        data.ctrl[self._servo] = acceleration
        data.ctrl[self._feed] = acceleration

    def servo(self, data: "mujoco.MjData") -> None:
        """Nothing: the ramp is integrated by the actuators themselves."""


def _limit_force(model: "mujoco.MjModel", joint: int, limit: float, servo: int) -> None:
    """Limit what a servoed joint really applies to ``limit`` [N or Nm].

    MuJoCo clamps the force before the implicit integrator takes off what the servo's damping will
    undo within the step, a factor of 1 + kv dt / m; the clamp is widened by it.
    """
    import mujoco

    gain = model.actuator_gainprm[servo, 0]
    body = model.jnt_bodyid[joint]
    slides = model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_SLIDE
    inertia = model.body_mass[body] if slides else model.body_inertia[body].max()
    clamp = limit * (1.0 + gain * model.opt.timestep / inertia)
    model.jnt_actfrcrange[joint] = (-clamp, clamp)


def _turn(twist: Array, yaw: Array) -> Array:
    c, s = np.cos(yaw), np.sin(yaw)
    turned = np.empty_like(twist)
    turned[:, 0] = c * twist[:, 0] - s * twist[:, 1]
    turned[:, 1] = s * twist[:, 0] + c * twist[:, 1]
    turned[:, 2] = twist[:, 2]
    return turned
