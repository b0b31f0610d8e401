"""PanTilt: a unit that turns a camera on every robot, with limited angles and rates."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.assets import model_path
from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.geometry import Pinhole, rotation_matrix
from mjmr.sensors.aim import aimed_angles
from mjmr.sensors.base import Sensor, carrier_body

if TYPE_CHECKING:
    import mujoco

    from mjmr.group import Group
    from mjmr.sensors.camera import Camera

Array = NDArray[np.float64]
AXES = ("pan", "tilt")


class PanTilt(Sensor):
    """A Sony EVI-D30 (assets/evi_d30/README.md), or the pan-tilt unit a robot has of its own.

    It is aimed by :meth:`aim` and reads its own angles; pan is anticlockwise seen from above, tilt
    is up. In a line::

        robots.mount(PanTilt(site="camera"))
        robots.mount(Camera(at="pan_tilt", width=320, height=240))

    Where the robot's model has joints and actuators named ``pan`` and ``tilt`` nothing is added and
    those are used, the actuators' set points as rate-limited as here; angles then count as the
    model's joints do, and the camera is called what the model calls it.

    In a kinematic simulation it moves exactly as fast as it can.

    Attributes:
        clamped: Aims cut to the angles the unit can reach so far, shape (n,).
    """

    name = "pan_tilt"

    def __init__(
        self,
        *,
        site: str = "camera",
        body: str = "",
        position: ArrayLike | None = None,
        pan: tuple[float, float] | None = None,
        tilt: tuple[float, float] | None = None,
        rates: tuple[float, float] = (math.radians(80.0), math.radians(50.0)),
        steps: tuple[float, float] = (math.radians(100 / 880), math.radians(25 / 300)),
        rate: float = 30.0,
        latency: float = 0.0,
        phase: float = 0.0,
    ):
        """Set place, limits and schedule; all defaults are those of the EVI-D30.

        Args:
            site: Of the robot's model, on which the unit stands, x forward; or give a position.
            body: Of the robot, whose frame ``position`` is in; default: its first.
            position: Of the unit's foot, below the pan axis (3,) [m].
            pan: Least and largest angle [rad]; None: as modelled, +-100 degrees.
            tilt: Least and largest angle [rad]; None: as modelled, +-25 degrees.
            rates: At most, of pan and of tilt [rad/s].
            steps: Of the angles it reports [rad].
            rate: Reports of the angles a second [Hz].
            latency: Of the reports [s].
            phase: Instant of the first report [s].

        Raises:
            InvalidInputError: Angles out of order, rates or steps that are not positive, or a body
                without a position.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        for axis, limits in zip(AXES, (pan, tilt), strict=True):
            if limits is not None and not (
                len(limits) == 2
                and -2 * math.pi <= limits[0] <= 0 <= limits[1] <= 2 * math.pi
                and limits[0] < limits[1]
            ):
                raise InvalidInputError(
                    f"{axis} needs a least and a larger angle within a turn, with 0, where it "
                    f"starts, between them [rad]; got {limits}"
                )
        for name, pair in (("rates", rates), ("steps", steps)):
            if len(pair) != 2 or not all(0 < value < math.inf for value in pair):
                raise InvalidInputError(
                    f"{name} of pan and tilt must be positive and finite; got {pair}"
                )
        if body and position is None:
            raise InvalidInputError(
                f"a pan-tilt unit's place on the body {body!r} takes a position (3,)"
            )
        self._site, self._body = site, body
        self._position = None if position is None else np.array(position, dtype=np.float64)
        if self._position is not None and not (
            self._position.shape == (3,) and np.isfinite(self._position).all()
        ):
            raise InvalidInputError("a pan-tilt unit's position has three finite numbers")
        self._limits, self._rates, self._steps = (pan, tilt), rates, np.array(steps)

    def aim(self, pan: ArrayLike, tilt: ArrayLike) -> None:
        """Turn to these angles, at most as fast as the unit can; they hold until the next call.

        Set points move in a straight line over every control period. Angles out of reach are cut
        and counted in ``clamped``.

        Args:
            pan: Shape (n,), or one for all [rad], anticlockwise from straight ahead.
            tilt: Shape (n,), or one for all [rad], up from level.

        Raises:
            InvalidInputError: Another shape, NaN or infinity (names the robots), or no simulation.
        """
        self._in_simulation()
        aimed = aimed_angles(self._group, pan=pan, tilt=tilt)
        within = np.clip(aimed, self._low, self._high)
        self.clamped += (within != aimed).any(axis=1)
        self._goal = within

    @property
    def aimed(self) -> Array:
        """Angles aimed at (n, 2) [rad]: pan and tilt, cut to what can be reached; a copy."""
        self._in_simulation()
        return self._goal.copy()

    @property
    def limits(self) -> Array:
        """Least and largest pan, least and largest tilt (2, 2) [rad]."""
        self._in_simulation()
        return np.column_stack([self._low, self._high])

    def read(self) -> Array:
        """Newest angles delivered by now, shape (n, 2): pan and tilt, in whole steps [rad].

        NaN before the first delivery.
        """
        return super().read()

    @property
    def reading_bounds(self) -> tuple[Array, Array]:
        """Least and largest pan and tilt that :meth:`read` can return, (2,) each [rad]."""
        self._in_simulation()
        return self._low - self._steps / 2.0, self._high + self._steps / 2.0

    def camera_poses(self, angles: ArrayLike) -> Array:
        """Poses of the unit's camera at given angles, in the frame of the robots' first body.

        Args:
            angles: Shape (n, 2): pan and tilt [rad], for example those of :meth:`read`.

        Returns:
            T_robot_camera, shape (n, 4, 4) [m]; the camera's axes are the image's right, down and
            forward.
        """
        self._in_simulation()
        at = np.asarray(angles, dtype=np.float64)
        if at.ndim != 2 or at.shape[1] != 2:
            raise InvalidInputError(f"angles must have shape (n, 2): pan, tilt; got {at.shape}")
        anchors, axes, where, rotation = self._chain
        turn_pan, turn_tilt = _rotations(axes[0], at[:, 0]), _rotations(axes[1], at[:, 1])
        tilted = anchors[1] + turn_tilt @ (where - anchors[1])
        poses = np.tile(np.eye(4), (len(at), 1, 1))
        poses[:, :3, :3] = turn_pan @ turn_tilt @ rotation
        poses[:, :3, 3] = anchors[0] + np.einsum("nij,nj->ni", turn_pan, tilted - anchors[0])
        return poses

    def pinhole(
        self, camera: "Camera", angles: ArrayLike, pose: ArrayLike | None = None
    ) -> Pinhole:
        """The ideal camera of one robot at given angles, to project points with.

        Args:
            camera: The camera at this unit, for its image.
            angles: Pan and tilt (2,) [rad].
            pose: Of the robot: (x, y, yaw) [m, m, rad], upright on the floor, or position and
                quaternion (7,) with height and tilt; the result is in the frame that pose is in.
                None: in the frame of the robot's first body.

        Raises:
            InvalidInputError: Angles or a pose of another shape.
        """
        transform = self.camera_poses(np.asarray(angles, dtype=np.float64)[None])[0]
        position, rotation = transform[:3, 3], transform[:3, :3]
        if pose is not None:
            at = np.asarray(pose, dtype=np.float64)
            if at.shape == (3,):
                x, y, yaw = at
                at = np.array([x, y, 0.0, math.cos(yaw / 2.0), 0.0, 0.0, math.sin(yaw / 2.0)])
            if at.shape != (7,):
                raise InvalidInputError(f"a pose has 3 numbers or 7; got shape {at.shape}")
            turn = rotation_matrix(at[3:])
            position, rotation = at[:3] + turn @ position, turn @ rotation
        image = camera.calibration
        return Pinhole(position, rotation, image.focal, image.width, image.height)

    def add_to(self, spec: "mujoco.MjSpec", prefixes: Sequence[str], key: str) -> None:
        """Stand a unit on every robot, or take over the one it has.

        Raises:
            UnknownNameError: The model has no such site or body.
            InvalidInputError: The robot's own unit does not turn that far, stands elsewhere than
                at the position given, or is moved by another PanTilt.
        """
        import mujoco

        unit = f"{key}/"
        for prefix in prefixes:
            own = {j.name for j in spec.joints} >= {f"{prefix}{a}" for a in AXES}
            if own:
                if self._position is not None:
                    raise InvalidInputError(
                        f"{prefix.rstrip('/')} has a pan-tilt unit of its own; leave position out"
                    )
                self._take_over(spec, prefix)
                continue
            child = mujoco.MjSpec.from_file(str(model_path("evi_d30")))
            for old in list(child.keys):
                child.delete(old)
            for axis, limits in zip(AXES, self._limits, strict=True):
                if limits is not None:
                    child.joint(axis).range = limits
                    child.actuator(axis).actrange = limits
            for axis, top in zip(AXES, self._rates, strict=True):
                child.actuator(axis).ctrlrange = [-top, top]
            name = f"{prefix}{unit}"
            if self._position is not None:
                body = carrier_body(spec, prefix, self._body)
                spec.attach(child, prefix=name, frame=body.add_frame(pos=self._position))
            else:
                sites = [s.name for s in spec.sites if s.name.startswith(prefix)]
                if prefix + self._site not in sites:
                    valid = [s.removeprefix(prefix) for s in sites]
                    raise UnknownNameError("site of the robot's model", self._site, valid)
                spec.attach(child, prefix=name, site=spec.site(prefix + self._site))
            spec.camera(f"{name}camera").name = f"{prefix}{key}"

    def _take_over(self, spec: "mujoco.MjSpec", prefix: str) -> None:
        """Let the set points of a robot's own position servos be integrals of rates."""
        import mujoco

        for axis, limits, top in zip(AXES, self._limits, self._rates, strict=True):
            joint, actuator = spec.joint(prefix + axis), spec.actuator(prefix + axis)
            if actuator is None:
                own = [a.name.removeprefix(prefix) for a in spec.actuators]
                raise UnknownNameError("actuator of the robot's model", axis, own)
            if actuator.dyntype == mujoco.mjtDyn.mjDYN_INTEGRATOR:
                raise InvalidInputError(
                    f"the {axis} of {prefix.rstrip('/')} is moved by another PanTilt already"
                )
            low, high = limits or joint.range
            if not joint.range[0] - 1e-9 <= low < high <= joint.range[1] + 1e-9:
                raise InvalidInputError(
                    f"the {axis} of {prefix.rstrip('/')} turns from {joint.range[0]:g} to "
                    f"{joint.range[1]:g} rad; got {low:g} to {high:g}"
                )
            actuator.dyntype = mujoco.mjtDyn.mjDYN_INTEGRATOR
            actuator.inheritrange = 0.0  # it would undo the range set here
            actuator.actlimited, actuator.actrange = 1, [low, high]
            actuator.ctrllimited, actuator.ctrlrange = 1, [-top, top]
            actuator.actearly = True

    def prepare(self, sequence: np.random.SeedSequence, group: "Group") -> None:
        """Look up joints, servos and limits; nothing is random."""
        import mujoco

        simulation: Any = self._simulation
        self._data: Any = getattr(simulation, "data", None)
        model = simulation.studio.model if self._data is None else simulation.model
        key = next(key for key, sensor in group.sensors.items() if sensor is self)
        added = f"{group.prefixes[0]}{key}/" in {
            model.joint(i).name.removesuffix("pan") for i in range(model.njnt)
        }
        units = [f"{p}{key}/" if added else p for p in group.prefixes]
        self._angles = np.array([[model.joint(u + a).qposadr[0] for a in AXES] for u in units])
        self._servos = np.array([[model.actuator(u + a).id for a in AXES] for u in units])
        self._points = model.actuator_actadr[self._servos]
        first = self._servos[0]
        self._low, self._high = model.actuator_actrange[first].T
        self._fastest = model.actuator_ctrlrange[first, 1]
        self._goal = np.tile(np.clip(0.0, self._low, self._high), (group.n, 1))
        # of a kinematic simulation: angles, rates, and the instant they hold from
        self._motion = np.zeros((group.n, 2)), np.zeros((group.n, 2)), 0.0
        self.clamped = np.zeros(group.n, dtype=np.int64)
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_camlight(model, data)
        self._chain = _chain(model, data, group.prefixes[0], units[0])

    def actuate(self, data: "mujoco.MjData | None", period: float) -> None:
        """Let the set points go towards what was aimed at during the period that begins."""
        assert self._simulation is not None
        time = self._simulation.time
        at = self.observe(time) if data is None else data.act[self._points]
        rates = np.clip((self._goal - at) / period, -self._fastest, self._fastest)
        if data is None:
            self._motion = at, rates, time
        else:
            data.ctrl[self._servos] = rates

    def observe(self, time: float) -> Array:
        """Angles now (n, 2)."""
        if self._data is not None:
            return self._data.qpos[self._angles]
        angles, rates, since = self._motion
        return angles + rates * (time - since)

    def place(self, data: "mujoco.MjData", parts: Array) -> None:
        """Put the units at angles (n, 2), for pictures."""
        data.qpos[self._angles] = parts

    def compute(self, state: Any, number: int) -> Array:
        """Whole steps."""
        return np.round(state / self._steps) * self._steps + 0.0  # no -0

    def nothing(self) -> Array:
        """All NaN."""
        return np.full((self._group.n, 2), np.nan)

    def state(self) -> Any:
        """What the unit remembers, for snapshots."""
        return super().state(), self._goal, self._motion, self.clamped.copy()

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        samples, self._goal, self._motion, clamped = state
        super().set_state(samples)
        self.clamped = clamped.copy()

    def _in_simulation(self) -> None:
        if self._simulation is None:
            raise InvalidInputError(
                f"the {self.name} can be used once its group is in a simulation"
            )


def _rotations(axis: Array, angles: Array) -> Array:
    """Rotations (n, 3, 3) about a unit axis (3,) by angles (n,), by Rodrigues' formula."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    sine, cosine = np.sin(angles)[:, None, None], np.cos(angles)[:, None, None]
    return np.eye(3) + sine * cross + (1.0 - cosine) * (cross @ cross)


def _chain(model: Any, data: Any, prefix: str, unit: str) -> tuple[Array, Array, Array, Array]:
    """Anchors and axes of pan and tilt, place and rotation of the camera, at angles of zero.

    All in the frame of the robot's first body; NaN for the camera if the unit carries none.
    """
    names = [model.body(i).name for i in range(model.nbody)]
    root = next(i for i, name in enumerate(names) if name.startswith(prefix))
    frame, origin = data.xmat[root].reshape(3, 3), data.xpos[root]
    joints = [model.joint(unit + a).id for a in AXES]
    anchors, axes = (data.xanchor[joints] - origin) @ frame, data.xaxis[joints] @ frame
    tilt = model.jnt_bodyid[joints[1]]
    for camera in range(model.ncam):
        body = model.cam_bodyid[camera]
        while body not in (tilt, 0):
            body = model.body_parentid[body]
        if body == tilt:
            rotation = data.cam_xmat[camera].reshape(3, 3) * [1.0, -1.0, -1.0]
            return anchors, axes, (data.cam_xpos[camera] - origin) @ frame, frame.T @ rotation
    return anchors, axes, np.full(3, np.nan), np.full((3, 3), np.nan)
